#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/rejections.hpp"
#include "conformance/interbus/slave_scene.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/code_words.hpp"

// IS-09 to IS-16: the frame check of both sides and the status word.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

// Another cycle in each round, one of four an ID cycle; the check is computed bit by bit.
void expect_check_of_what_left(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  bench.set_inputs(bench.random_words());
  const bool is_id_cycle = scene.round % 4 == 3;
  is_id_cycle ? bench.id_cycle(bench.interfaces_off()) : bench.data_cycle(bench.random_words());
  expect_all_telegrams(bench, scene.judge);
  const CycleOnLine out = cycle_that_left(bench, scene.judge, 0);
  const BitwiseCheck& check = bench.model().check();
  std::uint16_t state = check.start();
  for (std::size_t k = 0; k < out.octets; ++k) state = check.next(state, out.telegrams[k].data);
  scene.judge.expect(out.check() == check.word(state), "check_wrong", [&] {
    return Mismatch{
        .expected = {fmt::format("{:04X}h, the check of the octets that left", check.word(state))},
        .actual = fmt::format("{:04X}h", out.check()),
        .time = bench.out().start_of(out.telegrams[out.octets]),
        .first_difference = fmt::format("check of {} cycle {}", is_id_cycle ? "ID" : "data", scene.round)};
  });
}

SlaveChart check_chart() {
  return {.rounds = {30, 1'000},
          .steps = {{"a valid data or ID cycle with random inputs and words",
                     "the check that leaves equals the check, computed bit by bit, of the octets that left",
                     expect_check_of_what_left}},
          .first = {identified()}};
}

constexpr std::size_t kCheckBits = 16;  // the last ones of the code word

// One bit of the check, or of what it covers, in turn: rejected, marked, reported in the next ID cycle.
SlaveChart flipped_bits_chart(bool is_of_check) {
  const auto count = [is_of_check](SlaveScene& scene) {
    return is_of_check ? kCheckBits : scene.bench.code_word_bits() - kCheckBits;
  };
  const auto in_turn = [is_of_check, count](SlaveScene& scene, const CyclePlace& cycle) {
    const std::size_t first = is_of_check ? scene.bench.code_word_bits() - kCheckBits : 0;
    return scene.bench.code_word_level(cycle, first + scene.round % count(scene));
  };
  return {
      .rounds = {1, 20},
      .steps = {flipped("a data cycle in which it is flipped at the slave's receiver", in_turn), rejected(),
                check_error(true, "message_missing", "the cycle before it was rejected"),
                good_cycle("no_recovery")},
      .first = {identified(), good_cycle()},
      .walk = {is_of_check ? "each bit of the check" : "each bit of loopback word and process data", count}};
}

// ---- many error patterns ----

std::uint32_t random_bit(SlaveBench& bench) {
  return static_cast<std::uint32_t>(bench.random().below(bench.code_word_bits()));
}

void two_and_three_bits_flipped(SlaveBench& bench, CaseJudge& judge) {
  Rejections rejections(bench, judge, "double_or_triple_error_accepted");
  const auto bits = static_cast<std::uint32_t>(bench.code_word_bits());
  // Every pair of a two-word register; a longer one is sampled at the same number.
  constexpr std::uint32_t kExhaustive = 64;
  const std::uint32_t step = bench.volume(7U, 1U);
  std::uint32_t pair = 0;
  for (std::uint32_t a = 0; a < bits; ++a) {
    for (std::uint32_t b = a + 1; b < bits; ++b, ++pair) {
      const bool is_due = bits <= kExhaustive
                              ? pair % step == 0 || a + 8 >= bits
                              : bench.random().below(std::uint64_t{bits} * bits) < 4'000 / step;
      if (is_due) rejections.add(std::array{a, b});
    }
  }
  for (unsigned n = 0; n < bench.volume(300U, 100'000U); ++n) {
    const std::uint32_t a = random_bit(bench);
    std::uint32_t b = random_bit(bench);
    std::uint32_t c = random_bit(bench);
    while (b == a) b = random_bit(bench);
    while (c == a || c == b) c = random_bit(bench);
    rejections.add(std::array{a, b, c});
  }
  rejections.finish();
}

void add_burst(Rejections& rejections, std::uint32_t at, unsigned length, std::uint32_t inner) {
  std::array<std::uint32_t, 16> bits{};
  std::size_t count = 0;
  bits[count++] = at;
  for (unsigned n = 0; n + 2 < length; ++n) {
    if ((inner >> n & 1U) != 0) bits[count++] = at + 1 + n;
  }
  bits[count++] = at + length - 1;
  rejections.add(BitPattern(bits.data(), count));
}

void bursts_are_rejected(SlaveBench& bench, CaseJudge& judge) {
  Rejections rejections(bench, judge, "burst_accepted");
  const auto bits = static_cast<std::uint32_t>(bench.code_word_bits());
  // Up to this length every burst; of longer ones some at each position, drawn, and the densest one.
  constexpr std::uint32_t kExhaustive = 64;
  const unsigned exhaustive = bench.volume(2U, bits <= kExhaustive ? 16U : 10U);
  const std::uint32_t drawn = bench.volume(1U, 32U);
  const std::uint32_t step = bench.volume(3U, 1U);
  for (unsigned length = 2; length <= 16; ++length) {
    const std::uint32_t all = 1U << (length - 2);
    for (std::uint32_t at = length % step; at + length <= bits; at += step) {
      if (length <= exhaustive) {
        for (std::uint32_t inner = 0; inner < all; ++inner) add_burst(rejections, at, length, inner);
        continue;
      }
      for (std::uint32_t n = 0; n < drawn; ++n)
        add_burst(rejections, at, length, static_cast<std::uint32_t>(bench.random().below(all)));
      add_burst(rejections, at, length, all - 1);
    }
  }
  rejections.finish();
}

// ---- code words ----

void weight_four_code_words_are_accepted(SlaveBench& bench, CaseJudge& judge) {
  const auto span = static_cast<unsigned>(std::min<std::size_t>(64, bench.code_word_bits()));
  const auto offset = static_cast<std::uint32_t>(bench.code_word_bits() - span);
  const line::FrameCheckParameters& parameters = line::frame_check_named(bench.rules().frame_check);
  const auto patterns = line::weight_four_code_words(parameters, span);
  FIELDPROOF_CHECK(parameters.poly != 0x1021 || span != 64 || patterns.size() == 84,
                   "1021h has 84 code words of weight four in 64 bits");
  judge.measure("code words of weight four", "", static_cast<double>(patterns.size()));
  for (const line::FourBits& pattern : patterns) {
    bench.begin();
    const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
    bench.channel().on_next();
    for (const std::uint32_t bit : pattern) bench.channel().flip(bench.code_word_level(cycle, offset + bit));
    bench.send();
    expect_all_telegrams(bench, judge);
    const CycleOnLine out = cycle_that_left(bench, judge, 0);
    const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), 0);
    if (!in) judge.inconclusive("cycle_did_not_arrive", {{"the cycle arrives whole"}, "it did not"});
    const std::vector<std::uint16_t> arrived = words_held(in->telegrams.first(in->octets), bench.words());
    expect_outputs(bench, judge, arrived, "weight_four_code_word_rejected");
    expect_clean_status(bench, judge, out);
  }
}

// A cycle of so many more octets of zeros than the ring has, with the check of a cycle of `checked` more; or
// with the check of a register that was preset with zeros.
void drive_zeros(SlaveScene& scene, int more, std::optional<int> checked) {
  SlaveBench& bench = scene.bench;
  const auto zeros = [&](int n) {
    return std::vector<std::uint8_t>(static_cast<std::size_t>(2 + 2 * static_cast<int>(bench.words()) + n));
  };
  TrainWriter writer(bench.rules());
  writer.cycle(false, zeros(more), checked ? bench.model().check().of(zeros(*checked)) : 0,
               bench.rules().status_clean);
  line::Waveform wave{bench.now(), bench.rules().bit_rate, writer.levels()};
  bench.drive_at_receiver(wave);
}

SlaveStep zeros_rejected(std::string text, int more, std::optional<int> checked, std::string reason) {
  return {"a cycle of zeros, loopback word included, " + text, "it is rejected, no output changes",
          [text, more, checked, reason = std::move(reason)](SlaveScene& scene) {
            drive_zeros(scene, more, checked);
            scene.judge.expect(!left_clean(scene.bench), reason, "a cycle of zeros is rejected " + text,
                               "the status word left unmarked");
            expect_no_change(scene.bench, scene.judge, "output_changed_by_rejected_cycle",
                             "the cycle does not pass its check");
          }};
}

void zeros_accepted(SlaveScene& scene) {
  drive_zeros(scene, 0, 0);
  expect_outputs(scene.bench, scene.judge, std::vector<std::uint16_t>(scene.bench.words()),
                 "valid_cycle_rejected");
  scene.judge.expect(left_clean(scene.bench), "status_word_wrong",
                     "a cycle of zeros with its own check is accepted",
                     "its status word did not leave clean");
}

// ---- status word ----

void marked_in_front(SlaveBench& bench, CaseJudge& judge) {
  bench.begin();
  mark_in_front(bench, bench.append_data_cycle(bench.random_words()));
  bench.send();
  expect_all_telegrams(bench, judge);
  const CycleOnLine out = cycle_that_left(bench, judge, 0);
  const std::uint16_t marked = bench.rules().status_marked;
  judge.expect((out.status() & marked) == marked, "mark_of_others_cleared", [&] {
    return Mismatch{.expected = {fmt::format("status word {:04X}h, as it came", marked)},
                    .actual = fmt::format("status word {:04X}h", out.status()),
                    .time = bench.out().start_of(out.telegrams[out.octets + 2])};
  });
  expect_no_change(bench, judge, "marked_cycle_latched", "a station before the slave saw an error");
}

judge::Reference checks_of_both_sides() {
  return sources::practical_guide(
      "a check generator at the receive side and one at the send side of each device");
}

std::vector<SlaveCase> cases_of_checks() {
  const std::vector<PartialSource> rests_on{details::mark(), details::message(), details::status_coding()};
  return {
      slave_case("frame_check/leaves_for_what_the_slave_itself_sent", "IS-09",
                 "In the check phase a slave sends the check of the bits that it sent itself, not of those "
                 "that it received: polynomial x^16 + x^12 + x^5 + 1, register preset with ones.",
                 checks_of_both_sides(),
                 {{"crc_preset_zero", "check_wrong"},
                  {"crc_polynomial_8005", "check_wrong"},
                  {"sends_check_of_received_bits", "check_wrong"},
                  {"check_not_reset_between_cycles", "check_wrong"}},
                 check_chart(), {.details = {details::check_coding()}}),
      slave_case("frame_check/flipped_data_bit_is_rejected_marked_and_told", "IS-10",
                 "A slave whose received check does not fit what it received marks the status word that "
                 "passes, takes nothing over, and reports the error in the next ID cycle.",
                 sources::practical_guide("comparison with the checksum of the previous device"),
                 {{"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"},
                  {"does_not_mark_status", "error_not_marked"},
                  {"tells_no_check_error", "message_missing"}},
                 flipped_bits_chart(false), {.details = rests_on}),
      slave_case(
          "frame_check/flipped_check_bit_is_rejected_marked_and_told", "IS-11",
          "An error in the check itself is an error like one in the data: each of its 16 bits is compared.",
          checks_of_both_sides(),
          {{"compares_first_check_octet_only", "error_not_marked"},
           {"does_not_mark_status", "error_not_marked"},
           {"tells_no_check_error", "message_missing"}},
          flipped_bits_chart(true), {.details = rests_on}),
      slave_case(
          "frame_check/another_final_xor_counts", "IS-44",
          "The frame check is as the settings of the case say: its final XOR is FFFFh.",
          sources::own("the final XOR of the frame check is a setting"),
          {{"final_xor_hard_coded", "check_wrong"}}, check_chart(),
          {.details = {details::check_coding()},
           .only_for = for_other_settings(),
           .needs = {.change_rules = [](interbus::Rules& rules) { rules.frame_check = "CRC-16/GENIBUS"; }}})};
}

std::vector<SlaveCase> cases_of_cycles() {
  return {
      slave_case("frame_check/zeros_do_not_hide_a_lost_octet", "IS-15",
                 "The registers of the frame check are preset with ones, so that leading zeros count: a "
                 "frame of zeros that lost or gained an octet does not pass.",
                 sources::practical_guide("registers preset with 1 to improve detection"),
                 {{"crc_preset_zero", "valid_cycle_rejected"},
                  {"accepts_check_of_zero", "zero_preset_check_accepted"}},
                 {.steps = {identified(),
                            good_cycle(),
                            zeros_rejected("with the check of a register that was preset with zeros", 0, {},
                                           "zero_preset_check_accepted"),
                            zeros_rejected("one octet short with the check of the right length", -1, 0,
                                           "lost_zero_octet_accepted"),
                            zeros_rejected("one octet long with the check of the right length", 1, 0,
                                           "added_zero_octet_accepted"),
                            {"a cycle of zeros with its own check", "it is accepted", zeros_accepted}}},
                 {.details = {details::mark({"zero_preset_check_accepted", "lost_zero_octet_accepted",
                                             "added_zero_octet_accepted"}),
                              details::status_coding()}}),
      slave_case(
          "frame_check/mark_of_others_is_kept_and_obeyed", "IS-16",
          "A status word that another station has marked passes marked, and its cycle is not taken over even "
          "though the slave's own check fits (the slave-local rule). It is no error of this slave: reported "
          "as one, it would hide where the error lies.",
          sources::from_memory("the status word tells later stations and the master"),
          {{"ignores_upstream_status", "marked_cycle_latched"},
           {"clears_mark_of_others", "mark_of_others_cleared"},
           {"tells_errors_of_others", "error_of_others_told"}},
          {.rounds = {3, 30},
           .steps = {step("a data cycle whose data and check are right and whose status word arrives marked",
                          "the status word leaves marked, no output changes", marked_in_front),
                     check_error(false, "error_of_others_told",
                                 "the error lies before the station in front, and the first station that "
                                 "reports one says where"),
                     good_cycle("no_recovery")},
           .first = {identified(), good_cycle()}},
          {.details = {details::mark({"mark_of_others_cleared"}), details::message({"error_of_others_told"}),
                       details::status_coding()}})};
}

std::vector<SlaveCase> cases_of_patterns() {
  return {
      slave_case("frame_check/two_and_three_flipped_bits_are_rejected", "IS-12",
                 "The frame check detects every error of two or three bits in a code word of 64 bits.",
                 sources::calculated("Hamming distance 4 of 1021h at these lengths"),
                 {{"compares_first_check_octet_only", "double_or_triple_error_accepted"}},
                 {.steps = {step("all 2016 pairs of bits of the code word (loopback word, two words, check) "
                                 "and 100 000 random triples, flipped at the slave's receiver",
                                 "the status word of each cycle leaves marked, and no output changes",
                                 two_and_three_bits_flipped)}},
                 {.details = {details::mark({"double_or_triple_error_accepted"}), details::status_coding()}}),
      slave_case(
          "frame_check/bursts_up_to_16_bits_are_rejected", "IS-13",
          "The frame check detects every burst of at most 16 bits, at any position.",
          sources::calculated("a polynomial of degree 16 with a constant term"),
          {{"compares_first_check_octet_only", "burst_accepted"}},
          {.steps = {step("bursts of 2 to 16 bits, first and last bit flipped, at every position of the code "
                          "word of 64 bits with every pattern between: 1 638 335 of them. A longer register: "
                          "every burst up to 10 bits, drawn ones and the densest for longer ones",
                          "the status word of each cycle leaves marked, and no output changes",
                          bursts_are_rejected)}},
          {.details = {details::mark({"burst_accepted"}), details::status_coding()}, .tags = {"long"}}),
      slave_case(
          "frame_check/weight_four_code_word_is_accepted", "IS-14",
          "Four flipped bits that form a code word of the polynomial cannot be seen: the slave must accept "
          "such a cycle. A rejection proves another polynomial, another span or a stricter check than the "
          "other stations have.",
          sources::calculated("84 code words of weight four in 64 bits"),
          {{"expects_the_usual_loopback_word", "weight_four_code_word_rejected"},
           {"crc_polynomial_8005", "weight_four_code_word_rejected"}},
          {.steps = {identified(),
                     step("data cycles with each of the 84 patterns flipped at the slave's receiver, in "
                          "loopback word, data and check",
                          "the status word leaves clean, and the outputs show the words as they arrived",
                          weight_four_code_words_are_accepted)}},
          {.details = {details::status_coding()}})};
}

}  // namespace

std::vector<SlaveCase> slave_frame_check_cases() {
  return joined({cases_of_checks(), cases_of_patterns(), cases_of_cycles()});
}

}  // namespace fieldproof::conformance

#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/rejections.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/code_words.hpp"

// IS-09 to IS-16: the frame check of both sides and the status word.
namespace fieldproof::conformance {
namespace {

void check_leaves_for_what_was_sent(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  for (unsigned n = 0; n < bench.volume(30U, 1'000U); ++n) {
    bench.set_inputs(bench.random_words());
    const bool is_id_cycle = n % 4 == 3;
    is_id_cycle ? bench.id_cycle(bench.interfaces_off()) : bench.data_cycle(bench.random_words());
    expect_all_telegrams(bench, judge);
    const CycleOnLine out = cycle_that_left(bench, judge, 0);
    const BitwiseCheck& check = bench.model().check();
    std::uint16_t state = check.start();
    for (std::size_t k = 0; k < out.octets; ++k) state = check.next(state, out.telegrams[k].data);
    judge.expect(out.check() == check.word(state), "check_wrong", [&] {
      return Mismatch{
          .expected = {fmt::format("{:04X}h, the check of the octets that left", check.word(state))},
          .actual = fmt::format("{:04X}h", out.check()),
          .time = bench.out().start_of(out.telegrams[out.octets]),
          .first_difference = fmt::format("check of {} cycle {}", is_id_cycle ? "ID" : "data", n)};
    });
  }
}

// One flipped bit: rejected, marked, told in the next ID cycle.
void reject_single_bit(SlaveBench& bench, CaseJudge& judge, std::size_t bit) {
  bench.begin();
  const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
  bench.channel().on_next().flip(bench.code_word_level(cycle, bit));
  bench.send();
  expect_rejected(bench, judge, 0);
  bench.id_cycle(bench.interfaces_off());
  const std::uint16_t message = bench.rules().message_check_error;
  judge.expect((id_register(bench, judge) & message) != 0, "message_missing", [&] {
    return Mismatch{.expected = {fmt::format("message bit {:04X}h in the ID cycle after it", message)},
                    .actual = fmt::format("ID register {:04X}h", id_register(bench, judge)),
                    .first_difference = fmt::format("bit {} of the code word was flipped", bit)};
  });
}

void reject_single_bits(SlaveBench& bench, CaseJudge& judge, std::size_t first, std::size_t last) {
  bench.bring_up();
  expect_good_cycle(bench, judge, "valid_cycle_rejected");
  for (unsigned round = 0; round < bench.volume(1U, 20U); ++round) {
    for (std::size_t bit = first; bit < last; ++bit) reject_single_bit(bench, judge, bit);
    expect_good_cycle(bench, judge, "no_recovery");
  }
}

void data_bit_flipped(SlaveBench& bench, CaseJudge& judge) {
  reject_single_bits(bench, judge, 0, bench.code_word_bits() - 16);
}
void check_bit_flipped(SlaveBench& bench, CaseJudge& judge) {
  reject_single_bits(bench, judge, bench.code_word_bits() - 16, bench.code_word_bits());
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
  bench.bring_up();
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

// A cycle of zeros as the station in front of the slave would send it.
void drive_zeros(SlaveBench& bench, std::size_t octets, std::uint16_t check) {
  TrainWriter writer(bench.rules());
  const std::vector<std::uint8_t> zeros(octets);
  writer.cycle(false, zeros, check, bench.rules().status_clean);
  line::Waveform wave{bench.now(), bench.rules().bit_rate, writer.levels()};
  bench.drive_at_receiver(wave);
}

std::uint16_t check_of_zeros(SlaveBench& bench, std::size_t octets) {
  return bench.model().check().of(std::vector<std::uint8_t>(octets));
}

bool left_clean(SlaveBench& bench) {
  FoundCycle cycle;
  find_last_cycle(bench.out().data_telegrams(), cycle);
  return cycle.is_found && cycle.status == bench.rules().status_clean;
}

void zeros_do_not_hide_a_lost_octet(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  const std::size_t octets = 2 + 2 * bench.words();
  expect_good_cycle(bench, judge, "valid_cycle_rejected");
  const auto expect_zeros = [&](std::size_t sent, std::size_t checked, std::string_view reason) {
    drive_zeros(bench, sent, checked == 0 ? 0 : check_of_zeros(bench, checked));
    judge.expect(!left_clean(bench), reason, [&] {
      return Mismatch{
          .expected = {fmt::format("{} octets of zeros are rejected: their check is that of {} octets", sent,
                                   checked)},
          .actual = "the status word left unmarked"};
    });
    expect_no_change(bench, judge, "output_changed_by_rejected_cycle", "the cycle does not pass its check");
  };
  expect_zeros(octets, 0, "zero_preset_check_accepted");
  expect_zeros(octets - 1, octets, "lost_zero_octet_accepted");
  expect_zeros(octets + 1, octets, "added_zero_octet_accepted");
  drive_zeros(bench, octets, check_of_zeros(bench, octets));
  expect_outputs(bench, judge, std::vector<std::uint16_t>(bench.words()), "valid_cycle_rejected");
  judge.expect(left_clean(bench), "status_word_wrong", "a cycle of zeros with its own check is accepted",
               "its status word did not leave clean");
}

// ---- status word ----

void mark_of_others_is_kept(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  expect_good_cycle(bench, judge, "valid_cycle_rejected");
  const std::uint16_t marked = bench.rules().status_marked;
  for (unsigned n = 0; n < bench.volume(3U, 30U); ++n) {
    bench.begin();
    const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
    mark_in_front(bench, cycle);
    bench.send();
    expect_all_telegrams(bench, judge);
    const CycleOnLine out = cycle_that_left(bench, judge, 0);
    judge.expect((out.status() & marked) == marked, "mark_of_others_cleared", [&] {
      return Mismatch{.expected = {fmt::format("status word {:04X}h, as it came", marked)},
                      .actual = fmt::format("status word {:04X}h", out.status()),
                      .time = bench.out().start_of(out.telegrams[out.octets + 2])};
    });
    expect_no_change(bench, judge, "marked_cycle_latched", "a station before the slave saw an error");
    bench.id_cycle(bench.interfaces_off());
    const std::uint16_t message = bench.rules().message_check_error;
    judge.expect((id_register(bench, judge) & message) == 0, "error_of_others_told", [&] {
      return Mismatch{
          .expected = {fmt::format("no message bit {:04X}h: the error lies before the station in front, and "
                                   "the first station that reports one says where",
                                   message)},
          .actual = fmt::format("ID register {:04X}h", id_register(bench, judge))};
    });
    bench.terminals().forget_changes();
    expect_good_cycle(bench, judge, "no_recovery");
  }
}

judge::Reference checks_of_both_sides() {
  return sources::practical_guide(
      "a check generator at the receive side and one at the send side of each device");
}

void add_cases_of_single_bits(std::vector<SlaveCase>& cases) {
  cases.push_back(
      {{.id = "interbus/slave/frame_check/leaves_for_what_the_slave_itself_sent",
        .purpose = "IS-09",
        .requirement =
            "In the check phase a slave sends the check of the bits that it sent itself, not of those "
            "that it received: polynomial x^16 + x^12 + x^5 + 1, register preset with ones.",
        .reference = checks_of_both_sides(),
        .details = {details::check_coding()},
        .stimulus = "Valid data and ID cycles with random inputs and words, one after the other.",
        .expected = "The check that leaves equals the check, computed bit by bit, of the octets that left.",
        .tags = {"must"},
        .catches = {{"crc_preset_zero", "check_wrong"},
                    {"crc_polynomial_8005", "check_wrong"},
                    {"sends_check_of_received_bits", "check_wrong"},
                    {"check_not_reset_between_cycles", "check_wrong"}}},
       check_leaves_for_what_was_sent});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told",
        .purpose = "IS-10",
        .requirement =
            "A slave whose received check does not fit what it received marks the status word that "
            "passes, takes nothing over, and reports the error in the next ID cycle.",
        .reference = sources::practical_guide("comparison with the checksum of the previous device"),
        .details = {details::mark(), details::message(), details::status_coding()},
        .stimulus = "Data cycles in which one bit of loopback word or process data is flipped at the slave's "
                    "receiver, each bit in turn; an ID cycle after each.",
        .expected = "The status word leaves marked, no output changes, the message bit stands in the ID "
                    "register; a clean cycle afterwards is accepted.",
        .tags = {"must"},
        .catches = {{"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"},
                    {"does_not_mark_status", "error_not_marked"},
                    {"tells_no_check_error", "message_missing"}}},
       data_bit_flipped});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/flipped_check_bit_is_rejected_marked_and_told",
        .purpose = "IS-11",
        .requirement =
            "An error in the check itself is an error like one in the data: each of its 16 bits is "
            "compared.",
        .reference = checks_of_both_sides(),
        .details = {details::mark(), details::message(), details::status_coding()},
        .stimulus =
            "Data cycles in which one bit of the check is flipped at the slave's receiver, each bit in "
            "turn; an ID cycle after each.",
        .expected = "The status word leaves marked, no output changes, the message bit stands in the ID "
                    "register; a clean cycle afterwards is accepted.",
        .tags = {"must"},
        .catches = {{"compares_first_check_octet_only", "error_not_marked"},
                    {"does_not_mark_status", "error_not_marked"},
                    {"tells_no_check_error", "message_missing"}}},
       check_bit_flipped});
}

void add_cases_of_patterns(std::vector<SlaveCase>& cases) {
  cases.push_back(
      {{.id = "interbus/slave/frame_check/two_and_three_flipped_bits_are_rejected",
        .purpose = "IS-12",
        .requirement = "The frame check detects every error of two or three bits in a code word of 64 bits.",
        .reference = sources::calculated("Hamming distance 4 of 1021h at these lengths"),
        .details = {details::mark({"double_or_triple_error_accepted"}), details::status_coding()},
        .stimulus = "All 2016 pairs of bits of the code word (loopback word, two words, check) and 100 000 "
                    "random triples, flipped at the slave's receiver.",
        .expected = "The status word of each cycle leaves marked, and no output changes.",
        .tags = {"must"},
        .catches = {{"compares_first_check_octet_only", "double_or_triple_error_accepted"}}},
       two_and_three_bits_flipped});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/bursts_up_to_16_bits_are_rejected",
        .purpose = "IS-13",
        .requirement = "The frame check detects every burst of at most 16 bits, at any position.",
        .reference = sources::calculated("a polynomial of degree 16 with a constant term"),
        .details = {details::mark({"burst_accepted"}), details::status_coding()},
        .stimulus =
            "Bursts of 2 to 16 bits, first and last bit flipped, at every position of the code word of 64 "
            "bits with every pattern between: 1 638 335 of them. A longer register: every burst up to 10 "
            "bits, drawn ones and the densest for longer ones.",
        .expected = "The status word of each cycle leaves marked, and no output changes.",
        .tags = {"must", "long"},
        .catches = {{"compares_first_check_octet_only", "burst_accepted"}}},
       bursts_are_rejected});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/weight_four_code_word_is_accepted",
        .purpose = "IS-14",
        .requirement =
            "Four flipped bits that form a code word of the polynomial cannot be seen: the slave must "
            "accept such a cycle. A rejection proves another polynomial, another span or a stricter "
            "check than the other stations have.",
        .reference = sources::calculated("84 code words of weight four in 64 bits"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles with each of the 84 patterns flipped at the slave's receiver, in loopback word, "
            "data and check.",
        .expected = "The status word leaves clean, and the outputs show the words as they arrived.",
        .tags = {"must"},
        .catches = {{"expects_the_usual_loopback_word", "weight_four_code_word_rejected"},
                    {"crc_polynomial_8005", "weight_four_code_word_rejected"}}},
       weight_four_code_words_are_accepted});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/zeros_do_not_hide_a_lost_octet",
        .purpose = "IS-15",
        .requirement =
            "The registers of the frame check are preset with ones, so that leading zeros count: a "
            "frame of zeros that lost or gained an octet does not pass.",
        .reference = sources::practical_guide("registers preset with 1 to improve detection"),
        .details = {details::mark({"zero_preset_check_accepted", "lost_zero_octet_accepted",
                                   "added_zero_octet_accepted"}),
                    details::status_coding()},
        .stimulus =
            "Cycles of zeros, loopback word included: with the check of a register that was preset with "
            "zeros; one octet short and one octet long with the check of the right length; and one with "
            "its own check.",
        .expected = "The first three are rejected, no output changes; the last one is accepted.",
        .tags = {"must"},
        .catches = {{"crc_preset_zero", "valid_cycle_rejected"},
                    {"accepts_check_of_zero", "zero_preset_check_accepted"}}},
       zeros_do_not_hide_a_lost_octet});
  cases.push_back(
      {{.id = "interbus/slave/frame_check/mark_of_others_is_kept_and_obeyed",
        .purpose = "IS-16",
        .requirement =
            "A status word that another station has marked passes marked, and its cycle is not taken "
            "over even though the slave's own check fits (the slave-local rule). It is no error of this "
            "slave: reported as one, it would hide where the error lies.",
        .reference = sources::from_memory("the status word tells later stations and the master"),
        .details = {details::mark({"mark_of_others_cleared"}), details::message({"error_of_others_told"}),
                    details::status_coding()},
        .stimulus = "Data cycles whose data and check are right and whose status word arrives marked; an ID "
                    "cycle after each.",
        .expected = "The status word leaves marked, no output changes, the ID register has no message of a "
                    "check error; a clean cycle afterwards is accepted.",
        .tags = {"must"},
        .catches = {{"ignores_upstream_status", "marked_cycle_latched"},
                    {"clears_mark_of_others", "mark_of_others_cleared"},
                    {"tells_errors_of_others", "error_of_others_told"}}},
       mark_of_others_is_kept});
}

SlaveCase final_xor_case() {
  return {
      {.id = "interbus/slave/frame_check/another_final_xor_counts",
       .purpose = "IS-44",
       .requirement = "The frame check is as the settings of the case say, its final XOR included.",
       .reference = sources::own("the final XOR of the frame check is a setting"),
       .details = {details::check_coding()},
       .stimulus = "As in leaves_for_what_the_slave_itself_sent, with a final XOR of FFFFh.",
       .expected = "The check that leaves equals the check, computed bit by bit, of the octets that left.",
       .tags = {"must"},
       .catches = {{"final_xor_hard_coded", "check_wrong"}},
       .not_applicable = for_other_settings()},
      check_leaves_for_what_was_sent,
      {.change_rules = [](interbus::Rules& rules) { rules.frame_check = "CRC-16/GENIBUS"; }}};
}

}  // namespace

std::vector<SlaveCase> slave_frame_check_cases() {
  std::vector<SlaveCase> cases;
  add_cases_of_single_bits(cases);
  add_cases_of_patterns(cases);
  cases.push_back(final_xor_case());
  return cases;
}

}  // namespace fieldproof::conformance

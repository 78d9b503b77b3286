// Chapter rejection: which returned cycles a master takes and which it does not (IM-10 to IM-16, IM-33 to
// IM-35).
#include <fmt/format.h>

#include <array>
#include <numeric>
#include <utility>

#include "conformance/interbus/master_scene.hpp"
#include "harness/line/code_words.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::CycleFaults;
using interbus::FaultLocation;
using judge::Standing;

constexpr std::size_t kUserOctets = 4;  // of the ring that most of these cases use
constexpr unsigned kTelegrams = 6 + kUserOctets;

// A fault of the telegram that has the turn.
MakeFaults of_telegram(int CycleFaults::* fault) {
  return [fault](RingScene& scene, CycleFaults& faults) {
    faults.*fault = static_cast<int>(scene.round % kTelegrams);
  };
}

MasterChart rejected_chart(Walk<RingScene> walk, std::vector<MasterStep> steps, Prepare prepare = nullptr) {
  return {.steps = std::move(steps), .first = {in_run(prepare)}, .walk = std::move(walk)};
}

void damage_loopback(RingScene& scene, CycleFaults& faults) {
  std::vector<unsigned> bits(16);
  std::iota(bits.begin(), bits.end(), 0U);
  scene.bench.random().shuffle(bits);
  unsigned mask = 0;
  for (unsigned n = 0; n <= scene.round; ++n) mask |= 1U << bits[n];
  faults.flips = {{kUserOctets, static_cast<std::uint8_t>(mask >> 8), true},
                  {kUserOctets + 1, static_cast<std::uint8_t>(mask & 0xFF), true}};
}

void displace_loopback(RingScene& scene, CycleFaults& faults) {
  constexpr std::array kBits{-1, 1, -2, 2, -8, 8, -16, 16};
  scene.bench.ring().set_input(1, static_cast<std::uint16_t>(scene.bench.random().next()));
  faults.longer_bits = kBits.at(scene.round);
}

void expect_id_cycle(RingScene& scene) {
  scene.judge.expect(scene.suffered.id_cycles > 0, "no_id_cycle_after_error",
                     "an ID cycle follows on the line", "data cycles only");
}

void stay_longer(MasterBench& bench, CaseJudge&) {
  bench.set_script([](const auto&, CycleFaults& faults) { faults.longer_bits = 16; });
  for (int n = 0; n < 8 && bench.is_in_run(); ++n) bench.run_cycle();
}

// Data and check, without the loopback word between them.
void damage_after_last_station(RingScene& scene, CycleFaults& faults) {
  const std::size_t octet = scene.round / 8;
  faults.flips = {
      {octet < kUserOctets ? octet : octet + 2, static_cast<std::uint8_t>(1U << scene.round % 8), false}};
}

void expect_segment(RingScene& scene) {
  const int station = static_cast<int>(scene.round);
  const auto status = scene.bench.status();
  scene.judge.expect_equal(scene.suffered.id_cycles, 1U, "no_id_cycle_after_error",
                           "ID cycles that follow on the line");
  scene.judge.expect(
      status.has_fault_location && status.fault_location == FaultLocation{station - 1, station},
      "wrong_segment", fmt::format("segment {} -> {}", station - 1, station),
      fmt::format("segment {} -> {}", status.fault_location.from, status.fault_location.to));
}

// All patterns of four bits within the user octets that the frame check cannot see.
std::vector<std::vector<CycleFaults::Flip>> weight_four_patterns() {
  std::vector<std::vector<CycleFaults::Flip>> patterns;
  const line::FrameCheckParameters& check = line::frame_check_named(interbus::Rules{}.frame_check);
  for (const line::FourBits& bits : line::weight_four_code_words(check, 8 * kUserOctets)) {
    std::vector<CycleFaults::Flip>& flips = patterns.emplace_back();
    for (const unsigned bit : bits) {
      flips.push_back({bit / 8, static_cast<std::uint8_t>(0x80U >> bit % 8), false});
    }
  }
  return patterns;
}

// What the flips make of the input word of the paper's ring: its two octets come after those of the output
// terminal, which is the last station.
std::uint16_t changed_input(const std::vector<CycleFaults::Flip>& flips) {
  unsigned octets[kUserOctets] = {};
  for (const CycleFaults::Flip& flip : flips) octets[flip.telegram] ^= flip.mask;
  return static_cast<std::uint16_t>(octets[2] << 8 | octets[3]);
}

const std::vector<std::vector<CycleFaults::Flip>>& code_words() {
  static const auto words = weight_four_patterns();
  return words;
}

void accept_code_word(RingScene& scene) {
  CycleFaults faults;
  faults.flips = code_words().at(scene.round);
  const auto suffered = scene.bench.suffer(scene.judge, faults);
  scene.judge.expect(suffered.is_told_accepted, "code_word_rejected",
                     "an error pattern that is a code word is accepted", "it is rejected");
  const std::uint16_t brought = suffered.offered.front() ^ changed_input(faults.flips);
  scene.judge.expect(suffered.seen.front() == brought, "new_inputs_missed",
                     fmt::format("the inputs of the accepted cycle, {:04X}h", brought),
                     fmt::format("{:04X}h", suffered.seen.front()));
}

void code_words_there(MasterBench&, CaseJudge& judge) {
  judge.expect(!code_words().empty(), "no_code_word", "code words of weight 4 within 32 bits", "none");
  judge.measure("code words of weight 4 within the user octets", "",
                static_cast<double>(code_words().size()));
}

void inputs_held(RingScene& scene) {
  scene.held = 0x1234;
  scene.bench.ring().set_input(0, scene.held);
  scene.bench.run_data_cycles(scene.judge, 3);
  scene.bench.ring().set_input(0, static_cast<std::uint16_t>(~scene.held));
}

void hold_line(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.set_script([level = scene.round == 1](const auto&, CycleFaults& faults) { faults.stuck = level; });
  for (unsigned n = 0; n < bench.rules().stop_after_bad_cycles && bench.is_in_run(); ++n) {
    scene.judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on until the bus stop",
                       "no cycle ends");
    scene.judge.expect(!bench.finished().is_accepted, "stuck_line_accepted",
                       "no cycle is accepted from a line that holds one level", "one is");
    scene.judge.expect(!bench.is_in_run() || bench.master().input(0) == scene.held, "rejected_inputs_seen",
                       "the inputs of the last good cycle", "other inputs");
  }
}

void expect_bus_stop(MasterBench& bench, CaseJudge& judge) {
  judge.expect(!bench.is_in_run(), "no_bus_stop", "the bus stops", "it runs on");
  bench.ring().forget_statistics();
  bench.run_for(100 * kernel::kMillisecond);
  judge.expect_equal(bench.ring().statistics().data_cycles, 0U, "no_bus_stop",
                     "data cycles on the line after the bus stop");
}

void insert_telegram(RingScene& scene, CycleFaults& faults) {
  if (scene.round < kTelegrams) {
    faults.inserted = static_cast<int>(scene.round);
  } else {
    faults.trailing_telegram = true;
  }
}

// Of one telegram, or of the status telegram after the cycle.
void change_flag(RingScene& scene, CycleFaults& faults) {
  constexpr std::array<std::uint16_t, 3> kInputs{0, 0xFFFF, 0x00FF};
  for (const unsigned word : {0U, 1U})
    scene.bench.ring().set_input(word, kInputs.at(scene.round / (kTelegrams + 1)));
  scene.bench.run_data_cycles(scene.judge, 1);
  const unsigned at = scene.round % (kTelegrams + 1);
  if (at < kTelegrams) {
    faults.flag_flipped = static_cast<int>(at);
  } else {
    faults.status_flag_flipped = true;
  }
}

// That a cycle ends when the loopback word is back, and that a telegram has 5 bits of head, was read; that a
// master rejects what differs from it was not.
const judge::Reference kRejection{"literature from memory; Schneider INTERBUS manual",
                                  "cycle ends when the loopback word is back", Standing::memory};
const judge::Reference kHeader{"literature from memory; Park 2004, section 2.2",
                               "telegrams with 5 bits of head", Standing::memory};

std::vector<MasterCase> cases_of_contents() {
  return {
      master_case("rejection/damaged_loopback_word_is_rejected", "IM-10",
                  "A cycle whose loopback word comes back changed is rejected", kRejection, {"must"},
                  {{"loopback_not_compared", "damaged_loopback_accepted"}},
                  rejected_chart(each("each number of bit errors from 1 to 16", 16),
                                 {rejected("so many bit errors in the loopback word and a check that fits",
                                           "damaged_loopback_accepted", damage_loopback)})),
      master_case("rejection/displaced_loopback_word_is_rejected", "IM-11",
                  "A loopback word that comes back too early or too late is a ring of another length",
                  kRejection, {"must"},
                  {{"loopback_position_not_compared", "displaced_loopback_accepted"},
                   {"ring_longer_by_an_octet_accepted", "displaced_loopback_accepted"},
                   {"changed_ring_ignored", "ring_change_not_reported"}},
                  {.steps = {in_run(),
                             rejected("a register that is so much longer", "displaced_loopback_accepted",
                                      displace_loopback),
                             expected<RingScene>("an ID cycle follows on the line", expect_id_cycle),
                             step("the register stays 16 bits longer", "", stay_longer),
                             configuration_error("it is reported as a change of configuration",
                                                 "ring_change_not_reported")},
                   .walk = each("each of 1, 2, 8 and 16 bits, shorter and longer", 8)}),
      resting_also_on(
          {{"literature from memory", "inputs of a rejected cycle are discarded", Standing::memory},
           {"rejected_inputs_seen"}},
          master_case("rejection/wrong_return_check_is_rejected", "IM-13",
                      "The master compares the check of the last station with what it received",
                      {"Buesing/Meyer, Practical Guide", "check per segment", Standing::searched}, {"must"},
                      {{"own_check_ignored", "bad_check_accepted"},
                       {"inputs_taken_before_check", "rejected_inputs_seen"}},
                      rejected_chart(each("each bit of the data and of the check", 8 * (kUserOctets + 2)),
                                     {rejected("it changed after the last station", "bad_check_accepted",
                                               damage_after_last_station)}))),
      master_case(
          "rejection/marked_status_names_the_segment", "IM-14",
          "A marked status word rejects the cycle; the following ID cycle names the segment",
          {"literature from memory", "check status and message bits", Standing::memory}, {"must"},
          {{"status_word_ignored", "marked_status_accepted"},
           {"no_id_cycle_after_error", "no_id_cycle_after_error"},
           {"id_cycle_only_claimed", "no_id_cycle_after_error"},
           {"wrong_segment", "wrong_segment"}},
          {.steps = {rejected("a status word that it marked, its message bit in the next ID cycle",
                              "marked_status_accepted",
                              [](RingScene& scene, CycleFaults& faults) {
                                faults.marked_by = static_cast<int>(scene.round);
                              }),
                     expected<RingScene>("one ID cycle follows, segment k-1 -> k is named", expect_segment)},
           .first = {in_run("four stations", interbus::line_of(4, kOneWord, 1))},
           .walk = each("each station k", 4)}),
      master_case(
          "rejection/weight_four_code_word_is_accepted", "IM-15",
          "The check is exactly the one of the polynomial: what it cannot see is accepted",
          {"computed from x^16 + x^12 + x^5 + 1", "code words of weight 4", Standing::calc}, {"must"},
          {{"implausible_inputs_rejected", "code_word_rejected"}, {"inputs_frozen", "new_inputs_missed"}},
          {.steps = {{"a data cycle comes back with it", "it is accepted, the application gets its inputs",
                      accept_code_word}},
           .first = {in_run(), step("", "there are such patterns", code_words_there)},
           .walk = {"each error pattern of four bits in the user octets that the polynomial divides",
                    [](RingScene&) { return code_words().size(); }}}),
      master_case("rejection/stuck_return_line_stops_the_bus", "IM-16",
                  "A return line that holds one level never brings a good cycle", kRejection, {"must"},
                  {{"silence_taken_for_good", "stuck_line_accepted"}},
                  {.steps = {in_run(),
                             {"3 data cycles", "", inputs_held},
                             {"the return line holds the level", "every cycle is rejected, the inputs stay",
                              hold_line},
                             step("", "the bus stops: no data cycle in 100 ms", expect_bus_stop)},
                   .walk = each("each of the levels 0 and 1", 2)})};
}

std::vector<MasterCase> cases_of_telegrams() {
  return {
      master_case("rejection/lost_or_repeated_telegram_is_rejected", "IM-12",
                  "A cycle with a telegram less or more is rejected", kHeader, {"must"},
                  {{"telegram_count_ignored", "wrong_count_accepted"}},
                  rejected_chart(
                      each("each returned telegram", kTelegrams),
                      {rejected("it lost", "wrong_count_accepted", of_telegram(&CycleFaults::dropped)),
                       rejected("it twice", "wrong_count_accepted", of_telegram(&CycleFaults::duplicated))})),
      master_case("rejection/missing_stop_bit_is_rejected", "IM-33",
                  "A framing error in a returned telegram rejects the cycle", kHeader, {"must"},
                  {{"stop_bit_ignored", "framing_error_accepted"}},
                  rejected_chart(each("each returned telegram", kTelegrams),
                                 {rejected("its stop bit missing", "framing_error_accepted",
                                           of_telegram(&CycleFaults::stop_missing))})),
      master_case("rejection/inserted_telegram_is_rejected", "IM-34", "A telegram too many rejects the cycle",
                  kHeader, {"must"}, {{"telegram_count_ignored", "extra_telegram_accepted"}},
                  rejected_chart(
                      each("each place of the cycle, and after it", kTelegrams + 1),
                      {rejected("a telegram inserted there", "extra_telegram_accepted", insert_telegram)})),
      master_case("rejection/changed_flag_is_rejected", "IM-35",
                  "A data telegram that became a status telegram, or the other way round, rejects the cycle",
                  kHeader, {"must"}, {{"telegram_count_ignored", "flipped_flag_accepted"}},
                  rejected_chart(each("inputs of 0000h, FFFFh and 00FFh and each returned telegram, and the "
                                      "status telegram after them",
                                      3 * (kTelegrams + 1)),
                                 {rejected("its flag bit changed", "flipped_flag_accepted", change_flag)},
                                 // So far apart that a status telegram with the flag of a data telegram is a
                                 // telegram of ones.
                                 [](MasterBench& bench) { bench.rules().status_pitch_bits = 15; }))};
}

}  // namespace

std::vector<MasterCase> master_rejection_cases() {
  std::vector<MasterCase> cases = cases_of_contents();
  for (MasterCase& one : cases_of_telegrams()) cases.push_back(std::move(one));
  return cases;
}

}  // namespace fieldproof::conformance

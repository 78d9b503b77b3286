// Chapter rejection: which returned cycles a master takes and which it does not (IM-10 to IM-16, IM-33 to
// IM-35).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "conformance/interbus/master_cases.hpp"
#include "harness/line/code_words.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::CycleFaults;
using interbus::FaultLocation;
using interbus::MasterState;
using judge::Standing;
using Suffered = MasterBench::Suffered;

constexpr std::size_t kUserOctets = 4;  // of the ring that most of these cases use
constexpr int kTelegrams = 6 + static_cast<int>(kUserOctets);

Suffered expect_cycle_rejected(MasterBench& bench, CaseJudge& judge, CycleFaults faults,
                               std::string_view reason, const std::string& what) {
  const Suffered suffered = bench.suffer(judge, std::move(faults));
  judge.expect(!suffered.is_told_accepted, reason,
               [&] { return Mismatch{{what + ": rejected"}, "the cycle is accepted"}; });
  judge.expect(suffered.seen == suffered.held, "rejected_inputs_seen", [&] {
    return Mismatch{{fmt::format("{}: the inputs before, {:04X}h", what, fmt::join(suffered.held, "h "))},
                    fmt::format("{:04X}h", fmt::join(suffered.seen, "h "))};
  });
  return suffered;
}

void damaged_loopback(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  std::vector<unsigned> bits(16);
  for (unsigned n = 0; n < 16; ++n) bits[n] = n;
  for (unsigned errors = 1; errors <= 16; ++errors) {
    bench.random().shuffle(bits);
    unsigned mask = 0;
    for (unsigned n = 0; n < errors; ++n) mask |= 1U << bits[n];
    CycleFaults faults;
    faults.flips = {{kUserOctets, static_cast<std::uint8_t>(mask >> 8), true},
                    {kUserOctets + 1, static_cast<std::uint8_t>(mask & 0xFF), true}};
    expect_cycle_rejected(bench, judge, std::move(faults), "damaged_loopback_accepted",
                          fmt::format("loopback word with {} bit errors", errors));
  }
}

void displaced_loopback(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (const int bits : {-1, 1, -2, 2, -8, 8, -16, 16}) {
    bench.ring().set_input(1, static_cast<std::uint16_t>(bench.random().next()));
    CycleFaults faults;
    faults.longer_bits = bits;
    const Suffered suffered =
        expect_cycle_rejected(bench, judge, std::move(faults), "displaced_loopback_accepted",
                              fmt::format("loopback word {} bits late", bits));
    judge.expect(suffered.id_cycles > 0, "no_id_cycle_after_error", "an ID cycle follows on the line",
                 "data cycles only");
  }
  bench.set_script([](const auto&, CycleFaults& faults) { faults.longer_bits = 16; });
  for (int n = 0; n < 8 && bench.is_in_run(); ++n) bench.run_cycle();
  const auto status = bench.status();
  judge.expect(status.state != MasterState::run && !status.configuration_error.empty(),
               "ring_change_not_reported",
               "a ring that stays longer is reported as a change of configuration", "it is not");
}

void wrong_count(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (int n = 0; n < kTelegrams; ++n) {
    CycleFaults lost;
    lost.dropped = n;
    expect_cycle_rejected(bench, judge, std::move(lost), "wrong_count_accepted",
                          fmt::format("telegram {} lost", n));
    CycleFaults twice;
    twice.duplicated = n;
    expect_cycle_rejected(bench, judge, std::move(twice), "wrong_count_accepted",
                          fmt::format("telegram {} twice", n));
  }
}

void bad_check(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (std::size_t octet = 0; octet < kUserOctets + 4; ++octet) {
    if (octet == kUserOctets || octet == kUserOctets + 1) continue;  // the loopback word
    for (unsigned bit = 0; bit < 8; ++bit) {
      CycleFaults faults;
      faults.flips = {{octet, static_cast<std::uint8_t>(1U << bit), false}};
      expect_cycle_rejected(bench, judge, std::move(faults), "bad_check_accepted",
                            fmt::format("bit {} of octet {} changed after the last station", bit, octet));
    }
  }
}

void marked_status(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, interbus::line_of(4, 0x0103, 1));
  for (int station = 0; station < 4; ++station) {
    CycleFaults faults;
    faults.marked_by = station;
    const Suffered suffered = expect_cycle_rejected(bench, judge, std::move(faults), "marked_status_accepted",
                                                    fmt::format("status word marked by station {}", station));
    const auto status = bench.status();
    judge.expect_equal(suffered.id_cycles, 1U, "no_id_cycle_after_error",
                       "ID cycles that follow on the line");
    judge.expect(status.has_fault_location && status.fault_location == FaultLocation{station - 1, station},
                 "wrong_segment", [&] {
                   return Mismatch{
                       {fmt::format("segment {} -> {}", station - 1, station)},
                       fmt::format("segment {} -> {}", status.fault_location.from, status.fault_location.to)};
                 });
  }
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

void weight_four(MasterBench& bench, CaseJudge& judge) {
  static const auto words = weight_four_patterns();
  judge.expect(!words.empty(), "no_code_word", "code words of weight 4 within 32 bits", "none");
  judge.measure("code words of weight 4 within the user octets", "", static_cast<double>(words.size()));
  bench.bring_up(judge, paper_ring());
  for (const auto& flips : words) {
    CycleFaults faults;
    faults.flips = flips;
    const Suffered suffered = bench.suffer(judge, std::move(faults));
    judge.expect(suffered.is_told_accepted, "code_word_rejected",
                 "an error pattern that is a code word is accepted", "it is rejected");
    const std::uint16_t brought = suffered.offered.front() ^ changed_input(flips);
    judge.expect(suffered.seen.front() == brought, "new_inputs_missed", [&] {
      return Mismatch{{fmt::format("the inputs of the accepted cycle, {:04X}h", brought)},
                      fmt::format("{:04X}h", suffered.seen.front())};
    });
  }
}

void stuck_line(MasterBench& bench, CaseJudge& judge) {
  constexpr std::uint16_t kHeld = 0x1234;
  for (const bool level : {false, true}) {
    bench.set_script({});
    bench.bring_up(judge, paper_ring());
    bench.ring().set_input(0, kHeld);
    bench.run_data_cycles(judge, 3);
    bench.set_script([level](const auto&, CycleFaults& faults) { faults.stuck = level; });
    bench.ring().set_input(0, static_cast<std::uint16_t>(~kHeld));
    for (unsigned n = 0; n < bench.rules().stop_after_bad_cycles && bench.is_in_run(); ++n) {
      judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on until the bus stop", "no cycle ends");
      judge.expect(!bench.finished().is_accepted, "stuck_line_accepted",
                   "no cycle is accepted from a line that holds one level", "one is");
      judge.expect(!bench.is_in_run() || bench.master().input(0) == kHeld, "rejected_inputs_seen",
                   "the inputs of the last good cycle", "other inputs");
    }
    judge.expect(!bench.is_in_run(), "no_bus_stop", "the bus stops", "it runs on");
    bench.ring().forget_statistics();
    bench.run_for(100 * kernel::kMillisecond);
    judge.expect_equal(bench.ring().statistics().data_cycles, 0U, "no_bus_stop",
                       "data cycles on the line after the bus stop");
  }
}

void missing_stop(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (int n = 0; n < kTelegrams; ++n) {
    CycleFaults faults;
    faults.stop_missing = n;
    expect_cycle_rejected(bench, judge, std::move(faults), "framing_error_accepted",
                          fmt::format("telegram {} without stop bit", n));
  }
}

void extra_telegram(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  for (int n = 0; n < kTelegrams; ++n) {
    CycleFaults faults;
    faults.inserted = n;
    expect_cycle_rejected(bench, judge, std::move(faults), "extra_telegram_accepted",
                          fmt::format("a telegram inserted in front of telegram {}", n));
  }
  CycleFaults trailing;
  trailing.trailing_telegram = true;
  expect_cycle_rejected(bench, judge, std::move(trailing), "extra_telegram_accepted",
                        "a telegram after the last one");
}

void flipped_flag(MasterBench& bench, CaseJudge& judge) {
  // So far apart that a status telegram with the flag of a data telegram is a telegram of ones.
  bench.rules().status_pitch_bits = 15;
  bench.bring_up(judge, paper_ring());
  for (const std::uint16_t input : {std::uint16_t{0}, std::uint16_t{0xFFFF}, std::uint16_t{0x00FF}}) {
    bench.ring().set_input(0, input);
    bench.ring().set_input(1, input);
    bench.run_data_cycles(judge, 1);
    for (int n = 0; n < kTelegrams; ++n) {
      CycleFaults faults;
      faults.flag_flipped = n;
      expect_cycle_rejected(bench, judge, std::move(faults), "flipped_flag_accepted",
                            fmt::format("flag of telegram {} changed", n));
    }
  }
  CycleFaults status;
  status.status_flag_flipped = true;
  expect_cycle_rejected(bench, judge, std::move(status), "flipped_flag_accepted",
                        "flag of the status telegram after the cycle changed");
}

// That a cycle ends when the loopback word is back, and that a telegram has 5 bits of head, was read; that a
// master rejects what differs from it was not.
const judge::Reference kRejection{"literature from memory; Schneider INTERBUS manual",
                                  "cycle ends when the loopback word is back", Standing::memory};
const judge::Reference kHeader{"literature from memory; Park 2004, section 2.2",
                               "telegrams with 5 bits of head", Standing::memory};

}  // namespace

std::vector<MasterCase> master_rejection_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus,
                            std::vector<MustCatch> catches, auto procedure,
                            std::string_view expected = "each such cycle is rejected") {
    TestCase test_case;
    test_case.id = fmt::format("interbus/master/rejection/{}", words);
    test_case.purpose = purpose;
    test_case.requirement = requirement;
    test_case.reference = std::move(reference);
    test_case.stimulus = stimulus;
    test_case.expected = expected;
    test_case.tags = {"must"};
    test_case.catches = std::move(catches);
    cases.push_back({std::move(test_case), procedure});
  };
  add("damaged_loopback_word_is_rejected", "IM-10",
      "A cycle whose loopback word comes back changed is rejected", kRejection,
      "1 to 16 bit errors in the returned loopback word, with a check that fits",
      {{"loopback_not_compared", "damaged_loopback_accepted"}}, damaged_loopback);
  add("displaced_loopback_word_is_rejected", "IM-11",
      "A loopback word that comes back too early or too late is a ring of another length", kRejection,
      "a register that is 1, 2, 8 or 16 bits shorter or longer, once; then 16 bits longer for good",
      {{"loopback_position_not_compared", "displaced_loopback_accepted"},
       {"ring_longer_by_an_octet_accepted", "displaced_loopback_accepted"},
       {"changed_ring_ignored", "ring_change_not_reported"}},
      displaced_loopback, "rejected, an ID cycle follows, the lasting change is reported");
  add("lost_or_repeated_telegram_is_rejected", "IM-12", "A cycle with a telegram less or more is rejected",
      kHeader, "each returned telegram lost, or repeated",
      {{"telegram_count_ignored", "wrong_count_accepted"}}, wrong_count);
  add("wrong_return_check_is_rejected", "IM-13",
      "The master compares the check of the last station with what it received",
      {"Buesing/Meyer, Practical Guide", "check per segment", Standing::searched},
      "each bit of the data, and of the check, changed after the last station",
      {{"own_check_ignored", "bad_check_accepted"}, {"inputs_taken_before_check", "rejected_inputs_seen"}},
      bad_check);
  cases.back().test_case.details = {
      {{"literature from memory", "inputs of a rejected cycle are discarded", Standing::memory},
       {"rejected_inputs_seen"}}};
  add("marked_status_names_the_segment", "IM-14",
      "A marked status word rejects the cycle; the following ID cycle names the segment",
      {"literature from memory", "check status and message bits", Standing::memory},
      "the status word marked by each station in turn, with its message bit in the next ID cycle",
      {{"status_word_ignored", "marked_status_accepted"},
       {"no_id_cycle_after_error", "no_id_cycle_after_error"},
       {"id_cycle_only_claimed", "no_id_cycle_after_error"},
       {"wrong_segment", "wrong_segment"}},
      marked_status, "rejected, one ID cycle, segment k-1 -> k");
  add("weight_four_code_word_is_accepted", "IM-15",
      "The check is exactly the one of the polynomial: what it cannot see is accepted",
      {"computed from x^16 + x^12 + x^5 + 1", "code words of weight 4", Standing::calc},
      "every error pattern of four bits in the user octets that the polynomial divides",
      {{"implausible_inputs_rejected", "code_word_rejected"}, {"inputs_frozen", "new_inputs_missed"}},
      weight_four, "each such cycle is accepted");
  add("stuck_return_line_stops_the_bus", "IM-16",
      "A return line that holds one level never brings a good cycle", kRejection,
      "the return line stuck at 0, then at 1", {{"silence_taken_for_good", "stuck_line_accepted"}},
      stuck_line, "every cycle rejected, then bus stop");
  add("missing_stop_bit_is_rejected", "IM-33", "A framing error in a returned telegram rejects the cycle",
      kHeader, "the stop bit of each returned telegram missing",
      {{"stop_bit_ignored", "framing_error_accepted"}}, missing_stop);
  add("inserted_telegram_is_rejected", "IM-34", "A telegram too many rejects the cycle", kHeader,
      "a telegram inserted at each place of the cycle, and after it",
      {{"telegram_count_ignored", "extra_telegram_accepted"}}, extra_telegram);
  add("changed_flag_is_rejected", "IM-35",
      "A data telegram that became a status telegram, or the other way "
      "round, rejects the cycle",
      kHeader, "the flag bit of each returned telegram changed",
      {{"telegram_count_ignored", "flipped_flag_accepted"}}, flipped_flag);
  return cases;
}

}  // namespace fieldproof::conformance

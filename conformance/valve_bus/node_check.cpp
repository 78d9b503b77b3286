#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// The block check: what it must refuse, and what it cannot see. Faults are written into the octets of whole
// characters here; faults of single levels are in node_line.cpp.
namespace fieldproof::conformance {
namespace {

using Frame = std::array<std::uint8_t, valve_bus::kCommandOctets>;
constexpr unsigned kBits = 8 * valve_bus::kCommandOctets;

void flip(Frame& frame, unsigned bit) {
  frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ (1U << (bit % 8)));
}

Frame command(NodeBench& bench, unsigned number) {
  return octets_of(valve_bus::Command{bench.address(), static_cast<std::uint8_t>(number),
                                      bench.random_octet(), bench.random_octet()});
}

// Valves that are on show what switches them off, too.
void switch_some_on(NodeBench& bench) {
  bench.write(0x5A, 0xA5);
  bench.await_response_window();
  bench.clear_observations();
}

// A node that switches its valves off without a command is given one before each frame that is none.
void keep_switched_on(NodeBench& bench) {
  if (bench.rules().loss_limit > kernel::Duration{}) switch_some_on(bench);
}

void single_bit_errors_are_refused(NodeBench& bench, CaseJudge& judge) {
  switch_some_on(bench);
  for (const unsigned number : {bench.rules().write_command, bench.rules().read_command}) {
    for (unsigned bit = 0; bit < kBits; ++bit) {
      keep_switched_on(bench);
      Frame frame = command(bench, number);
      flip(frame, bit);
      bench.send(frame);
      bench.await_response_window();
      expect_ignored(bench, judge, "acts_on_wrong_check",
                     fmt::format("bit {} of octet {} is wrong", bit % 8, bit / 8));
    }
  }
  expect_serves(bench, judge);
}

// What a right node does with a frame whose check fits, by the octets that arrive.
enum class WhatItIs : std::uint8_t { executed, answered, discarded, ignored };

WhatItIs outcome_of(const NodeBench& bench, const Frame& frame) {
  if (frame[0] != bench.address()) return WhatItIs::ignored;
  if (frame[1] == bench.rules().write_command) return WhatItIs::executed;
  return frame[1] == bench.rules().read_command ? WhatItIs::answered : WhatItIs::discarded;
}

// The exclusive or cannot see two wrong bits in one column. A node that refuses such a frame has another
// check; one that takes any other double error has none.
void double_errors_show_the_exclusive_or(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::process_side);
  std::array<unsigned, 4> counts{};
  const unsigned step = bench.volume(7U, 1U);
  unsigned pair = 0;
  for (unsigned first = 0; first < kBits; ++first) {
    for (unsigned second = first + 1; second < kBits; ++second) {
      const bool is_one_column = first % 8 == second % 8;
      if (!is_one_column && ++pair % step != 0) continue;
      bench.write(0x5A, 0xA5);
      bench.await_response_window();
      bench.clear_observations();
      // A wrong DATA octet must move a valve: both differ from what stands in every bit.
      Frame frame = octets_of(valve_bus::Command{bench.address(), 0, 0xA5, 0x5A});
      flip(frame, first);
      flip(frame, second);
      const kernel::Time end = bench.send(frame);
      bench.await_response_window();
      const std::string place = fmt::format("bits {} and {} of the frame are wrong", first, second);
      if (!is_one_column) {
        expect_ignored(bench, judge, "acts_on_wrong_check", place);
        continue;
      }
      const WhatItIs outcome = outcome_of(bench, frame);
      ++counts.at(static_cast<std::size_t>(outcome));
      if (outcome == WhatItIs::executed) {
        judge.expect(!bench.boards().changes().empty(), "right_check_refused",
                     fmt::format("the exclusive or fits although {}: the write is taken", place),
                     "no valve moved");
        expect_valves(bench, judge, bench.valves_of(frame[2], frame[3]), "valves_wrong");
      } else if (outcome == WhatItIs::answered) {
        judge.expect(bench.has_driven(), "right_check_refused",
                     fmt::format("the exclusive or fits although {}: the read is answered", place),
                     "no answer");
        expect_answer(bench, judge, 0, end);
      } else {
        expect_ignored(bench, judge, "acts_on_foreign_frame", place);
      }
    }
  }
  judge.measure("same-column double errors executed", "", counts[0]);
  judge.measure("same-column double errors answered", "", counts[1]);
  judge.measure("same-column double errors discarded", "", counts[2]);
  judge.measure("same-column double errors ignored", "", counts[3]);
}

void other_checks_are_refused(NodeBench& bench, CaseJudge& judge) {
  switch_some_on(bench);
  for (int n = 0; n < bench.volume(8, 200); ++n) {
    for (const unsigned number : {bench.rules().write_command, bench.rules().read_command}) {
      Frame frame = command(bench, number);
      const std::uint8_t right = frame.back();
      const auto sum = static_cast<std::uint8_t>(frame[0] + frame[1] + frame[2] + frame[3]);
      const std::array<std::uint8_t, 4> wrong{static_cast<std::uint8_t>(~right), sum,
                                              static_cast<std::uint8_t>(-sum), bench.random_octet()};
      for (const std::uint8_t check : wrong) {
        if (check == right) continue;
        frame.back() = check;
        keep_switched_on(bench);
        bench.send(frame);
        bench.await_response_window();
        expect_ignored(bench, judge, "acts_on_wrong_check",
                       fmt::format("the check is {:02X} and should be {:02X}", check, right));
      }
    }
  }
  expect_serves(bench, judge);
}

}  // namespace

std::vector<NodeCase> node_check_cases() {
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/check/single_bit_errors_are_refused",
                    .purpose = "RN-09",
                    .requirement = "A frame whose block check does not fit is ignored.",
                    .reference = valve_sources::paper("node on a wrong block check"),
                    .stimulus = "A write and a read with each of their 40 bits wrong in turn.",
                    .expected = "No valve moves and no answer; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"read_not_checked", "acts_on_wrong_check"},
                                {"write_not_checked", "acts_on_wrong_check"},
                                {"valves_off_on_wrong_check", "acts_on_wrong_check"}}},
                   single_bit_errors_are_refused});
  cases.push_back(
      {{.id = "valve_bus/node/check/double_errors_show_the_exclusive_or",
        .purpose = "RN-10",
        .requirement = "The block check is the exclusive or of ID, COMMAND, DATA0 and DATA1: it fits "
                       "whenever each of its eight columns has an even number of wrong bits, and only then.",
        .reference = valve_sources::calculated("80 double errors in one column, 700 others"),
        .stimulus = "Writes with two wrong bits: all 80 pairs in one column, and the 700 others.",
        .expected = "Of the 80, 24 are executed with wrong data, 3 are answered as reads, 21 have "
                    "another command and 32 another ID; all others are refused.",
        .tags = {"must"},
        .catches = {{"check_is_crc", "right_check_refused"}, {"check_is_parity", "acts_on_wrong_check"}}},
       double_errors_show_the_exclusive_or});
  cases.push_back({{.id = "valve_bus/node/check/other_checks_are_refused",
                    .purpose = "RN-11",
                    .requirement = "Nothing but the exclusive or is a right check.",
                    .reference = valve_sources::paper("block check"),
                    .stimulus = "Frames with the complement, with the sum and its negative, and with a "
                                "random octet for a check.",
                    .expected = "No valve moves and no answer; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"check_or_complement", "acts_on_wrong_check"},
                                {"read_not_checked", "acts_on_wrong_check"}}},
                   other_checks_are_refused});
  return cases;
}

}  // namespace fieldproof::conformance

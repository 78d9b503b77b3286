#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "conformance/valve_bus/blind_check.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"
#include "conformance/valve_bus/node_lateness.hpp"

// Bursts on the line of a node. What it does then must follow from what arrived: a frame that is wrong and
// whose exclusive or fits all the same is taken, and no node can know better.
namespace fieldproof::conformance {
namespace {

struct BurstLedger {
  std::uint64_t sent = 0;
  std::uint64_t taken_wrong = 0;
  std::uint64_t refused = 0;
};

std::string frame_text(const ArrivedFrame& frame) {
  return fmt::format("{:02X}{}", fmt::join(frame.octets, " "), frame.is_spoilt ? " (spoilt)" : "");
}

// Each move of the valves is that of a command that arrived: all that change within 1 us move at once.
void expect_moves_follow(NodeBench& bench, CaseJudge& judge) {
  const auto& changes = bench.boards().changes();
  for (std::size_t n = 0; n < changes.size(); ++n) {
    const auto& change = changes[n];
    const bool goes_on = n + 1 < changes.size() && changes[n + 1].when - change.when <= kernel::kMicrosecond;
    const bool follows = goes_on || std::ranges::any_of(bench.arrived(), [&](const ArrivedFrame& frame) {
                           return frame.is_command() && frame.octets[0] == bench.address() &&
                                  frame.octets[1] == bench.rules().write_command &&
                                  frame.end <= change.when &&
                                  bench.valves_of(frame.octets[2], frame.octets[3]) == change.after;
                         });
    if (!follows) expect_move_not_late(bench, judge, change.after, change.when);
    judge.expect(follows, "moves_without_command", [&] {
      std::vector<std::string> arrived;
      for (const ArrivedFrame& frame : bench.arrived()) arrived.push_back(frame_text(frame));
      return Mismatch{{fmt::format("valves move by what arrived only: {}", fmt::join(arrived, "; "))},
                      fmt::format("valves {:04X}h became {:04X}h", change.before, change.after),
                      change.when};
    });
  }
}

void expect_answers_follow(NodeBench& bench, CaseJudge& judge) {
  const bool is_asked = std::ranges::any_of(bench.arrived(), [&](const ArrivedFrame& frame) {
    return frame.is_command() && frame.octets[0] == bench.address() &&
           (frame.octets[1] == bench.rules().read_command || bench.rules().answers_writes);
  });
  if (!is_asked) expect_silence(bench, judge, "answers_without_command", "no read arrived");
}

void send_under_stress(NodeBench& bench, CaseJudge& judge, BurstLedger& ledger) {
  bench.clear_observations();
  const std::uint16_t before = bench.valves();
  const bool is_write = bench.random().chance(0.7);
  const auto data0 = bench.random_octet();
  const auto data1 = bench.random_octet();
  is_write ? bench.write(data0, data1) : bench.read();
  bench.await_response_window();
  expect_moves_follow(bench, judge);
  expect_answers_follow(bench, judge);
  ++ledger.sent;
  const std::uint16_t now = bench.valves();
  if (!is_write || now == bench.valves_of(data0, data1)) return;
  ++(now == before ? ledger.refused : ledger.taken_wrong);
}

void bursts_move_nothing_by_themselves(NodeBench& bench, CaseJudge& judge) {
  BurstLedger ledger;
  for (int round = 0; round < bench.volume(4, 100); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      bench.begin_stress(stress);
      const kernel::Time until = bench.now() + stress.duration;
      while (bench.now() < until) send_under_stress(bench, judge, ledger);
      bench.end_stress();
      bench.clear_observations();
      expect_serves(bench, judge);
    }
  }
  judge.measure("frames under bursts", "", static_cast<double>(ledger.sent));
  judge.measure("characters that arrived otherwise", "", static_cast<double>(bench.stressed_transmissions()));
  judge.measure("writes refused", "", static_cast<double>(ledger.refused));
  judge.measure("writes taken with wrong data", "", static_cast<double>(ledger.taken_wrong));
  if (bench.stressed_transmissions() == 0) {
    judge.inconclusive("nothing_was_hit", {{"bursts change characters"}, "no character arrived otherwise"});
  }
  warn_of_blind_check(judge, ledger.taken_wrong, ledger.taken_wrong + ledger.refused,
                      "hit writes were taken with wrong data");
}

}  // namespace

std::vector<NodeCase> node_immunity_cases() {
  std::vector<NodeCase> cases;
  cases.push_back(
      {{.id = "valve_bus/node/immunity/bursts_move_nothing_by_themselves",
        .purpose = "RN-39",
        .requirement = "Under bursts valves move and answers come only by frames that arrive with a "
                       "check that fits; after a burst the first frame is served.",
        .reference = valve_sources::paper("block check; use in disturbed surroundings"),
        .details = {{valve_sources::calculated("errors in one column"), {std::string(kCheckDoesNotSeeIt)}}},
        .stimulus = "Bursts of IEC 61000-4-4, 5 and 100 kHz, both polarities, the two highest levels, "
                    "while writes and reads go on.",
        .expected = "Each move follows from a frame that arrived; wrong data whose exclusive or fits "
                    "are counted. After each burst a write and a read are served.",
        .tags = {"must", std::string(kStressTag)},
        .catches = {{"write_not_checked", "moves_without_command"},
                    {"valves_off_on_wrong_check", "moves_without_command"},
                    {"buffer_not_cleared", "does_not_recover"}}},
       bursts_move_nothing_by_themselves});
  return cases;
}

}  // namespace fieldproof::conformance

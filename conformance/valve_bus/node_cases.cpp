#include "conformance/valve_bus/node_cases.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

NodeCase canary() {
  return {canary_of("valve_bus/node", valve_sources::own("rules of the suite"), "A read.",
                    "the case asks for an answer that no node gives."),
          [](NodeBench& bench, CaseJudge& judge) {
            bench.read();
            bench.await_response_window();
            const auto answers = bench.answers();
            judge.expect(answers.size() == 1 && answers.front().characters.size() == 300, "canary",
                         "an answer of 300 octets", "it was shorter");
          }};
}

// On a real line an instant is known to some microseconds. One that lies closer to its limit says nothing; a
// case of which most say nothing has not shown what was to be judged.
void judge_instants(const InstantLedger& instants, CaseJudge& judge) {
  const auto microseconds = [](kernel::Duration time) { return static_cast<double>(time.count()) * 1e-6; };
  if (instants.greatest_doubt > kernel::Duration{})
    judge.measure("greatest uncertainty U of an instant", "us", microseconds(instants.greatest_doubt));
  if (instants.in_doubt == 0) return;
  judge.measure("instants closer to a limit than U", "", static_cast<double>(instants.in_doubt));
  if (instants.in_doubt <= instants.sure) return;
  judge.inconclusive("timing_in_doubt", {{"instants that are known better than their distance from a limit"},
                                         fmt::format("{} of {} were closer than U, which was {} at least",
                                                     instants.in_doubt, instants.in_doubt + instants.sure,
                                                     kernel::describe(instants.least_doubt_open))});
}

}  // namespace

void judge_end(NodeBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  bench.finish();
  judge_instants(bench.instants(), judge);
}

const std::vector<NodeCase>& node_cases() {
  static const std::vector<NodeCase> cases = [] {
    // What is basic comes first: who answers wrong is told so of a read, not of one board.
    static constexpr std::array kChapters{node_write_cases,    node_read_cases,      node_one_board_cases,
                                          node_address_cases,  node_check_cases,     node_framing_cases,
                                          node_timing_cases,   node_line_cases,      node_power_cases,
                                          node_loss_cases,     node_meanwhile_cases, node_settings_cases,
                                          node_immunity_cases, node_resonance_cases};
    auto all = cases_of<NodeCase>(kChapters, node_details());
    all.push_back(canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

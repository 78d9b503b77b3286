#include "conformance/token_bus/dual_channel_cases.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

ManagerCase manager_canary() {
  return {canary_of("token_bus/channel_manager", token_sources::own("rules of the suite"),
                    "A preamble on both channels.",
                    "the case asks for a symbol that no channel manager indicates."),
          [](ManagerBench& bench, CaseJudge& judge) {
            bench.carry({"11111111"}, {"11111111"});
            bench.settle();
            judge.expect(bench.indicated().text().find('P') != std::string::npos, "canary", "pad_idle",
                         "none");
          }};
}

}  // namespace

const std::vector<ManagerCase>& manager_cases() {
  static const std::vector<ManagerCase> cases = [] {
    static constexpr std::array kChapters{
        manager_request_cases, manager_management_cases, manager_selection_cases, manager_inside_cases,
        manager_fault_cases,   manager_limit_cases,      manager_verdict_cases,   manager_symbol_cases,
        manager_series_cases,  manager_ring_cases};
    auto all = cases_of<ManagerCase>(kChapters, {});
    all.push_back(manager_canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

#include "conformance/interbus/master_cases.hpp"

#include <array>

namespace fieldproof::conformance {

namespace {

MasterCase canary() {
  return {canary_of("interbus/master", {"this project", "suite rules", judge::Standing::own},
                    "The master is powered on a ring.", "the case asks for a master that is not in run."),
          [](MasterBench& bench, CaseJudge& judge) {
            bench.bring_up(judge, paper_ring());
            judge.expect(!bench.is_in_run(), "canary", "a master that runs is not in run", "it is in run");
          }};
}

}  // namespace

const std::vector<MasterCase>& master_cases() {
  static const std::vector<MasterCase> cases = [] {
    static constexpr std::array kChapters{master_identification_cases,
                                          master_data_cycle_cases,
                                          master_rejection_cases,
                                          master_supervision_cases,
                                          master_ring_change_cases,
                                          master_timing_cases,
                                          master_application_cases,
                                          master_skew_cases,
                                          master_immunity_cases,
                                          master_compared_cases,
                                          master_cases_at_length,
                                          master_id_cycle_cases,
                                          master_cases_of_telegrams_at_ends,
                                          master_cases_of_rings_at_ends,
                                          master_cases_of_starts};
    auto all = cases_of<MasterCase>(kChapters, {});
    all.push_back(canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

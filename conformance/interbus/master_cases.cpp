#include "conformance/interbus/master_cases.hpp"

#include <iterator>
#include <utility>

namespace fieldproof::conformance {

namespace {

MasterCase canary() {
  TestCase test_case;
  test_case.id = "interbus/master/canary/a_failure_is_seen";
  test_case.purpose = "canary";
  test_case.requirement = "a failure of this suite is seen";
  test_case.reference = {"this project", "suite rules", judge::Standing::own};
  test_case.stimulus = "none";
  test_case.expected = "the verdict is fail";
  test_case.tags = {"canary"};
  return {test_case, [](MasterBench& bench, CaseJudge& judge) {
            bench.bring_up(judge, paper_ring());
            judge.expect(!bench.is_in_run(), "canary", "a master that runs is not in run", "it is in run");
          }};
}

}  // namespace

const std::vector<MasterCase>& master_cases() {
  static const std::vector<MasterCase> cases = [] {
    std::vector<MasterCase> all;
    for (auto chapter : {master_identification_cases, master_data_cycle_cases, master_rejection_cases,
                         master_supervision_cases, master_ring_change_cases, master_timing_cases,
                         master_application_cases, master_skew_cases, master_immunity_cases}) {
      std::vector<MasterCase> cases_of_chapter = chapter();
      std::move(cases_of_chapter.begin(), cases_of_chapter.end(), std::back_inserter(all));
    }
    all.push_back(canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

#include "conformance/fieldbus_dll/ff_cases.hpp"

#include <array>

#include "conformance/fieldbus_dll/ff_expect.hpp"

namespace fieldproof::conformance {
namespace {

FfCase ff_canary(const std::string& role) {
  return {canary_of("fieldbus_dll/" + role, link_sources::own("rules of the suite"), "A PT.",
                    "the case asks for a DLPDU that no station sends."),
          [](FfBench& bench, CaseJudge& judge) {
            bench.send(bench.pt(fieldbus_dll::Priority::normal, 500));
            const auto all = bench.listen();
            judge.expect(!all.empty() && all.front().octets.size() == 300, "canary", "a DLPDU of 300 octets",
                         "none of this length");
          }};
}

}  // namespace

void judge_end(FfBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  judge_driven(bench, judge);
  bench.finish();
}

const std::vector<FfCase>& ff_cases() {
  static const std::vector<FfCase> cases = [] {
    static constexpr std::array kChapters{
        ff_probe_cases,       ff_token_cases,    ff_publisher_cases, ff_frame_cases, ff_schedule_cases,
        ff_circulation_cases, ff_rotation_cases, ff_live_list_cases, ff_time_cases,  ff_claim_cases};
    auto all = cases_of<FfCase>(kChapters, ff_details());
    all.push_back(ff_canary("ff_device"));
    all.push_back(ff_canary("ff_las"));
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

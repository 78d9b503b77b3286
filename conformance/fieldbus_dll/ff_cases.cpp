#include "conformance/fieldbus_dll/ff_cases.hpp"

#include <fmt/format.h>

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

// Whose they are, and for whom: to whom the user submits, or between data link entities.
void judge_addresses(const FfBench& bench, CaseJudge& judge) {
  for (const DrivenDlpdu& one : bench.driven()) {
    if (!is_dt1(bench, one)) continue;
    const auto [to, from] = addresses_in(one);
    const bool is_of_entity = from == fieldbus_dll::address_of(bench.node());
    const bool is_right =
        fieldbus_dll::node_of(from) == bench.node() && (is_of_entity || bench.destinations().contains(to));
    judge.expect(is_right, "dlpdu_wrong", [&] {
      return Sighting{{fmt::format("a DT1 from node {:02X}, to where its user submitted", bench.node())},
                      one.text(),
                      one.begin};
    });
  }
}

}  // namespace

void judge_end(FfBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  judge_driven(bench, judge);
  judge_addresses(bench, judge);
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

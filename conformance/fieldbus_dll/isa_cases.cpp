#include "conformance/fieldbus_dll/isa_cases.hpp"

#include <array>

#include "conformance/fieldbus_dll/isa_expect.hpp"

namespace fieldproof::conformance {
namespace {

IsaCase canary(const std::string& role) {
  return {canary_of("fieldbus_dll/" + role, link_sources::own("rules of the suite"), "An ET.",
                    "the case asks for a DLPDU that no station sends."),
          [](IsaBench& bench, CaseJudge& judge) {
            bench.send(bench.et(fieldbus_dll::Priority::normal));
            const auto all = bench.listen();
            judge.expect(!all.empty() && all.front().octets.size() == 300, "canary", "a DLPDU of 300 octets",
                         "none of this length");
          }};
}

}  // namespace

void judge_end(IsaBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  judge_driven(bench, judge);
  for (const DrivenDlpdu& one : bench.driven()) {
    judge.expect(one.octet(2) == bench.address(), "source_wrong", [&] {
      return Sighting{{"the station's own address as the source"}, one.text(), one.begin};
    });
  }
  bench.finish();
}

const std::vector<IsaCase>& isa_cases() {
  static const std::vector<IsaCase> cases = [] {
    static constexpr std::array kChapters{isa_single_token_cases, isa_sequence_cases,   isa_duration_cases,
                                          isa_rejection_cases,    isa_compelling_cases, isa_compelled_cases,
                                          isa_data_cases,         isa_line_cases,       isa_schedule_cases,
                                          isa_supervision_cases,  isa_transfer_cases};
    auto all = cases_of<IsaCase>(kChapters, isa_details());
    all.push_back(canary("isa_dle"));
    all.push_back(canary("isa_las"));
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

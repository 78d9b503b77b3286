#include "conformance/fieldbus_dll/isa_cases.hpp"

#include <array>

#include "conformance/fieldbus_dll/isa_expect.hpp"
#include "conformance/fieldbus_dll/isa_standby.hpp"

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

void judge_what_its_user_was_told(IsaBench& bench, CaseJudge& judge) {
  std::vector<fieldbus_dll::IsaDlpdu> told;
  for (const IsaUpperTester::Delivery& one : bench.user().deliveries) told.push_back(one.dlpdu);
  const auto& codes = bench.rules().codes;
  judge_told(bench, judge, told, [&](const DrivenDlpdu& sent, const fieldbus_dll::IsaDlpdu& one) {
    const std::uint8_t code = one.type == fieldbus_dll::IsaType::du ? codes.du : codes.dt;
    return is_type(sent, code) &&
           (sent.octet(0) & fieldbus_dll::kPriorityBits) == static_cast<unsigned>(one.priority) &&
           sent.octet(1) == one.destination && sent.octet(2) == one.source && sent.rest() == one.data;
  });
}

}  // namespace

void judge_end(IsaBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  judge_driven(bench, judge);
  judge_what_its_user_was_told(bench, judge);
  for (const DrivenDlpdu& one : bench.driven()) {
    judge.expect(one.octet(2) == bench.address(), "source_wrong", [&] {
      return Mismatch{{"the station's own address as the source"}, one.text(), one.begin};
    });
  }
  bench.finish();
}

const std::vector<IsaCase>& isa_cases() {
  static const std::vector<IsaCase> cases = [] {
    static constexpr std::array kChapters{
        isa_single_token_cases, isa_sequence_cases,    isa_duration_cases,      isa_rejection_cases,
        isa_compelling_cases,   isa_compelled_cases,   isa_data_cases,          isa_line_cases,
        isa_schedule_cases,     isa_supervision_cases, isa_transfer_cases,      isa_immunity_cases,
        isa_timers_cases,       isa_request_cases,     isa_link_settings_cases, isa_reception_cases};
    auto all = cases_of<IsaCase>(kChapters, isa_details());
    const std::vector<IsaCase> in_standby = isa_standby_cases(all);
    all.insert(all.end(), in_standby.begin(), in_standby.end());
    all.push_back(canary("isa_dle"));
    all.push_back(canary("isa_las"));
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

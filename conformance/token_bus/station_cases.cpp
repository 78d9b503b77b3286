#include "conformance/token_bus/station_cases.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

TokenCase canary() {
  return {canary_of("token_bus/station", token_sources::own("rules of the suite"), "A token.",
                    "the case asks for a frame that no station sends."),
          [](TokenBench& bench, CaseJudge& judge) {
            bench.send(bench.frame(TokenControl::token, bench.address(), TokenBench::kAbove));
            const auto one = bench.next(bench.now() + bench.slots(2));
            judge.expect(one && one->octets.size() == 9'000, "canary", "a frame of 9000 octets", "none");
          }};
}

}  // namespace

void judge_end(TokenBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  for (const DrivenFrame& one : bench.driven()) {
    const auto expect = [&](bool holds, std::string_view reason, std::string_view what) {
      judge.expect(holds, reason, [&] { return Mismatch{{std::string(what)}, one.text(), one.begin}; });
    };
    expect(one.is_well_formed, "frame_malformed", "preamble, delimiters and whole octets");
    expect(one.has_right_check, "check_wrong", "a frame check that fits");
    expect(one.preamble_octets >= bench.rules().preamble_octets, "preamble_short",
           "as many octets of preamble as are set, at least");
    expect(one.source() == bench.address(), "source_wrong", "the station's own address as the source");
  }
  judge_events(bench, judge);
  bench.finish();
}

const std::vector<TokenCase>& token_cases() {
  static const std::vector<TokenCase> cases = [] {
    static constexpr std::array kChapters{
        token_initialisation_cases, token_joining_cases,    token_passing_cases,
        token_failure_cases,        token_holding_cases,    token_reception_cases,
        token_line_cases,           token_event_cases,      token_anew_cases,
        token_user_cases,           token_supply_cases,     token_address_cases,
        token_request_cases,        token_dropping_cases,   token_class_cases,
        token_alone_cases,          token_membership_cases, token_kind_cases,
        token_many_cases,           token_settings_cases,   token_rotation_settings_cases,
        token_long_address_cases,   token_immunity_cases,   token_each_cases};
    auto all = cases_of<TokenCase>(kChapters, token_details());
    all.push_back(canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

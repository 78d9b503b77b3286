#include "conformance/fieldbus_dll/ff_cases.hpp"

#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/ff_standby.hpp"

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
      return Mismatch{{fmt::format("a DT1 from node {:02X}, to where its user submitted", bench.node())},
                      one.text(),
                      one.begin};
    });
  }
}

// Is it an address of this station's link, whatever link a long address names?
bool is_same_address(fieldbus_dll::FfAddress one, fieldbus_dll::FfAddress other) {
  constexpr fieldbus_dll::FfAddress kNodeAndSelector = 0xFFFF;
  return (one & kNodeAndSelector) == (other & kNodeAndSelector);
}

// Entities tell each other what no user is told; without data they tell nothing.
bool is_between_entities(const AddressesOfDt1& addresses) {
  const auto is_of_entity = [](fieldbus_dll::FfAddress one) { return (one & 0xFF) == fieldbus_dll::kEntity; };
  return is_of_entity(addresses.from) &&
         (is_of_entity(addresses.to) || addresses.to == fieldbus_dll::kEverybody);
}

void judge_what_its_user_was_told(FfBench& bench, CaseJudge& judge) {
  const auto is_data = [&](const DrivenDlpdu& sent, const fieldbus_dll::FfDlpdu& told) {
    if (!is_dt1(bench, sent)) return false;
    const AddressesOfDt1 addresses = addresses_in(sent);
    return (!is_between_entities(addresses) || dlsdu_of(sent).empty()) &&
           is_same_address(addresses.to, told.destination) && is_same_address(addresses.from, told.source) &&
           priority_in(sent) == told.priority && dlsdu_of(sent) == told.data;
  };
  const auto is_buffer = [&](const DrivenDlpdu& sent, const fieldbus_dll::FfDlpdu& told) {
    if (!is_dt3(bench, sent)) return false;
    const BufferOfDt3 buffer = buffer_in(sent);
    return is_same_address(buffer.from, told.source) && buffer.writes == told.writes &&
           buffer.data == told.data;
  };
  judge_told(bench, judge, bench.user().data, is_data);
  judge_told(bench, judge, bench.user().published, is_buffer);
}

}  // namespace

void judge_end(FfBench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  judge_driven(bench, judge);
  judge_addresses(bench, judge);
  judge_what_its_user_was_told(bench, judge);
  bench.finish();
}

const std::vector<FfCase>& ff_cases() {
  static const std::vector<FfCase> cases = [] {
    static constexpr std::array kChapters{ff_probe_cases,      ff_token_cases,       ff_publisher_cases,
                                          ff_frame_cases,      ff_schedule_cases,    ff_circulation_cases,
                                          ff_rotation_cases,   ff_live_list_cases,   ff_time_cases,
                                          ff_claim_cases,      ff_immunity_cases,    ff_link_settings_cases,
                                          ff_link_times_cases, ff_endings_cases,     ff_request_cases,
                                          ff_reception_cases,  ff_transmission_cases};
    auto all = cases_of<FfCase>(kChapters, ff_details());
    const std::vector<FfCase> in_standby = ff_standby_cases(all);
    all.insert(all.end(), in_standby.begin(), in_standby.end());
    all.push_back(ff_canary("ff_device"));
    all.push_back(ff_canary("ff_las"));
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance

#include "conformance/valve_bus/host_cases.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

namespace fieldproof::conformance {
namespace {

HostCase host_canary() {
  return {canary_of("valve_bus/host", valve_sources::own("rules of the suite"), "A read.",
                    "the case asks for a frame that no host sends."),
          [](HostBench& bench, CaseJudge& judge) {
            bench.order({5, 1, 0, 0});
            const auto frame = bench.next_frame(bench.observation_timeout());
            judge.expect(frame && frame->sent.characters.size() == 300, "canary", "a frame of 300 octets",
                         "it was shorter");
          }};
}

// What a driver does is reported as it was, and a silence that is too short is one whatever the doubt.
constexpr std::array<std::string_view, 3> kOfAnyInstants{
    "valve_bus/host/timing/write_is_left_alone",
    "valve_bus/host/timing/delimiter_is_in_front_of_each_request",
    "valve_bus/host/timing/driver_is_on_for_requests_only"};

// Here the PC writes much before a response is due.
constexpr std::array<std::string_view, 2> kOfOneInstant{"valve_bus/host/fifo/lost_command_is_lost_whole",
                                                        "valve_bus/host/fifo/full_fifo_keeps_the_oldest"};

bool needs_exact_instants(const TestCase& test_case) {
  if (std::ranges::find(kOfOneInstant, test_case.id) != kOfOneInstant.end()) return true;
  return std::ranges::find(test_case.tags, "timing") != test_case.tags.end() &&
         std::ranges::find(kOfAnyInstants, test_case.id) == kOfAnyInstants.end();
}

auto at_exact_instants(std::function<void(HostBench&, CaseJudge&)> procedure) {
  return [procedure = std::move(procedure)](HostBench& bench, CaseJudge& judge) {
    bench.expect_exact_instants();
    procedure(bench, judge);
  };
}

}  // namespace

const std::vector<HostCase>& host_cases() {
  static const std::vector<HostCase> cases = [] {
    static constexpr std::array kChapters{host_request_cases,   host_response_cases,   host_retry_cases,
                                          host_fifo_cases,      host_timing_cases,     host_line_cases,
                                          host_cycle_cases,     host_memory_cases,     host_refresh_cases,
                                          host_dip_cases,       host_immunity_cases,   host_supply_cases,
                                          host_attempt_cases,   host_kept_write_cases, host_meanwhile_cases,
                                          host_endurance_cases, host_corner_cases};
    auto all = cases_of<HostCase>(kChapters, host_details());
    for (HostCase& one : all)
      if (needs_exact_instants(one.test_case)) one.procedure = at_exact_instants(std::move(one.procedure));
    all.push_back(host_canary());
    return all;
  }();
  return cases;
}

Applicability for_switched_power() {
  return for_item("power_can_be_switched", true, declared_host(),
                  "the bench cannot switch the supply of the host");
}

Applicability for_settable_dip() {
  return for_both(
      for_item("dip_can_be_set", true, declared_host(), "the bench cannot turn the host's DIP switches"),
      for_switched_power());
}

Applicability for_quick_frames(unsigned requests) {
  return [requests](const judge::Pics& pics) -> std::optional<std::string> {
    valve_bus::Rules rules = host_configuration({}, pics.completed_by(declared_host())).rules;
    rules.bit_rate = valve_bus::dip_bit_rates()[static_cast<std::size_t>(pics.number("dip", 0))];
    constexpr std::int64_t kFrameBits = 11 * valve_bus::kCommandOctets;
    if (requests * (valve_bus::bits(rules, kFrameBits) + valve_bus::delimiter(rules)) < rules.refresh)
      return std::nullopt;
    return "at this bit rate what was written is sent again meanwhile";
  };
}

Applicability for_plain_writes() {
  return [](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.supports("answers_writes")) return "the host waits for an acknowledge after each write";
    if (pics.supports("verifies_writes")) return "the host sends a read after each write";
    return std::nullopt;
  };
}

}  // namespace fieldproof::conformance

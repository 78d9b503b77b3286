#include <fmt/format.h>

#include <algorithm>

#include "conformance/valve_bus/host_scene.hpp"

// What becomes of a read that is not answered, or wrongly, or too late.
namespace fieldproof::conformance {
namespace {

using valve_bus::HostCounters;
using valve_bus::HostError;
using valve_bus::HostErrorKind;
using valve_bus::Response;

constexpr double kTolerance = 0.05;  // of a time-out

kernel::Duration times(kernel::Duration duration, double factor) {
  return kernel::Duration{static_cast<std::int64_t>(static_cast<double>(duration.count()) * factor)};
}

// A host knows of a start bit when its character is over, and then switches its driver on.
kernel::Duration latest_retry(const HostBench& bench) {
  return times(bench.time_out(), 1 + kTolerance) + character_notice(bench.rules()) + bench.bits(3);
}

void expect_time_out(HostBench& bench, CaseJudge& judge, kernel::Duration waited) {
  const double least = in_microseconds(times(bench.time_out(), 1 - kTolerance));
  const double most = in_microseconds(latest_retry(bench));
  const double measured = in_microseconds(waited);
  if (measured < least) {
    judge.expect_between("time-out", "us", measured, least, most, "time_out_too_short");
  }
  judge.expect_between("time-out", "us", measured, least, most, "time_out_too_long");
}

void a_silent_node_is_polled_three_times(HostBench& bench, CaseJudge& judge) {
  const auto polls = static_cast<int>(bench.rules().read_attempts);
  for (int n = 0; n < bench.volume(2, 50); ++n) {
    const HostFrame first = order_read(bench, judge, bench.random_id());
    const std::uint8_t id = first.command().id;
    const HostCounters before = bench.counters(id);
    HostFrame last = first;
    for (int poll = 1; poll < polls; ++poll) {
      const HostFrame again = expect_retry(bench, judge, first);
      expect_time_out(bench, judge, again.start - last.end);
      last = again;
    }
    expect_no_request(bench, judge, 2 * bench.time_out(), "polled_too_often",
                      fmt::format("{} attempts in all", polls));
    const kernel::Time limit = last.end + latest_retry(bench);
    const auto told = bench.next_told(bench.observation_timeout());
    judge.expect(told && told->when <= limit, "error_late", [&] {
      return Mismatch{{fmt::format("an error at {} at the latest", kernel::describe(limit))},
                      told ? text_of(*told) : std::string("nothing was reported")};
    });
    const auto* error = std::get_if<HostError>(&told->what);
    judge.expect(error != nullptr && *error == HostError{id, HostErrorKind::no_response}, "error_wrong",
                 fmt::format("an error of {:02X}: no response", id), text_of(*told));
    judge.expect_equal(bench.counters(id).timeouts - before.timeouts, static_cast<unsigned>(polls),
                       "counters_wrong", "time-outs");
    expect_nothing_told(bench, judge, kernel::kMillisecond, "data_of_silence_told", "nothing was known");
  }
}

void a_late_response_is_drained(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 100); ++n) {
    const HostFrame first = order_read(bench, judge, bench.random_id());
    const std::uint8_t id = first.command().id;
    const auto other = static_cast<std::uint8_t>(id % bench.rules().last_address + 1);
    const HostCounters before = bench.counters(id);
    for (unsigned poll = 1; poll < bench.rules().read_attempts; ++poll) expect_retry(bench, judge, first);
    const valve_bus::Command next{other, static_cast<std::uint8_t>(bench.rules().read_command), 0, 0};
    bench.order(next);
    bench.answer({bench.random_octet(), bench.random_octet()}, times(bench.time_out(), 1 + kTolerance));
    expect_error(bench, judge, {id, HostErrorKind::no_response}, "late_response_told");
    expect_old_if_known(bench, judge, id);
    expect_request(bench, judge, next);
    expect_nothing_told(bench, judge, bench.turnaround_time(), "late_response_told",
                        "nothing was answered yet");
    judge.expect_equal(bench.counters(id).late - before.late, 1U, "late_not_counted", "late responses");
    const Response response{bench.random_octet(), bench.random_octet()};
    bench.answer(response, bench.turnaround_time() + bench.bits(1));
    expect_response(bench, judge, other, response);
  }
}

// One of the ways in which a response can be wrong, another one in each round and attempt.
HostStep wrong_answer(unsigned attempt) {
  return stimulus<HostScene>("the node answers with a wrong check, two octets, or a wrong stop bit",
                             [attempt](HostScene& scene) {
                               HostBench& bench = scene.bench;
                               auto octets = octets_of(scene.random_response());
                               const unsigned way = (scene.round + attempt) % 3;
                               if (way == 0) {
                                 octets.back() = static_cast<std::uint8_t>(octets.back() + 1);
                                 bench.answer(octets, bench.turnaround_time());
                               } else if (way == 1) {
                                 bench.answer(std::span(octets).first(2), bench.turnaround_time());
                               } else {
                                 line::Levels levels;
                                 for (const std::uint8_t octet : octets)
                                   levels.append(bench.levels_of(octet));
                                 levels.flip(bench.levels_of(0).size() - 1);  // the stop bit of the first
                                 bench.answer_levels(levels, bench.turnaround_time());
                               }
                             });
}

HostCase silent_node_case(unsigned dip, std::string_view rate, std::vector<MustCatch> catches) {
  return {
      {.id = fmt::format("valve_bus/host/retry/silent_node_is_polled_three_times_at_{}", rate),
       .purpose = "RH-08",
       .requirement = "A node that does not answer within a delimiter and 3 ms is polled again, three "
                      "times in all; then an error is reported to the PC.",
       .reference = valve_sources::own("time-out and attempts"),
       .stimulus = fmt::format("Reads of nodes that do not answer, at {} bit/s.", rate),
       .expected = "Three polls; the time-out within 5 %, where the host knows of a start bit when its "
                   "character is over; an error, no data.",
       .tags = {"must", "timing"},
       .catches = std::move(catches),
       .not_applicable = for_host_with("dip_can_be_set", "the bench cannot set the bit rate of the host")},
      a_silent_node_is_polled_three_times,
      {.dip = dip}};
}

}  // namespace

std::vector<HostCase> host_retry_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("time-out and attempts");
  std::vector<HostCase> cases;
  cases.push_back(silent_node_case(0, "375000",
                                   {{"two_attempts", "no_retry"},
                                    {"four_attempts", "polled_too_often"},
                                    {"time_out_short", "time_out_too_short"},
                                    {"time_out_long", "time_out_too_long"}}));
  cases.push_back(silent_node_case(4, "20833", {{"time_out_fixed", "time_out_too_short"}}));
  cases.push_back(
      on_chart({.id = "valve_bus/host/retry/response_just_in_time_is_taken",
                .purpose = "RH-09",
                .requirement = "A response that begins 5 % before the time-out is taken.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"time_out_short", "response_not_told"}}},
               {{3, 100},
                {read(),
                 answer("the node answers rightly at 0.95 times the time-out", right_octets,
                        [](HostScene& scene) { return times(scene.bench.time_out(), 1 - kTolerance); }),
                 reported()}}));
  cases.push_back(
      {{.id = "valve_bus/host/retry/late_response_is_drained",
        .purpose = "RH-09",
        .requirement = "A response that begins 5 % after the last time-out is counted, not reported, "
                       "and not taken for the response of the node that is polled next.",
        .reference = own,
        .stimulus = "A late response to the last attempt, with a read of another node waiting.",
        .expected = "An error, a late response counted; the next node is served.",
        .tags = {"must", "timing", "hazard"},
        .catches = {{"takes_late_response", "late_response_told"}, {"late_not_counted", "late_not_counted"}}},
       a_late_response_is_drained});
  cases.push_back(
      on_chart({.id = "valve_bus/host/retry/third_attempt_is_taken",
                .purpose = "RH-16",
                .requirement = "After two wrong responses a right one is reported; retries and wrong "
                               "responses are counted for this node.",
                .reference = own,
                .tags = {"must"},
                .catches = {{"two_attempts", "no_retry"},
                            {"bad_response_not_repeated", "no_retry"},
                            {"counters_shared", "counters_wrong"}}},
               {{6, 200},
                {read(), wrong_answer(1), polled_again(), wrong_answer(2), polled_again(), response(),
                 reported(), counted(&HostCounters::retries, 2, "retries"),
                 counted(&HostCounters::rejected, 2, "rejected responses")}}));
  cases.push_back(on_chart(
      {.id = "valve_bus/host/retry/three_wrong_responses_are_an_error",
       .purpose = "RH-17",
       .requirement = "After three wrong responses an error is reported to the PC, and what was known "
                      "of the node, marked as old.",
       .reference = own,
       .tags = {"must"},
       .catches = {{"old_told_as_new", "old_data_told_as_new"},
                   {"old_forgotten", "old_data_not_told"},
                   {"four_attempts", "polled_too_often"}}},
      {{3, 100},
       {served_read(), read(), wrong_answer(0), polled_again(), wrong_answer(1), polled_again(),
        wrong_answer(2), not_polled_again(), error(HostErrorKind::bad_response, "wrong_response_told"),
        old_data(), nothing_reported(kernel::kMillisecond, "told_twice", "it has been reported")}}));
  return cases;
}

}  // namespace fieldproof::conformance

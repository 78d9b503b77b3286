#include <fmt/format.h>

#include "conformance/valve_bus/host_scene.hpp"

// What the host leaves between frames, and how long it holds the line.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;

void expect_two_writes_apart(HostScene& scene) {
  HostBench& bench = scene.bench;
  const Command first = bench.write_to(1 + scene.round % 3);
  const Command second = bench.write_to(4 + scene.round % 3);
  bench.order(first);
  bench.order(second);
  const kernel::Time end = expect_request(bench, scene.judge, first).end;
  const HostFrame next = expect_request(bench, scene.judge, second);
  const kernel::Time start = next.start;
  const kernel::Duration least = bench.delimiter() + bench.rules().write_distance;
  scene.judge.expect(start - end + bench.doubt_of(next).later + kernel::kNanosecond >= least,
                     "write_distance_too_short", [&] {
                       return Mismatch{{fmt::format("{} or more after a write", kernel::describe(least))},
                                       kernel::describe(start - end),
                                       start};
                     });
}

void expect_not_written_again(HostScene& scene) {
  const kernel::Duration since = scene.bench.now() - scene.request.start;
  const auto again = scene.bench.next_frame(scene.bench.rules().refresh * 8 / 10 - since);
  scene.judge.expect(!again, "write_repeated", [&] {
    return Mismatch{
        {"a write is not answered and not repeated before its refresh"}, "it was sent again", again->start};
  });
}

void order_four_commands(HostScene& scene) {
  const Command read = scene.bench.read_of(scene.id);
  scene.command = scene.bench.write_to(9);
  for (const Command& command : {read, read, scene.command, read}) scene.bench.order(command);
}

HostStep write_is_next() {
  return expected("the host sends the write, at least 38.5 bits after what was on the line",
                  [](HostScene& scene) { scene.expect_sent(); });
}

HostStep read_is_next() {
  return {"the node answers a read at any time at which it may",
          "the host sends it at least 38.5 bits after what was on the line, and the PC gets the data",
          [](HostScene& scene) {
            HostBench& bench = scene.bench;
            expect_request(bench, scene.judge, bench.read_of(scene.id));
            const valve_bus::Response response = bench.random_response();
            const std::int64_t span = turnaround_time_span(bench.rules()).count();
            bench.answer(response, bench.delimiter() + kernel::Duration{bench.random().between(0, span)});
            expect_response(bench, scene.judge, scene.id, response);
          }};
}

void measure_driver_of_host(HostScene& scene) {
  const HostFrame& frame = scene.request;
  scene.judge.measure("driver on before the start bit", "us",
                      in_microseconds(frame.start - frame.sent.driver_on));
  scene.judge.measure("driver on after the stop bit", "us",
                      in_microseconds(frame.sent.driver_off - frame.end));
}

void expect_driver_off_for_20_ms(HostScene& scene) {
  const auto unasked = scene.bench.next_frame(20 * kernel::kMillisecond);
  scene.judge.expect(!unasked, "drives_without_need", "nothing is sent when nothing is to do",
                     "it drove the line");
}

kernel::Duration latest_far_response(HostScene& scene) {
  return scene.bench.delimiter() + turnaround_time_span(scene.bench.rules()) + 20 * kernel::kMicrosecond;
}

}  // namespace

std::vector<HostCase> host_timing_cases() {
  using namespace host_chart;
  return {
      on_chart(
          {.id = "valve_bus/host/timing/write_is_left_alone",
           .purpose = "RH-18",
           .requirement = "After a write the line is left alone for a delimiter and 1 ms: the time "
                          "of the node.",
           .reference = valve_sources::own("a delimiter and 1 ms after a write"),
           .tags = {"must", "timing"},
           .catches = {{"write_distance_missing", "write_distance_too_short"}},
           .not_applicable = for_plain_writes()},
          {{3, 100},
           {{"the PC orders two writes at once, to different nodes",
             "the second begins at least a delimiter and 1 ms after the first", expect_two_writes_apart}}}),
      on_chart(
          {.id = "valve_bus/host/timing/write_is_not_answered",
           .purpose = "RH-18",
           .requirement = "A write has no response: the host does not wait for one and does not "
                          "repeat the write but by its refresh.",
           .reference = valve_sources::paper("a node answers requests for data only"),
           .tags = {"must", "timing"},
           .catches = {{"write_waits_for_answer", "write_repeated"}},
           .not_applicable = for_plain_writes()},
          {{1, 1},
           {write(), expected("it is not sent again before 0.8 times the refresh", expect_not_written_again),
            nothing_reported(kernel::Duration{}, "write_told", "a write has no response")}}),
      on_chart({.id = "valve_bus/host/timing/unasked_octets_are_drained",
                .purpose = "RH-18",
                .requirement = "What comes after a write is nobody's response: it is drained.",
                .reference = valve_sources::derived("a write has no response"),
                .tags = {"must"},
                .catches = {{"stray_told_as_response", "unasked_told"}},
                .not_applicable = for_both(for_plain_writes(), for_switched_power())},
               {{3, 100},
                {power_cycled(), write(), answer("three octets with a right check come", right_octets),
                 nothing_reported("unasked_told", "a write has no response"), served_read()}}),
      on_chart({.id = "valve_bus/host/timing/delimiter_is_in_front_of_each_request",
                .purpose = "RH-19",
                .requirement = "A request begins 3.5 characters after whatever was on the line, at the "
                               "earliest.",
                .reference = valve_sources::own("silence of 3.5 characters ends a frame"),
                .tags = {"must", "timing"},
                .catches = {{"delimiter_missing", "no_delimiter"},
                            {"delimiter_of_two_silent_characters", "no_delimiter"}},
                .not_applicable = for_plain_writes()},
               {{10, 500},
                {stimulus("the PC orders two reads, a write and a read at once", order_four_commands),
                 read_is_next(), read_is_next(), write_is_next(), read_is_next()}}),
      on_chart({.id = "valve_bus/host/timing/driver_is_on_for_requests_only",
                .purpose = "RH-27",
                .requirement = "The driver comes on at least a bit before a request, stays on until its "
                               "last stop bit is over, is off at most two bits later, and else not on.",
                .reference = valve_sources::paper("a station that does not send listens"),
                .tags = {"must", "timing"},
                .catches = {{"driver_on_with_start_bit", "driver_on_late"},
                            {"driver_cuts_stop_bit", "driver_released_early"},
                            {"driver_stays_on", "driver_not_released"}}},
               {{5, 200},
                {read(),
                 expected("its driver is on at least a bit before it and off at most two bits after it",
                          measure_driver_of_host),
                 response(), reported(),
                 expected("the driver stays off for 20 ms", expect_driver_off_for_20_ms)}}),
      on_chart(
          {.id = "valve_bus/host/timing/latest_response_is_taken_at_all_rates",
           .purpose = "RH-30",
           .requirement = "At every bit rate a response that begins as late as a node may begin it "
                          "is taken.",
           .reference = valve_sources::own("turnaround and time-out"),
           .tags = {"must", "timing"},
           .catches = {{"time_out_fixed", "response_not_told"}},
           .not_applicable = for_settable_dip()},
          {{dip_positions(), 20 * dip_positions()},
           {powered_up_at_each_position(), read(),
            answer("the node answers rightly 2 ms after the delimiter, where that is longer two characters "
                   "and two bits after it, from 10 us away",
                   right_octets, latest_far_response),
            reported()}}),
      on_chart(
          {.id = "valve_bus/host/timing/too_early_response_is_none_at_all_rates",
           .purpose = "RH-30",
           .requirement = "At every bit rate a response that begins 1.2 characters after the request is a "
                          "wrong attempt.",
           .reference = valve_sources::own("turnaround and time-out"),
           .tags = {"must", "timing"},
           .catches = {{"earliest_response_fixed", "early_response_taken"}},
           .not_applicable = for_settable_dip()},
          {{dip_positions(), 10 * dip_positions()},
           {powered_up_at_each_position(), read(),
            answer("the node answers rightly 1.2 characters after the request", right_octets,
                   [](HostScene& scene) { return scene.bench.characters(1.2); }),
            refused("early_response_taken", "it began less than 1.5 characters after the request")}}),
  };
}

}  // namespace fieldproof::conformance

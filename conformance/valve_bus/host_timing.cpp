#include <fmt/format.h>

#include <algorithm>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// What the host leaves between frames, and how long it holds the line.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::Response;

Command some_write(HostBench& bench, unsigned id) {
  return {static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(bench.rules().write_command),
          bench.random_octet(), bench.random_octet()};
}

void a_write_is_left_alone(HostBench& bench, CaseJudge& judge) {
  const kernel::Duration least = bench.delimiter() + bench.rules().write_distance;
  for (int n = 0; n < bench.volume(3, 100); ++n) {
    const Command first = some_write(bench, 1 + static_cast<unsigned>(n) % 3);
    const Command second = some_write(bench, 4 + static_cast<unsigned>(n) % 3);
    bench.order(first);
    bench.order(second);
    const HostFrame one = expect_request(bench, judge, first);
    const HostFrame two = expect_request(bench, judge, second);
    const kernel::Duration distance = two.start - one.end;
    judge.expect(distance + kernel::kNanosecond >= least, "write_distance_too_short", [&] {
      return Mismatch{{fmt::format("{} or more after a write", kernel::describe(least))},
                      kernel::describe(distance),
                      two.start};
    });
  }
}

void a_write_is_not_answered(HostBench& bench, CaseJudge& judge) {
  bench.order(some_write(bench, 7));
  const auto write = bench.next_frame(bench.observation_timeout());
  judge.expect(write.has_value(), "no_request", "the write is sent", "nothing was sent");
  expect_form(bench, judge, *write);
  // Up to the first refresh nothing more is to be sent.
  const kernel::Duration quiet = bench.rules().refresh * 8 / 10 - (bench.now() - write->start);
  const auto again = bench.next_frame(quiet);
  judge.expect(!again, "write_repeated", [&] {
    return Mismatch{
        {"a write is not answered and not repeated before its refresh"}, "it was sent again", again->start};
  });
  expect_nothing_told(bench, judge, kernel::Duration{}, "write_told", "a write has no response");
  bench.note_write(write->command());
}

// What nobody asked for after a write.
void unasked_octets_are_drained(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 100); ++n) {
    const Command write = some_write(bench, 8);
    bench.order(write);
    expect_request(bench, judge, write);
    bench.answer(Response{bench.random_octet(), bench.random_octet()});
    expect_nothing_told(bench, judge, bench.characters(14) + kernel::kMillisecond, "unasked_told",
                        "a write has no response");
    expect_read_served(bench, judge, bench.random_id());
  }
}

void a_delimiter_is_in_front_of_each_request(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(10, 500); ++n) {
    const Command read{bench.random_id(), static_cast<std::uint8_t>(bench.rules().read_command), 0, 0};
    const Command write = some_write(bench, 9);
    bench.order(read);
    bench.order(read);
    bench.order(write);
    bench.order(read);
    for (int poll = 0; poll < 3; ++poll) {
      if (poll == 2) expect_request(bench, judge, write);
      expect_request(bench, judge, read);
      const Response response{bench.random_octet(), bench.random_octet()};
      const kernel::Duration span = turnaround_time_span(bench.rules());
      bench.answer(response, bench.delimiter() + kernel::Duration{bench.random().between(0, span.count())});
      expect_response(bench, judge, read.id, response);
    }
  }
}

void the_driver_is_on_for_requests_only(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 200); ++n) {
    const HostFrame frame = order_read(bench, judge, bench.random_id());
    judge.measure("driver on before the start bit", "us",
                  in_microseconds(frame.start - frame.sent.driver_on));
    judge.measure("driver on after the stop bit", "us", in_microseconds(frame.sent.driver_off - frame.end));
    const Response response{bench.random_octet(), bench.random_octet()};
    bench.answer(response);
    expect_response(bench, judge, frame.command().id, response);
    const auto unasked = bench.next_frame(20 * kernel::kMillisecond);
    judge.expect(!unasked, "drives_without_need", "nothing is sent when nothing is to do",
                 "it drove the line");
  }
}

void the_latest_response_is_taken_at_all_rates(HostBench& bench, CaseJudge& judge) {
  for (unsigned dip = 0; dip < valve_bus::dip_bit_rates().size(); ++dip) {
    bench.restart(dip);
    for (int n = 0; n < bench.volume(1, 20); ++n) {
      const HostFrame request = order_read(bench, judge, bench.random_id());
      const Response response{bench.random_octet(), bench.random_octet()};
      // After a repeater of 10 us each way.
      bench.answer(response,
                   bench.delimiter() + turnaround_time_span(bench.rules()) + 20 * kernel::kMicrosecond);
      expect_response(bench, judge, request.command().id, response);
    }
  }
}

}  // namespace

std::vector<HostCase> host_timing_cases() {
  const judge::Reference distance = valve_sources::own("a delimiter and 1 ms after a write");
  std::vector<HostCase> cases;
  cases.push_back({{.id = "valve_bus/host/timing/write_is_left_alone",
                    .purpose = "RH-18",
                    .requirement = "After a write the line is left alone for a delimiter and 1 ms: the time "
                                   "of the node.",
                    .reference = distance,
                    .stimulus = "Two writes, one after the other.",
                    .expected = "The second begins no earlier than that.",
                    .tags = {"must", "timing"},
                    .catches = {{"write_distance_missing", "write_distance_too_short"}},
                    .not_applicable = for_plain_writes()},
                   a_write_is_left_alone});
  cases.push_back({{.id = "valve_bus/host/timing/write_is_not_answered",
                    .purpose = "RH-18",
                    .requirement = "A write has no response: the host does not wait for one and does not "
                                   "repeat the write but by its refresh.",
                    .reference = valve_sources::paper("a node answers requests for data only"),
                    .stimulus = "A write that nobody answers.",
                    .expected = "It is sent once up to its refresh; nothing is reported to the PC.",
                    .tags = {"must", "timing"},
                    .catches = {{"write_waits_for_answer", "write_repeated"}},
                    .not_applicable = for_plain_writes()},
                   a_write_is_not_answered});
  cases.push_back({{.id = "valve_bus/host/timing/unasked_octets_are_drained",
                    .purpose = "RH-18",
                    .requirement = "What comes after a write is nobody's response: it is drained.",
                    .reference = valve_sources::derived("a write has no response"),
                    .stimulus = "Three octets with a right check after a write; then a read.",
                    .expected = "They are not reported; the read is served.",
                    .tags = {"must"},
                    .catches = {{"stray_told_as_response", "unasked_told"}},
                    .not_applicable = for_plain_writes()},
                   unasked_octets_are_drained});
  cases.push_back({{.id = "valve_bus/host/timing/delimiter_is_in_front_of_each_request",
                    .purpose = "RH-19",
                    .requirement = "A request begins 3.5 characters after whatever was on the line, at the "
                                   "earliest.",
                    .reference = valve_sources::own("silence of 3.5 characters ends a frame"),
                    .stimulus = "Reads and writes that wait for each other, responses at many times.",
                    .expected = "At least 38.5 bits of silence in front of each.",
                    .tags = {"must", "timing"},
                    .catches = {{"delimiter_missing", "no_delimiter"},
                                {"delimiter_of_two_silent_characters", "no_delimiter"}},
                    .not_applicable = for_plain_writes()},
                   a_delimiter_is_in_front_of_each_request});
  cases.push_back({{.id = "valve_bus/host/timing/driver_is_on_for_requests_only",
                    .purpose = "RH-27",
                    .requirement = "The driver comes on at least a bit before a request, stays on until its "
                                   "last stop bit is over, is off at most two bits later, and else not on.",
                    .reference = valve_sources::paper("a station that does not send listens"),
                    .stimulus = "Reads.",
                    .expected = "The driver is on around the requests, and at no other time.",
                    .tags = {"must", "timing"},
                    .catches = {{"driver_on_with_start_bit", "driver_on_late"},
                                {"driver_cuts_stop_bit", "driver_released_early"},
                                {"driver_stays_on", "driver_not_released"}}},
                   the_driver_is_on_for_requests_only});
  cases.push_back(
      {{.id = "valve_bus/host/timing/latest_response_is_taken_at_all_rates",
        .purpose = "RH-30",
        .requirement = "At every bit rate a response that begins as late as a node may begin it "
                       "is taken.",
        .reference = valve_sources::own("turnaround and time-out"),
        .stimulus = "At each position of the DIP switches, a response 2 ms after the delimiter "
                    "(where that is longer, two characters and two bits), from 10 us away.",
        .expected = "It is reported.",
        .tags = {"must", "timing"},
        .catches = {{"time_out_fixed", "response_not_told"}},
        .not_applicable = for_host_with("dip_can_be_set", "the bench cannot set the bit rate of the host")},
       the_latest_response_is_taken_at_all_rates});
  return cases;
}

}  // namespace fieldproof::conformance

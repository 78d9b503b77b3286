#include <fmt/format.h>

#include <algorithm>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// What a line does to a host: its own echo, lines that are stuck, and noise between the polls.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostError;
using valve_bus::HostErrorKind;
using valve_bus::Response;

// ID ^ COMMAND = DATA0 makes a response of the first three octets of a read.
void an_echo_is_no_response(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(5, 200); ++n) {
    const std::uint8_t id = n == 0 ? std::uint8_t{5} : bench.random_id();
    const auto number = static_cast<std::uint8_t>(bench.rules().read_command);
    const Command read{id, number, static_cast<std::uint8_t>(id ^ number), bench.random_octet()};
    bench.order(read);
    expect_request(bench, judge, read);
    expect_nothing_told(bench, judge, bench.turnaround_time(), "echo_told", "no node has answered yet");
    const Response response{bench.random_octet(), bench.random_octet()};
    bench.answer(response, bench.turnaround_time() + bench.bits(1));
    expect_response(bench, judge, id, response);
  }
}

// The read ends in an error, and no data are told.
void expect_read_fails(HostBench& bench, CaseJudge& judge, std::uint8_t id, std::string_view data_reason,
                       std::string_view hanging_reason) {
  const auto told = bench.next_told(2 * bench.observation_timeout());
  judge.expect(told.has_value(), hanging_reason, "an error is reported to the PC", "nothing was reported");
  judge.expect(std::holds_alternative<HostError>(told->what), data_reason,
               fmt::format("an error of {:02X}", id), text_of(*told));
  expect_nothing_told(bench, judge, kernel::kMillisecond, data_reason, "nothing was known of the node");
}

void three_low_characters_are_no_response(HostBench& bench, CaseJudge& judge) {
  const std::size_t length = bench.levels_of(0).size();
  for (const bool is_one_break : {false, true}) {
    const HostFrame request = order_read(bench, judge, bench.random_id());
    line::Levels low;
    low.append_fill(false, is_one_break ? 3 * length : length);
    for (int n = 0; n < (is_one_break ? 1 : 3); ++n) {
      bench.answer_levels(low, bench.turnaround_time() + bench.characters(n));
    }
    expect_nothing_told(bench, judge, bench.characters(14) + kernel::kMillisecond, "low_line_told",
                        "a low line has no stop bits");
    expect_retry(bench, judge, request);
    const Response response{bench.random_octet(), bench.random_octet()};
    bench.answer(response);
    expect_response(bench, judge, request.command().id, response);
  }
}

void a_low_line_is_an_error(HostBench& bench, CaseJudge& judge) {
  const std::size_t length = bench.levels_of(0).size();
  const HostFrame request = order_read(bench, judge, bench.random_id());
  const auto count = static_cast<int>(3 * bench.observation_timeout() / bench.characters(1));
  line::Levels low;
  low.append_fill(false, length);
  for (int n = 0; n < count; ++n) bench.answer_levels(low, bench.turnaround_time() + bench.characters(n));
  expect_read_fails(bench, judge, request.command().id, "low_line_told", "waits_for_ever");
  bench.wait(2 * bench.observation_timeout());
  expect_host_recovers(bench, judge);
}

void a_high_line_is_a_time_out(HostBench& bench, CaseJudge& judge) {
  const HostFrame request = order_read(bench, judge, bench.random_id());
  line::Levels high;
  high.append_idle(
      static_cast<std::size_t>(kernel::levels_within(bench.observation_timeout(), bench.rules().bit_rate)));
  bench.answer_levels(high, bench.bits(4));
  const auto told = bench.next_told(2 * bench.observation_timeout());
  const HostError wanted{request.command().id, HostErrorKind::no_response};
  judge.expect(told.has_value(), "waits_for_ever", "an error is reported to the PC", "nothing was reported");
  const auto* error = std::get_if<HostError>(&told->what);
  judge.expect(error != nullptr && *error == wanted, "error_wrong", "an error: no response", text_of(*told));
  expect_nothing_told(bench, judge, kernel::kMillisecond, "high_line_told", "nothing was said");
  expect_host_recovers(bench, judge);
}

// Octets between two polls, a valid response among them.
void noise_between_polls_is_drained(HostBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(8, 300); ++n) {
    expect_read_served(bench, judge, bench.random_id());
    bench.wait(bench.characters(5) + bench.bits(static_cast<std::int64_t>(bench.random().below(100))));
    std::vector<std::uint8_t> noise(1 + static_cast<std::size_t>(n) % 4);
    std::ranges::generate(noise, [&] { return bench.random_octet(); });
    const bool is_response = noise.size() == valve_bus::kResponseOctets;
    if (is_response) noise[2] = noise[0] ^ noise[1];
    bench.say(noise);
    // After a valid response as long as it takes to be told; else the next read may come at once.
    const double silence = is_response ? 8 : static_cast<double>(bench.random().below(8));
    expect_nothing_told(bench, judge, bench.characters(silence), "noise_told", "nothing was asked");
  }
  expect_read_served(bench, judge, bench.random_id());
}

}  // namespace

std::vector<HostCase> host_line_cases() {
  std::vector<HostCase> cases;
  cases.push_back({{.id = "valve_bus/host/line/echo_is_no_response",
                    .purpose = "RH-13",
                    .requirement = "A host that receives its own echo does not take it for a response.",
                    .reference = valve_sources::calculated("ID ^ COMMAND = DATA0 is a valid response"),
                    .stimulus = "Reads of which the first three octets are a valid response; the receiver is "
                                "on while the host drives.",
                    .expected = "What the node answers is reported to the PC.",
                    .tags = {"must", "hazard"},
                    .catches = {{"echo_taken_as_response", "echo_told"}}},
                   an_echo_is_no_response,
                   {.receives_own_echo = true}});
  cases.push_back({{.id = "valve_bus/host/line/low_characters_are_no_response",
                    .purpose = "RH-14",
                    .requirement = "A line that is low as long as a response is none, although three octets "
                                   "of zeros have a right check: their stop bits are missing.",
                    .reference = valve_sources::own("the stop bit is looked at"),
                    .stimulus = "The line low for three characters, as three and as one break.",
                    .expected = "Nothing is reported; the node is polled again and served.",
                    .tags = {"must", "hazard"},
                    .catches = {{"stop_bits_not_looked_at", "low_line_told"}}},
                   three_low_characters_are_no_response});
  cases.push_back({{.id = "valve_bus/host/line/stuck_low_line_is_an_error",
                    .purpose = "RH-14",
                    .requirement = "A line that stays low ends a read in an error, and the host serves again "
                                   "when it is released.",
                    .reference = valve_sources::own("the PC is never left without an answer"),
                    .stimulus = "The line low after a request, longer than all attempts take.",
                    .expected = "An error, no data; then a read is served.",
                    .tags = {"must"},
                    .catches = {{"waits_for_silence", "waits_for_ever"}}},
                   a_low_line_is_an_error});
  cases.push_back({{.id = "valve_bus/host/line/stuck_high_line_is_a_time_out",
                    .purpose = "RH-15",
                    .requirement = "A line that stays high is no response.",
                    .reference = valve_sources::own("a character begins with a low start bit"),
                    .stimulus = "The line driven high after a request.",
                    .expected = "An error: no response, and no data; then a read is served.",
                    .tags = {"must"},
                    .catches = {{"silence_told_as_data", "high_line_told"}}},
                   a_high_line_is_a_time_out});
  cases.push_back(
      {{.id = "valve_bus/host/line/noise_between_polls_is_drained",
        .purpose = "RH-28",
        .requirement = "What is received between two polls is not reported and does not disturb the next "
                       "one.",
        .reference = valve_sources::own("what nobody asked for is drained"),
        .stimulus = "One to four octets between two reads, also a valid response.",
        .expected = "They are not reported, and the reads are served.",
        .tags = {"must"},
        .catches = {{"keeps_stray_octets", "response_not_told"}, {"stray_told_as_response", "noise_told"}}},
       noise_between_polls_is_drained});
  return cases;
}

}  // namespace fieldproof::conformance

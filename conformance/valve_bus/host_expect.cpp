#include "conformance/valve_bus/host_expect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "conformance/valve_bus/node_expect.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostError;
using valve_bus::HostResponse;
using valve_bus::Response;

std::string told_text(const std::optional<HostEvent>& told) {
  return told ? text_of(*told) : std::string("nothing");
}

const HostResponse* response_told(const std::optional<HostEvent>& told) {
  return told ? std::get_if<HostResponse>(&told->what) : nullptr;
}

auto data_sighting(const HostResponse& wanted, const std::optional<HostEvent>& told) {
  return [wanted, &told] {
    return Mismatch{{fmt::format("the PC gets the data of {:02X}{}: {:02X} {:02X}", wanted.id,
                                 wanted.is_old ? ", as old" : "", wanted.data0, wanted.data1)},
                    told_text(told)};
  };
}

auto duration_sighting(std::string_view expected, kernel::Duration actual, kernel::Time when) {
  return
      [expected, actual, when] { return Mismatch{{std::string(expected)}, kernel::describe(actual), when}; };
}

void expect_driver_around(HostBench& bench, CaseJudge& judge, const HostFrame& frame) {
  const valve_bus::Rules& rules = bench.rules();
  const kernel::Duration before = frame.start - frame.sent.driver_on;
  const kernel::Duration behind = frame.sent.driver_off - frame.end;
  judge.expect(before + kRounding >= bench.bits(rules.driver_on_bits), "driver_on_late",
               duration_sighting("the driver is on at least a bit before the start bit", before,
                                 frame.sent.driver_on));
  judge.expect(
      behind + kRounding >= kernel::Duration{}, "driver_released_early",
      duration_sighting("the driver is on until the last stop bit is over", behind, frame.sent.driver_off));
  judge.expect(behind <= bench.bits(rules.driver_off_bits) + kRounding, "driver_not_released",
               duration_sighting("the driver is off at most two bits after the last stop bit", behind,
                                 frame.sent.driver_off));
}

}  // namespace

double in_microseconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

std::string text_of_command(const Command& command) {
  return fmt::format("{:02X} {:02X} {:02X} {:02X}", command.id, command.command, command.data0,
                     command.data1);
}

void expect_form(HostBench& bench, CaseJudge& judge, const HostFrame& frame) {
  const auto octets = frame.sent.octets();
  const auto sighting = [&](std::string_view expected) {
    return [&, expected] {
      return Mismatch{{std::string(expected)}, fmt::format("{:02X}", fmt::join(octets, " ")), frame.start};
    };
  };
  judge.expect(octets.size() == valve_bus::kCommandOctets, "frame_length_wrong", sighting("five octets"));
  judge.expect(std::ranges::all_of(frame.sent.characters, &DrivenCharacter::is_good), "frame_garbled",
               sighting("characters with a right parity and a stop bit"));
  judge.expect(std::ranges::all_of(frame.sent.characters,
                                   [&](const DrivenCharacter& one) {
                                     return one.data == uart(bench.rules()).character_of(one.octet());
                                   }),
               "ninth_bit_wrong", "a ninth bit of 1 in each character", "one of 0");
  const unsigned check = octets[0] ^ octets[1] ^ octets[2] ^ octets[3];
  judge.expect(octets[4] == check, "check_wrong", sighting("the exclusive or of the four octets after them"));
  const kernel::Duration gap = frame.sent.longest_gap();
  judge.expect(gap <= valve_bus::longest_gap(bench.rules()) + kRounding, "gap_in_frame",
               duration_sighting("at most 1.5 characters between two octets", gap, frame.start));
  const iut::TimingUncertainty doubt = bench.doubt_of(frame);
  judge.expect(frame.silence == kernel::Duration::max() ||
                   frame.silence + doubt.later + kRounding >= bench.delimiter(),
               "no_delimiter",
               duration_sighting("at least 3.5 characters of silence in front of a frame", frame.silence,
                                 frame.start));
  expect_driver_around(bench, judge, frame);
}

HostFrame expect_request(HostBench& bench, CaseJudge& judge, const Command& command) {
  return expect_request(bench, judge, command, "no_request");
}

HostFrame expect_request(HostBench& bench, CaseJudge& judge, const Command& command,
                         std::string_view missing_reason) {
  const kernel::Time limit = bench.now() + bench.observation_timeout();
  std::string instead = "it sent nothing";
  for (;;) {
    auto frame = bench.next_frame(std::max(kernel::Duration{}, limit - bench.now()));
    judge.expect(frame.has_value(), missing_reason,
                 [&] { return Mismatch{{fmt::format("it sends {}", text_of_command(command))}, instead}; });
    expect_form(bench, judge, *frame);
    const Command seen = frame->command();
    if (seen != command && bench.is_refresh(seen)) {
      instead = fmt::format("it sent refreshes only, the last one {}", text_of_command(seen));
      continue;
    }
    judge.expect(seen == command, "request_wrong",
                 [&] { return Mismatch{{text_of_command(command)}, text_of_command(seen), frame->start}; });
    bench.note_write(seen);
    return *frame;
  }
}

HostFrame order_read(HostBench& bench, CaseJudge& judge, std::uint8_t id) {
  const auto [data0, data1] = bench.random_response();
  const Command read = bench.read_of(id, data0, data1);
  bench.order(read);
  return expect_request(bench, judge, read);
}

void expect_no_request(HostBench& bench, CaseJudge& judge, kernel::Duration duration, std::string_view reason,
                       std::string_view why_not) {
  const kernel::Time limit = bench.now() + duration;
  while (const auto frame = bench.next_frame(std::max(kernel::Duration{}, limit - bench.now()))) {
    const auto octets = frame->sent.octets();
    if (octets.size() == valve_bus::kCommandOctets && bench.is_refresh(frame->command())) continue;
    judge.fail(reason, {{fmt::format("nothing is sent: {}", why_not)},
                        fmt::format("{:02X}", fmt::join(octets, " ")),
                        frame->start});
  }
}

void expect_response(HostBench& bench, CaseJudge& judge, std::uint8_t id, const Response& response) {
  expect_response(bench, judge, id, response, bench.observation_timeout(), "response_not_told");
}

void expect_response(HostBench& bench, CaseJudge& judge, std::uint8_t id, const Response& response,
                     kernel::Duration within, std::string_view missing_reason) {
  const auto told = bench.next_told(within);
  const HostResponse* seen = response_told(told);
  const auto sighting = data_sighting({id, response.data0, response.data1}, told);
  judge.expect(seen != nullptr, missing_reason, sighting);
  judge.expect(seen->id == id && Response{seen->data0, seen->data1} == response, "response_wrong", sighting);
  judge.expect(!seen->is_old, "told_as_old", sighting);
}

void expect_error(HostBench& bench, CaseJudge& judge, const HostError& error, std::string_view told_data) {
  const auto told = bench.next_told(bench.observation_timeout());
  const auto sighting = [&] { return Mismatch{{text_of_error(error)}, told_text(told)}; };
  judge.expect(response_told(told) == nullptr, told_data, sighting);
  judge.expect(told.has_value(), "error_not_told", sighting);
  judge.expect(std::get<HostError>(told->what) == error, "error_wrong", sighting);
}

void expect_old(HostBench& bench, CaseJudge& judge, std::uint8_t id, const Response& response) {
  const auto told = bench.next_told(bench.observation_timeout());
  const HostResponse* seen = response_told(told);
  const auto sighting = data_sighting({id, response.data0, response.data1, true}, told);
  judge.expect(seen != nullptr, "old_data_not_told", sighting);
  judge.expect(seen->id == id && Response{seen->data0, seen->data1} == response, "old_data_wrong", sighting);
  judge.expect(seen->is_old, "old_data_told_as_new", sighting);
}

void expect_old_if_known(HostBench& bench, CaseJudge& judge, std::uint8_t id) {
  const auto told = bench.next_told(kernel::Duration{});
  if (!told) return;
  const HostResponse* seen = response_told(told);
  judge.expect(seen != nullptr && seen->id == id && seen->is_old, "old_data_told_as_new", [&] {
    return Mismatch{{fmt::format("what is known of {:02X}, as old", id)}, told_text(told), told->when};
  });
}

void expect_nothing_told(HostBench& bench, CaseJudge& judge, kernel::Duration within, std::string_view reason,
                         std::string_view why_not) {
  const auto told = bench.next_told(within);
  judge.expect(!told, reason, [&] {
    return Mismatch{{fmt::format("nothing is reported to the PC: {}", why_not)}, told_text(told), told->when};
  });
}

kernel::Duration latest_repetition(const HostBench& bench) {
  return bench.time_out() + bench.time_out_tolerance() + character_notice(bench.rules()) + bench.bits(3);
}

kernel::Duration earliest_repetition(const HostBench& bench) {
  return bench.time_out() - bench.time_out_tolerance();
}

HostFrame expect_retry(HostBench& bench, CaseJudge& judge, const HostFrame& first) {
  return expect_request(bench, judge, first.command(), "no_retry");
}

HostFrame expect_retry_in_time(HostBench& bench, CaseJudge& judge, const HostFrame& first,
                               kernel::Time since) {
  HostFrame again = expect_retry(bench, judge, first);
  const double least = in_microseconds(earliest_repetition(bench));
  const double measured = in_microseconds(again.start - since);
  judge.expect_between("time-out", "us", measured, least, in_microseconds(latest_repetition(bench)),
                       measured < least ? "time_out_too_short" : "time_out_too_long");
  return again;
}

Response expect_read_served(HostBench& bench, CaseJudge& judge, std::uint8_t id) {
  order_read(bench, judge, id);
  const Response response = bench.random_response();
  bench.answer(response);
  expect_response(bench, judge, id, response);
  return response;
}

void expect_host_recovers(HostBench& bench, CaseJudge& judge) {
  constexpr std::string_view kReason = "does_not_recover";
  bench.wait(bench.observation_timeout());
  bench.clear_observations();
  const Command read = bench.read_of(bench.random_id());
  bench.order(read);
  expect_request(bench, judge, read, kReason);
  const Response response = bench.random_response();
  bench.answer(response);
  const auto told = bench.next_told(bench.observation_timeout());
  const HostResponse wanted{read.id, response.data0, response.data1};
  judge.expect(response_told(told) != nullptr && *response_told(told) == wanted, kReason,
               [&] { return Mismatch{{"a read and its response are served"}, told_text(told)}; });
  bench.clear_observations();
}

}  // namespace fieldproof::conformance

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "conformance/judging.hpp"
#include "conformance/valve_bus/host_bench.hpp"

// What the cases for a host module require again and again, each with its reason codes.
namespace fieldproof::conformance {

double in_microseconds(kernel::Duration duration);
std::string text_of_command(const valve_bus::Command& command);

// The form of one frame: `frame_length_wrong`, `frame_garbled`, `ninth_bit_wrong`, `check_wrong`,
// `gap_in_frame`, `no_delimiter`, `driver_on_late`, `driver_released_early`, `driver_not_released`.
void expect_form(HostBench& bench, CaseJudge& judge, const HostFrame& frame);

// The IUT sends this command within its patience, in the right form; refreshes of what it has written before
// may come in front of it: `no_request`, `request_wrong`, and the reasons of expect_form.
HostFrame expect_request(HostBench& bench, CaseJudge& judge, const valve_bus::Command& command);
// The same in a case that is about when or how often it comes.
HostFrame expect_request(HostBench& bench, CaseJudge& judge, const valve_bus::Command& command,
                         std::string_view missing_reason);
// The PC orders a read with random data, and the IUT sends it.
HostFrame order_read(HostBench& bench, CaseJudge& judge, std::uint8_t id);
// The IUT sends nothing but refreshes for so long.
void expect_no_request(HostBench& bench, CaseJudge& judge, kernel::Duration duration, std::string_view reason,
                       std::string_view why_not);

// The PC is told this, fresh, as the next thing: `response_not_told`, `response_wrong`, `told_as_old`.
void expect_response(HostBench& bench, CaseJudge& judge, std::uint8_t id,
                     const valve_bus::Response& response);
// The same within a time, in a case that is about what is a response.
void expect_response(HostBench& bench, CaseJudge& judge, std::uint8_t id, const valve_bus::Response& response,
                     kernel::Duration within, std::string_view missing_reason);
// An error as the next thing: `error_not_told`, `error_wrong`; data instead of it have the reason
// `told_data`.
void expect_error(HostBench& bench, CaseJudge& judge, const valve_bus::HostError& error,
                  std::string_view told_data = "error_not_told");
// What was known, as old: `old_data_not_told`, `old_data_wrong`, `old_data_told_as_new`.
void expect_old(HostBench& bench, CaseJudge& judge, std::uint8_t id, const valve_bus::Response& response);
// The same where it may not be known: what is told now of this node is old.
void expect_old_if_known(HostBench& bench, CaseJudge& judge, std::uint8_t id);
// Nothing within this time.
void expect_nothing_told(HostBench& bench, CaseJudge& judge, kernel::Duration within, std::string_view reason,
                         std::string_view why_not);

// After the end of an attempt, the next one begins by then: a host knows of a start bit when its character is
// over, and then switches its driver on.
kernel::Duration latest_repetition(const HostBench& bench);
// And not before.
kernel::Duration earliest_repetition(const HostBench& bench);
// The IUT polls again after an attempt that has failed: `no_retry`.
HostFrame expect_retry(HostBench& bench, CaseJudge& judge, const HostFrame& first);
// The same in its time after the attempt before it ended: `time_out_too_short`, `time_out_too_long`.
HostFrame expect_retry_in_time(HostBench& bench, CaseJudge& judge, const HostFrame& first,
                               kernel::Time since);
// A read of this node, with a random response, is served.
valve_bus::Response expect_read_served(HostBench& bench, CaseJudge& judge, std::uint8_t id);
// A read is served, whatever came before: `does_not_recover`. Forgets what was seen.
void expect_host_recovers(HostBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

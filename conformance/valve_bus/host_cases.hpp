#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/valve_bus/applicability.hpp"
#include "conformance/valve_bus/host_bench.hpp"
#include "conformance/valve_bus/sources.hpp"

// The test cases for a host module of the valve bus, RH-01 to RH-40 of the catalogue of test purposes, and a
// canary.
namespace fieldproof::conformance {

using HostCase = BenchCase<HostBench, HostNeeds>;

const std::vector<HostCase>& host_cases();

// The chapters, each in its own file.
std::vector<HostCase> host_request_cases();
std::vector<HostCase> host_response_cases();
std::vector<HostCase> host_retry_cases();
std::vector<HostCase> host_fifo_cases();
std::vector<HostCase> host_timing_cases();
std::vector<HostCase> host_line_cases();
std::vector<HostCase> host_cycle_cases();
std::vector<HostCase> host_memory_cases();
std::vector<HostCase> host_refresh_cases();
std::vector<HostCase> host_dip_cases();
std::vector<HostCase> host_immunity_cases();
std::vector<HostCase> host_supply_cases();
std::vector<HostCase> host_corner_cases();
std::vector<HostCase> host_attempt_cases();
std::vector<HostCase> host_kept_write_cases();
std::vector<HostCase> host_meanwhile_cases();
std::vector<HostCase> host_endurance_cases();

// Applies only to a host whose switches the bench can set.
Applicability for_settable_dip();
// So many requests take less than the time after which a write is sent again.
Applicability for_quick_frames(unsigned requests);
// The bench can switch its supply.
Applicability for_switched_power();
// Applies only to a host that sends a write and does not look after it.
Applicability for_plain_writes();

}  // namespace fieldproof::conformance

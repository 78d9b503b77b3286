#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/valve_bus/host_bench.hpp"
#include "conformance/valve_bus/sources.hpp"

// The test cases for a host module of the valve bus, RH-01 to RH-36 of the catalogue of test purposes, and a
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
std::vector<HostCase> host_dip_cases();
std::vector<HostCase> host_immunity_cases();

// Applies only to a host of which the PICS says so, or says the contrary.
std::function<std::optional<std::string>(const judge::Pics&)> for_host_with(std::string item,
                                                                            std::string sentence);
std::function<std::optional<std::string>(const judge::Pics&)> for_host_without(std::string item,
                                                                               std::string sentence);

// Applies only to a host that sends a write and does not look after it.
std::function<std::optional<std::string>(const judge::Pics&)> for_plain_writes();

}  // namespace fieldproof::conformance

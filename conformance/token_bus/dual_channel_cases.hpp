#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/token_bus/dual_channel_bench.hpp"
#include "conformance/token_bus/station_sources.hpp"

// The test cases for a dual channel manager, PST-16 and PST-17 of the catalogue of test purposes and what
// follows from the rules of its page. All of them rest on this project's choice.
namespace fieldproof::conformance {

using ManagerCase = BenchCase<ManagerBench, ManagerNeeds>;

const std::vector<ManagerCase>& manager_cases();

// The chapters, each in its own file.
std::vector<ManagerCase> manager_request_cases();
std::vector<ManagerCase> manager_management_cases();
std::vector<ManagerCase> manager_selection_cases();
std::vector<ManagerCase> manager_inside_cases();
std::vector<ManagerCase> manager_fault_cases();
std::vector<ManagerCase> manager_limit_cases();
std::vector<ManagerCase> manager_verdict_cases();
std::vector<ManagerCase> manager_symbol_cases();
std::vector<ManagerCase> manager_series_cases();
std::vector<ManagerCase> manager_ring_cases();

}  // namespace fieldproof::conformance

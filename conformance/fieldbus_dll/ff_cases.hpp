#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/fieldbus_dll/link_sources.hpp"

// The test cases for the profile FF-P, FF-01 to FF-49 of the catalogue of test purposes, of both roles:
// `ff_device`, a basic device, and `ff_las`, a link master.
namespace fieldproof::conformance {

using FfCase = BenchCase<FfBench, FfNeeds>;

const std::vector<FfCase>& ff_cases();

// How each DLPDU of the IUT stands on the line, whatever the case was about.
void judge_end(FfBench& bench, CaseJudge& judge);

// The chapters, each in its own file.
std::vector<FfCase> ff_probe_cases();
std::vector<FfCase> ff_token_cases();
std::vector<FfCase> ff_publisher_cases();
std::vector<FfCase> ff_frame_cases();
std::vector<FfCase> ff_link_settings_cases();
std::vector<FfCase> ff_link_times_cases();
std::vector<FfCase> ff_endings_cases();
std::vector<FfCase> ff_request_cases();
std::vector<FfCase> ff_reception_cases();
std::vector<FfCase> ff_transmission_cases();
std::vector<FfCase> ff_schedule_cases();
std::vector<FfCase> ff_circulation_cases();
std::vector<FfCase> ff_rotation_cases();
std::vector<FfCase> ff_live_list_cases();
std::vector<FfCase> ff_time_cases();
std::vector<FfCase> ff_claim_cases();
std::vector<FfCase> ff_immunity_cases();

}  // namespace fieldproof::conformance

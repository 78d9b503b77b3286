#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/token_bus/station_bench.hpp"
#include "conformance/token_bus/station_sources.hpp"

// The test cases for a station of the token bus, TB-01 to TB-35 of the catalogue of test purposes.
namespace fieldproof::conformance {

using TokenCase = BenchCase<TokenBench, TokenNeeds>;

const std::vector<TokenCase>& token_cases();

// How each frame of the IUT stands on the line, whatever the case was about.
void judge_end(TokenBench& bench, CaseJudge& judge);

// What leads to each event that was reported: `reported_unfounded`.
void judge_events(TokenBench& bench, CaseJudge& judge);

// The chapters, each in its own file.
std::vector<TokenCase> token_initialisation_cases();
std::vector<TokenCase> token_joining_cases();
std::vector<TokenCase> token_passing_cases();
std::vector<TokenCase> token_failure_cases();
std::vector<TokenCase> token_holding_cases();
std::vector<TokenCase> token_reception_cases();
std::vector<TokenCase> token_line_cases();
std::vector<TokenCase> token_event_cases();
std::vector<TokenCase> token_anew_cases();
std::vector<TokenCase> token_user_cases();
std::vector<TokenCase> token_supply_cases();
std::vector<TokenCase> token_address_cases();
std::vector<TokenCase> token_request_cases();
std::vector<TokenCase> token_dropping_cases();
std::vector<TokenCase> token_class_cases();
std::vector<TokenCase> token_each_cases();
std::vector<TokenCase> token_alone_cases();
std::vector<TokenCase> token_membership_cases();
std::vector<TokenCase> token_kind_cases();
std::vector<TokenCase> token_many_cases();
std::vector<TokenCase> token_settings_cases();
std::vector<TokenCase> token_rotation_settings_cases();
std::vector<TokenCase> token_long_address_cases();
std::vector<TokenCase> token_immunity_cases();

}  // namespace fieldproof::conformance

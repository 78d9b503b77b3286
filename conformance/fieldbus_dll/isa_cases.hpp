#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_sources.hpp"

// The test cases for the profile ISA-D, ISA-01 to ISA-41 of the catalogue of test purposes, of both roles:
// `isa_dle`, a data link entity, and `isa_las`, a link master.
namespace fieldproof::conformance {

using IsaCase = BenchCase<IsaBench, IsaNeeds>;

const std::vector<IsaCase>& isa_cases();

// How each DLPDU of the IUT stands on the line, whatever the case was about.
void judge_end(IsaBench& bench, CaseJudge& judge);

// The chapters, each in its own file.
std::vector<IsaCase> isa_single_token_cases();
std::vector<IsaCase> isa_sequence_cases();
std::vector<IsaCase> isa_duration_cases();
std::vector<IsaCase> isa_rejection_cases();
std::vector<IsaCase> isa_compelling_cases();
std::vector<IsaCase> isa_compelled_cases();
std::vector<IsaCase> isa_data_cases();
std::vector<IsaCase> isa_line_cases();
std::vector<IsaCase> isa_timers_cases();
std::vector<IsaCase> isa_request_cases();
std::vector<IsaCase> isa_link_settings_cases();
std::vector<IsaCase> isa_reception_cases();
std::vector<IsaCase> isa_schedule_cases();
std::vector<IsaCase> isa_supervision_cases();
std::vector<IsaCase> isa_transfer_cases();
std::vector<IsaCase> isa_immunity_cases();

}  // namespace fieldproof::conformance

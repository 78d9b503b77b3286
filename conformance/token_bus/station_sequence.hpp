#pragma once

#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"
#include "conformance/token_bus/station_bench.hpp"

// Sequences for a station of the token bus: what can be drawn, and how it is done and judged on the bench of
// the cases.
namespace fieldproof::conformance {

// "token_bus/station/check/follows_the_reference".
const SequenceRole& token_station_sequence_role();

// Does the commands in order; after each, what the station has driven and reported must be what a reference
// has on its twin of the line. The tester takes part as its successor does. What stations choose by chance
// ends the sequence without a finding.
void run_token_station_sequence(const Sequence& sequence, TokenBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

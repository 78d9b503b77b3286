#pragma once

#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"
#include "conformance/token_bus/dual_channel_bench.hpp"

// Sequences for a dual channel manager: what can be drawn, and how it is done and judged on the bench of the
// cases.
namespace fieldproof::conformance {

// "token_bus/channel_manager/check/follows_the_reference".
const SequenceRole& channel_manager_sequence_role();

// Does the commands in order; after each, all sides and all reports must be those of the reference.
void run_channel_manager_sequence(const Sequence& sequence, ManagerBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

#pragma once

#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"
#include "conformance/valve_bus/host_bench.hpp"

// Sequences for a host module: what its PC orders and what its nodes answer, in any order, with faults in the
// answers.
namespace fieldproof::conformance {

// "valve_bus/host/check/follows_the_reference".
const SequenceRole& host_sequence_role();

// Does the commands on the bench and on a second one with the reference, and compares what both hosts send
// and report. A host chooses when it sends, so the n-th request of the one is answered like the n-th of the
// other. What receivers may differ about ends the sequence without a finding.
void run_host_sequence(const Sequence& sequence, HostBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

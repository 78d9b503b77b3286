#pragma once

#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"
#include "conformance/valve_bus/node_bench.hpp"

// Sequences for a local node: what can be drawn, and how it is done and judged on the bench of the cases.
namespace fieldproof::conformance {

// "valve_bus/node/check/follows_the_model".
const SequenceRole& node_sequence_role();

// Does the commands in order and judges, whenever the line has been silent for a delimiter, what the node has
// done by then against the model. The tester is a host that waits for the answer that is due. What receivers
// may differ about ends the sequence without a finding.
void run_node_sequence(const Sequence& sequence, NodeBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

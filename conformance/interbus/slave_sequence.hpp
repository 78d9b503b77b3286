#pragma once

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for an INTERBUS slave on the bench of the cases, after both interfaces of which is a station:
// what comes at its ports, at its terminals and to its supply, beside two references (slave_twins.hpp).
namespace fieldproof::conformance {

// "interbus/slave/check/follows_the_model".
const SequenceRole& slave_sequence_role();

// Of a bench for sequences.
SlaveNeeds slave_sequence_needs();

void run_slave_sequence(const Sequence& sequence, SlaveBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

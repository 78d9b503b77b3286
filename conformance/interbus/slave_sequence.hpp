#pragma once

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for an INTERBUS slave: cycles, with flipped levels and lost telegrams, on the bench of the cases.
//
// The model: outputs hold, or show the words of a cycle that arrived whole with a check that fits and a clean
// status word, and nothing else; a cycle that nothing disturbs is taken over and answered as `SlaveModel`
// says. After a fault that left the telegrams of a cycle as they are, that holds for the very next cycle;
// after any other one for the cycle after as many as the published recovery takes.
namespace fieldproof::conformance {

// "interbus/slave/check/follows_the_model".
const SequenceRole& slave_sequence_role();

void run_slave_sequence(const Sequence& sequence, SlaveBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

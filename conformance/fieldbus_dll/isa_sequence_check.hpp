#pragma once

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for a data link entity of the profile ISA-D: what can be drawn, and how it is done and judged on
// the bench of the cases. (The cases of ES, the sequence token, lie in isa_sequence.cpp.)
namespace fieldproof::conformance {

// "fieldbus_dll/isa_dle/check/follows_the_model".
const SequenceRole& isa_dle_sequence_role();

// Does the commands in order and judges each DLPDU of the station against the model. The tester either waits
// until the station has nothing to say any more, or goes on before V(MID) is over, when it may not have
// begun.
void run_isa_dle_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

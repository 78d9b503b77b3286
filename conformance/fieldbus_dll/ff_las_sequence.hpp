#pragma once

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for a link active scheduler of the profile FF-P: what others on its link do can be drawn, and all
// that it says is judged on the bench of the cases.
namespace fieldproof::conformance {

// "fieldbus_dll/ff_las/check/follows_the_model".
const SequenceRole& ff_las_sequence_role();

// The link of the sequences: two live nodes, three items, few addresses that are polled.
FfNeeds ff_las_sequence_needs();

// Does the commands in order and judges each DLPDU of the scheduler against the model. Where no command says
// otherwise nodes return each token at once, answer each CD, and leave probes unanswered. After the last
// command that goes on for three macrocycles.
void run_ff_las_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

#pragma once

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for a link master of the profile ISA-D that is the scheduler: what holders do with their tokens,
// faults and other schedulers, held against `IsaLasAcceptor`.
namespace fieldproof::conformance {

// "fieldbus_dll/isa_las/check/follows_the_rules".
const SequenceRole& isa_las_sequence_role();

IsaNeeds isa_las_sequence_needs();

void run_isa_las_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

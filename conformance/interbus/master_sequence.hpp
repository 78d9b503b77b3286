#pragma once

#include "conformance/interbus/master_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for an INTERBUS master: what comes back of its cycles, what its application orders, and rings
// that change. Cycle by cycle a master is compared with the reference on a bench of its own, whose ring
// answers alike; how it recognises a ring is its own, what it finds is compared.
namespace fieldproof::conformance {

// "interbus/master/check/follows_the_reference".
const SequenceRole& master_sequence_role();

// `change_rules`: what every power-up has otherwise; null: nothing.
void run_master_sequence(const Sequence& sequence, MasterBench& bench, CaseJudge& judge,
                         void (*change_rules)(interbus::Rules&));
inline void run_master_sequence(const Sequence& sequence, MasterBench& bench, CaseJudge& judge) {
  run_master_sequence(sequence, bench, judge, nullptr);
}

}  // namespace fieldproof::conformance

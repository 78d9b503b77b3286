#pragma once

#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"
#include "conformance/token_bus/translator_bench.hpp"

// Sequences for a translator: what can be drawn, and how it is done and judged on the bench of the cases.
namespace fieldproof::conformance {

// "token_bus/translator/check/follows_the_reference".
const SequenceRole& translator_sequence_role();

// Does the commands in order; after each, both sides must be those of the reference.
void run_translator_sequence(const Sequence& sequence, TranslatorBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

#pragma once

#include "conformance/fieldbus_dll/ff_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// Sequences for a basic device of the profile FF-P: what can be drawn, and how it is done and judged on the
// bench of the cases.
namespace fieldproof::conformance {

// "fieldbus_dll/ff_device/check/follows_the_model".
const SequenceRole& ff_device_sequence_role();

// The device of the sequences publishes and hears short and long addresses.
FfNeeds ff_device_sequence_needs();

// Does the commands in order and judges each DLPDU of the device against the model. The tester either waits
// until the device has nothing to say any more, or goes on before V(MID) is over, when it may not have begun:
// nowhere does it speak into an answer.
void run_ff_device_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

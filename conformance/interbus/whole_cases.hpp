#pragma once

#include "conformance/interbus/master_cases.hpp"
#include "conformance/interbus/master_sequence.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_sequence.hpp"
#include "conformance/sequence_families.hpp"

// For tests that run a case as a catalogue does, whether it has a procedure or families of sequences.
namespace fieldproof::conformance {

inline judge::CaseResult run_whole(const SlaveCase& one, const SlaveSetting& setting) {
  const auto run_case = [&](const SlaveCase& asked) { return run_slave_case(asked, setting); };
  if (!one.families) return run_case(one);
  return run_families(
      one, {.vocabulary = slave_sequence_role().vocabulary, .seed = setting.seed, .volume = setting.volume},
      run_case);
}

inline judge::CaseResult run_whole(const MasterCase& one, const MasterSetting& setting) {
  const auto run_case = [&](const MasterCase& asked) { return run_on_bench(asked, setting); };
  if (!one.families) return run_case(one);
  return run_families(
      one, {.vocabulary = master_sequence_role().vocabulary, .seed = setting.seed, .volume = setting.volume},
      run_case);
}

}  // namespace fieldproof::conformance

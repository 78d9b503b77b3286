#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/interbus/master_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/test_case.hpp"

// The test cases for an INTERBUS master, IM-01 to IM-40 of the catalogue of test purposes, and a canary.
namespace fieldproof::conformance {

using MasterCase = BenchCase<MasterBench, NoNeeds>;

const std::vector<MasterCase>& master_cases();

// The chapters, each in its own file.
std::vector<MasterCase> master_identification_cases();
std::vector<MasterCase> master_data_cycle_cases();
std::vector<MasterCase> master_rejection_cases();
std::vector<MasterCase> master_supervision_cases();
std::vector<MasterCase> master_ring_change_cases();
std::vector<MasterCase> master_timing_cases();
std::vector<MasterCase> master_application_cases();
std::vector<MasterCase> master_skew_cases();
std::vector<MasterCase> master_immunity_cases();
std::vector<MasterCase> master_compared_cases();
std::vector<MasterCase> master_cases_at_length();
std::vector<MasterCase> master_id_cycle_cases();
std::vector<MasterCase> master_cases_of_telegrams_at_ends();
std::vector<MasterCase> master_cases_of_rings_at_ends();
std::vector<MasterCase> master_cases_of_starts();

}  // namespace fieldproof::conformance

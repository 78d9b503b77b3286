#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/valve_bus/applicability.hpp"
#include "conformance/valve_bus/node_bench.hpp"
#include "conformance/valve_bus/sources.hpp"

// The test cases for a local node of the valve bus, RN-01 to RN-44 of the catalogue of test purposes, and a
// canary.
namespace fieldproof::conformance {

using NodeCase = BenchCase<NodeBench, NodeNeeds>;

const std::vector<NodeCase>& node_cases();

// The instants of a node on a real line besides: a case of which most are in doubt has shown nothing.
void judge_end(NodeBench& bench, CaseJudge& judge);

// The chapters, each in its own file.
std::vector<NodeCase> node_write_cases();
std::vector<NodeCase> node_one_board_cases();
std::vector<NodeCase> node_read_cases();
std::vector<NodeCase> node_address_cases();
std::vector<NodeCase> node_check_cases();
std::vector<NodeCase> node_framing_cases();
std::vector<NodeCase> node_timing_cases();
std::vector<NodeCase> node_line_cases();
std::vector<NodeCase> node_power_cases();
std::vector<NodeCase> node_loss_cases();
std::vector<NodeCase> node_meanwhile_cases();
std::vector<NodeCase> node_settings_cases();
std::vector<NodeCase> node_immunity_cases();
std::vector<NodeCase> node_resonance_cases();

}  // namespace fieldproof::conformance

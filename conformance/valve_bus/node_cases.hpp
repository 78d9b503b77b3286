#pragma once

#include <functional>
#include <string>
#include <vector>

#include "conformance/judging.hpp"
#include "conformance/test_case.hpp"
#include "conformance/valve_bus/node_bench.hpp"

// The test cases for a local node of the valve bus, RN-01 to RN-40 of the catalogue of test purposes, and a
// canary.
namespace fieldproof::conformance {

struct NodeCase {
  TestCase test_case;
  std::function<void(NodeBench&, CaseJudge&)> procedure;
  NodeNeeds needs{};
};

const std::vector<NodeCase>& node_cases();

// One run on a bench of its own. The result has verdict, findings, measurements, seed, fingerprint and
// virtual time; wall time is the caller's to fill.
judge::CaseResult run_node_case(const NodeCase& node_case, const NodeSetting& setting);

// The chapters, each in its own file.
std::vector<NodeCase> node_write_cases();
std::vector<NodeCase> node_read_cases();
std::vector<NodeCase> node_address_cases();
std::vector<NodeCase> node_check_cases();
std::vector<NodeCase> node_framing_cases();
std::vector<NodeCase> node_timing_cases();
std::vector<NodeCase> node_line_cases();
std::vector<NodeCase> node_power_cases();
std::vector<NodeCase> node_immunity_cases();

namespace valve_sources {
judge::Reference paper(std::string place);       // the paper that describes the bus
judge::Reference calculated(std::string place);  // from its block check
judge::Reference own(std::string place);         // where the paper is silent
judge::Reference derived(std::string place);     // follows from the paper
}  // namespace valve_sources

// Applies only to a node of which the PICS says so.
std::function<std::optional<std::string>(const judge::Pics&)> for_node_with(std::string item,
                                                                            std::string sentence);
// Applies only where the node talks in this character format, or has not said in which.
std::function<std::optional<std::string>(const judge::Pics&)> for_characters(std::string profile);

}  // namespace fieldproof::conformance

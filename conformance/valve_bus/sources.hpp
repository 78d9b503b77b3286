#pragma once

#include <string>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/judge/finding.hpp"

// What the cases of the valve bus rest on. The paper says little more than the frames; silences, times and
// character formats are this project's own choice, and almost every case judges some of them on its way.
namespace fieldproof::conformance {

namespace valve_sources {
judge::Reference paper(std::string place);       // the paper that describes the bus
judge::Reference calculated(std::string place);  // from its block check
judge::Reference own(std::string place);         // where the paper is silent
judge::Reference derived(std::string place);     // follows from the paper
}  // namespace valve_sources

// The reasons of node_expect and host_expect that rest on less than the paper, whatever a case is about.
const std::vector<PartialSource>& node_details();
const std::vector<PartialSource>& host_details();

}  // namespace fieldproof::conformance

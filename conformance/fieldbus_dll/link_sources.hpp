#pragma once

#include <string>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/judge/finding.hpp"

// What the cases of the data link rest on. Of the ISA draft the paper says who may speak when; addresses,
// encodings and the values of all timers are this project's own choice. Of Foundation Fieldbus names,
// functions and link parameters are published; octets are from memory.
namespace fieldproof::conformance {

namespace link_sources {
judge::Reference isa_paper(std::string place);   // the paper on the ISA draft
judge::Reference ff_paper(std::string place);    // the paper on the delay of urgent data
judge::Reference line(std::string place);        // IEC 61158-2, as an open implementation has it
judge::Reference vendors(std::string place);     // tables of link parameters
judge::Reference memory(std::string place);      // IEC 61158, from memory
judge::Reference calculated(std::string place);  // from the rules themselves
judge::Reference own(std::string place);         // where all of these are silent
}  // namespace link_sources

// The reasons that rest on less than the case that finds them.
const std::vector<PartialSource>& isa_details();
const std::vector<PartialSource>& ff_details();

}  // namespace fieldproof::conformance

#pragma once

#include <string>
#include <vector>

#include "conformance/test_case.hpp"

// What the cases of the token bus rest on. The paper joins a standard that it does not repeat: states, frames
// and timers are IEEE 802.4 as it is known, as the manual of a controller and a management information base
// print it, or as it is remembered.
namespace fieldproof::conformance {

namespace token_sources {
judge::Reference paper(std::string place);
judge::Reference standard(std::string place);    // IEEE 802.4, sure
judge::Reference controller(std::string place);  // the manual of the MC68824
judge::Reference mib(std::string place);         // RFC 1230
judge::Reference memory(std::string place);      // IEEE 802.4, from memory
judge::Reference derived(std::string place);     // follows from the paper and IEEE 802.3
judge::Reference own(std::string place);
}  // namespace token_sources

// The reasons that rest on less than the case that finds them.
const std::vector<PartialSource>& token_details();

}  // namespace fieldproof::conformance

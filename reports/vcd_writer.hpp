// The recording of a case as a value change dump (IEEE 1364, four-state VCD) for wave viewers.
//
// A channel that something was driven on is a wire of its levels, idle outside of transmissions; where faults
// changed something on the way, the wire NAME/received beside it shows what arrived. Faults of a channel are
// a counter, NAME/faults; each kind of observation is a vector of 64 bit with its last value. The timescale
// is one picosecond; where several things happen at one instant the last one stands. Equal recordings give
// equal octets.
//
// Limits: a name has only letters, digits and _@/#- ; an instant before zero is shown at zero.
#pragma once

#include <string>
#include <string_view>

#include "harness/trace/recording.hpp"

namespace fieldproof::reports {

// `title` says what the dump is of.
std::string vcd(const trace::Recording& recording, std::string_view application, std::string_view title);

}  // namespace fieldproof::reports

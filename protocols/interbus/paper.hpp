#pragma once

#include "protocols/interbus/network.hpp"

// The network that Park 2004, "The Study on the Cycling Time for Interbus", measured. What it publishes of it
// stands with what is reproduced, in papers/.
namespace fieldproof::interbus {

// RFC 430 ETH with one station of IB IL 24 DI 16 and IB IL 24 DO 16, under formula f4: examples/paper.json.
NetworkDescription paper_network();
// The same under the formula as printed, with 8 + n telegrams: examples/paper_printed_reading.json.
NetworkDescription paper_network_as_printed();

inline constexpr kernel::Duration kPaperBestCycle = 814 * kernel::kMicrosecond;  // set, with the best result

}  // namespace fieldproof::interbus

#pragma once

#include <array>
#include <cstdint>

#include "protocols/interbus/network.hpp"

// What Park 2004, "The Study on the Cycling Time for Interbus", publishes in numbers, and the network that it
// measured. Its traces of input and output, without and with bursts, are pictures without a number.
namespace fieldproof::interbus {

// RFC 430 ETH with one station of IB IL 24 DI 16 and IB IL 24 DO 16, under formula f4: examples/paper.json.
NetworkDescription paper_network();
// The same under the formula as printed, with 8 + n telegrams: examples/paper_printed_reading.json.
NetworkDescription paper_network_as_printed();

inline constexpr kernel::Duration kPaperCalculatedCycle = 755 * kernel::kMicrosecond;  // "about 0.755 ms"
inline constexpr kernel::Duration kPaperBestCycle = 814 * kernel::kMicrosecond;        // set, best result
inline constexpr kernel::Duration kPaperSetCycle = 860 * kernel::kMicrosecond;         // set first
inline constexpr double kPaperHighestFrequencyHz = 614;
inline constexpr std::array<std::int64_t, 3> kPaperSignalsHz = {50, 150, 200};

}  // namespace fieldproof::interbus

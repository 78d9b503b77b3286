#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/sequence.hpp"

// What sequences of every profile of the data link have in common: the silence after a command, and how it
// is put on the line with its faults. A unit is an octet of a frame, its delimiters included; the preamble is
// none, because of a frame with a part of it any receiver may hear the rest.
namespace fieldproof::conformance {

inline constexpr unsigned kHalfBitsOfAnOctet = 16;
// What a flip can hit: a half bit, which breaks the code, and after those a whole bit, which only the frame
// check sees. Of whole bits two are flipped at most: the check sees any three of a frame.
inline constexpr unsigned kFlipsOfAnOctet = kHalfBitsOfAnOctet + 8;

// The tester waits until the station has nothing more to say. Else it goes on after so many octet durations,
// less than V(MID), before the station may begin.
inline constexpr std::int64_t kLinkSettles = 100;

// Who is on the link and what a DLPDU is called is the tester's, too.
inline constexpr std::array<std::string_view, 9> kFixedOfLink{
    "code_*", "first_node", "last_node",  "first_address",      "last_address",
    "node",   "address",    "schedule_*", "begins_as_scheduler"};

// Throws kernel::Error(configuration) where a station may not begin within the time in which it has to.
void expect_time_for_answers(const fieldbus_dll::LinkRules& link);

// After what the command sends, to the next.
SequenceNumber link_silence();

// Sends the octets in a frame, their check after them. False: with faults, after which it is no frame to
// anybody.
bool send_link_command(LinkBench& bench, const Octets& octets, const SequenceCommand& command);

}  // namespace fieldproof::conformance

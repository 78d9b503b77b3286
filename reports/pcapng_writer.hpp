// The recording of a case as a pcapng capture: one interface for each channel, one packet for each
// transmission. Programs that read pcapng open it; reports/wireshark/fieldproof.lua takes the packets apart.
//
// Contract: a transmission is a packet of direction "outbound" as it was driven. Where a fault changed it on
// the way, a packet of direction "inbound" follows for each waveform that its receiver got instead; what was
// not changed arrived as it was driven. Both carry a comment that says what happened. The flag "CRC error" is
// set where the dissector finds a frame check wrong. Packets stand in order of time. Equal recordings give
// equal octets.
//
// Limits: stamps have nanoseconds, because readers overflow on picoseconds (the payload has these); instants
// before zero are stamped zero. Levels beyond the millionth of a transmission are left out of its packet.
//
// A packet's payload (link type 147, USER0), numbers with the most significant octet first:
//
//   octet  0     2: version of this layout
//   octet  1     protocol, trace::Dissector::capture_number
//   octet  2     flags: 1 arrived (else driven), 2 changed by a fault, 4 lost, 8 a mask follows the levels
//   octet  3     variant of the protocol, trace::Dissector::capture_variant
//   octets 4     start in picoseconds since the start of the run, signed, 64 bit
//   octets 12    levels per second, 64 bit
//   octets 20    bits per second, 0 when unknown, 64 bit
//   octets 28    number of levels, 32 bit
//   octets 32    number of the channel, 32 bit: a dissector cannot always see the interface of a packet
//   octets 36    the levels, the first in the most significant bit, the last octet filled with idle (1)
//   then         the mask: as many bits, 1 where the level is not the one that was sent, filled with 0
#pragma once

#include <string>
#include <string_view>

#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

namespace fieldproof::reports {

// `application` is the program's name and version, `title` what the capture is of; both become text of the
// section.
std::string pcapng(const trace::Recording& recording, const trace::Dissector& dissector,
                   std::string_view application, std::string_view title);

}  // namespace fieldproof::reports

#pragma once

#include <cstdint>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/sequence.hpp"

// How a frame can look on its line: with the check of another kind of line, with a long preamble, by another
// clock, with edges that are off; and what else can be in its transmission.
namespace fieldproof::conformance {

// Without complement, beginning with 0, both, reflected, CCITT, CCITT with complement, with its octets
// exchanged.
inline constexpr unsigned kOtherChecks = 7;
line::Levels half_bits_with_other_check(const Octets& octets, unsigned kind);

// Each edge moved by up to a tenth of a bit, in hundredths of a half bit.
line::Waveform jittered(LinkBench& bench, const line::Levels& half_bits);
// At so many per mille of the bit rate.
line::Waveform clocked(const LinkBench& bench, const line::Levels& half_bits, std::int64_t per_mille);

// Octets with their check, as this link has frames.
line::Levels frame_of_link(const LinkBench& bench, const Octets& octets);
// The frame, in front of which it ends after an octet and so many bits, by its own start delimiter.
line::Levels begun_within_an_octet(const LinkBench& bench, const Octets& octets, std::size_t bits);
// In front of a frame so many half bits that are no preamble: of one level, alternating from the other one
// on, or two and two; or a frame that so many half bits of one level, and two more, cut off.
inline constexpr std::size_t kKindsInFront = 4;
inline constexpr std::size_t kMostInFront = 16;
line::Levels in_front_of(const line::Levels& frame, std::size_t kind, std::size_t half_bits);
// So many octets of symbols that are data, and no frame, behind the frame.
line::Levels with_tail(const LinkBench& bench, const Octets& octets, std::size_t tail);
// At 4000000 levels/s, with a pulse of one, half-way between an edge and the middle of a half bit.
line::Waveform with_pulse(LinkBench& bench, const Octets& octets);

// ---- words of sequences ----

// How a frame comes to its receiver: up to 8, with so many octets of preamble; then by a clock that is fast,
// by one that is slow, and with edges that are off.
inline constexpr std::int64_t kMostPreamble = 8;
inline constexpr std::int64_t kClockIsFast = 9;
inline constexpr std::int64_t kClockIsSlow = 10;
inline constexpr std::int64_t kEdgesAreOff = 11;
SequenceWord link_received();
void send_received(LinkBench& bench, const Octets& octets, std::int64_t how);
SequenceWord link_in_front();
void send_in_front(LinkBench& bench, const Octets& octets, std::int64_t kind, std::int64_t half_bits);
SequenceWord link_checked();

}  // namespace fieldproof::conformance

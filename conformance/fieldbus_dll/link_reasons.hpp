#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "conformance/test_case.hpp"

// Rules of the line that stations of both profiles have: what a finding about how a frame stands on it says
// is required.
namespace fieldproof::conformance::link_reasons {

inline constexpr std::string_view kFrame =
    "Each transmission is one frame: preamble of AA, start delimiter, whole octets, end delimiter, "
    "every bit as its two half bits at twice the bit rate and nothing else.";
inline constexpr std::string_view kCheck =
    "The last two octets of each frame are its check, high octet first: CRC-16/PROFIBUS, polynomial "
    "1DCF, preset FFFF, complemented.";
inline constexpr std::string_view kPreamble =
    "In front of the start delimiter of each frame are exactly `preamble_octets` octets of preamble, "
    "and the transmission ends with the end delimiter.";
inline constexpr std::string_view kGap =
    "The line is silent for V(MID), `inter_pdu_delay_octets`, at least in front of each DLPDU, from the "
    "end of the last transmission on, its own or another's; nothing is begun while others send.";
inline constexpr std::string_view kOverlap =
    "A station begins a transmission only when its own one before is over: two drives do not overlap.";
inline constexpr std::string_view kDriver =
    "A transmission has one frame, and the driver is off after its end delimiter: no drive is longer "
    "than the longest DLPDU.";
inline constexpr std::string_view kBabble =
    "A station sends each DLPDU as one transmission with V(MID) of silence in front of it, and so never "
    "many within a few octet durations.";

inline constexpr std::array kOfTheLine{
    ReasonRule{"frame_malformed", kFrame}, ReasonRule{"check_wrong", kCheck},
    ReasonRule{"gap_too_short", kGap},     ReasonRule{"transmissions_overlap", kOverlap},
    ReasonRule{"driver_held", kDriver},    ReasonRule{"station_babbles", kBabble}};

template <std::size_t kCount>
constexpr std::array<ReasonRule, kCount + kOfTheLine.size()> with_those_of_the_line(
    const std::array<ReasonRule, kCount>& own) {
  std::array<ReasonRule, kCount + kOfTheLine.size()> all{};
  std::ranges::copy(kOfTheLine, std::ranges::copy(own, all.begin()).out);
  return all;
}

}  // namespace fieldproof::conformance::link_reasons

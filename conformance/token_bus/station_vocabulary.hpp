#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/token_bus/station_scene.hpp"

// The words of charts that walk a vocabulary: every other address, every state, a station like new for each.
namespace fieldproof::conformance::token_chart {

// The supply fails and returns; of its user nothing is left either.
TokenStep starts_anew();
// Individual addresses that differ from the station's own in one bit: in each octet at both ends, but where
// the tester's own are.
std::vector<std::uint64_t> addresses_beside(const TokenBench& bench);
// And groups: its own with the group bit, the lowest, everybody.
std::vector<std::uint64_t> groups_beside(const TokenBench& bench);

// The states in which it listens, whatever it waits for; `scene.turn` says which.
inline constexpr unsigned kListeningStates = 7;
TokenStep brought_to_each_state();

// The same, and the events before are forgotten: `not_reported`.
TokenStep reported_again(const std::string& text, token_bus::EventKind kind, std::uint64_t about);
// None of this kind since the events were forgotten: `reported_unfounded`.
TokenStep not_reported(const std::string& text, token_bus::EventKind kind);
TokenStep forget_events();
// In a window, or in place of a response: `token_kept`.
TokenStep keeps_no_token();
// 0020 sends data to 0004.
TokenStep stranger_talks();
// The user changes whether the station is to be in the ring.
TokenStep desired(bool is_desired);
// 000E solicits those between it and 0004.
TokenStep solicited();
TokenStep answers(std::uint64_t whom, SpanOf span);

}  // namespace fieldproof::conformance::token_chart

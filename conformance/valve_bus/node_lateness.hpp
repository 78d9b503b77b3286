#pragma once

#include <cstdint>
#include <optional>

#include "conformance/judging.hpp"
#include "conformance/valve_bus/node_bench.hpp"

// Valves that do what a write says, and later than they may: `valves_too_late`, whatever a case expected of
// them. A wrong instant is no wrong value.
namespace fieldproof::conformance {

// How long after a write a move may still be that of the write.
inline constexpr kernel::Duration kLatestMove = 500 * kernel::kMillisecond;

// How long after the last stop bit of a write valves may move.
kernel::Duration limit_of_moves(const NodeBench& bench);

// "the valves move at most 2.1 ms after the last stop bit"
std::string limit_of_moves_text(const NodeBench& bench);
// "they moved 3.13 ms after the last stop bit, to A5 3C; limit 2.1 ms"
std::string late_move_text(const NodeBench& bench, std::uint16_t to, kernel::Duration after);

// The valves have been told to stand like this, and do not, or did not at this instant: where they do so
// later, that is the finding. Waits for it as long as it may take; call it where something is wrong already.
void expect_not_late(NodeBench& bench, CaseJudge& judge, std::uint16_t valves,
                     std::optional<kernel::Time> seen_at = std::nullopt);
// The valves became this then: where they should have done so before, that is the finding.
void expect_move_not_late(NodeBench& bench, CaseJudge& judge, std::uint16_t valves, kernel::Time when);

}  // namespace fieldproof::conformance

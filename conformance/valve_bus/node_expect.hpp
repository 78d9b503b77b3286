#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "conformance/judging.hpp"
#include "conformance/valve_bus/node_bench.hpp"

// What the cases for a local node require again and again, each with its reason codes.
namespace fieldproof::conformance {

// Positions on the line are rounded to picoseconds, each for itself: limits are held to a nanosecond.
inline constexpr kernel::Duration kRounding = kernel::kNanosecond;

// "valves 5A A5": the first board, the second one.
std::string valves_text(std::uint16_t valves);

// The valves stand like this now. Here and wherever else valves are looked at: where a write says so and they
// do it later, the reason is `valves_too_late` instead (node_lateness.hpp).
void expect_valves(NodeBench& bench, CaseJudge& judge, std::uint16_t valves, std::string_view reason);
// No valve has moved since the bench last forgot.
void expect_no_valve_moved(NodeBench& bench, CaseJudge& judge, std::string_view reason,
                           std::string_view why_not);
// The IUT has not driven the line since the bench last forgot.
void expect_silence(NodeBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why_not);
// Both, for what is no command of the IUT's.
void expect_ignored(NodeBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why_not);

// A write whose last stop bit ended at `end` (at the tester) has moved the valves to `valves` in time, all at
// once, and nothing else: `write_not_taken`, `valves_wrong`, `valves_too_early`, `valves_too_late`,
// `valves_one_by_one`; `write_answered`, or, where the PICS says so, the reasons of expect_answer.
void expect_write_taken(NodeBench& bench, CaseJudge& judge, std::uint8_t data0, std::uint8_t data1,
                        kernel::Time end);

// One answer with this data to a command whose last stop bit ended at `end`, at the tester: `no_answer`,
// `answered_twice`, `answer_length_wrong`, `answer_garbled`, `answer_data_wrong`, `answer_check_wrong`,
// `ninth_bit_wrong`, `answer_too_early`, `answer_too_late`, `driver_on_late`, `driver_not_released`,
// `gap_in_answer`. It is judged where the IUT drives it.
Transmission expect_one_answer(NodeBench& bench, CaseJudge& judge, std::uint8_t data0, std::uint8_t data1,
                               kernel::Time end);
// The same to a read, with these limit switches.
Transmission expect_answer(NodeBench& bench, CaseJudge& judge, std::uint16_t switches, kernel::Time end);

// A write and a read of the IUT are served: `does_not_recover`. Forgets what was seen.
void expect_serves(NodeBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance

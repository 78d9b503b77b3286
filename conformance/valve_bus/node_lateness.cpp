#include "conformance/valve_bus/node_lateness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/valve_bus/node_expect.hpp"

namespace fieldproof::conformance {
namespace {

[[noreturn]] void fail_late(const NodeBench& bench, CaseJudge& judge, const ValveMove& move,
                            kernel::Time since) {
  judge.fail("valves_too_late",
             {{limit_of_moves_text(bench)}, late_move_text(bench, move.after, move.when - since), move.when});
}

bool is_late(const NodeBench& bench, kernel::Time when, const ToldValves& told) {
  return when - told.end > limit_of_moves(bench) + kRounding;
}

// Valves that go off for want of a host do not do what a write said.
kernel::Time latest_move_of(const NodeBench& bench, const ToldValves& told) {
  const kernel::Duration loss = bench.rules().loss_limit;
  if (loss == kernel::Duration{} || told.valves != 0) return told.end + kLatestMove;
  return told.end + std::min(kLatestMove, loss / 10 * 9);
}

std::optional<ValveMove> awaited_move_of(NodeBench& bench, const ToldValves& told) {
  constexpr kernel::Duration kLook = 5 * kernel::kMillisecond;
  const kernel::Time latest = latest_move_of(bench, told);
  for (;;) {
    const auto move = bench.ledger().first_move_to(told.valves, told.end);
    if (move) return move->when <= latest ? move : std::nullopt;
    if (bench.now() >= latest) return std::nullopt;
    bench.wait(std::min(kLook, latest - bench.now()));
  }
}

}  // namespace

kernel::Duration limit_of_moves(const NodeBench& bench) {
  return bench.delimiter() + actuation_limit(bench.rules());
}

std::string limit_of_moves_text(const NodeBench& bench) {
  return fmt::format("the valves move at most {} after the last stop bit",
                     kernel::describe(limit_of_moves(bench)));
}

std::string late_move_text(const NodeBench& bench, std::uint16_t to, kernel::Duration after) {
  return fmt::format("they moved {} after the last stop bit, to {:02X} {:02X}; limit {}",
                     kernel::describe(after), to & 0xFF, to >> 8, kernel::describe(limit_of_moves(bench)));
}

void expect_not_late(NodeBench& bench, CaseJudge& judge, std::uint16_t valves,
                     std::optional<kernel::Time> seen_at) {
  if (!bench.capabilities().process_side) return;
  const kernel::Time when = seen_at.value_or(bench.now());
  const auto told = bench.ledger().write_of(valves, when - kLatestMove, when);
  if (!told || bench.ledger().at(told->end) == valves) return;
  const auto move = awaited_move_of(bench, *told);
  if (move && is_late(bench, move->when, *told)) fail_late(bench, judge, *move, told->end);
}

void expect_move_not_late(NodeBench& bench, CaseJudge& judge, std::uint16_t valves, kernel::Time when) {
  const ValveLedger& ledger = bench.ledger();
  for (const ToldValves& told : ledger.writes()) {
    const bool is_of_it =
        told.valves == valves && is_late(bench, when, told) && when <= latest_move_of(bench, told);
    if (!is_of_it || ledger.at(told.end) == valves) continue;
    const auto first = ledger.first_move_to(valves, told.end);
    if (first && first->when == when) fail_late(bench, judge, *first, told.end);
  }
}

}  // namespace fieldproof::conformance

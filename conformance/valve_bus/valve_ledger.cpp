#include "conformance/valve_bus/valve_ledger.hpp"

#include <algorithm>

namespace fieldproof::conformance {

void ValveLedger::add_move(const ValveMove& move) {
  moves_.insert(std::ranges::upper_bound(moves_, move.when, {}, &ValveMove::when), move);
  if (moves_.size() > kMost) moves_.pop_front();
}

void ValveLedger::add_write(const ToldValves& write) {
  if (write.end <= last_end_) return;
  last_end_ = write.end;
  writes_.push_back(write);
  if (writes_.size() > kMost) writes_.pop_front();
}

std::uint16_t ValveLedger::at(kernel::Time when) const {
  if (moves_.empty()) return 0;  // off from the begin
  const auto next = std::ranges::upper_bound(moves_, when, {}, &ValveMove::when);
  return next == moves_.begin() ? next->before : std::prev(next)->after;
}

std::optional<ValveMove> ValveLedger::first_move_to(std::uint16_t valves, kernel::Time from) const {
  const auto found = std::ranges::find_if(
      moves_, [&](const ValveMove& move) { return move.when >= from && move.after == valves; });
  return found == moves_.end() ? std::nullopt : std::optional(*found);
}

std::optional<ToldValves> ValveLedger::write_of(std::uint16_t valves, kernel::Time from,
                                                kernel::Time until) const {
  std::optional<ToldValves> found;
  bool goes_on = false;
  for (const ToldValves& write : writes_) {
    if (write.end < from || write.end > until) continue;
    const bool is_it = write.valves == valves;
    if (is_it && !goes_on) found = write;
    goes_on = is_it;
  }
  return found;
}

}  // namespace fieldproof::conformance

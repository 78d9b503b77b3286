#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "harness/kernel/time.hpp"

// What a node was told to do with its valves and what they did: the last of both, over all that a case
// forgets in between. It tells a valve that moves too late from one that moves wrongly.
namespace fieldproof::conformance {

struct ValveMove {
  kernel::Time when{};  // may lie ahead: a node may announce it
  std::uint16_t before = 0;
  std::uint16_t after = 0;
};

// A write of the node's own that arrived whole.
struct ToldValves {
  kernel::Time end{};  // of its last stop bit, at the node
  std::uint16_t valves = 0;
};

class ValveLedger {
 public:
  void add_move(const ValveMove& move);
  // Of writes that are no later than the last one nothing is kept: they are known.
  void add_write(const ToldValves& write);
  // What was told before a loss of power asks for nothing any more.
  void forget_writes() { writes_.clear(); }

  const std::deque<ValveMove>& moves() const { return moves_; }  // in order of time
  const std::deque<ToldValves>& writes() const { return writes_; }
  // What the valves were at this instant.
  std::uint16_t at(kernel::Time when) const;
  std::optional<ValveMove> first_move_to(std::uint16_t valves, kernel::Time from) const;
  // The last write of these in this time; where it came again and again with no other between, the first of
  // them: what it asked for is due since then.
  std::optional<ToldValves> write_of(std::uint16_t valves, kernel::Time from, kernel::Time until) const;

 private:
  static constexpr std::size_t kMost = 256;

  std::deque<ValveMove> moves_;
  std::deque<ToldValves> writes_;
  kernel::Time last_end_{};
};

}  // namespace fieldproof::conformance

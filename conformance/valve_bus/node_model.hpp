#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/valve_bus/arrived_frames.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/valve_bus/device.hpp"

// What a local node must do, told from what arrived at it: a model of the bus's rules that shares nothing
// with the stations but their numbers. It does not act at instants, as a node does; it says between which
// instants the valves must have moved, and what an answer must carry.
//
//   write of its own that is whole   valves stand so from its last stop bit on at the earliest, and at the
//                                    latest a delimiter and the actuation limit behind it
//   read of its own that is whole    an answer with the limit switches
//   anything else                    nothing
//
// A write that comes while the one before is still due may be the only one that is seen at the valves.
namespace fieldproof::conformance {

class NodeModel {
 public:
  struct Answer {
    std::uint8_t data0 = 0;
    std::uint8_t data1 = 0;
  };
  // What does not follow from what arrived.
  struct Objection {
    std::string reason;    // moves_without_command, valves_wrong, write_not_taken
    std::string expected;  // in words
    kernel::Time when;
  };

  explicit NodeModel(const valve_bus::NodeConfiguration& configuration);

  // From now on the node has just been powered: valves off, nothing due.
  void power_up(kernel::Time now);

  // The frame makes the node speak.
  bool is_answered(const ArrivedFrame& frame) const;
  // A frame with a delimiter in front of it and behind it; the limit switches stand like this. Nothing: it is
  // not answered.
  std::optional<Answer> hear(const ArrivedFrame& frame, std::uint16_t switches);

  // The valves became `valves`; instants never decrease, also between this and `pass`. Valves that move
  // within the skew of outputs are one change, to the last of them.
  std::optional<Objection> move(std::uint16_t valves, kernel::Time when);
  // Nothing else has moved until now.
  std::optional<Objection> pass(kernel::Time now);

  // Behind this, a node that is declared to let go of its valves without a host may do so.
  kernel::Time holds_until() const;

 private:
  struct Write {
    std::uint16_t valves = 0;
    kernel::Time earliest;
    kernel::Time latest;
  };

  bool is_own(const ArrivedFrame& frame, unsigned command) const;
  // The first write behind the one that stands, not before `least`, that the valves can show at `now`.
  std::optional<std::size_t> next_with(std::uint16_t valves, std::size_t least, kernel::Time now) const;
  std::size_t overdue(kernel::Time now) const;
  std::string admissible(kernel::Time now) const;

  valve_bus::NodeConfiguration configuration_;
  unsigned address_;
  std::vector<Write> writes_;  // the first is what stands
  std::uint16_t valves_ = 0;   // as they were seen
  kernel::Time last_command_{};
};

}  // namespace fieldproof::conformance

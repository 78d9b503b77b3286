#pragma once

#include <cstdint>

#include "harness/segment/station.hpp"
#include "protocols/valve_bus/rules.hpp"

// What the bench wires to and asks of a local node, whoever implements it: the built-in reference, a
// deviation of it, or an implementation outside. The line side is segment::Station (it hears the line as port
// 0, not what it drives itself); here is the other side of the device.
namespace fieldproof::valve_bus {

// The boards of a node. Bit i of the valves is solenoid i + 1: bits 0..7 those that DATA0 drives, bits 8..15
// those of DATA1. Bits of the limit switches in the same way: what a response carries. Instants never
// decrease from call to call.
class NodeBoards {
 public:
  virtual ~NodeBoards() = default;
  virtual std::uint16_t limit_switches(kernel::Time when) = 0;
  // All 16 from now on. A node that sets them one by one calls this for each.
  virtual void drive_valves(std::uint16_t valves, kernel::Time when) = 0;
};

struct NodeConfiguration {
  Rules rules;
  // The two address switches: decimal digits as they are set, 0..15 each (a switch can be of another kind).
  unsigned tens = 0;
  unsigned units = 1;
  unsigned boards = 2;  // drive boards, 1 or 2
};

class NodeDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& line, NodeBoards& boards) = 0;
  // The supply comes and goes; a node begins without it. It must not drive the line or a valve without it:
  // the valves are told off by who switches it.
  virtual void set_power(bool is_on, kernel::Time now) = 0;
  // The case is over: nothing is asked of the node any more. What it does then is still its verdict.
  virtual void end() {}
};

}  // namespace fieldproof::valve_bus

#pragma once

#include "harness/segment/process_words.hpp"
#include "protocols/valve_bus/device.hpp"

// The boards of a simulated node: one word of valves, one of limit switches.
namespace fieldproof::valve_bus {

class ValveBlock final : public NodeBoards, public segment::ProcessWords {
 public:
  ValveBlock() : ProcessWords(1) {}

  std::uint16_t limit_switches(kernel::Time when) override { return input(0, when); }
  void drive_valves(std::uint16_t valves, kernel::Time when) override { write(0, valves, when); }
  std::uint16_t valves() const { return output(0); }
};

}  // namespace fieldproof::valve_bus

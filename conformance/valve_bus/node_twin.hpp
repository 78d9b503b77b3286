#pragma once

#include <cstdint>
#include <vector>

#include "conformance/comparison/observation.hpp"
#include "conformance/comparison/twin_line.hpp"
#include "conformance/valve_bus/driven_line.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/valve_block.hpp"

// A reference node at one extreme of the rules that receives what arrives at the node under test.
namespace fieldproof::conformance {

class NodeTwin {
 public:
  // Powered, with all valves off, at `now`.
  NodeTwin(const valve_bus::NodeConfiguration& configuration, kernel::Time now);

  segment::Tap& line() { return line_; }
  void run_until(kernel::Time now) { line_.run_until(now); }
  void set_power(bool is_on, kernel::Time now);
  void set_switches(std::uint16_t switches) { boards_.set_input(0, switches); }

  const LevelHistory& valves() const { return valves_; }
  // DATA0 and DATA1 of what it has answered since the last call.
  Observations take_answers();

 private:
  valve_bus::Node node_;
  valve_bus::ValveBlock boards_;
  DrivenLine driven_;
  TwinLine line_;
  LevelHistory valves_;
};

// The extremes that the rules of this node allow: without a host it may let go of its valves a tenth of its
// limit before or after that.
std::vector<valve_bus::NodeConfiguration> node_extremes(const valve_bus::NodeConfiguration& configuration);

}  // namespace fieldproof::conformance

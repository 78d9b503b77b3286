#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "protocols/valve_bus/device.hpp"

// The suite of the RS-485 bus for pneumatic valves: the cases for local nodes, and their deviations.
//
// Implementations of a role: `ref`, `deviant:NAME`, and what the makers of implementations that the suite was
// given can make of their URI.
namespace fieldproof::conformance {

struct ValveBusGiven {
  // The node that such a URI means; null for a URI of another kind.
  using MakeNode = std::function<std::unique_ptr<valve_bus::NodeDevice>(
      const std::string& uri, const valve_bus::NodeConfiguration& configuration)>;

  MakeNode make_node{};
  std::span<const fault::DisturbanceKind> disturbances{};  // what a plan can name
};

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given = {});

}  // namespace fieldproof::conformance

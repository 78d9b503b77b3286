#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conformance/case_devices.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "harness/judge/pics.hpp"
#include "protocols/valve_bus/device.hpp"

// The suite of the RS-485 bus for pneumatic valves: the cases for local nodes and for
// host modules, and their mutants.
//
// Implementations of a role: `ref`, `mutant:NAME`, and what the suite was given.
namespace fieldproof::conformance {

struct ValveBusGiven {
  Attach attach{};  // implementations outside; null: there are none
  MakeOwn<valve_bus::NodeDevice, valve_bus::NodeConfiguration> own_node{};
  MakeOwn<valve_bus::HostDevice, valve_bus::HostConfiguration> own_host{};
  // Nodes on real lines: what their URI says of them, as answers to a PICS that has none; nothing for a URI
  // of another kind.
  std::function<std::optional<judge::Pics>(const std::string& uri)> on_real_line{};
  std::vector<fault::DisturbanceKind> disturbances{};  // what a plan can name
  std::vector<fault::Stress> stresses{};  // for cases with the tag `bursts`; without any they are left out
};

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given = {});

}  // namespace fieldproof::conformance

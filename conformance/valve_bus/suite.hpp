#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "harness/judge/pics.hpp"
#include "protocols/valve_bus/device.hpp"

// The suite of the RS-485 bus for pneumatic valves: the cases for local nodes and for
// host modules, and their deviations.
//
// Implementations of a role: `ref`, `deviant:NAME`, and what the makers of implementations that the suite was
// given can make of their URI.
namespace fieldproof::conformance {

struct ValveBusGiven {
  // Who plays the role of one case.
  struct Wanted {
    const std::string& uri;
    const std::string& case_id;
    std::uint64_t seed;
  };
  // The node, the host that such a URI means; null for a URI of another kind.
  using MakeNode = std::function<std::unique_ptr<valve_bus::NodeDevice>(
      const Wanted& wanted, const valve_bus::NodeConfiguration& configuration)>;
  using MakeHost = std::function<std::unique_ptr<valve_bus::HostDevice>(
      const Wanted& wanted, const valve_bus::HostConfiguration& configuration)>;

  MakeNode make_node{};
  MakeHost make_host{};
  // Nodes on real lines: what their URI says of them, as answers to a PICS that has none; nothing for a URI
  // of another kind.
  std::function<std::optional<judge::Pics>(const std::string& uri)> on_real_line{};
  std::span<const fault::DisturbanceKind> disturbances{};  // what a plan can name
  std::vector<fault::Stress> stresses{};  // for cases with the tag `bursts`; without any they are left out
};

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given = {});

}  // namespace fieldproof::conformance

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "conformance/assigned.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "protocols/interbus/device.hpp"

// The INTERBUS suite: the cases for slaves, for masters and for whole networks, and their mutants.
//
// Implementations of a role: `ref`, `mutant:NAME`, what the suite was given, and `recorded:FILE` (a device
// that does again what a stored run recorded). Cases for a slave and for a network take the network of the
// setup; cases for a master make the rings that they need.
namespace fieldproof::conformance {

using GivenSlaves = StationSources<interbus::SlaveDevice, interbus::SlaveConfiguration>;
using GivenMasters = StationSources<interbus::MasterDevice, interbus::MasterConfiguration>;

// What disturbs a line comes from outside as well, because a suite has no model of a disturbance.
struct InterbusGiven {
  GivenSlaves slave{};
  GivenMasters master{};
  std::vector<fault::DisturbanceKind> disturbances{};  // what a plan can name
  std::vector<fault::Stress> stresses{};  // for cases with the tag `bursts`; without any they are left out
};

std::unique_ptr<Suite> interbus_suite(InterbusGiven given = {});

}  // namespace fieldproof::conformance

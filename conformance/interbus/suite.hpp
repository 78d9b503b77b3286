#pragma once

#include <memory>
#include <span>
#include <vector>

#include "conformance/case_devices.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "protocols/interbus/device.hpp"

// The INTERBUS suite: the cases for slaves, for masters and for whole networks, and their mutants.
//
// Implementations of a role: `ref`, `mutant:NAME`, and what the suite was given. Cases for a slave and for a
// network take the network of the setup; cases for a master make the rings that they need.
namespace fieldproof::conformance {

// What disturbs a line comes from outside as well, because a suite has no model of a disturbance.
struct InterbusGiven {
  Attach attach{};  // implementations outside; null: there are none
  MakeOwn<interbus::SlaveDevice, interbus::SlaveConfiguration> own_slave{};
  MakeOwn<interbus::MasterDevice, interbus::MasterConfiguration> own_master{};
  std::vector<fault::DisturbanceKind> disturbances{};  // what a plan can name
  std::vector<fault::Stress> stresses{};  // for cases with the tag `bursts`; without any they are left out
};

std::unique_ptr<Suite> interbus_suite(InterbusGiven given = {});

}  // namespace fieldproof::conformance

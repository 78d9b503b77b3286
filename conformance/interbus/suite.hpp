#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"
#include "protocols/interbus/device.hpp"

// The INTERBUS suite: the cases for slaves, for masters and for whole networks, and their deviations.
//
// Implementations of a role: `ref`, `deviant:NAME`, `recorded:FILE` (a device that does again what a stored
// run recorded). Cases for a slave and for a network take the network of the setup; cases for a master make
// the rings that they need.
namespace fieldproof::conformance {

// What makes the stations that the URI `own` means; null where there is none.
struct OwnStations {
  std::function<std::unique_ptr<interbus::SlaveDevice>(const interbus::SlaveConfiguration&)> make_slave{};
  std::function<std::unique_ptr<interbus::MasterDevice>(const interbus::MasterConfiguration&)> make_master{};
};

// What disturbs a line. It comes from outside, because a suite has no model of a disturbance.
struct LineDisturbances {
  std::vector<fault::Stress> stresses{};  // for cases with the tag `bursts`; without any they are left out
  std::vector<fault::DisturbanceKind> of_plans{};  // what a plan can name
};

std::unique_ptr<Suite> interbus_suite(OwnStations own = {}, LineDisturbances disturbances = {});

}  // namespace fieldproof::conformance

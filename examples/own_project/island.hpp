// The product: what its data sheet promises beyond what the valve bus demands of any node, as a suite of its
// own. The station of the suite (`ref`) is a model of the product, its mutants are the model with one
// decision changed.
#pragma once

#include <functional>
#include <memory>

#include <conformance/suite.hpp>
#include <protocols/valve_bus/device.hpp>

namespace island {

using fieldproof::valve_bus::NodeConfiguration;
using fieldproof::valve_bus::NodeDevice;

// The firmware as a node of the bench, for one case.
std::unique_ptr<NodeDevice> firmware(const NodeConfiguration& configuration, const std::string& case_id,
                                     std::uint64_t seed);

// The firmware as what the URI `own` means.
fieldproof::conformance::OwnStations own_firmware();

std::unique_ptr<fieldproof::conformance::Suite> island_suite(fieldproof::conformance::SuiteGiven given);

}  // namespace island

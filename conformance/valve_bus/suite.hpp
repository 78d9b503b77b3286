#pragma once

#include <memory>

#include "conformance/suite.hpp"

// The suite of the RS-485 bus for pneumatic valves: the cases for local nodes and for host modules, and their
// mutants.
namespace fieldproof::conformance {

std::unique_ptr<Suite> valve_bus_suite(SuiteGiven given = {});

}  // namespace fieldproof::conformance

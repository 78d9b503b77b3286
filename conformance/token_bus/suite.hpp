#pragma once

#include <memory>

#include "conformance/suite.hpp"

// The suite of the token bus: stations of the MAC, and translators to the physical layer.
namespace fieldproof::conformance {

std::unique_ptr<Suite> token_bus_suite(SuiteGiven given = {});

}  // namespace fieldproof::conformance

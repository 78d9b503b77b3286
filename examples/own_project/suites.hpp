// What the product is held against: the suite of the valve bus and the suite of the product, with the
// firmware as `own` in both.
#pragma once

#include <memory>
#include <vector>

#include <conformance/valve_bus/suite.hpp>

namespace island {

std::vector<std::unique_ptr<fieldproof::conformance::Suite>> suites(
    fieldproof::conformance::ValveBusGiven given = {});

}  // namespace island

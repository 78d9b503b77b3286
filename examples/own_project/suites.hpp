// What the product is held against: the suite of the valve bus and the suite of the product, with the
// firmware as `own` in both.
#pragma once

#include <memory>

#include <conformance/suite.hpp>

namespace island {

std::unique_ptr<fieldproof::conformance::Suite> valve_bus_suite(
    fieldproof::conformance::SuiteGiven given = {});
std::unique_ptr<fieldproof::conformance::Suite> product_suite(fieldproof::conformance::SuiteGiven given = {});

}  // namespace island

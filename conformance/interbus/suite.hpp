#pragma once

#include <memory>

#include "conformance/suite.hpp"

// The INTERBUS suite: the cases for slaves, for masters and for whole networks, and their mutants. Cases for
// a slave and for a network take the network of the setup; cases for a master make the rings that they need.
namespace fieldproof::conformance {

std::unique_ptr<Suite> interbus_suite(SuiteGiven given = {});

}  // namespace fieldproof::conformance

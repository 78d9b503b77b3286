#pragma once

#include <memory>

#include "conformance/suite.hpp"

// The suite of the data link of IEC 61158 type 1 and of its drafts: data link entities and link masters of
// the profile ISA-D, basic devices and link masters of the profile FF-P, and their mutants.
namespace fieldproof::conformance {

std::unique_ptr<Suite> fieldbus_dll_suite(SuiteGiven given = {});

}  // namespace fieldproof::conformance

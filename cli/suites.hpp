#pragma once

#include <vector>

#include "cli/program.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"

// The protocols of the program, one row each in suites.cpp.
namespace fieldproof::cli {

// What disturbs lines: for cases with bursts of their own, and for plans.
struct Disturbances {
  std::vector<fault::Stress> stresses;
  std::vector<fault::DisturbanceKind> of_plans;
};

// Those of IEC 61000-4-4, and the channels of the textbooks.
Disturbances all_disturbances();

Suites suites();
Suites suites_under(const Disturbances& disturbances);

}  // namespace fieldproof::cli

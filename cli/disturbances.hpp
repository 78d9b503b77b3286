#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "harness/fault/disturbance.hpp"
#include "harness/fault/stress.hpp"

namespace fieldproof::cli {

// What disturbs lines: for cases with bursts of their own, and for plans. A suite is made with them, because
// `shrink` and quiet replays run it with others: with some that are noted, and with none.
struct Disturbances {
  std::vector<fault::Stress> stresses;
  std::map<std::int64_t, std::vector<fault::Stress>> link_stresses;  // of lines of IEC 61158-2, by bit rate
  std::vector<fault::DisturbanceKind> of_plans;
};

// Those of IEC 61000-4-4, and the channels of the textbooks.
Disturbances all_disturbances();

}  // namespace fieldproof::cli

#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "harness/fault/plan.hpp"
#include "harness/judge/finding.hpp"

namespace fieldproof::conformance {

// What a case's plan of faults did; nothing where it has none (null).
inline std::vector<judge::PlannedFault> planned_faults(const fault::InstalledPlan* installed) {
  std::vector<judge::PlannedFault> faults;
  if (installed == nullptr) return faults;
  const fault::Plan& plan = installed->plan();
  for (std::size_t n = 0; n < plan.rules().size(); ++n) {
    faults.push_back({fmt::format("/rules/{}", n), plan.rules()[n].name, installed->hits(n)});
  }
  for (std::size_t n = 0; n < plan.disturbances().size(); ++n) {
    faults.push_back(
        {fmt::format("/disturbances/{}", n), plan.disturbances()[n].name, installed->changes(n)});
  }
  return faults;
}

}  // namespace fieldproof::conformance

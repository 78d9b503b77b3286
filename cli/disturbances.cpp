#include "cli/disturbances.hpp"

#include "emc/burst_stress.hpp"
#include "emc/plan_disturbances.hpp"

namespace fieldproof::cli {

conformance::Disturbances all_disturbances() {
  return {emc::catalogue_stresses(), emc::catalogue_link_stresses(), emc::plan_disturbances()};
}

}  // namespace fieldproof::cli

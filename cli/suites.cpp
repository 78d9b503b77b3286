#include "cli/suites.hpp"

#include "cli/attachments.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "emc/burst_stress.hpp"
#include "emc/plan_disturbances.hpp"

namespace fieldproof::cli {

Suites suites() {
  Suites all;
  all.push_back(conformance::interbus_suite({}, {emc::catalogue_stresses(), emc::plan_disturbances()}));
  all.push_back(conformance::valve_bus_suite({.make_node = attached_nodes(),
                                              .on_real_line = node_on_real_line,
                                              .disturbances = emc::plan_disturbances(),
                                              .stresses = emc::catalogue_stresses()}));
  return all;
}

}  // namespace fieldproof::cli

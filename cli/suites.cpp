#include "cli/suites.hpp"

#include "cli/attachments.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "emc/burst_stress.hpp"
#include "emc/plan_disturbances.hpp"

namespace fieldproof::cli {

Suites suites() {
  Suites all;
  all.push_back(conformance::interbus_suite({.slave = {.attached = attached_slaves()},
                                             .disturbances = emc::plan_disturbances(),
                                             .stresses = emc::catalogue_stresses()}));
  all.push_back(conformance::valve_bus_suite({.node = {.attached = attached_nodes()},
                                              .host = {.attached = attached_hosts()},
                                              .disturbances = emc::plan_disturbances(),
                                              .stresses = emc::catalogue_stresses()}));
  return all;
}

}  // namespace fieldproof::cli

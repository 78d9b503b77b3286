#include "cli/suites.hpp"

#include "cli/attachments.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"

namespace fieldproof::cli {

Suites suites(const Disturbances& disturbances) {
  Suites all;
  all.push_back(conformance::interbus_suite({.slave = {.attached = attached_slaves()},
                                             .master = {.attached = attached_masters()},
                                             .disturbances = disturbances.of_plans,
                                             .stresses = disturbances.stresses}));
  all.push_back(conformance::valve_bus_suite({.node = {.attached = attached_nodes()},
                                              .host = {.attached = attached_hosts()},
                                              .on_real_line = node_on_real_line,
                                              .disturbances = disturbances.of_plans,
                                              .stresses = disturbances.stresses}));
  all.push_back(conformance::fieldbus_dll_suite({.isa_dle = {.attached = attached_isa_stations("isa_dle")},
                                                 .isa_las = {.attached = attached_isa_stations("isa_las")},
                                                 .ff_device = {.attached = attached_ff_stations("ff_device")},
                                                 .ff_las = {.attached = attached_ff_stations("ff_las")},
                                                 .disturbances = disturbances.of_plans,
                                                 .stresses = disturbances.link_stresses}));
  return all;
}

}  // namespace fieldproof::cli

#include "cli/suites.hpp"
#include "conformance/interbus/suite.hpp"
#include "emc/burst_stress.hpp"

namespace fieldproof::cli {

Suites suites() {
  Suites all;
  all.push_back(conformance::interbus_suite({}, emc::catalogue_stresses()));
  return all;
}

}  // namespace fieldproof::cli

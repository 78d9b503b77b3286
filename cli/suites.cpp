#include "cli/suites.hpp"
#include "conformance/interbus/suite.hpp"

namespace fieldproof::cli {

Suites suites() {
  Suites all;
  all.push_back(conformance::interbus_suite());
  return all;
}

}  // namespace fieldproof::cli

#include "cli/suites.hpp"

namespace fieldproof::cli {

Suites suites() {
  Suites all;
  return all;
}

}  // namespace fieldproof::cli

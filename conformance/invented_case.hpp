// For tests: cases of suites that do not exist.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

inline TestCase invented_case(std::string id, std::vector<std::string> tags = {},
                              std::vector<MustCatch> catches = {}) {
  TestCase test_case;
  test_case.id = std::move(id);
  test_case.purpose = "P-1";
  test_case.tags = std::move(tags);
  test_case.catches = std::move(catches);
  return test_case;
}

}  // namespace fieldproof::conformance

#include "conformance/test_case.hpp"

#include <algorithm>

namespace fieldproof::conformance {

std::string TestCase::role() const {
  const std::size_t first = id.find('/');
  if (first == std::string::npos) return {};
  return id.substr(first + 1, id.find('/', first + 1) - first - 1);
}

bool has_tag(const TestCase& test_case, std::string_view tag) {
  return std::find(test_case.tags.begin(), test_case.tags.end(), tag) != test_case.tags.end();
}

bool is_canary(const TestCase& test_case) {
  return has_tag(test_case, "canary");
}

std::string_view name(Volume volume) {
  return volume == Volume::quick ? "quick" : "full";
}

}  // namespace fieldproof::conformance

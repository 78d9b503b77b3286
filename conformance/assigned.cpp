#include "conformance/assigned.hpp"

#include <fmt/format.h>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

Assignment assigned_to(const TestCase& test_case, const Setup& setup) {
  Assignment assigned;
  const std::string role = test_case.role();
  for (const Assignment& assignment : setup.implementations) {
    if (assignment.role.empty() || assignment.role == role) assigned = assignment;
  }
  return assigned;
}

std::string mutant_of(const std::string& uri, std::string_view what) {
  if (!uri.starts_with(kMutantUri)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("\"{}\" is no {}; use ref or mutant:NAME", uri, what));
  }
  return uri.substr(kMutantUri.size());
}

void refuse_outside(const iut::RoleName& role) {
  throw kernel::Error(
      kernel::ErrorKind::usage,
      "'" + role.path() +
          "' is played by stations of this program only (ref, mutant:NAME, own): the role says "
          "nothing of how an implementation outside is called");
}

}  // namespace fieldproof::conformance

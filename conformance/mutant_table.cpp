#include "conformance/mutant_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

void refuse_mutant(std::string_view role, std::string_view name, std::span<const std::string_view> names) {
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no mutant {} \"{}\"; near are {}", role, name,
                                  fmt::join(config::nearest(name, names, 3), ", ")));
}

}  // namespace fieldproof::conformance

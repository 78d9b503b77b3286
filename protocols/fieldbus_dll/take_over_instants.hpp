#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/kernel/sanitized.hpp"

// For tests: at how many random instants a scheduler dies. FIELDPROOF_INSTANTS in the environment says
// otherwise, for a long campaign; under a sanitizer it is a tenth.
namespace fieldproof::fieldbus_dll {

inline std::uint64_t instants_of_test(std::uint64_t usual) {
  if (const char* const wanted = std::getenv("FIELDPROOF_INSTANTS")) return std::stoull(wanted);
  return kernel::kIsSanitized ? (usual + 9) / 10 : usual;
}

}  // namespace fieldproof::fieldbus_dll

#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/kernel/sanitized.hpp"

// For tests that are as long as one likes: how many seeds, instants or kills. The variable of the environment
// says how many where the usual number is too few, for a long campaign; under a sanitizer it is a tenth.
namespace fieldproof::kernel {

inline std::uint64_t campaign_count(const char* variable, std::uint64_t usual) {
  if (const char* const wanted = std::getenv(variable)) return std::max(1ULL, std::stoull(wanted));
  return kIsSanitized ? (usual + 9) / 10 : usual;
}

}  // namespace fieldproof::kernel

#include "cli/build_info.hpp"

namespace fieldproof::cli {

std::string tool_version() {
  return FIELDPROOF_VERSION;
}

std::string build_type() {
  return FIELDPROOF_BUILD_TYPE;
}

std::string compiler() {
#if defined(__clang__)
  return "clang++ " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace fieldproof::cli

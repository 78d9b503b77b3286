// What this program is: version and build, as they were when it was compiled.
#pragma once

#include <string>

namespace fieldproof::cli {

std::string tool_version();  // "0.1.0"
std::string build_type();    // "Release"
std::string compiler();      // "g++ 12.2.0"

}  // namespace fieldproof::cli

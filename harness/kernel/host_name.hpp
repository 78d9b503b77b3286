// The name of the machine that this runs on.
#pragma once

#include <string>

namespace fieldproof::kernel {

std::string host_name();  // "unknown" where it has none

}  // namespace fieldproof::kernel

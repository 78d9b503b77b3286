#pragma once

#include <memory>
#include <string>

#include "harness/iut/device.hpp"

// An implementation in a shared library, called in this process. One that crashes takes the process with it:
// where that must not be, it is loaded by a process of its own (`fieldproof station`).
namespace fieldproof::iut {

// Loads the library and creates an instance for the role. Throws kernel::Error(implementation) for a file
// that is no such library, one of another version, and a role that it does not serve.
std::unique_ptr<Device> load_plugin(const std::string& path, const std::string& protocol,
                                    const std::string& role);

}  // namespace fieldproof::iut

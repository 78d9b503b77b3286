#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "harness/iut/device.hpp"
#include "harness/iut/fieldproof_plugin.h"

// An implementation after the functions of fieldproof_plugin.h, called in this process: in a shared library,
// or linked into the program. One that crashes takes the process with it: where that must not be, it is
// loaded by a process of its own (`fieldproof station`).
namespace fieldproof::iut {

// In what a role tells its implementation things: what is on its line in the unit that the implementation has
// chosen, and the words of a PC or an application, where the role has one, in characters whatever that is.
enum class UnitOffer : std::uint8_t { in_its_unit, in_characters_too };

// Loads the library and creates an instance for the role. Throws kernel::Error(implementation) for a file
// that is no such library, one of another version, one without a function that the role needs, and a role
// that it does not serve.
std::unique_ptr<Device> load_plugin(const std::string& path, const std::string& protocol,
                                    const std::string& role, UnitOffer told = UnitOffer::in_its_unit);

// The name that the library reports of itself, escaped. Throws as load_plugin does for a file that is none.
std::string own_name_of_plugin(const std::string& path);

// The same for an implementation that the program holds itself, as firmware that is compiled into its tests.
std::unique_ptr<Device> make_plugin(const fieldproof_implementation& implementation,
                                    const std::string& protocol, const std::string& role,
                                    UnitOffer told = UnitOffer::in_its_unit);

}  // namespace fieldproof::iut

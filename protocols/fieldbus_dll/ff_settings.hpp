#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a station of the profile FF-P is given at the beginning of a case.
namespace fieldproof::fieldbus_dll {

extern const field::Table<FfConfiguration> kFfTable;

field::Settings ff_settings(const FfConfiguration& configuration);
FfConfiguration ff_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::fieldbus_dll

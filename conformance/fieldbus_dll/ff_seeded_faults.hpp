#pragma once

#include <span>
#include <vector>

#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"

// Stations of the profile FF-P that differ from the reference in one decision each; ff_mutants.cpp names
// and describes them. A decision that is a number is changed in the rules there, without a class. They lie by
// role in ff_device_seeded_faults.hpp, ff_ending_seeded_faults.hpp and ff_las_seeded_faults.hpp; here is what
// both name.
namespace fieldproof::conformance::ff_seeded_faults {

using fieldbus_dll::Arrived;
using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::FfDlpdu;
using fieldbus_dll::FfLas;
using fieldbus_dll::FfRequest;
using fieldbus_dll::FfScheduleItem;
using fieldbus_dll::FfStation;
using fieldbus_dll::FfType;
using fieldbus_dll::Octets;
using fieldbus_dll::Priority;
using kernel::Duration;
using kernel::Time;
using HeardOctets = std::span<const std::uint8_t>;

}  // namespace fieldproof::conformance::ff_seeded_faults

#pragma once

#include <span>
#include <vector>

#include "protocols/fieldbus_dll/isa_dle.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"

// Stations of the profile ISA-D that differ from the reference in one decision each; isa_mutants.cpp names
// and describes them. A decision that is a number is changed in the rules there, without a class. They lie by
// theme in isa_token_seeded_faults.hpp, isa_reply_, isa_frame_ and isa_las_seeded_faults.hpp; here is what
// all of these name.
namespace fieldproof::conformance::isa_seeded_faults {

using fieldbus_dll::Arrived;
using fieldbus_dll::EndReason;
using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaDle;
using fieldbus_dll::IsaDlpdu;
using fieldbus_dll::IsaLas;
using fieldbus_dll::IsaRequest;
using fieldbus_dll::IsaScheduleItem;
using fieldbus_dll::IsaService;
using fieldbus_dll::IsaType;
using fieldbus_dll::LasState;
using fieldbus_dll::Octets;
using fieldbus_dll::Priority;
using kernel::Duration;
using kernel::Time;
using Heard = std::span<const std::uint8_t>;

}  // namespace fieldproof::conformance::isa_seeded_faults

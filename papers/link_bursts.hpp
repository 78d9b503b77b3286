// Bursts on a link of Foundation Fieldbus: one generator for the receivers of all its stations.
#pragma once

#include <cstdint>

#include "emc/generator.hpp"
#include "emc/profile.hpp"
#include "protocols/fieldbus_dll/ff_link.hpp"

namespace fieldproof::papers {

// From `on` on; `seed` decides when bursts come.
fieldbus_dll::FfDisturb bursts_on_link(const emc::Profile& profile, const emc::BurstSettings& settings,
                                       std::int64_t bit_rate, kernel::Time on, std::uint64_t seed);

}  // namespace fieldproof::papers

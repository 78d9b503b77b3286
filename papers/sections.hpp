// The sections of a publication: each a function that reproduces one part of a paper. What the program prints
// is the table in catalogue.cpp; a new section is a row there.
#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"
#include "reports/publication.hpp"

namespace fieldproof::papers {

struct Settings {
  std::uint64_t seed = 1;
  kernel::Duration duration = 60 * kernel::kSecond;  // virtual time of each signal
};

// Park 2004, "The Study on the Cycling Time for Interbus".
reports::PublishedSection interbus_cycle_times(const Settings& settings);
reports::PublishedSection interbus_highest_frequency(const Settings& settings);
reports::PublishedSection interbus_square_waves(const Settings& settings);
reports::PublishedSection interbus_bursts(const Settings& settings);

// Kim, Seo and Lee, the RS-485 bus for pneumatic valves.
reports::PublishedSection valve_bus_cycle_times(const Settings& settings);
reports::PublishedSection valve_bus_sentences(const Settings& settings);
reports::PublishedSection valve_bus_block_check(const Settings& settings);
reports::PublishedSection valve_bus_resonance(const Settings& settings);

// Hong and Son, the delay of urgent data in the Foundation Fieldbus.
reports::PublishedSection foundation_rotations(const Settings& settings);
reports::PublishedSection foundation_sentences(const Settings& settings);
reports::PublishedSection foundation_targets(const Settings& settings);
reports::PublishedSection foundation_shares(const Settings& settings);
reports::PublishedSection foundation_lengths(const Settings& settings);
reports::PublishedSection foundation_stations(const Settings& settings);

// Hong, Kim, Kim and Ko, control loops over a fieldbus.
reports::PublishedSection control_loop_quiet(const Settings& settings);
reports::PublishedSection control_loop_under_bursts(const Settings& settings);
reports::PublishedSection control_loop_with_operator(const Settings& settings);

// The same, its section 5: bandwidth for periodic, real-time and non-real-time data.
reports::PublishedSection bandwidth_periodic(const Settings& settings);
reports::PublishedSection bandwidth_non_real_time(const Settings& settings);
reports::PublishedSection bandwidth_real_time(const Settings& settings);
reports::PublishedSection bandwidth_loop(const Settings& settings);
reports::PublishedSection bandwidth_stations(const Settings& settings);

// Lee, Moon, Moon, Kwon, Lee and Park, the token bus on the physical layer of IEEE 802.3.
reports::PublishedSection control_network_coding(const Settings& settings);
reports::PublishedSection control_network_rotation(const Settings& settings);
reports::PublishedSection control_network_access(const Settings& settings);
reports::PublishedSection control_network_recovery(const Settings& settings);

}  // namespace fieldproof::papers

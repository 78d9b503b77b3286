#pragma once

#include "harness/field/field.hpp"
#include "harness/kernel/time.hpp"

// The numbers of a line that is longer than a table: cable, and repeaters between its segments.
namespace fieldproof::token_bus {

struct CableRules {
  // ---- the cable ----
  std::int64_t cable_delay_ps_per_m = 4'400;
  unsigned longest_segment_m = 500;
  unsigned most_repeaters = 4;
  // ---- a repeater ----
  unsigned repeater_delay_bits = 20;
  unsigned repeater_preamble_bits = 64;
  unsigned least_fragment_bits = 96;
  kernel::Duration jabber = 5 * kernel::kMillisecond;
  unsigned most_octets_with_repeaters = 2'400;
  // ---- a station ----
  kernel::Duration station_delay = 20 * kernel::kMicrosecond;
};

extern const field::Table<CableRules> kCableRulesTable;

}  // namespace fieldproof::token_bus

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "harness/kernel/time.hpp"

// Every number of the token bus of IEEE 802.4 on the physical layer of IEEE 802.3, as Lee, Moon, Moon, Kwon,
// Lee and Park join them. Times are octet durations of the MAC, 1.6 us at 5 Mbit/s, and slot times, as the
// standard counts them.
namespace fieldproof::token_bus {

enum class AddressLength : std::uint8_t { bits_16 = 2, bits_48 = 6 };

// 6, 4, 2, 0: the most urgent first.
inline constexpr unsigned kAccessClasses = 4;

struct Rules {
  // ---- the line ----
  std::int64_t phy_bit_rate = 10'000'000;  // of IEEE 802.3; a MAC symbol is two of these bits
  unsigned preamble_octets = 4;
  unsigned response_gap_octets = 6;  // from the end of a transmission to the next one
  unsigned blanking_symbols = 28;    // of MAC symbols, after a transmission: the receiver reports silence

  // ---- the network ----
  AddressLength address_length = AddressLength::bits_16;
  unsigned slot_time_octets = 28;
  unsigned most_octets = 8'191;  // from the start delimiter to the end delimiter, both exclusive

  // ---- access ----
  unsigned bus_idle_slots = 7;
  unsigned lowest_bus_idle_slots = 6;     // of the ring's lowest address
  unsigned noise_wait_slots = 4;          // more, after noise that follows a token
  unsigned demand_wait_slots = 4;         // after an own set_successor
  unsigned response_wait_slots = 3;       // for the response to a request
  unsigned max_retry_limit = 2;           // of a request with response
  unsigned max_inter_solicit_count = 16;  // tokens between two response windows
  unsigned transmitter_fault_limit = 7;
  std::uint32_t high_priority_hold_octets = 2'000;                              // of class 6
  std::array<std::uint32_t, 3> target_rotation_octets{60'000, 40'000, 20'000};  // of the classes 4, 2, 0
  std::uint32_t ring_maintenance_octets = 1'000'000;                            // target rotation time
  bool solicits_at_first = true;  // ring maintenance begins with time left

  friend bool operator==(const Rules&, const Rules&) = default;
};

inline unsigned address_octets(const Rules& rules) {
  return static_cast<unsigned>(rules.address_length);
}

inline std::int64_t mac_symbol_rate(const Rules& rules) {
  return rules.phy_bit_rate / 2;
}
inline kernel::Duration mac_symbols(const Rules& rules, std::int64_t count) {
  return kernel::levels_duration(count, mac_symbol_rate(rules));
}
inline kernel::Duration octets(const Rules& rules, std::int64_t count) {
  return mac_symbols(rules, 8 * count);
}
inline kernel::Duration slots(const Rules& rules, std::int64_t count) {
  return octets(rules, count * rules.slot_time_octets);
}

// Two bits of an address are used in each pass of a contest, and two random ones in the last.
inline unsigned contest_passes(const Rules& rules) {
  return 4 * address_octets(rules) + 1;
}

// Octets between the delimiters of a frame with so many octets of data: control, two addresses, data, check.
inline std::size_t frame_octets(const Rules& rules, std::size_t data) {
  return 1 + 2 * std::size_t{address_octets(rules)} + data + 4;
}
inline std::size_t most_data(const Rules& rules) {
  return rules.most_octets - frame_octets(rules, 0);
}
// From the first symbol of the preamble to the last one of the end delimiter.
inline kernel::Duration frame_time(const Rules& rules, std::size_t data) {
  return octets(rules, static_cast<std::int64_t>(frame_octets(rules, data) + rules.preamble_octets + 2));
}

// A sentence about the first number outside of the range of its row; the longest claim must besides fit a
// frame, and a slot must hold the gap before a response.
std::optional<std::string> impossible(const Rules& rules);

}  // namespace fieldproof::token_bus

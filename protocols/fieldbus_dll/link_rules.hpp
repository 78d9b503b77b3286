#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "harness/kernel/time.hpp"
#include "harness/traffic/request_queues.hpp"

// The numbers of a link that every profile of the data link has: its rate, its frames, the times that bound
// who speaks when. Times are octet durations, as the data link counts them.
namespace fieldproof::fieldbus_dll {

// PP. What is more urgent is the greater.
enum class Priority : std::uint8_t { time_available = 1, normal = 2, urgent = 3 };

// What waits to be sent.
template <typename Request>
using LinkQueues =
    traffic::RequestQueues<Request, Priority::urgent, Priority::normal, Priority::time_available>;

// Bits of the first octet of a DLPDU.
inline constexpr unsigned kFinalBit = 0x04;
inline constexpr unsigned kPriorityBits = 0x03;

// "urgent".
std::string_view text_of(Priority priority);

struct LinkRules {
  std::int64_t bit_rate = 31'250;                      // bit/s; 1 and 2.5 Mbit/s, too
  unsigned preamble_octets = 1;                        // 1 + V(PhPE), at most 8
  unsigned slot_time_octets = 8;                       // V(ST)
  unsigned response_delay_slots = 4;                   // V(MRD), in slot times
  unsigned inter_pdu_delay_octets = 8;                 // V(MID)
  std::array<std::size_t, 3> most_data{256, 128, 64};  // octets of a DLSDU, by priority, the least first

  friend bool operator==(const LinkRules&, const LinkRules&) = default;
};

// What stands before and after the octets of a frame: preamble, start and end delimiter.
inline unsigned octets_around(const LinkRules& rules) {
  return rules.preamble_octets + 2;
}

// `count` octet durations; may be negative.
inline kernel::Duration octets(const LinkRules& rules, std::int64_t count) {
  return kernel::levels_duration(8 * count, rules.bit_rate);
}

// From the first bit of the preamble to the last one of the end delimiter; `count` octets with their check.
inline kernel::Duration frame_time(const LinkRules& rules, std::size_t count) {
  return octets(rules, static_cast<std::int64_t>(count + octets_around(rules)));
}

inline std::size_t most_data(const LinkRules& rules, Priority priority) {
  return rules.most_data[static_cast<std::size_t>(priority) - 1];
}

}  // namespace fieldproof::fieldbus_dll

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/kernel/time.hpp"

// How control loops share a line whose server (a token, or a poll) visits node after node: window scheduling
// and bandwidth allocation, after section 5 of S.-H. Hong and others, "Distributed control and automation
// systems and fieldbus".
//
// Time is divided into slots of T_1, the sampling period of the fastest loop. Each loop samples every 2^n-th
// slot, its sensor and its controller in slots of their own offsets, so that no slot has more data than the
// line carries in it: windows (gamma). What remains is for real-time and non-real-time packets, whose length
// is limited so that all data of a slot are sent within it. Times are exact; what is found is whole
// microseconds, rounded so that it holds.
namespace fieldproof::bandwidth {

// How long a sampling period may be for a bound of the loop delay, the time from a sample to the actuator.
//   hong   2 T_i + T_1 <= bound: all that is known of the sensor datum is that it takes up to T_i
//   sharp  T_i + 2 T_1 <= bound: it takes up to T_1
enum class Rule : std::uint8_t { hong, sharp };

// How many non-real-time packets may go before the last of g data of a slot: N - g + 1, of N nodes.
//   printed  as the paper has it, with g = gamma, the most data of a slot
//   safe     the shortest packet over each g that a slot has
enum class LengthRule : std::uint8_t { printed, safe };

std::string_view text_of(Rule rule);
std::string_view text_of(LengthRule rule);

struct Demand {
  Rule rule = Rule::hong;
  std::vector<kernel::Duration> bounds;  // of loop delays (Phi), one for each loop
  unsigned nodes = 0;                    // that the server visits (N)
  unsigned real_time_queues = 0;         // N_c
  kernel::Duration overhead{};           // of the server at a node (sigma)
  kernel::Duration periodic_packet{};    // L_p
  kernel::Duration real_time_packet{};   // L_c
};

inline constexpr std::size_t kMostLoops = 64;
inline constexpr unsigned kMostNodes = 128;  // 7 bits of the periodic byte
inline constexpr unsigned kMostSlots = 4'096;

struct LoopShare {
  unsigned every = 1;                // k: it samples each so many slots
  kernel::Duration period{};         // T_i
  unsigned sensor_offset = 0;        // the first slot in which the sensor samples, under `every`
  unsigned controller_offset = 0;    // the same of the controller
  kernel::Duration longest_delay{};  // of the loop, with these periods
};

struct Allocation {
  kernel::Duration slot{};               // T_1
  std::vector<LoopShare> loops;          // as demanded
  std::vector<unsigned> loads;           // data of each slot, until they repeat
  unsigned windows = 0;                  // gamma
  unsigned fewest = 0;                   // data of a slot, at least
  std::int64_t most_windows = 0;         // gamma that fits the slot; negative: not even the server does
  kernel::Duration rotation{};           // R = N sigma
  kernel::Duration periodic_interval{};  // gamma L_p + N_c L_c + R
  // The longest non-real-time packet; negative where the slot has no room for one.
  kernel::Duration longest_printed{};
  kernel::Duration longest_safe{};
  // With it a real-time packet also goes within T_1 where no periodic datum stops non-real-time packets.
  kernel::Duration longest_for_real_time{};
  // With it data go within T_1 as well while controllers wait for their first datum and slots have fewer.
  kernel::Duration longest_from_start{};

  bool is_feasible() const { return windows <= most_windows; }
  kernel::Duration longest(LengthRule rule) const {
    return rule == LengthRule::printed ? longest_printed : longest_safe;
  }
  // Data of a slot in the mean (sum of 2 / k), and the share of slots that have some.
  double mean_load() const;
  double busy_slots() const;
};

// The longest non-real-time packet with which `data` of a slot are sent within it, whatever the order of the
// nodes.
kernel::Duration longest_beside(const Demand& demand, kernel::Duration slot, unsigned data);

// Throws kernel::Error(configuration) for no loop or more than kMostLoops, more streams than nodes, more than
// kMostNodes, times that are negative, a bound under 3 us and one over 1000 s.
Allocation allocate(const Demand& demand);

// What a bound of the loop delay would need, where the demand is not feasible; each on its own.
struct Remedy {
  std::size_t fastest = 0;                // the loop whose bound makes the slot
  std::optional<kernel::Duration> bound;  // of it, with which the demand is feasible
  std::optional<kernel::Duration> periodic_packet;
  std::optional<kernel::Duration> overhead;
  std::size_t loops_to_leave_out = 0;  // the fastest ones
};
Remedy remedy(const Demand& demand, const Allocation& allocation);

}  // namespace fieldproof::bandwidth

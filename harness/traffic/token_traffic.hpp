#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "harness/kernel/time.hpp"

// Queues and rotations of a token beyond the two priorities and equal nodes of `token_rotation`: three
// priorities, nodes that differ, and a schedule beside the token.
//
// At each node the token costs its overhead, then one packet of each admitted priority goes, urgent first,
// that has arrived by then. A rotation shorter than the target rotation time admits one lower priority in the
// next one, any other withdraws one; urgent packets are always admitted. The first rotation admits all.
// A scheduled item goes at its time. A token is not passed and a packet not begun that would not end by the
// begin of the next item: the token waits for the end of the item, the packet for the next visit.
//
// Without a schedule as much leaves as arrives while all queues are stable, so a mean rotation takes
// R / (1 - U). With one no closed form holds, because the idle time before items depends on what is
// waiting: with the measured share W of it a mean rotation takes R / (1 - U - Us - W).
namespace fieldproof::traffic {

inline constexpr unsigned kTokenPriorities = 3;
enum TokenPriority : unsigned { kUrgent, kNormal, kTimeAvailable };
const char* name_of(TokenPriority priority);

// Packets that arrive as a Poisson stream; none with a rate of 0.
struct PacketStream {
  double per_ms = 0;          // 0, or kLeastPerMs to kMostPerMs
  kernel::Duration length{};  // on the line, to kLongestTokenTime
};

struct TokenNode {
  kernel::Duration overhead{};  // of the token, used or not: 1 ns to kLongestTokenTime
  std::array<PacketStream, kTokenPriorities> streams{};
};

struct ScheduledItem {
  kernel::Duration offset{};  // in the macrocycle
  kernel::Duration length{};
};

enum class TokenRule {
  one_step,       // a rotation admits or withdraws one priority
  all_or_urgent,  // it admits all or only urgent packets, as in the paper
};

struct TokenTraffic {
  std::vector<TokenNode> nodes;  // 1 to kMostTokenNodes
  kernel::Duration idle{};       // once in a rotation, beside the overheads
  kernel::Duration target{};     // TTRT
  TokenRule rule = TokenRule::one_step;
  kernel::Duration macrocycle{};        // of the schedule
  std::vector<ScheduledItem> schedule;  // by offset, none over another or over the end of the macrocycle

  kernel::Duration empty_rotation() const;  // R
  double load() const;                      // U
  double scheduled_load() const;            // Us
};

inline constexpr std::size_t kMostTokenNodes = 64;
inline constexpr std::size_t kMostScheduledItems = 256;
inline constexpr double kLeastPerMs = 1e-6;
inline constexpr double kMostPerMs = 1e3;
inline constexpr kernel::Duration kLongestTokenTime = kernel::kSecond;
inline constexpr kernel::Duration kLongestMacrocycle = 60 * kernel::kSecond;
// What a queue holds; one that gets there grows without end.
inline constexpr std::uint64_t kMostQueued = 50'000;

struct TrafficRun {
  std::uint64_t seed = 1;
  std::uint64_t urgent_packets = 1'000'000;  // that are counted, unless `visits` are over before
  std::uint64_t warm_up_rotations = 10'000;
  std::uint64_t visits = 50'000'000;  // of the token at a node, at most, the warm-up included
  kernel::Duration bound{};           // of which `within` tells
};

struct StreamFigures {
  // More comes than leaves, or nothing does: delays are those of the time simulated, and grow with it.
  bool is_unstable = false;
  std::uint64_t packets = 0;
  std::size_t batches = 0;    // that the standard errors rest on; they are 0 with fewer than 2
  double mean_delay = 0;      // ms, from the arrival to the end of the transmission
  double standard_error = 0;  // of it
  double largest_delay = 0;   // ms
  double within = 0;          // share of packets with a delay up to the bound
  double least_within = 0;    // what it is at least, with 97.5 %
  double arrive_per_ms = 0;   // as configured
  double leave_per_ms = 0;
  std::uint64_t waiting = 0;  // at the end
};

struct TrafficFigures {
  std::vector<std::array<StreamFigures, kTokenPriorities>> nodes;
  // Over all nodes; where a queue of the priority is unstable, only that is told.
  std::array<StreamFigures, kTokenPriorities> all;
  std::uint64_t rotations = 0;
  double mean_rotation = 0;                            // ms
  double longest_rotation = 0;                         // ms
  double rotation_error = 0;                           // standard error of it
  std::array<double, kTokenPriorities> admitted_to{};  // share of rotations, by the lowest admitted priority
  double waits_for_schedule = 0;                       // W, share of time
};

// Throws kernel::Error(configuration) for what is outside of the ranges above, a schedule whose items
// overlap or are not in order, and one that has no room between its items for the token or a packet.
void check(const TokenTraffic& traffic);

// Throws as `check` does; also for a run that counts fewer than 100 urgent packets.
TrafficFigures pass_token(const TokenTraffic& traffic, const TrafficRun& run);

}  // namespace fieldproof::traffic

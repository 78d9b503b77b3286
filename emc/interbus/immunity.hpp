#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "emc/burst_channel.hpp"
#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "harness/fault/channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"

// One immunity run of an INTERBUS network: it comes up on a quiet line, exchanges random process data while
// bursts couple into its remote-bus cables (or a channel of the textbooks disturbs them, to hold the theory
// against), and must be well again when they are over. An end-to-end oracle
// knows what was at the terminals and in the images, and keeps the ledger of errors; the performance
// criterion follows from it.
//
// Contract: deterministic in network, stations, response and settings. The mapping to a criterion is this
// project's own; in words in `text_of`.
//
// Limits: all remote-bus cables lie in the clamp, local-bus segments do not. An output that a station would
// take over in the same cycle in which the master stops the bus is not told from one of the cycle before.
namespace fieldproof::emc {

// Who plays; null: the references.
struct InterbusStations {
  std::function<std::unique_ptr<interbus::MasterDevice>(const interbus::MasterConfiguration&)> make_master;
  interbus::Ring::MakeSlave make_slave;

  bool are_references() const { return make_master == nullptr && make_slave == nullptr; }
};

struct ImmunitySettings {
  BurstSettings bursts;  // `on` and `off` are the run's own
  // Where it is set, each receiver gets one of these instead of the bursts.
  std::function<std::unique_ptr<fault::Channel>(kernel::Random)> make_channel;
  kernel::Duration duration = 60 * kernel::kSecond;
  std::uint64_t seed = 1;
};

enum class Criterion : std::uint8_t { a, b, c, d };
// "A" ..., and what it means here.
std::string_view name(Criterion criterion);
std::string_view text_of(Criterion criterion);

// Cycles are data cycles, counted from the first pulse that can come to the end of the recovery.
struct ErrorLedger {
  std::uint64_t sent = 0;
  std::uint64_t corrupted = 0;  // some receiver got something else than was driven
  std::uint64_t detected = 0;   // rejected by the master
  std::uint64_t repeated = 0;   // ID cycles that followed a rejection
  // Words that an application got and nobody had sent: in the master's input image, at a station's outputs.
  std::uint64_t accepted_wrong_inputs = 0;
  std::uint64_t accepted_wrong_outputs = 0;
  std::uint64_t wrong_cycles = 0;  // with such words, however many
  // Words of good cycles that a station did not put out: it held the ones before.
  std::uint64_t missed_outputs = 0;
  // Words at a station's outputs that became 0, which nobody sends: a reset, after a stop of the bus or a
  // silence.
  std::uint64_t cleared_outputs = 0;
  // Rejected by the master, but a station had taken over its outputs: the words were right.
  std::uint64_t partly_latched = 0;

  std::uint64_t accepted_wrong() const { return accepted_wrong_inputs + accepted_wrong_outputs; }
};

struct ImmunityResult {
  bool came_up = false;  // on the quiet line; nothing else says anything if not
  Criterion criterion = Criterion::d;
  ErrorLedger ledger;
  std::uint64_t longest_bad_run = 0;  // cycles of either kind
  // After the last pulse until a good data cycle that is put out everywhere, that one included.
  std::uint64_t recovery_cycles = 0;
  bool recovered_by_itself = false;
  bool recovered_after_start = false;  // where it did not by itself
  std::uint64_t bus_stops = 0;         // each was followed by a new start
  bool quality_bit = false;            // at any time
  std::uint64_t receivers = 0;         // that were disturbed
  BurstStatistics line;                // sums over them; of a textbook's channel only the transmissions
  kernel::Duration cycle_time{};
};

ImmunityResult run_immunity(const interbus::NetworkDescription& network, const InterbusStations& stations,
                            const LineResponse& response, const ImmunitySettings& settings);

}  // namespace fieldproof::emc

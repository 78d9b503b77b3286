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
#include "protocols/interbus/exchange_oracle.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"

// One immunity run of an INTERBUS network: it comes up on a quiet line, exchanges random process data while
// bursts couple into its remote-bus cables (or a channel of the textbooks disturbs them, to hold the theory
// against), and must be well again when they are over. interbus::ExchangeOracle keeps the ledger of errors;
// the performance criterion follows from it.
//
// Contract: deterministic in network, stations, response and settings. The mapping to a criterion is this
// project's own; in words in `text_of`.
//
// Limits: all remote-bus cables lie in the clamp, local-bus segments do not.
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

struct ImmunityResult {
  bool came_up = false;  // on the quiet line; nothing else says anything if not
  Criterion criterion = Criterion::d;
  interbus::ErrorLedger ledger;       // from the first pulse that can come to the end of the recovery
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

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "emc/burst_channel.hpp"
#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "emc/immunity_course.hpp"
#include "harness/fault/channel.hpp"
#include "harness/fault/plan.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/measure/phase.hpp"
#include "harness/network/exchange_statistics.hpp"
#include "harness/network/network.hpp"

// One immunity run of an installation: it comes up on a quiet line, exchanges random process data while
// bursts couple into its exposed cables (or a channel of the textbooks disturbs them, to hold the theory
// against), and must be well again when they are over. network::ExchangeStatistics counts its errors; the
// performance criterion follows from them.
//
// Contract: deterministic in network, response and settings. The mapping to a criterion is this project's
// own; in words in `text_of`. Whether the network runs, and that it has recovered, is decided by what passes
// on its lines and by what its sinks show, never by what a station reports about itself.
namespace fieldproof::emc {

struct ImmunitySettings {
  BurstSettings bursts;  // `on` and `off` are the run's own
  // Where it is set, each receiver gets one of these instead of the bursts.
  std::function<std::unique_ptr<fault::Channel>(kernel::Random)> make_channel;
  // Where it is set, what is declared is on the lines instead, from when bursts would come on.
  std::optional<fault::Plan> plan{};
  // Where it is set, what a receiver gets through is this, which asks the channel given: to watch it, or to
  // leave out some of what it does.
  std::function<std::unique_ptr<fault::Channel>(fault::Channel&, const network::Place&)> around{};
  kernel::Duration duration = 60 * kernel::kSecond;
  std::uint64_t seed = 1;
  // A run that is asked to stop ends at once, and says so by `is_complete`.
  std::stop_token stop{};
};

enum class Criterion : std::uint8_t { a, b, c, d };
inline constexpr std::array kCriteria = {Criterion::a, Criterion::b, Criterion::c, Criterion::d};
// "A" ..., and what it means here.
std::string_view name(Criterion criterion);
std::string_view text_of(Criterion criterion);

// Times of the cycles of one kind, by what the bursts did meanwhile.
struct CycleTimes {
  network::CycleKind kind;
  measure::PhasedDistribution times{};  // ps
};

struct ImmunityResult {
  bool is_complete = true;
  bool came_up = false;   // on the quiet line; nothing else says anything if not
  std::string complaint;  // where it did not
  Criterion criterion = Criterion::d;
  std::string reason;      // of B, C and D: one word for what decided, however often it happened
  std::string decided_by;  // of C and D: which number, in words
  std::optional<kernel::Time> decided_at;  // when it happened first, where it has an instant
  std::optional<network::WrongWord> first_wrong;
  std::string first_wrong_text;       // "at 1.5 ms 'output ...' got 0x1234, and 0x2345 was sent"; or empty
  kernel::Time on{};                  // bursts may come from here on
  std::uint64_t fingerprint = 0;      // of the trace
  network::ErrorStatistics counts;    // from the first pulse that can come to the end of the recovery
  std::uint64_t longest_bad_run = 0;  // exchanges of either kind that were not served
  // After the last pulse until every signal has been delivered once, that exchange included.
  std::uint64_t recovery_exchanges = 0;
  kernel::Duration recovery_time{};  // as long as these took, the silence before them included
  bool recovered_by_itself = false;
  bool recovered_after_start = false;  // where it did not by itself
  std::uint64_t stops = 0;             // each was followed by a new start
  bool poor_quality = false;           // was reported by its controller at any time
  std::uint64_t receivers = 0;         // that were disturbed
  bool had_a_burst = false;  // one at least came while they were; a textbook's channel is always there
  std::uint64_t bursts = 0;  // that came; 0 on a textbook's channel
  BurstStatistics line;      // sums over them; of a textbook's channel only the transmissions
  std::vector<CycleTimes> cycles;
  ImmunityCourse course;

  // Where not, a criterion says nothing.
  bool was_disturbed() const { return receivers > 0 && had_a_burst; }
};

// Comes up and delivers each signal once without anything on its lines. Empty, or what is wrong: then bursts
// would be blamed for it. Asked to stop, it has no complaint. `network` has not been started.
std::string complaint_on_quiet_line(network::Network& network, std::uint64_t seed, std::stop_token stop = {});

// `network` has not been started.
ImmunityResult run_immunity(network::Network& network, const LineResponse& response,
                            const ImmunitySettings& settings);

}  // namespace fieldproof::emc

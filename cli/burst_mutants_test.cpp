// Subject: what a report of bursts shows of stations that handle errors worse than they should.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "emc/immunity.hpp"
#include "emc/profile.hpp"
#include "emc/random_flips.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::cli {
namespace {

using emc::Criterion;
using emc::ImmunityResult;

// Two stations with a word each on the remote bus, both in the clamp.
interbus::NetworkDescription two_remote_stations() {
  interbus::NetworkDescription network;
  network.name = "two remote stations";
  network.stations = {{.name = "a", .id_code = 0x0103}, {.name = "b", .id_code = 0x0103}};
  return network;
}

// What tells a mutant from the reference, which has none of it.
enum class Sign {
  wrong_data,      // words are accepted wrong: criterion D
  dead,            // it does not work again: criterion D
  cleared,         // outputs become 0
  missed,          // outputs of good cycles are not put out
  not_repeated,    // no ID cycles behind rejected cycles
  stops,           // the bus stops more often
  stops_less,      // or less often, by a twentieth at least
  fewer_rejected,  // of the cycles that were corrupted
};

// Where it shows: under bursts, which hit in clusters, or where single levels flip.
enum class Line { bursts, flips };

struct Row {
  std::string_view mutant;
  Sign sign;
  Line line = Line::bursts;
};

constexpr std::array kOfMasters = {
    Row{"own_check_ignored", Sign::wrong_data},
    Row{"status_word_ignored", Sign::wrong_data},
    Row{"inputs_taken_before_check", Sign::wrong_data},
    Row{"inputs_zeroed_on_error", Sign::wrong_data},
    Row{"no_id_cycle_after_error", Sign::not_repeated},
    Row{"id_cycle_only_claimed", Sign::not_repeated},
    Row{"consecutive_never_cleared", Sign::stops},
    Row{"id_cycles_for_ever_after_error", Sign::stops},
    Row{"stop_one_late", Sign::stops_less, Line::flips},
    Row{"silent_after_error", Sign::dead},
    Row{"telegram_count_ignored", Sign::fewer_rejected, Line::flips},
    Row{"stop_bit_ignored", Sign::fewer_rejected, Line::flips},
};

// Two that the suite catches cannot show in a network whose master behaves, because it sends an ID cycle
// after each rejected one: loses_the_cycle_behind_a_rejected_one, waits_for_id_cycle_after_rejected_cycle.
constexpr std::array kOfSlaves = {
    Row{"latches_in_spite_of_own_error", Sign::wrong_data},
    Row{"latches_at_end_of_data_phase", Sign::wrong_data},
    Row{"does_not_mark_status", Sign::wrong_data},
    Row{"ignores_upstream_status", Sign::wrong_data},
    Row{"clears_mark_of_others", Sign::missed},
    Row{"glitches_outputs_on_rejected_cycle", Sign::wrong_data},
    Row{"clears_outputs_on_rejected_cycle", Sign::cleared},
    Row{"locks_up_after_rejected_cycle", Sign::missed},
    Row{"does_not_resynchronise", Sign::stops},
    Row{"start_bit_not_validated", Sign::stops},
    Row{"compares_first_check_octet_only", Sign::fewer_rejected, Line::flips},
    Row{"stop_bit_not_checked", Sign::fewer_rejected, Line::flips},
};

double rejected_share(const ImmunityResult& result) {
  return static_cast<double>(result.counts.detected) / static_cast<double>(result.counts.corrupted);
}

bool shows(Sign sign, const ImmunityResult& result, const ImmunityResult& reference) {
  switch (sign) {
    case Sign::wrong_data:
      return result.criterion == Criterion::d && result.counts.accepted_wrong() > 0;
    case Sign::dead:
      return result.criterion == Criterion::d && !result.recovered_after_start;
    case Sign::cleared:
      return result.counts.cleared_outputs > reference.counts.cleared_outputs;
    case Sign::missed:
      return result.counts.missed_outputs > reference.counts.missed_outputs;
    case Sign::not_repeated:
      return result.counts.repeated == 0 && reference.counts.repeated > 0;
    case Sign::stops:
      return result.stops > 2 * reference.stops;
    case Sign::stops_less:
      return 20 * result.stops < 19 * reference.stops;
    case Sign::fewer_rejected:
      return rejected_share(result) < rejected_share(reference);
  }
  return false;
}

emc::ImmunityResult run_immunity(Line line, const interbus::RunningStations& stations, std::uint64_t seed) {
  static const emc::LineResponse response(emc::Profile::named("A").coupling);
  emc::ImmunitySettings settings;
  settings.bursts.level = emc::Level::standard(emc::PortKind::signal, 4);
  settings.duration = 30 * kernel::kSecond;
  settings.seed = seed;
  if (line == Line::flips) {
    settings.make_channel = [](kernel::Random random) {
      return std::make_unique<emc::BernoulliChannel>(0.001, random);
    };
  }
  interbus::RunningNetwork network(two_remote_stations(), stations);
  return emc::run_immunity(network, response, settings);
}

// Of flips many runs together: what a mutant rejects less is a hundredth of the corrupted cycles, several
// times what chance makes of so many.
constexpr std::uint64_t kRunsOfFlips = 12;

emc::ImmunityResult run_immunity(Line line, const interbus::RunningStations& stations = {}) {
  emc::ImmunityResult sum = run_immunity(line, stations, 1);
  for (std::uint64_t seed = 2; line == Line::flips && seed <= kRunsOfFlips; ++seed) {
    const emc::ImmunityResult one = run_immunity(line, stations, seed);
    sum.counts.detected += one.counts.detected;
    sum.counts.corrupted += one.counts.corrupted;
    sum.stops += one.stops;
  }
  return sum;
}

// Under a sanitizer the many runs of flips take minutes, and look at no other code.
bool is_left_out(const Row& row) {
  return kernel::kIsSanitized && row.line == Line::flips;
}

const ImmunityResult& reference(Line line) {
  static const ImmunityResult of_bursts = run_immunity(Line::bursts);
  if (line == Line::bursts) return of_bursts;
  static const ImmunityResult of_flips = run_immunity(Line::flips);
  return of_flips;
}

interbus::RunningStations with_master(std::string_view name) {
  return {.make_master = conformance::master_mutants().maker(name)};
}

interbus::RunningStations with_slave(int at, std::string_view name) {
  return {.make_slave = [=](int position, const interbus::SlaveConfiguration& configuration) {
    return position == at ? conformance::slave_mutants().make(name, configuration) : nullptr;
  }};
}

TEST(BurstMutants, ReferencesHaveNoneOfTheSigns) {
  EXPECT_EQ(reference(Line::bursts).criterion, Criterion::b);
  for (const Line line : {Line::bursts, Line::flips}) {
    if (kernel::kIsSanitized && line == Line::flips) continue;
    EXPECT_EQ(reference(line).counts.accepted_wrong(), 0U);
    // A missing stop level of the last telegram of a cycle marks nothing: its slave holds its outputs, and
    // the master hears of no error.
    EXPECT_LT(100 * reference(line).counts.missed_outputs, reference(line).counts.repeated);
    EXPECT_GT(reference(line).counts.repeated, 0U);
  }
}

TEST(BurstMutants, MastersAreSeen) {
  for (kernel::FewerIfSanitized few(3); const Row& row : kOfMasters) {
    if (is_left_out(row) || few.leaves_out()) continue;
    EXPECT_TRUE(shows(row.sign, run_immunity(row.line, with_master(row.mutant)), reference(row.line)))
        << row.mutant;
  }
}

TEST(BurstMutants, SlavesAreSeenAtOneOfTheTwoPlaces) {
  for (kernel::FewerIfSanitized few(3); const Row& row : kOfSlaves) {
    if (is_left_out(row) || few.leaves_out()) continue;
    const auto is_seen = [&](int at) {
      return shows(row.sign, run_immunity(row.line, with_slave(at, row.mutant)), reference(row.line));
    };
    EXPECT_TRUE(is_seen(1) || is_seen(2)) << row.mutant;
  }
}

}  // namespace
}  // namespace fieldproof::cli

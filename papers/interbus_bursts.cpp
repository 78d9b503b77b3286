// The section of Park 2004 about bursts: what the model of an installation without and with a proper shield
// makes of the levels that the paper tested.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "emc/immunity.hpp"
#include "emc/profile.hpp"
#include "harness/kernel/random.hpp"
#include "papers/sections.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::papers {
namespace {

using emc::Polarity;
using emc::Repetition;
using reports::PublishedRow;
using reports::PublishedSection;

constexpr double kLowestVolts = 1000;
constexpr double kHighestVolts = 4500;
constexpr double kStepVolts = 500;
// Edition 1 of the standard has 2.5 kHz instead of 5 kHz from here on.
constexpr double kSlowFromVolts = 4000;
constexpr int kShareOfTime = 12;  // one of the many runs of this section has this part of a signal's time

// What all runs of one voltage came to: the worst of them, and their sums.
struct AtVoltage {
  emc::Criterion worst = emc::Criterion::a;
  std::uint64_t sent = 0;
  std::uint64_t rejected = 0;
  std::uint64_t accepted_wrong = 0;
  std::uint64_t longest_bad_run = 0;

  void add(const emc::ImmunityResult& result) {
    worst = std::max(worst, result.criterion);
    sent += result.counts.sent;
    rejected += result.counts.detected;
    accepted_wrong += result.counts.accepted_wrong();
    longest_bad_run = std::max(longest_bad_run, result.longest_bad_run);
  }
};

class BurstTest {
 public:
  BurstTest(const Settings& settings, const emc::Profile& profile)
      : network_(interbus::paper_network()), response_(profile.coupling) {
    network_.cycle_time = interbus::kPaperBestCycle;
    immunity_.duration = settings.duration / kShareOfTime;
    immunity_.seed = settings.seed;
  }

  AtVoltage at(double volts) {
    AtVoltage sum;
    const bool is_slow = volts >= kSlowFromVolts;
    for (const Repetition repetition :
         {is_slow ? Repetition::khz_2_5_edition_1 : Repetition::khz_5, Repetition::khz_100}) {
      for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
        immunity_.bursts.level = emc::Level::free(volts);
        immunity_.bursts.repetition = repetition;
        immunity_.bursts.polarity = polarity;
        immunity_.seed = kernel::Random(immunity_.seed).split("run").seed();
        interbus::RunningNetwork network(network_);
        sum.add(emc::run_immunity(network, response_, immunity_));
      }
    }
    return sum;
  }
  kernel::Duration duration() const { return immunity_.duration; }

 private:
  interbus::NetworkDescription network_;
  emc::LineResponse response_;
  emc::ImmunitySettings immunity_;
};

double seconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / 1e12;
}

std::string told(const AtVoltage& sum) {
  return fmt::format("{}: {:.2f} % of {} cycles rejected, {} wrong words accepted", emc::name(sum.worst),
                     100 * static_cast<double>(sum.rejected) / static_cast<double>(sum.sent), sum.sent,
                     sum.accepted_wrong);
}

}  // namespace

PublishedSection interbus_bursts(const Settings& settings) {
  PublishedSection section;
  section.heading = "Bursts of IEC 61000-4-4 on the remote-bus cable: 1000 to 4500 V";
  section.note =
      "The paper shows pictures with almost no distortion and prints neither a count of errors nor the "
      "repetition "
      "rate, polarity, shield or time. The levels of the model are uncalibrated.";
  const emc::Profile& open = emc::Profile::named("A");
  const emc::Profile& shielded = emc::Profile::named("C");
  BurstTest without(settings, open);
  BurstTest with(settings, shielded);
  bool is_all_quiet = true;
  for (double volts = kLowestVolts; volts <= kHighestVolts; volts += kStepVolts) {
    const AtVoltage bare = without.at(volts);
    const AtVoltage bonded = with.at(volts);
    is_all_quiet = is_all_quiet && bonded.worst == emc::Criterion::a;
    section.rows.push_back(
        {fmt::format("{} V, {}", volts, open.title), "", told(bare),
         fmt::format("longest run of bad cycles {}; worst of 2 rates and 2 polarities, {:.3g} s each",
                     bare.longest_bad_run, seconds(without.duration())),
         std::nullopt});
    section.rows.push_back(
        {fmt::format("{} V, {}", volts, shielded.title), "", told(bonded), "", std::nullopt});
  }
  section.rows.push_back(
      {fmt::format("all levels, {}", shielded.title), "pictures with almost no distortion",
       is_all_quiet ? "no cycle was rejected" : "cycles were rejected",
       "a picture has no number, and that the laboratory's cable was shielded so is a reading of ours",
       std::nullopt});
  return section;
}

}  // namespace fieldproof::papers

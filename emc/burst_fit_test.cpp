#include "emc/burst_fit.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "emc/profile.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kGain = 1.7;
constexpr double kStrength = 0.6;

const BurstModel& model() {
  static const BurstModel kModel(Profile::named("A").coupling, 182, 500'000);
  return kModel;
}

using ShareOf = std::function<double(const CountedFrames&)>;

double truth(const CountedFrames& row) {
  return model().corrupted(row, kGain, kStrength);
}

// A minute of frames at each condition.
std::vector<CountedFrames> conditions() {
  std::vector<CountedFrames> rows;
  for (const double volts : {20.0, 40.0, 60.0, 125.0, 250.0, 500.0, 1000.0, 2000.0}) {
    for (const Repetition repetition : {Repetition::khz_5, Repetition::khz_100}) {
      for (const Polarity polarity : {Polarity::positive, Polarity::negative})
        rows.push_back({volts, repetition, polarity, 60, 73'640, 0, 0});
    }
  }
  return rows;
}

std::vector<CountedFrames> counted(const ShareOf& share_of, kernel::Random random) {
  std::vector<CountedFrames> rows = conditions();
  for (CountedFrames& row : rows) {
    const double share = share_of(row);
    if (share <= 0) continue;
    for (std::uint64_t at = random.geometric(share); at < row.frames; at += 1 + random.geometric(share))
      ++row.bad;
  }
  return rows;
}

// In so many of a hundred.
int contradicted(const ShareOf& share_of) {
  constexpr int kCampaigns = kernel::kIsSanitized ? 10 : 100;
  int count = 0;
  for (std::uint64_t n = 0; n < kCampaigns; ++n)
    count +=
        model().fit(counted(share_of, kernel::Random(n).split("wrong"))).verdict == FitVerdict::contradicts;
  return count * 100 / kCampaigns;
}

// Of 1000 campaigns 959 and 945 held the truth.
TEST(BurstFit, ItsIntervalsHoldTheTruthAndTheModelIsConsistent) {
  constexpr int kCampaigns = kernel::kIsSanitized ? 20 : 200;
  constexpr int kLeast = kCampaigns * (kernel::kIsSanitized ? 80 : 93) / 100;
  int gain = 0;
  int strength = 0;
  int consistent = 0;
  for (int n = 0; n < kCampaigns; ++n) {
    const BurstFit fit =
        model().fit(counted(truth, kernel::Random(static_cast<std::uint64_t>(n)).split("true")));
    gain += fit.gain.holds(kGain) ? 1 : 0;
    strength += fit.strength.holds(kStrength) ? 1 : 0;
    consistent += fit.verdict == FitVerdict::consistent ? 1 : 0;
    EXPECT_LT(fit.gain.to / fit.gain.from, 2) << "narrow enough to say something";
    EXPECT_LT(fit.strength.to / fit.strength.from, 1.5);
  }
  EXPECT_GE(gain, kLeast);
  EXPECT_GE(strength, kLeast);
  EXPECT_GE(consistent, kLeast);
}

TEST(BurstFit, ErrorsThatDoNotFollowTheLevelContradict) {
  EXPECT_GE(contradicted([](const CountedFrames& row) {
              CountedFrames at = row;
              at.volts = 500;
              return truth(at);
            }),
            95);
}

TEST(BurstFit, ErrorsThatDoNotFollowTheRepetitionContradict) {
  EXPECT_GE(contradicted([](const CountedFrames& row) {
              CountedFrames at = row;
              at.repetition = Repetition::khz_5;
              return truth(at);
            }),
            95);
}

TEST(BurstFit, ErrorsThatComeByThemselvesContradict) {
  EXPECT_GE(contradicted([](const CountedFrames&) { return 0.002; }), 95);
}

TEST(BurstFit, OneConditionLeavesTheParametersOpen) {
  std::vector<CountedFrames> one = counted(truth, kernel::Random(1));
  one.resize(one.size() / 2 + 1);
  one.erase(one.begin(), one.end() - 1);
  const BurstFit fit = model().fit(one);
  EXPECT_EQ(fit.verdict, FitVerdict::open);
  EXPECT_TRUE(fit.gain.is_open_above || fit.strength.is_open_above);
  EXPECT_NEAR(fit.expected.front(), static_cast<double>(one.front().bad), 0.01 * fit.expected.front() + 1);
}

TEST(BurstFit, NoErrorAtAllIsNoContradiction) {
  const BurstFit fit = model().fit(conditions());
  EXPECT_NE(fit.verdict, FitVerdict::contradicts);
  EXPECT_TRUE(fit.gain.is_open_below);
}

TEST(BurstFit, CountsWhereNoneCanBeContradict) {
  std::vector<CountedFrames> rows = conditions();
  for (CountedFrames& row : rows) row.bad = row.volts < 100 ? 500 : 0;
  EXPECT_EQ(model().fit(rows).verdict, FitVerdict::contradicts);
}

}  // namespace
}  // namespace fieldproof::emc

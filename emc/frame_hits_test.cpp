#include "emc/frame_hits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "emc/effective_time.hpp"

namespace fieldproof::emc {
namespace {

// Wrong for both levels: such a time flips any level that is sampled in it.
WrongOutput wrong_for(std::int64_t nanoseconds) {
  const Interval interval{kernel::Duration{}, nanoseconds * 1000 * kernel::kPicosecond};
  return {{{{interval}, {interval}}}};
}

// The figures of closed_forms_test: frames of 182 levels at 500 kbit/s, one sample, an output that is forced
// to a level.
TEST(FrameHits, HaveTheClosedFormsOfWholeLines) {
  struct Row {
    Repetition repetition;
    std::int64_t nanoseconds;
    double corrupted;
  };
  for (const Row& row : {Row{Repetition::khz_5, 100, 0.0022}, Row{Repetition::khz_5, 300, 0.0066},
                         Row{Repetition::khz_5, 1000, 0.02}, Row{Repetition::khz_100, 100, 0.0017},
                         Row{Repetition::khz_100, 300, 0.0028}}) {
    WrongOutput forced = wrong_for(row.nanoseconds);
    forced.of_level[1].clear();
    const double chance = chance_of_hit(forced, line::kMidBit, 500'000);
    const FrameHits hits(182, 500'000, row.repetition);
    EXPECT_NEAR(hits.corrupted(-std::log1p(-chance)), row.corrupted, row.corrupted * 0.05)
        << row.nanoseconds << " " << text_of(row.repetition);
  }
}

TEST(FrameHits, AShortWrongTimeHitsAsOftenAsItFlips) {
  for (const auto& sampling : {line::kMidBit, line::kMajorityOfThree}) {
    for (const std::int64_t nanoseconds : {100, 150, 300, 1000}) {
      const WrongOutput wrong = wrong_for(nanoseconds);
      EXPECT_NEAR(chance_of_hit(wrong, sampling, 500'000), flips_per_pulse(wrong, sampling, 500'000), 0.005)
          << nanoseconds;
    }
  }
  EXPECT_EQ(chance_of_hit(wrong_for(4000), line::kMidBit, 500'000), 1);
  WrongOutput forced = wrong_for(4000);
  forced.of_level[0].clear();
  EXPECT_EQ(chance_of_hit(forced, line::kMidBit, 500'000), 0.75) << "two levels, right when both are zero";
  EXPECT_EQ(chance_of_hit(WrongOutput{}, line::kMidBit, 500'000), 0);
}

TEST(FrameHits, GrowWithStrengthUpToTheFramesThatMeetAPulse) {
  const FrameHits hits(182, 500'000, Repetition::khz_5);
  EXPECT_EQ(hits.corrupted(0), 0);
  double before = 0;
  for (double strength = 0.01; strength < 20; strength *= 2) {
    EXPECT_GT(hits.corrupted(strength), before);
    before = hits.corrupted(strength);
  }
  EXPECT_NEAR(before, (75 * 0.2 + 0.164) / 300, 0.0003) << "75 pulses in 15 ms, each 300 ms, and a frame";
  EXPECT_LE(FrameHits(100'000'000, 1000, Repetition::khz_100).corrupted(1e9), 1);
}

}  // namespace
}  // namespace fieldproof::emc

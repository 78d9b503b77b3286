#include "harness/line/sampling.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace fieldproof::line {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;
using kernel::Time;

constexpr std::int64_t kBitRate = 62'500;  // 16 us per bit, 1 us per sixteenth

// A line that is low in [from, to), told in levels of one picosecond's grid: low exactly there.
Waveform low_between(Duration from, Duration to) {
  Waveform wave;
  wave.start = kStart + from;
  wave.rate = 1'000'000'000'000 / (to - from).count();
  wave.levels.append(0, 1);
  return wave;
}

TEST(Sampling, TakesTheMajorityOfSevenEightAndNineSixteenths) {
  const Sampling majority;
  // Low over exactly one of the three samples, over two, over all.
  EXPECT_TRUE(majority.sample(low_between(7 * kMicrosecond, 8 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_FALSE(majority.sample(low_between(7 * kMicrosecond, 9 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_FALSE(majority.sample(low_between(8 * kMicrosecond, 10 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_TRUE(majority.sample(low_between(9 * kMicrosecond, 10 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_FALSE(majority.sample(low_between(Duration{0}, 16 * kMicrosecond), kStart, 0, kBitRate));
}

TEST(Sampling, TakesOneSampleInTheMiddle) {
  const Sampling single{Sampling::Kind::mid_bit};
  EXPECT_FALSE(single.sample(low_between(8 * kMicrosecond, 9 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_TRUE(single.sample(low_between(7 * kMicrosecond, 8 * kMicrosecond), kStart, 0, kBitRate));
  EXPECT_TRUE(
      single.sample(low_between(8 * kMicrosecond + kPicosecond, 16 * kMicrosecond), kStart, 0, kBitRate));
}

TEST(Sampling, LooksForTheNextEdgeBehindTheLastIdleSample) {
  const Sampling majority;
  const Time idle_at_nine =
      majority.idle_seen_at(low_between(Duration{0}, 7 * kMicrosecond), kStart, kBitRate);
  EXPECT_EQ(idle_at_nine, kStart + 9 * kMicrosecond);
  const Waveform low_at_nine = low_between(9 * kMicrosecond, 10 * kMicrosecond);
  EXPECT_EQ(majority.idle_seen_at(low_at_nine, kStart, kBitRate), kStart + 8 * kMicrosecond);
}

TEST(Sampling, FindsFallingEdges) {
  Levels levels;
  levels.append(0b0011, 4);
  levels.append_idle(64);
  levels.append(0b10, 2);
  EXPECT_EQ(falling_edge(levels, 0), 2U);
  EXPECT_EQ(falling_edge(levels, 2), 2U);
  EXPECT_EQ(falling_edge(levels, 3), 68U) << "level 3 continues a low line, it is no edge";
  EXPECT_EQ(falling_edge(levels, 69), 70U);
}

RC_GTEST_PROP(Sampling, AgreesWithAskingForEachSample, ()) {
  Waveform wave;
  wave.start = kStart + Duration{*rc::gen::inRange<std::int64_t>(0, 50'000'000)};
  wave.rate = *rc::gen::inRange<std::int64_t>(30'000, 3'000'000);
  for (const bool level : *rc::gen::arbitrary<std::vector<bool>>()) wave.levels.append(level ? 1 : 0, 1);
  const Time edge = kStart + Duration{*rc::gen::inRange<std::int64_t>(0, 100'000'000)};
  const auto bit = *rc::gen::inRange(0U, 12U);
  const auto at = [&](unsigned sixteenth) {
    return int{wave.at(Sampling::instant(edge, bit, sixteenth, kBitRate))};
  };
  RC_ASSERT(Sampling{}.sample(wave, edge, bit, kBitRate) == (at(7) + at(8) + at(9) >= 2));
}

// On a grid of whole picoseconds, where instants are exact, levels and instants tell the same.
RC_GTEST_PROP(Sampler, SeesInLevelsWhatInstantsTell, ()) {
  const auto sixteenth = *rc::gen::element<std::int64_t>(1, 2, 5, 10);  // levels
  Waveform wave;
  wave.start = kStart + 3 * kMicrosecond;
  wave.rate = kBitRate * 16 * sixteenth;
  for (const bool level : *rc::gen::arbitrary<std::vector<bool>>()) {
    wave.levels.append_fill(level, *rc::gen::inRange<std::size_t>(0, 40));
  }
  wave.levels.append(0, 1);
  const Sampling sampling{*rc::gen::element(Sampling::Kind::majority_of_three, Sampling::Kind::mid_bit)};
  const auto edge = *rc::gen::inRange<std::size_t>(0, wave.levels.size());
  const auto bit = *rc::gen::inRange(0U, 12U);
  const Time start = wave.time_of(edge);
  Sampler sampler(wave, sampling, kBitRate);
  sampler.start(edge);
  RC_ASSERT(sampler.sample(bit) == sampling.sample(wave, start, bit, kBitRate));
  RC_ASSERT(sampler.is_decided(bit) == (sampling.decided_at(start, bit, kBitRate) <= wave.end()));
  RC_ASSERT(sampler.behind(bit) == wave.first_level_at(sampling.decided_at(start, bit, kBitRate)));
  RC_ASSERT(sampler.idle_seen() == wave.first_level_at(sampling.idle_seen_at(wave, start, kBitRate)));
}

RC_GTEST_PROP(Sampling, FindsTheEdgeThatASlowSearchFinds, (const std::vector<bool>& bits)) {
  Levels levels;
  for (const bool level : bits) levels.append(level ? 1 : 0, 1);
  const auto from = *rc::gen::inRange<std::size_t>(0, bits.size() + 1);
  std::size_t expected = from;
  while (expected < bits.size() && (bits[expected] || (expected > 0 && !bits[expected - 1]))) ++expected;
  RC_ASSERT(falling_edge(levels, from) == expected);
}

}  // namespace
}  // namespace fieldproof::line

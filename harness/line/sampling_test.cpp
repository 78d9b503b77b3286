#include "harness/line/sampling.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace fieldproof::line {
namespace {

constexpr std::int64_t kSampledRate = 62'500;  // 16 us per bit, 1 us per sixteenth

// A line with one level per sixteenth of a bit, low in [from, to).
Waveform low_between(std::size_t from, std::size_t to) {
  Waveform wave;
  wave.rate = 16 * kSampledRate;
  wave.levels.append_idle(64);
  wave.levels.fill(from, to, false);
  return wave;
}

bool first_bit(const Sampling& sampling, const Waveform& wave) {
  Sampler sampler(sampling, kSampledRate);
  sampler.look_at(wave);
  sampler.start(0);
  return sampler.sample(0);
}

TEST(Sampling, TakesTheMajorityOfSevenEightAndNineSixteenths) {
  // Low over exactly one of the three samples, over two, over all.
  EXPECT_TRUE(first_bit({}, low_between(7, 8)));
  EXPECT_FALSE(first_bit({}, low_between(7, 9)));
  EXPECT_FALSE(first_bit({}, low_between(8, 10)));
  EXPECT_TRUE(first_bit({}, low_between(9, 10)));
  EXPECT_FALSE(first_bit({}, low_between(0, 16)));
}

TEST(Sampling, TakesOneSampleInTheMiddle) {
  EXPECT_FALSE(first_bit(kMidBit, low_between(8, 9)));
  EXPECT_TRUE(first_bit(kMidBit, low_between(7, 8)));
  EXPECT_TRUE(first_bit(kMidBit, low_between(9, 16)));
}

TEST(Sampling, LooksForTheNextEdgeBehindTheLastIdleSample) {
  Sampler sampler({}, kSampledRate);
  const Waveform idle_at_nine = low_between(0, 7);
  sampler.look_at(idle_at_nine);
  sampler.start(0);
  EXPECT_EQ(sampler.idle_seen(), 9U);
  const Waveform low_at_nine = low_between(9, 10);
  sampler.look_at(low_at_nine);
  EXPECT_EQ(sampler.idle_seen(), 8U);
}

TEST(Sampling, DecidesWithTheLastSample) {
  const kernel::Time edge = kernel::kStart + 3 * kernel::kMicrosecond;
  EXPECT_EQ(Sampling{}.decided_at(edge, 2, kSampledRate), edge + (32 + 9) * kernel::kMicrosecond);
  EXPECT_EQ(kMidBit.decided_at(edge, 2, kSampledRate), edge + (32 + 8) * kernel::kMicrosecond);
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

// The definition, in whole numbers: level n after the edge begins at n / rate, a sample is taken at
// sixteenths / (16 * bit rate).
struct SlowSampler {
  std::int64_t rate;
  std::int64_t begins(std::int64_t level) const { return level * 16 * kSampledRate; }
  std::int64_t taken(unsigned bit, unsigned sixteenth) const {
    return static_cast<std::int64_t>(bit * 16 + sixteenth) * rate;
  }
  // The level that begins at or before the sample.
  std::size_t level(unsigned bit, unsigned sixteenth) const {
    std::int64_t n = 0;
    while (begins(n + 1) <= taken(bit, sixteenth)) ++n;
    return static_cast<std::size_t>(n);
  }
  // The first that begins at or after it.
  std::size_t behind(unsigned bit, unsigned sixteenth) const {
    std::int64_t n = 0;
    while (begins(n) < taken(bit, sixteenth)) ++n;
    return static_cast<std::size_t>(n);
  }
};

RC_GTEST_PROP(Sampler, SeesWhatTheDefinitionTells, ()) {
  Waveform wave;
  wave.rate = *rc::gen::oneOf(
      rc::gen::inRange<std::int64_t>(10'000, 3'000'000),
      rc::gen::map(rc::gen::inRange<std::int64_t>(1, 40), [](std::int64_t n) { return n * kSampledRate; }),
      rc::gen::map(rc::gen::inRange<std::int64_t>(1, 12),
                   [](std::int64_t n) { return n * 16 * kSampledRate; }));
  for (const bool level : *rc::gen::arbitrary<std::vector<bool>>()) {
    wave.levels.append_fill(level, *rc::gen::inRange<std::size_t>(0, 40));
  }
  wave.levels.append(0, 1);
  const Sampling sampling{*rc::gen::element(Sampling::Kind::majority_of_three, Sampling::Kind::mid_bit)};
  const auto edge = *rc::gen::inRange<std::size_t>(0, wave.levels.size());
  const auto bit = *rc::gen::inRange(0U, Sampler::kMostBits);
  const SlowSampler slow{wave.rate};
  const auto at = [&](unsigned n, unsigned sixteenth) {
    return wave.levels[edge + slow.level(n, sixteenth)];
  };
  const auto within = [&](std::size_t place) { return std::min(edge + place, wave.levels.size()); };
  Sampler sampler(sampling, kSampledRate);
  Waveform other;  // that it had looked at before
  other.rate = *rc::gen::inRange<std::int64_t>(10'000, 3'000'000);
  sampler.look_at(other);
  sampler.look_at(wave);
  sampler.start(edge);
  const bool is_single = sampling.kind == Sampling::Kind::mid_bit;
  const unsigned last = is_single ? 8 : 9;
  RC_ASSERT(sampler.sample(bit) ==
            (is_single ? at(bit, 8) : int{at(bit, 7)} + int{at(bit, 8)} + int{at(bit, 9)} >= 2));
  RC_ASSERT(sampler.is_decided(bit) == (edge + slow.behind(bit, last) <= wave.levels.size()));
  RC_ASSERT(sampler.behind(bit) == within(slow.behind(bit, last)));
  RC_ASSERT(sampler.idle_seen() == within(slow.behind(0, at(0, last) ? last : 8)));
}

// 208 sixteenths times the rate have more than 64 bits.
TEST(Sampler, BearsTheFastestLine) {
  constexpr std::int64_t kFastest = (std::int64_t{1} << 59) - 1;
  Waveform wave;
  wave.rate = 4 * kFastest;  // four levels to a bit
  wave.levels.append(0, 2);
  wave.levels.append_idle(60);
  Sampler sampler({}, kFastest);
  sampler.look_at(wave);
  sampler.start(0);
  EXPECT_TRUE(sampler.sample(0)) << "7/16 lies in level 1, 8/16 and 9/16 in level 2";
  EXPECT_EQ(sampler.behind(12), 51U) << "12 9/16 bits";
  EXPECT_TRUE(sampler.is_decided(14));
  EXPECT_FALSE(sampler.is_decided(15));
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

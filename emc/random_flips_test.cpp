#include "emc/random_flips.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

line::Waveform wave_of(std::size_t bits) {
  line::Waveform wave;
  wave.rate = 500'000;
  wave.levels.append_idle(bits);
  return wave;
}

// The bits that a channel flips, counted over all transmissions.
std::vector<std::uint64_t> flips_of(fault::Channel& channel, const std::vector<std::size_t>& sizes) {
  std::vector<std::uint64_t> flips;
  std::uint64_t passed = 0;
  for (const std::size_t size : sizes) {
    line::Waveforms arrivals;
    const line::Waveform sent = wave_of(size);
    if (channel.pass(sent, arrivals)) {
      EXPECT_EQ(arrivals.size(), 1U);
      for (std::size_t n = 0; n < size; ++n) {
        if (!arrivals.front().levels[n]) flips.push_back(passed + n);
      }
    } else {
      EXPECT_TRUE(arrivals.empty());
    }
    passed += size;
  }
  return flips;
}

// ---- the binary symmetric channel ----

TEST(BernoulliChannelTest, FlipsAsManyBitsAsItsProbabilitySays) {
  for (const double p : {1e-4, 1e-2, 0.3}) {
    BernoulliChannel channel(p, kernel::Random(1));
    constexpr std::size_t kBits = 2'000'000;
    const auto flips = flips_of(channel, std::vector<std::size_t>(2000, 1000));
    EXPECT_EQ(channel.flipped_bits(), flips.size());
    const double expected = p * kBits;
    EXPECT_NEAR(static_cast<double>(flips.size()), expected, 4.5 * std::sqrt(expected * (1 - p))) << p;
  }
}

TEST(BernoulliChannelTest, NeverAndAlways) {
  BernoulliChannel never(0, kernel::Random(1));
  EXPECT_TRUE(flips_of(never, {1, 1000, 0, 64}).empty());
  BernoulliChannel always(1, kernel::Random(1));
  EXPECT_EQ(flips_of(always, {1, 100, 0, 64}).size(), 165U);
}

// Where the line is divided into transmissions makes no difference.
RC_GTEST_PROP(BernoulliChannelProperty, TheDivisionIntoTransmissionsDoesNotMatter, ()) {
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  const double p = *rc::gen::element(0.001, 0.05, 0.5, 0.99);
  auto sizes = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, 300));
  std::size_t total = 0;
  for (const std::size_t size : sizes) total += size;
  BernoulliChannel divided(p, random);
  BernoulliChannel whole(p, random);
  RC_ASSERT(flips_of(divided, sizes) == flips_of(whole, {total}));
}

TEST(BernoulliChannelTest, RefusesWhatIsNoProbability) {
  for (const double p : {-0.001, 1.001, std::nan("")}) {
    EXPECT_THROW(BernoulliChannel(p, kernel::Random(1)), kernel::Error) << p;
  }
}

// ---- Gilbert and Elliott ----

// The definition, bit by bit.
struct BitByBit {
  double bad_share;
  double error_rate;
  double mean_bad_sojourn;
};

BitByBit observe(const GilbertElliott& parameters, std::uint64_t bits) {
  GilbertElliottProcess process(parameters, kernel::Random(3));
  std::uint64_t bad = 0;
  std::uint64_t errors = 0;
  std::uint64_t sojourns = 0;
  bool was_bad = false;
  for (std::uint64_t n = 0; n < bits; ++n) {
    const bool is_bad = process.is_bad();
    bad += is_bad;
    sojourns += is_bad && !was_bad;
    was_bad = is_bad;
    errors += process.next_flip(1).has_value();
  }
  const auto all = static_cast<double>(bits);
  return {static_cast<double>(bad) / all, static_cast<double>(errors) / all,
          static_cast<double>(bad) / static_cast<double>(sojourns)};
}

TEST(GilbertElliottTest, HasTheShareTheErrorRateAndTheSojournOfItsFormulas) {
  for (const GilbertElliott& parameters :
       {GilbertElliott{0.001, 0.02, 0, 0.5}, GilbertElliott{0.01, 0.05, 0.003, 0.1}}) {
    const BitByBit observed = observe(parameters, 4'000'000);
    EXPECT_NEAR(observed.bad_share / parameters.bad_share(), 1, 0.05);
    EXPECT_NEAR(observed.error_rate / parameters.bit_error_rate(), 1, 0.05);
    EXPECT_NEAR(observed.mean_bad_sojourn * parameters.to_good, 1, 0.05);
  }
}

RC_GTEST_PROP(GilbertElliottProperty, TheDivisionIntoQuestionsDoesNotMatter, ()) {
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  const GilbertElliott parameters{*rc::gen::element(0.0, 0.01, 1.0), *rc::gen::element(0.1, 1.0),
                                  *rc::gen::element(0.0, 0.01), *rc::gen::element(0.5, 1.0)};
  constexpr std::uint64_t kBits = 3000;
  const auto flips = [&](const std::vector<std::uint64_t>& steps) {
    GilbertElliottProcess process(parameters, random);
    std::vector<std::uint64_t> positions;
    std::uint64_t passed = 0;
    for (std::size_t n = 0; passed < kBits; ++n) {
      const std::uint64_t step = steps.empty() ? kBits : 1 + steps.at(n % steps.size());
      const std::uint64_t bits = std::min(step, kBits - passed);
      const auto flip = process.next_flip(bits);
      if (flip) positions.push_back(passed + *flip);
      passed += flip ? *flip + 1 : bits;
    }
    return positions;
  };
  const auto steps = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 100));
  RC_ASSERT(flips(steps) == flips({}));
}

// What is skipped has the state that it would have if it were walked through, bit by bit.
TEST(GilbertElliottTest, SkippingIsWalking) {
  for (const GilbertElliott& parameters : {GilbertElliott{0.02, 0.1, 0, 0}, GilbertElliott{0.9, 0.8, 0, 0}}) {
    for (const std::uint64_t bits : {1U, 2U, 3U, 7U, 30U}) {
      constexpr int kWays = 20'000;
      int bad_of_skipped = 0;
      int bad_of_walked = 0;
      for (int n = 0; n < kWays; ++n) {
        const kernel::Random random = kernel::Random(1).split(static_cast<std::uint64_t>(n));
        GilbertElliottProcess skipped(parameters, random);
        GilbertElliottProcess walked(parameters, random.split("another"));
        // Those that begin in the bad state.
        while (!skipped.is_bad()) skipped.next_flip(1);
        while (!walked.is_bad()) walked.next_flip(1);
        skipped.skip(bits);
        walked.next_flip(bits);
        bad_of_skipped += skipped.is_bad() ? 1 : 0;
        bad_of_walked += walked.is_bad() ? 1 : 0;
      }
      EXPECT_NEAR(bad_of_skipped, bad_of_walked, 4.5 * std::sqrt(kWays / 2)) << bits;
    }
  }
}

TEST(GilbertElliottTest, RefusesWhatHasNoShare) {
  EXPECT_THROW(GilbertElliottProcess({0, 0, 0, 0.5}, kernel::Random(1)), kernel::Error);
  EXPECT_THROW(GilbertElliottProcess({-0.1, 0.5, 0, 0.5}, kernel::Random(1)), kernel::Error);
  EXPECT_THROW(GilbertElliottProcess({0.1, 0.5, 0, 1.5}, kernel::Random(1)), kernel::Error);
  EXPECT_NO_THROW(GilbertElliottProcess({0, 1, 0, 0.5}, kernel::Random(1)));
}

// A bad time of a second is over after a pause of hours, though no bit was sent in it.
TEST(GilbertElliottChannelTest, IdleTimePasses) {
  const GilbertElliott parameters{1e-9, 2e-6, 0, 1};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    GilbertElliottChannel channel(parameters, kernel::Random(seed));
    int changes = 0;
    bool was_hit = false;
    for (int n = 0; n < 2000; ++n) {
      line::Waveform wave = wave_of(100);
      wave.start = kernel::kStart + n * 3600 * kernel::kSecond;
      line::Waveforms arrivals;
      const bool is_hit = channel.pass(wave, arrivals);
      changes += is_hit && was_hit;
      was_hit = is_hit;
    }
    // The share of the bad state is 1 in 2000: two of two thousand in a row would be the same bad time.
    EXPECT_LE(changes, 1) << seed;
  }
}

// ---- bit lists ----

BitListChannel::Positions list(std::vector<BitListChannel::Position> positions) {
  return std::make_shared<const std::vector<BitListChannel::Position>>(std::move(positions));
}

TEST(BitListChannelTest, FlipsExactlyTheBitsOfTheList) {
  BitListChannel channel(list({{0, 0}, {0, 99}, {2, 0}, {2, 5}}));
  EXPECT_EQ(flips_of(channel, {100, 100, 100, 100}), (std::vector<std::uint64_t>{0, 99, 200, 205}));
  EXPECT_EQ(channel.flipped_bits(), 4U);
  EXPECT_EQ(channel.missed_bits(), 0U);
}

TEST(BitListChannelTest, CountsWhatLiesBehindTheEnd) {
  BitListChannel channel(list({{0, 100}, {1, 99}, {1, 100}}));
  EXPECT_EQ(flips_of(channel, {100, 100}), std::vector<std::uint64_t>{199});
  EXPECT_EQ(channel.missed_bits(), 2U);
}

}  // namespace
}  // namespace fieldproof::emc

#include "emc/burst_stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "emc/burst_channel.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kStart;
using kernel::Time;

constexpr std::int64_t kStressedRate = 500'000;

class BurstStress : public testing::Test {
 protected:
  // Which transmissions of ten bits, sent end to end around `from`, were changed.
  std::vector<Time> changes(const fault::Stress& stress, Time from, std::uint64_t seed) {
    const auto channel = stress.make_channel(
        {kStressedRate, from, kernel::Random(seed), trace_, trace_.add_channel("receiver")});
    std::vector<Time> changed;
    line::Waveform sent;
    sent.rate = kStressedRate;
    sent.levels.append(0b0101010101, 10);
    line::Waveforms arrivals;
    for (sent.start = from - 2 * kMillisecond; sent.start < from + stress.duration + 10 * kMillisecond;
         sent.start = sent.end()) {
      arrivals.clear();
      if (channel->pass(sent, arrivals)) changed.push_back(sent.start);
    }
    return changed;
  }

  trace::Trace trace_;
};

TEST_F(BurstStress, IsOneBurstThatBeginsWhereItIsWanted) {
  const Time from = kStart + 777 * kMillisecond;
  for (const fault::Stress& stress : catalogue_stresses()) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::vector<Time> changed = changes(stress, from, seed);
      ASSERT_FALSE(changed.empty()) << stress.name << " of seed " << seed;
      EXPECT_GE(changed.front(), from - 20 * kMicrosecond) << stress.name;
      EXPECT_LE(changed.back(), from + stress.duration) << stress.name;
    }
  }
}

TEST_F(BurstStress, IsAFunctionOfItsStream) {
  const fault::Stress stress = catalogue_stresses().front();
  EXPECT_EQ(changes(stress, kStart, 3), changes(stress, kStart, 3));
  EXPECT_NE(changes(stress, kStart, 3), changes(stress, kStart, 4));
}

TEST_F(BurstStress, OfAQuietInstallationChangesNothing) {
  const std::array levels{Level::standard(PortKind::signal, 4)};
  for (const fault::Stress& stress : burst_stresses(Profile::named("C"), levels)) {
    EXPECT_TRUE(changes(stress, kStart, 1).empty()) << stress.name;
  }
}

TEST_F(BurstStress, HasEveryCombinationOnce) {
  const std::array levels{Level::standard(PortKind::signal, 1), Level::free(3000)};
  const auto stresses = burst_stresses(Profile::named("A"), levels);
  ASSERT_EQ(stresses.size(), 8U);
  EXPECT_EQ(stresses.front().name, "a burst of 5 kHz, +, level 1 (250 V), profile A");
  EXPECT_EQ(stresses.back().name, "a burst of 100 kHz, -, level X (3000 V), profile A");
}

}  // namespace
}  // namespace fieldproof::emc

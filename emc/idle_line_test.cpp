// Subject: what a receiver would see of a burst on an idle line, of which no channel is asked: how much the
// limit of burst_channel.hpp leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "emc/profile.hpp"
#include "harness/line/sampling.hpp"

namespace fieldproof::emc {
namespace {

// The highest level of a signal port, and of a power port.
constexpr std::array kStrongVolts = {2000.0, 4000.0};
constexpr std::array kBothPolarities = {Polarity::positive, Polarity::negative};
constexpr kernel::Duration kLone{};  // the pitch of a pulse that comes alone

// Relative to the first pulse of a train.
bool is_low(const std::vector<Interval>& lows, kernel::Duration pitch, kernel::Duration time) {
  for (kernel::Duration pulse{}; pulse + lows.front().from <= time; pulse += pitch) {
    const auto holds = [&](const Interval& low) { return time - pulse >= low.from && time - pulse < low.to; };
    if (std::ranges::any_of(lows, holds)) return true;
    if (pitch == kLone) break;
  }
  return false;
}

// Whether a receiver that validates its start bit takes one of the edges of the first pulse for one.
bool takes_a_start(const std::vector<Interval>& lows, kernel::Duration pitch, std::int64_t bit_rate) {
  return std::ranges::any_of(lows, [&](const Interval& edge) {
    int low = 0;
    for (const unsigned sixteenth : {7U, 8U, 9U}) {
      const kernel::Time sample = line::Sampling::instant(kernel::kStart + edge.from, 0, sixteenth, bit_rate);
      low += is_low(lows, pitch, sample - kernel::kStart) ? 1 : 0;
    }
    return low >= 2;
  });
}

// The times in which an idle line is received as low, around one pulse; of each level and polarity.
std::vector<std::vector<Interval>> all_low_times(const Profile& profile) {
  const LineResponse response(profile.coupling);
  std::vector<std::vector<Interval>> all;
  for (const double volts : kStrongVolts) {
    for (const Polarity polarity : kBothPolarities) {
      auto lows = response.wrong_output(volts, polarity).of_level[1];
      if (!lows.empty()) all.push_back(std::move(lows));
    }
  }
  return all;
}

kernel::Duration longest_low(std::string_view profile) {
  kernel::Duration longest{};
  for (const std::vector<Interval>& lows : all_low_times(Profile::named(profile))) {
    for (const Interval& low : lows) longest = std::max(longest, low.to - low.from);
  }
  return longest;
}

bool takes_a_lone_start(std::string_view profile, std::int64_t bit_rate) {
  return std::ranges::any_of(all_low_times(Profile::named(profile)),
                             [bit_rate](const auto& lows) { return takes_a_start(lows, kLone, bit_rate); });
}

constexpr std::array<std::int64_t, 9> kUartRates = {1'200,  2'404,  4'808,   10'417, 20'833,
                                                    31'250, 62'500, 375'000, 500'000};

// Up to the rate of INTERBUS a low time ends before the first sample of a start bit, 7/16 bit after its edge.
TEST(IdleLine, NoStartBitComesOutOfALonePulse) {
  for (const Profile& profile : Profile::built_in()) {
    for (const std::vector<Interval>& lows : all_low_times(profile)) {
      for (const std::int64_t bit_rate : kUartRates)
        EXPECT_FALSE(takes_a_start(lows, kLone, bit_rate)) << profile.name << " " << bit_rate;
    }
  }
}

// The next pulse comes 8.3 to 12.5 us later: only where the samples lie a whole number of pitches apart, and
// after the edge, does it make up for what the first one lacks.
TEST(IdleLine, OneComesOutOf100KilohertzOnSlowLinesOnly) {
  std::map<std::int64_t, bool> is_taken;
  for (const Profile& profile : Profile::built_in()) {
    for (const std::vector<Interval>& lows : all_low_times(profile)) {
      for (const std::int64_t bit_rate : kUartRates) {
        for (int per_mille = 800; per_mille <= 1200 && !is_taken[bit_rate]; ++per_mille)
          is_taken[bit_rate] = takes_a_start(lows, 10'000 * kernel::kMicrosecond / per_mille, bit_rate);
      }
    }
  }
  for (const std::int64_t bit_rate : kUartRates) EXPECT_EQ(is_taken[bit_rate], bit_rate < 4'000) << bit_rate;
}

// So where a line is faster, or its receiver does not validate, the limit leaves characters out.
TEST(IdleLine, OneComesOutOfItOnAFasterUnshieldedLine) {
  EXPECT_TRUE(takes_a_lone_start("A", 1'000'000));
  EXPECT_FALSE(takes_a_lone_start("B", 1'000'000));
  EXPECT_TRUE(takes_a_lone_start("D", 2'000'000));
  EXPECT_GT(longest_low("A"), 690 * kernel::kNanosecond);
  EXPECT_LT(longest_low("A"), 700 * kernel::kNanosecond);
}

// Of Manchester code a receiver counts the half bits of a run, rounded. In the profiles of IEC 61158-2 a
// pulse is less than half of one; in that of the token bus at 10 Mbit/s it is one or two, which is something
// on the line.
TEST(IdleLine, HalfBitsComeOutOfItOnTheTokenBusOnly) {
  const auto half_bits = [](std::string_view profile, std::int64_t bit_rate) {
    return static_cast<double>(longest_low(profile).count()) /
           static_cast<double>(kernel::levels_duration(1, 2 * bit_rate).count());
  };
  EXPECT_LT(half_bits("E2", 31'250), 0.02);
  EXPECT_LT(half_bits("F", 1'000'000), 0.2);
  EXPECT_GT(half_bits("D", 10'000'000), 1.0);
  EXPECT_LT(half_bits("D", 10'000'000), 2.0);
}

}  // namespace
}  // namespace fieldproof::emc

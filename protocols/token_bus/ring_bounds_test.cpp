#include "protocols/token_bus/ring_bounds.hpp"

#include <gtest/gtest.h>

namespace fieldproof::token_bus {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

constexpr kernel::Duration kOctet = 1'600 * kernel::kNanosecond;
// A token: 4 octets of preamble, 2 delimiters, 9 octets, and a gap of 6; a datum of 5 octets has 26.
constexpr std::int64_t kToken = 21;
constexpr std::int64_t kWord = 26;
// Two frames for each station, a window of 28 octets, and one more of the lowest.
constexpr std::int64_t passes(std::int64_t stations) {
  return stations * (2 * kToken + 28) + 28;
}

RingDescription ring_of(std::vector<RingData> data) {
  RingDescription ring{.name = "bounds", .stations = {2, 4, 6}, .data = std::move(data)};
  return ring;
}

TEST(RingBounds, OfAWordUnderEachTokenAreTheirSum) {
  const RingBounds bounds = bounds_of(RingDescription::built_in(4));
  EXPECT_EQ(bounds.rotation, (passes(4) + 4 * kWord) * kOctet);
  EXPECT_EQ(bounds.access[0], (passes(4) + 5 * kWord) * kOctet);
  EXPECT_EQ(least_rotation(RingDescription::built_in(4)), 4 * kToken * kOctet);
}

TEST(RingBounds, OfAPeriodCountTwoDataInARound) {
  const RingBounds bounds = bounds_of(ring_of({{.from = 2, .to = 4, .every = 10 * kMillisecond}}));
  EXPECT_EQ(bounds.rotation, (passes(3) + 2 * kWord) * kOctet);
  EXPECT_EQ(bounds.access[0], (passes(3) + 4 * kWord) * kOctet);
}

TEST(RingBounds, OfAPeriodShorterThanTwoRoundsAreTheHoldTime) {
  RingDescription ring = ring_of({{.from = 2, .to = 4, .every = 200 * kMicrosecond}});
  ring.rules.high_priority_hold_octets = 300;
  const RingBounds bounds = bounds_of(ring);
  EXPECT_EQ(bounds.rotation, (passes(3) + 300 + kWord) * kOctet);
  EXPECT_FALSE(bounds.access[0]);
}

TEST(RingBounds, OfALoadInALowerClassAreItsTargetTime) {
  RingDescription ring =
      ring_of({{.from = 2, .to = 4},
               {.from = 2, .to = 4, .service = RingService::periodic, .every = 100 * kMillisecond},
               {.from = 4, .to = 2, .service = RingService::bulk, .load = 1'000, .octets = 1'000}});
  ring.rules.target_rotation_octets = {20'000, 0, 5'000};
  const RingBounds bounds = bounds_of(ring);
  // The station with urgent data need not be the one that sends last.
  constexpr std::int64_t kRound = 5'000 + (kToken + 1'000) + passes(3) + kWord + 2 * kWord;
  EXPECT_EQ(bounds.rotation, kRound * kOctet);
  EXPECT_EQ(bounds.access[0], (kRound + kWord) * kOctet);
  EXPECT_EQ(bounds.access[1], (kRound + 2 * kWord) * kOctet);
  EXPECT_FALSE(bounds.access[3]) << "a load has none";
  ring.rules.target_rotation_octets = {6'000, 0, 5'000};
  EXPECT_FALSE(bounds_of(ring).access[1]) << "a round may leave it no time";
}

TEST(RingBounds, OfConfirmedDataHoldTheResponse) {
  const RingBounds bounds =
      bounds_of(ring_of({{.from = 2, .to = 4, .service = RingService::confirmed, .every = kernel::kSecond}}));
  // Three slot times, and a response with 3 octets that has no gap of its own in them.
  constexpr std::int64_t kConfirmed = kWord + 3 * 28 + (15 + 3);
  EXPECT_EQ(bounds.rotation, (passes(3) + 2 * kConfirmed) * kOctet);
  EXPECT_EQ(bounds.access[2], (passes(3) + 4 * kConfirmed) * kOctet);
}

}  // namespace
}  // namespace fieldproof::token_bus

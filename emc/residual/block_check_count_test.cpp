#include "emc/residual/block_check_count.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

std::vector<BigCount> big(const std::vector<std::uint64_t>& counts) {
  return {counts.begin(), counts.end()};
}

TEST(BlockCheckCount, OfAllPatternsOfThreeOctetsIsExact) {
  const BlockCheck check{3, false};
  const std::array<std::uint8_t, 2> message{0xF0, 0x0F};
  const std::vector<std::uint64_t> counted = count_block_check_patterns(check, check.bits(), message);
  EXPECT_EQ(big(counted), undetected_patterns(check, check.bits()));
  EXPECT_EQ(counted[2], 24U);
  EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), std::uint64_t{0}), 1U << 16);
}

TEST(BlockCheckCount, OfAllPatternsOfThreeOctetsWithParityIsExact) {
  const BlockCheck check{3, true};
  const std::vector<std::uint64_t> counted = count_block_check_patterns(check, check.bits());
  EXPECT_EQ(big(counted), undetected_patterns(check, check.bits()));
  EXPECT_EQ(counted[4], 108U);
}

TEST(BlockCheckCount, OfSixFlipsInFiveOctetsIsExact) {
  const std::array<std::uint8_t, 4> message{0x63, 0x01, 0xA5, 0x3C};
  for (const bool has_parity : {false, true}) {
    const BlockCheck check{5, has_parity};
    const std::vector<std::uint64_t> counted = count_block_check_patterns(check, 6, message);
    EXPECT_EQ(big(counted), undetected_patterns(check, 6)) << has_parity;
    EXPECT_EQ(counted[2], has_parity ? 0U : 80U);
    EXPECT_EQ(counted[4], has_parity ? 360U : 2840U);
  }
}

// The check is linear: what passes is no matter of the frame that was sent.
RC_GTEST_PROP(BlockCheckCount, IsTheSameForEveryFrame, ()) {
  const unsigned octets = *rc::gen::inRange(1U, 8U);
  const BlockCheck check{octets, *rc::gen::arbitrary<bool>()};
  const auto message =
      *rc::gen::container<std::vector<std::uint8_t>>(octets - 1, rc::gen::arbitrary<std::uint8_t>());
  const unsigned flips = *rc::gen::inRange(0U, 5U);
  RC_ASSERT(big(count_block_check_patterns(check, flips, message)) == undetected_patterns(check, flips));
}

// [calc] A burst of up to 8 data bits hides nowhere; of length 9 it hides only as two flips in one column;
// longer ones hide as noise does.
TEST(BlockCheckCount, BurstsHideFromNineBitsOn) {
  for (const unsigned octets : {3U, 5U}) {
    for (unsigned length = 1; length <= 16; ++length) {
      const CountedBursts bursts = count_block_check_bursts({octets, false}, length);
      const std::uint64_t places = 8 * octets - length + 1;
      EXPECT_EQ(bursts.patterns, places << (length < 3 ? 0 : length - 2));
      const std::uint64_t one_in = length <= 8 ? 0 : length == 9 ? 128 : 256;
      EXPECT_EQ(bursts.undetected, one_in == 0 ? 0 : bursts.patterns / one_in) << length;
    }
  }
  // All places and lengths together are all patterns that pass but the one without a flip.
  std::uint64_t undetected = 0;
  for (unsigned length = 1; length <= 24; ++length) {
    undetected += count_block_check_bursts({3, false}, length).undetected;
  }
  EXPECT_EQ(undetected, (1U << 16) - 1);
}

// With parity the two rows and two columns of a rectangle have to lie in the burst: 9 bits and one.
TEST(BlockCheckCount, BurstsHideFromElevenBitsOnBehindParity) {
  for (unsigned length = 1; length <= 14; ++length) {
    const CountedBursts bursts = count_block_check_bursts({5, true}, length);
    EXPECT_EQ(bursts.undetected == 0, length < 11) << length;
  }
}

TEST(BlockCheckCount, RefusesWhatItCannotTry) {
  EXPECT_THROW(count_block_check_patterns({8, false}, 2), kernel::Error);
  EXPECT_THROW(count_block_check_patterns({0, false}, 2), kernel::Error);
  EXPECT_THROW(count_block_check_patterns({5, false}, 40), kernel::Error);
  EXPECT_THROW(count_block_check_patterns({5, false}, 2, std::array<std::uint8_t, 5>{}), kernel::Error);
  EXPECT_THROW(count_block_check_bursts({5, false}, 0), kernel::Error);
  EXPECT_THROW(count_block_check_bursts({5, false}, 41), kernel::Error);
  EXPECT_THROW(count_block_check_bursts({5, false}, 36), kernel::Error);
  // More flips than bits: nothing passes.
  EXPECT_EQ(count_block_check_patterns({1, false}, 10),
            (std::vector<std::uint64_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace fieldproof::emc

#include "emc/frame_residual.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "emc/interbus/undetected_cycle.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::emc {
namespace {

// One station of one word: 48 bits, so that the code words of each weight can be counted one by one.
interbus::NetworkDescription one_word() {
  interbus::NetworkDescription network;
  network.stations.push_back({.name = "a", .id_code = 0x0103, .cable_m = 0, .is_local = false, .branch = {}});
  return network;
}

FrameResidual residual_of(const interbus::NetworkDescription& network, kernel::Duration distance) {
  network::ProtectedFrame frame = interbus::RunningNetwork(network).protected_frames().front();
  frame.distance = distance;
  return frame_residual(frame);
}

TEST(FrameResidual, ProtectsLoopbackWordDataAndCheck) {
  EXPECT_EQ(residual_of(one_word(), kernel::kMillisecond).bits, 48U);
  EXPECT_EQ(residual_of(interbus::paper_network(), kernel::kMillisecond).bits, 64U);
  EXPECT_EQ(residual_of(one_word(), kernel::kMillisecond).frame_check, "CRC-16/IBM-3740");
}

// Four flips pass when the remainders of their places add up to nothing. All such fours are counted here;
// words of six flips and more are a small part at this rate.
TEST(FrameResidual, IsThatOfTheLightestCodeWordsWhereFlipsAreRare) {
  constexpr unsigned kMessage = 32;
  constexpr std::uint32_t kPolynomial = 0x11021;
  std::vector<std::uint32_t> remainders;
  std::uint32_t remainder = 1;
  for (unsigned n = 0; n < kMessage + 16; ++n) {
    remainders.push_back(remainder);
    remainder <<= 1;
    if ((remainder & 0x10000) != 0) remainder ^= kPolynomial;
  }
  std::uint64_t weight_four = 0;
  const std::size_t bits = remainders.size();
  for (std::size_t a = 0; a < bits; ++a)
    for (std::size_t b = a + 1; b < bits; ++b)
      for (std::size_t c = b + 1; c < bits; ++c)
        for (std::size_t d = c + 1; d < bits; ++d)
          if ((remainders[a] ^ remainders[b] ^ remainders[c] ^ remainders[d]) == 0) ++weight_four;
  ASSERT_GT(weight_four, 0U);
  const double p = 1e-2;
  const double of_four =
      static_cast<double>(weight_four) * std::pow(p, 4) * std::pow(1 - p, static_cast<double>(bits) - 4);
  const double exact = residual_of(one_word(), kernel::kMillisecond).probability_at_one_in_100;
  EXPECT_GT(exact, of_four);
  EXPECT_LT(exact, 1.3 * of_four);
}

TEST(FrameResidual, IsPerHourWhatItIsPerCycle) {
  const FrameResidual slow = residual_of(one_word(), 2 * kernel::kMillisecond);
  const FrameResidual fast = residual_of(one_word(), kernel::kMillisecond);
  EXPECT_DOUBLE_EQ(fast.rate_per_hour, 2 * slow.rate_per_hour);
  EXPECT_DOUBLE_EQ(fast.rate_per_hour, 3'600'000 * fast.probability_at_one_in_100);
  EXPECT_EQ(residual_of(one_word(), kernel::Duration{}).rate_per_hour, 0);
}

// A random word passes once in 2^16; there is always a rate at which it is no less.
TEST(FrameResidual, WorstShareIsAtLeastThatOfRandomWords) {
  for (const auto& network : {one_word(), interbus::paper_network()}) {
    const FrameResidual residual = residual_of(network, kernel::kMillisecond);
    EXPECT_GE(residual.worst_share, 0.99 / 65536);
    EXPECT_LT(residual.worst_share, 1e-3);
    EXPECT_GT(residual.worst_ber, 0);
  }
}

TEST(FrameResidual, AMovedEndOfTheDataPassesOneTimeIn256OrAlways) {
  const PassingShifts shifts = passing_shifts(interbus::paper_network());
  EXPECT_DOUBLE_EQ(shifts.early_check, 1.0 / 256);
  EXPECT_EQ(shifts.late_check, 0) << "the cycle lacks an octet of its status word then";
  const PassingShifts as_printed = passing_shifts(interbus::paper_network_as_printed());
  EXPECT_DOUBLE_EQ(as_printed.early_check, 1.0 / 256);
  EXPECT_EQ(as_printed.late_check, 1) << "end telegrams are taken for it";
  EXPECT_DOUBLE_EQ(undetected_cycle(interbus::paper_network(), 0.001).by_shift, 0.001 / 256);
  EXPECT_EQ(undetected_cycle(interbus::paper_network(), 0).any(), 0);
}

// Any two flips in one column of an exclusive or pass it.
TEST(FrameResidual, AnExclusiveOrLetsMuchMorePass) {
  const FrameResidual residual = frame_residual({"response", "", 24, kernel::kMillisecond});
  EXPECT_GT(residual.worst_share, 0.03);
  EXPECT_NEAR(residual.probability_at_one_in_100, 24 * 1e-4 * 0.8, 3e-4);
}

TEST(FrameResidual, ChanceOfACountIsThatOfThePoissonDistribution) {
  EXPECT_DOUBLE_EQ(chance_of_at_least(0, 0.1), 1);
  EXPECT_DOUBLE_EQ(chance_of_at_least(1, 0), 0);
  EXPECT_NEAR(chance_of_at_least(1, 0.1), 1 - std::exp(-0.1), 1e-12);
  EXPECT_NEAR(chance_of_at_least(3, 2), 1 - std::exp(-2.0) * (1 + 2 + 2), 1e-12);
}

}  // namespace
}  // namespace fieldproof::emc

#include "emc/exponential.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::emc {
namespace {

TEST(ExponentialTest, AgreesWithTheLibraryToAFewUnitsInTheLastPlace) {
  for (double x = -690; x < 690; x += 0.37) {
    EXPECT_NEAR(portable_exp(x) / std::exp(x), 1, 1e-15) << x;
  }
  for (double x = -0.4; x < 0.4; x += 0.001) EXPECT_NEAR(portable_exp(x) / std::exp(x), 1, 4e-16) << x;
}

TEST(ExponentialTest, EndsWhereItsTypeEnds) {
  EXPECT_EQ(portable_exp(0), 1);
  EXPECT_EQ(portable_exp(-701), 0);
  EXPECT_GT(portable_exp(-700), 0);
  EXPECT_THROW(portable_exp(701), kernel::BrokenInvariant);
}

TEST(ExponentialTest, PowersAndDecibels) {
  for (double x = 0.01; x < 300; x *= 1.3) EXPECT_NEAR(portable_power(x, 1.8) / std::pow(x, 1.8), 1, 2e-14);
  EXPECT_EQ(voltage_factor(0), 1);
  EXPECT_NEAR(voltage_factor(20), 0.1, 1e-16);
  EXPECT_NEAR(voltage_factor(58), std::pow(10, -2.9), 1e-17);
}

}  // namespace
}  // namespace fieldproof::emc

#include "emc/pulse_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emc/profile.hpp"

namespace fieldproof::emc {
namespace {

double largest(const std::vector<double>& volts) {
  double most = 0;
  for (const double one : volts)
    if (std::abs(one) > std::abs(most)) most = one;
  return most;
}

TEST(PulsePictureTest, ShowsThePeaksOfTheModelWithTheirSign) {
  const Coupling coupling = Profile::named("A").coupling;
  const LineResponse response(coupling);
  for (const auto polarity : {Polarity::positive, Polarity::negative}) {
    const PulsePicture picture = picture_of(response, 1'000, polarity);
    EXPECT_EQ(picture.generator_v.size(), picture.receiver_v.size());
    EXPECT_NEAR(largest(picture.generator_v), 1'000.0 * static_cast<double>(polarity), 10);
    const double decibels = coupling.shield_db + coupling.imbalance_db;
    const double peak = 1'000 * response.differential_peak() * std::pow(10, -decibels / 20);
    EXPECT_NEAR(std::abs(largest(picture.receiver_v)), peak, peak * 0.01);
    EXPECT_EQ(picture.wrong.of_level, response.wrong_output(1'000, polarity).of_level);
  }
}

TEST(PulsePictureTest, GoesOnUntilNothingOfThePulseIsLeft) {
  for (const char* const profile : {"A", "B", "C", "D", "E"}) {
    const LineResponse response(Profile::named(profile).coupling);
    const PulsePicture picture = picture_of(response, 2'000, Polarity::positive);
    EXPECT_LE(picture.receiver_v.size(), kMostValues) << profile;
    EXPECT_LE(std::abs(picture.receiver_v.back()), 0.011 * std::abs(largest(picture.receiver_v))) << profile;
    const auto until = picture.step * static_cast<std::int64_t>(picture.receiver_v.size());
    EXPECT_GE(until, picture.wrong.hull().to) << profile;
  }
}

TEST(PulsePictureTest, BelowTheThresholdNothingIsWrong) {
  const LineResponse response(Profile::named("A").coupling);
  const double threshold = response.threshold_volts();
  EXPECT_TRUE(picture_of(response, 0.98 * threshold, Polarity::positive).wrong.empty());
  EXPECT_FALSE(picture_of(response, 1.05 * threshold, Polarity::negative).wrong.empty());
}

}  // namespace
}  // namespace fieldproof::emc

#include "protocols/token_bus/ring_recovery.hpp"

#include <gtest/gtest.h>

#include "protocols/token_bus/ring_network.hpp"

namespace fieldproof::token_bus {
namespace {

TEST(RingRecovery, IsWithinWhatTheTimersAllow) {
  for (unsigned n = 0; n < kDisturbances; ++n) {
    for (const bool has_bursts : {false, true}) {
      const auto disturbance = static_cast<Disturbance>(n);
      const RecoveryFigures figures =
          recover(disturbance, {.stations = 4, .instants = 20, .has_bursts = has_bursts});
      EXPECT_EQ(figures.whole_after.count(), 20U) << text_of(disturbance);
      EXPECT_TRUE(figures.is_as_allowed())
          << text_of(disturbance) << figures.beyond << figures.delivered_twice << figures.out_of_order;
      EXPECT_LE(figures.longest_double, slots(Rules{}, 1)) << text_of(disturbance);
      EXPECT_GT(figures.delivered, 20U * 4U) << text_of(disturbance);
    }
  }
}

TEST(RingRecovery, EqualSettingsGiveEqualFigures) {
  const RecoverySettings settings{.stations = 3, .instants = 5, .has_bursts = true, .seed = 9};
  const RecoveryFigures first = recover(Disturbance::station_dies, settings);
  const RecoveryFigures second = recover(Disturbance::station_dies, settings);
  EXPECT_EQ(first.whole_after.max(), second.whole_after.max());
  EXPECT_EQ(first.delivered, second.delivered);
  RecoverySettings other = settings;
  other.seed = 10;
  EXPECT_NE(recover(Disturbance::station_dies, other).delivered, first.delivered);
}

TEST(RingRecovery, TwoTokensAreSeenWhereNobodyDropsHis) {
  const RecoveryFigures figures =
      recover(Disturbance::token_doubled, {.stations = 4, .instants = 10, .seed = 2, .drops_tokens = false});
  EXPECT_GT(figures.longest_double, slots(Rules{}, 1));
}

TEST(RingRecovery, SixteenStationsFormARing) {
  const kernel::Duration time = time_to_form(16, Rules{});
  EXPECT_GT(time, kernel::Duration{});
  EXPECT_LT(time, kernel::kSecond);
}

}  // namespace
}  // namespace fieldproof::token_bus

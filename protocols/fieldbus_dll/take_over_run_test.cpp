#include "protocols/fieldbus_dll/take_over_run.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/campaign.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

class TakeOverAtRandomInstants : public testing::TestWithParam<double> {};

TEST_P(TakeOverAtRandomInstants, IsByTheLowestLinkMasterInTimeAndAlone) {
  const kernel::Duration octet = kernel::levels_duration(8, 31'250);
  for (std::uint64_t seed = 1; seed <= kernel::campaign_count("FIELDPROOF_INSTANTS", 200); ++seed) {
    const TakeOver found = run_take_over(
        {.seed = seed, .disturb = losing_frames(GetParam(), kernel::Random(seed).split("losses"))});
    ASSERT_EQ(found.claimer, 0x11) << seed;
    ASSERT_EQ(found.claims, 1U) << seed;
    ASSERT_GE(found.silence, take_over_silence()) << seed;
    ASSERT_LE(found.silence, take_over_silence() + octet) << seed;
    ASSERT_EQ(found.foreign_frames, 0U) << seed;
    ASSERT_LE(found.not_compelled, found.due_meanwhile) << seed;
    if (GetParam() == 0) {
      ASSERT_EQ(found.not_published, 0U) << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(QuietAndWithLoss, TakeOverAtRandomInstants, testing::Values(0.0, 0.05));

}  // namespace
}  // namespace fieldproof::fieldbus_dll

#include "conformance/interbus/slave_sequence.hpp"

#include <gtest/gtest.h>

#include "conformance/interbus/suite.hpp"
#include "conformance/sequence_check.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

SequenceSearchResult check_slave(const std::string& uri, std::uint64_t cases, std::uint64_t seed = 1) {
  static const std::unique_ptr<Suite> suite = interbus_suite();
  SequenceSearch one;
  one.suite = suite.get();
  one.role = &slave_sequence_role();
  one.setup.seed = seed;
  one.setup.implementations = {{"slave", 0, uri}};
  one.cases = cases;
  return search(one);
}

TEST(SlaveSequence, TheReferenceFollowsTheModel) {
  constexpr std::uint64_t kCases = kernel::kIsSanitized ? 100 : 400;
  for (kernel::FewerIfSanitized few(3); const std::uint64_t seed : {1U, 2U, 3U}) {
    if (few.leaves_out()) continue;
    EXPECT_EQ(check_slave("ref", kCases, seed).passed, kCases) << seed;
  }
}

TEST(SlaveSequence, FindsSlavesThatARejectedCycleChanges) {
  for (const char* name : {"locks_up_after_rejected_cycle", "waits_for_id_cycle_after_rejected_cycle"}) {
    const SequenceSearchResult result = check_slave(std::string("mutant:") + name, 1'000);
    ASSERT_TRUE(result.found) << name;
    EXPECT_LE(result.found->smallest.commands.size(), 3U) << name;
  }
}

// Each of another coding than usual, of inputs that move, of a bridge, and of a situation.
TEST(SlaveSequence, FindsWhatOnlyASettingASignalOrASituationShows) {
  for (const char* name : {"select_level_hard_coded", "header_places_hard_coded", "status_clean_hard_coded",
                           "control_reset_hard_coded", "message_check_error_hard_coded", "tears_inputs",
                           "tears_between_input_words", "ignores_the_bridge", "reset_ends_outgoing_reset"}) {
    EXPECT_TRUE(check_slave(std::string("mutant:") + name, 1'000).found) << name;
  }
}

TEST(SlaveSequence, TwoCodingsThatNeedOnePlaceAreObjectedTo) {
  const SequenceVocabulary& slave = slave_sequence_role().vocabulary;
  EXPECT_FALSE(slave.objection_to({{"select_place", 1}}));
  EXPECT_FALSE(slave.objection_to({{"select_place", 1}, {"control_place", 2}}));
  EXPECT_TRUE(slave.objection_to({{"select_place", 1}, {"control_place", 1}}));
  EXPECT_TRUE(slave.objection_to({{"control_remote_off", 0x8000}, {"control_reset", 0x8000}}));
}

TEST(SlaveSequence, FindsASlaveThatLatchesABrokenCycle) {
  const SequenceSearchResult result = check_slave("mutant:latches_in_spite_of_own_error", 1'000);
  ASSERT_TRUE(result.found);
  EXPECT_LE(result.found->smallest.commands.size(), 2U);
  EXPECT_EQ(result.found->outcome.result.reason, "outputs_wrong");
}

}  // namespace
}  // namespace fieldproof::conformance

#include "conformance/token_bus/station_sequence.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "conformance/sequence_check.hpp"
#include "conformance/token_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

SequenceSearchResult searched(const std::string& uri, std::uint64_t cases, std::uint64_t seed = 1) {
  static const std::unique_ptr<Suite> suite = token_bus_suite();
  SequenceSearch one;
  one.suite = suite.get();
  one.role = &token_station_sequence_role();
  one.setup.seed = seed;
  one.setup.implementations = {{"station", 0, uri}};
  one.cases = cases;
  return search(one);
}

TEST(TokenStationSequence, TheReferenceFollowsItsTwin) {
  for (const std::uint64_t seed : {1U, 2U}) {
    constexpr std::uint64_t kCases = kernel::kIsSanitized ? 100 : 500;
    const SequenceSearchResult result = searched("ref", kCases, seed);
    EXPECT_FALSE(result.found.has_value());
    EXPECT_EQ(result.passed, kCases);
  }
}

// Each of these shows in a situation of its own, most of them with a setting.
TEST(TokenStationSequence, FindsWhatShowsInASituation) {
  const std::string_view names[]{
      "noise_is_success",          "range_of_low_bits", "windows_not_drawn",
      "last_claim_always_short",   "fault_unreported",  "timers_begin_with_the_token",
      "response_to_another_taken", "zero_is_no_limit",  "blanks_always",
      "low_control_bits_only",     "low_pairs_first",   "group_answers"};
  for (kernel::FewerIfSanitized few(6); const std::string_view name : names) {
    if (few.leaves_out()) continue;
    EXPECT_TRUE(searched("mutant:" + std::string(name), 2'000).found) << name;
  }
}

TEST(TokenStationSequence, FindsEachStationForCheckWithFewCommands) {
  const auto suite = token_bus_suite();
  for (kernel::FewerIfSanitized few(9); const Mutant& mutant : suite->mutants()) {
    if (!mutant.is_for_check || mutant.role != "station" || few.leaves_out()) continue;
    const SequenceSearchResult result = searched("mutant:" + mutant.name, 2'000);
    ASSERT_TRUE(result.found) << mutant.name;
    EXPECT_TRUE(result.found->is_confirmed) << mutant.name;
    // A series, or a frame that others follow, is several in one command.
    EXPECT_GE(result.found->smallest.commands.size(), 1U) << mutant.name;
    EXPECT_LE(result.found->smallest.commands.size(), 5U) << mutant.name;
  }
}

}  // namespace
}  // namespace fieldproof::conformance

// Subject: the cases of the joined catalogue that need bursts, which no suite alone has.
#include <gtest/gtest.h>

#include "cli/protocols.hpp"
#include "conformance/catalogue.hpp"
#include "conformance/runner.hpp"
#include "conformance/stressed_receiver.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

using conformance::Catalogue;
using conformance::Entry;

std::vector<Entry> burst_cases() {
  static const Catalogue catalogue(built_in_suites());
  return catalogue.select(std::vector<std::string>{"+" + std::string(conformance::kStressTag)});
}

conformance::CaseRun run_burst_case(const Entry& entry, const std::string& uri, std::uint64_t seed,
                                    int position = 0) {
  conformance::Setup setup;
  setup.seed = seed;
  setup.volume = conformance::Volume::quick;
  setup.implementations = {{entry.test_case->role(), position, uri}};
  return conformance::run_case(entry, setup);
}

TEST(BurstCases, ReferencesPass) {
  ASSERT_EQ(burst_cases().size(), 13U);
  for (const Entry& entry : burst_cases()) {
    for (std::uint64_t seed = 1; seed <= (kernel::kIsSanitized ? 1U : 20U); ++seed) {
      const judge::CaseResult result = run_burst_case(entry, "ref", seed).outcome.result;
      EXPECT_TRUE(result.verdict == judge::Verdict::pass || result.verdict == judge::Verdict::warn)
          << result.id << " seed " << seed << ": " << result.reason;
    }
  }
}

TEST(BurstCases, CatchWhatTheyDeclare) {
  for (const Entry& entry : burst_cases()) {
    EXPECT_FALSE(entry.test_case->catches.empty());
    for (const conformance::MustCatch& caught : entry.test_case->catches) {
      for (const int position : {1, 2}) {
        const auto result = run_burst_case(entry, "mutant:" + caught.mutant, 1, position).outcome.result;
        EXPECT_EQ(result.verdict, judge::Verdict::fail) << result.id << " " << caught.mutant;
        EXPECT_EQ(result.reason, caught.reason) << result.id << " " << caught.mutant;
      }
    }
  }
}

}  // namespace
}  // namespace fieldproof::cli

#include "conformance/interbus/master_sequence.hpp"

#include <gtest/gtest.h>

#include <set>

#include "conformance/interbus/suite.hpp"
#include "conformance/sequence_check.hpp"
#include "conformance/sequence_draw.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

const Suite& suite_with_masters() {
  static const std::unique_ptr<Suite> suite = interbus_suite();
  return *suite;
}

SequenceSearch master_search_of(const std::string& uri, std::uint64_t cases) {
  SequenceSearch one;
  one.suite = &suite_with_masters();
  one.role = &master_sequence_role();
  one.setup.implementations = {{"master", 0, uri}};
  one.cases = cases;
  return one;
}

std::string master_lines(const Sequence& sequence) {
  std::string text;
  for (const std::string& line : sequence_lines(sequence, master_sequence_role().vocabulary))
    text += line + "\n";
  return text;
}

std::string master_lines(const SequenceSearchResult& result) {
  if (!result.found) return "";
  return result.found->outcome.result.reason + "\n" + master_lines(result.found->smallest);
}

std::vector<std::string> masters(bool are_for_check) {
  std::vector<std::string> names;
  for (const Mutant& mutant : suite_with_masters().mutants()) {
    if (mutant.role == "master" && mutant.is_for_check == are_for_check) names.push_back(mutant.name);
  }
  return names;
}

TEST(MasterSequence, TheReferenceIsNeverAccused) {
  for (kernel::FewerIfSanitized few(3); const std::uint64_t seed : {1U, 2U, 3U}) {
    if (few.leaves_out()) continue;
    SequenceSearch one = master_search_of("ref", kernel::kIsSanitized ? 200 : 2'000);
    one.setup.seed = seed;
    const SequenceSearchResult result = search(one);
    EXPECT_EQ(result.passed, one.cases) << seed << "\n" << master_lines(result);
  }
}

TEST(MasterSequence, FindsEachMasterForCheckWithAtMostFiveCommands) {
  ASSERT_EQ(masters(true).size(), 7U);
  for (kernel::FewerIfSanitized few(7); const std::string& name : masters(true)) {
    if (few.leaves_out()) continue;
    const SequenceSearchResult result = search(master_search_of("mutant:" + name, 5'000));
    ASSERT_TRUE(result.found) << name;
    EXPECT_TRUE(result.found->is_confirmed) << name;
    EXPECT_LE(result.found->smallest.commands.size(), 5U) << name << "\n" << master_lines(result);
    EXPECT_GE(result.found->smallest.commands.size() + result.found->smallest.settings.size(), 2U)
        << name << "\n"
        << master_lines(result);
  }
}

// Else it would be no fault of sequences.
TEST(MasterSequence, NoSingleCommandTellsThem) {
  const SequenceSource source(master_sequence_role().vocabulary, 1);
  std::vector<Sequence> single;
  for (std::uint64_t n = 0; single.size() < (kernel::kIsSanitized ? 50U : 300U); ++n) {
    for (const SequenceCommand& command : source.draw(n).commands) single.push_back({{command}});
  }
  for (const std::string& name : masters(true)) {
    for (const Sequence& sequence : single) {
      const Outcome outcome = run_sequence(suite_with_masters(), master_sequence_role(), sequence,
                                           master_search_of("mutant:" + name, 1).setup);
      EXPECT_EQ(outcome.result.verdict, judge::Verdict::pass) << name << "\n" << master_lines(sequence);
    }
  }
}

// One telegram too many is certain to be seen, however long the gaps are.
TEST(MasterSequence, OneTelegramTooManyCountsWithLongGaps) {
  const SequenceVocabulary& vocabulary = master_sequence_role().vocabulary;
  const auto extra = static_cast<std::size_t>(vocabulary.find("extra") - vocabulary.words.data());
  for (const std::int64_t gap : {0, 1'950, 11'201, 12'950, 100'000}) {
    const Sequence sequence{{simple_command(vocabulary, extra, {{0, 2}})}, {{"telegram_gap_millibits", gap}}};
    for (const std::string uri : {"ref", "mutant:telegram_count_ignored"}) {
      const judge::CaseResult result =
          run_sequence(suite_with_masters(), master_sequence_role(), sequence, master_search_of(uri, 1).setup)
              .result;
      EXPECT_EQ(result.verdict, uri == "ref" ? judge::Verdict::pass : judge::Verdict::fail) << gap << uri;
      EXPECT_EQ(result.reason, uri == "ref" ? "" : "wrong_cycle_accepted") << gap;
    }
  }
}

// Not found in 2,000 sequences: most of them show with another clock, hundreds of failures, rings that
// sequences do not have, or words beyond the ring.
TEST(MasterSequence, FindsWhatTheCatalogueNames) {
  const std::set<std::string> outside{"copies_zero_for_no_word",
                                      "counter_saturates",
                                      "counters_go_on",
                                      "counts_bad_cycles_in_8_bits",
                                      "cycle_time_in_32_bits",
                                      "cycle_time_in_us",
                                      "each_branch_is_level_2",
                                      "guards_6_bits",
                                      "last_order_only",
                                      "local_off_bit_kept",
                                      "located_by_id_code",
                                      "looks_at_eight_stations",
                                      "low_octet_and_length_compared",
                                      "message_bit_kept",
                                      "messages_of_recognition_lost",
                                      "no_clock_tolerance",
                                      "place_in_ring_order",
                                      "recognition_adds_up",
                                      "recognition_stops_late",
                                      "station_before_in_8_bits",
                                      "waits_for_usual_cable",
                                      "writes_256_words"};
  std::set<std::string> passed;
  for (const std::string& name : masters(false)) {
    const bool is_outside = outside.contains(name);
    // Under sanitizers there is time for those only that nothing finds.
    if (kernel::kIsSanitized && !is_outside) continue;
    constexpr std::uint64_t kCasesOutside = kernel::kIsSanitized ? 3 : 100;
    const std::uint64_t cases = is_outside ? kCasesOutside : 2'000;
    if (!search(master_search_of("mutant:" + name, cases)).found) passed.insert(name);
  }
  EXPECT_EQ(passed, outside);
}

}  // namespace
}  // namespace fieldproof::conformance

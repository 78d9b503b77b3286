// Subject: derived_sequences.hpp and derived_cases.hpp
#include "conformance/derived_sequences.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "conformance/derived_cases.hpp"
#include "conformance/invented_case.hpp"

namespace fieldproof::conformance {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::array<std::int64_t, 1> kLikely{40};
constexpr std::array<std::int64_t, 2> kGaps{11, 45};

SequenceVocabulary two_words() {
  return {.words = {{.word = "say",
                     .meaning = "says a number",
                     .numbers = {{"value", 0, 255, 90, kLikely}},
                     .units = 3},
                    {.word = "wait", .meaning = "waits", .numbers = {{"ms", 1, 3, 2, {}, true}}}},
          .levels_per_unit = 11,
          .gaps = kGaps};
}

DerivedSequences all_of(DerivedKind kind, const SequenceVocabulary& vocabulary) {
  return derived_sequences(kind, vocabulary, 10'000, kernel::Random(1));
}

TEST(DerivedSequences, ANumberHasItsEndsTheirNeighboursPowersOfTwoAndWhatIsNamed) {
  EXPECT_THAT(derived_values({"value", 0, 255, 90, kLikely}),
              ElementsAre(90, 40, 0, 1, 254, 255, 2, 3, 4, 7, 8, 15, 16, 31, 32, 63, 64, 127, 128));
  EXPECT_THAT(derived_values({"value", 0, 255, 90, kLikely, true}), ElementsAre(90, 40));
  EXPECT_THAT(derived_values({"value", -1, 1, 0}), ElementsAre(0, -1, 1));
  EXPECT_THAT(derived_values({"value", 5, 5, 5}), ElementsAre(5));
}

TEST(DerivedSequences, EachNumberTakesEachOfItsValues) {
  const SequenceVocabulary vocabulary = two_words();
  std::set<std::int64_t> said;
  for (const Sequence& sequence : all_of(DerivedKind::values, vocabulary).sequences)
    for (const SequenceCommand& command : sequence.commands)
      if (command.word == 0) said.insert(command.numbers[0]);
  for (const std::int64_t value : derived_values(vocabulary.words[0].numbers[0]))
    EXPECT_THAT(said, Contains(value));
}

TEST(DerivedSequences, EachUnitIsSpoiltInEachWay) {
  std::set<SequenceFault> alone;
  for (const Sequence& sequence : all_of(DerivedKind::faults, two_words()).sequences)
    for (const SequenceCommand& command : sequence.commands)
      if (command.faults.size() == 1) alone.insert(command.faults[0]);
  for (std::uint32_t unit = 0; unit < 3; ++unit) {
    EXPECT_THAT(alone, Contains(SequenceFault{SequenceFaultKind::drop, unit, 0}));
    for (std::uint32_t level = 0; level < 11; ++level)
      EXPECT_THAT(alone, Contains(SequenceFault{SequenceFaultKind::flip, unit, level}));
    for (const std::int64_t gap : kGaps)
      EXPECT_THAT(alone,
                  Contains(SequenceFault{SequenceFaultKind::gap, unit, static_cast<std::uint32_t>(gap)}));
  }
}

TEST(DerivedSequences, EachThreeWordsFollowEachOtherInEachOrder) {
  std::set<std::array<std::size_t, 3>> orders;
  for (const Sequence& sequence : all_of(DerivedKind::words, two_words()).sequences)
    for (std::size_t n = 0; n + 2 < sequence.commands.size(); ++n)
      orders.insert(
          {sequence.commands[n].word, sequence.commands[n + 1].word, sequence.commands[n + 2].word});
  EXPECT_EQ(orders.size(), 8U);
}

TEST(DerivedSequences, BeginInEachStateOfTheVocabulary) {
  SequenceVocabulary vocabulary = two_words();
  const SequenceCommand waits{.word = 1, .numbers = {3}};
  vocabulary.beginnings = {{waits, waits, waits, waits}};
  for (const DerivedRow& row : kDerivedRows) {
    // Walks follow from a reference, not from a vocabulary alone.
    if (row.kind == DerivedKind::settings || row.kind == DerivedKind::walks) continue;
    const auto sequences = derived_sequences(row.kind, vocabulary, 1'000, kernel::Random(1)).sequences;
    const auto begins_so = [&](const Sequence& one) {
      return one.commands.size() > 4 &&
             std::ranges::equal(std::span(one.commands).first(4), vocabulary.beginnings[0]);
    };
    const auto count = std::ranges::count_if(sequences, begins_so);
    EXPECT_GT(count, 200) << row.name;
    EXPECT_LT(count, 900) << row.name;
  }
}

TEST(DerivedSequences, GiveEachChoiceInEachState) {
  SequenceVocabulary vocabulary = two_words();
  const SequenceCommand waits{.word = 1, .numbers = {3}};
  vocabulary.words[1].numbers = {{"ms", 1, 3, 2}};
  vocabulary.beginnings = {{waits, waits, waits, waits}};
  const DerivedSequences all = all_of(DerivedKind::states, vocabulary);
  for (const bool is_in_state : {false, true}) {
    for (std::int64_t ms = 1; ms <= 3; ++ms) {
      const auto is_it = [&](const Sequence& one) {
        const std::size_t at = is_in_state ? 4 : 0;
        return one.commands.size() == at + 3 &&
               one.commands[at] == SequenceCommand{.word = 1, .numbers = {ms}};
      };
      EXPECT_GE(std::ranges::count_if(std::span(all.sequences).first(all.singles), is_it), 1)
          << is_in_state << " " << ms;
    }
  }
}

TEST(DerivedSequences, EndWithWhatIsLost) {
  SequenceVocabulary vocabulary = two_words();
  vocabulary.words[0].is_loss = true;
  std::size_t alone = 0;  // with nothing in front of the command and one of each
  for (const Sequence& one : all_of(DerivedKind::states, vocabulary).sequences) {
    if (one.commands.size() != 3) continue;
    ++alone;
    EXPECT_EQ(one.commands.back().word, 0U);
  }
  EXPECT_GT(alone, 0U);
}

TEST(DerivedSequences, HaveEachTwoValuesOfTwoNumbersTogether) {
  SequenceVocabulary vocabulary = two_words();
  vocabulary.words[1].numbers = {{"ms", 1, 3, 2}, {"how", 0, 2, 0}};
  const DerivedSequences all = all_of(DerivedKind::values, vocabulary);
  for (const std::int64_t ms : derived_values(vocabulary.words[1].numbers[0])) {
    for (std::int64_t how = 0; how <= 2; ++how) {
      const SequenceCommand wanted{.word = 1, .numbers = {ms, how}};
      EXPECT_TRUE(std::ranges::any_of(
          all.sequences, [&](const Sequence& one) { return std::ranges::count(one.commands, wanted) > 0; }))
          << ms << " " << how;
    }
  }
}

TEST(DerivedSequences, GoOnWithTheSameForAThousandTimesWhereTheyAreAskedTo) {
  const SequenceVocabulary vocabulary = two_words();
  const auto longest_row = [&](std::size_t repetitions, std::size_t word) {
    const DerivedSequences derived =
        derived_sequences(DerivedKind::repetitions, vocabulary, 30, kernel::Random(1), repetitions);
    std::size_t longest = 0;
    for (const Sequence& one : derived.sequences) {
      std::size_t row = 0;
      for (std::size_t n = 0; n < one.commands.size(); ++n) {
        row = n > 0 && one.commands[n] == one.commands[n - 1] ? row + 1 : 1;
        if (one.commands[n].word == word) longest = std::max(longest, row);
      }
    }
    return longest;
  };
  constexpr std::size_t kSay = 0;
  constexpr std::size_t kWait = 1;  // an hour, as likely as not
  EXPECT_LT(longest_row(kManyRepetitions, kSay), kMostRepetitions);
  EXPECT_GE(longest_row(kMostRepetitions, kSay), 1'000U);
  EXPECT_LT(longest_row(kMostRepetitions, kWait), kMostRepetitions);
}

TEST(DerivedSequences, AreTheSameForOneStreamAndOthersForAnother) {
  const SequenceVocabulary vocabulary = two_words();
  for (const DerivedRow& row : kDerivedRows) {
    const auto derived = [&](std::uint64_t seed) {
      return derived_sequences(row.kind, vocabulary, 20, kernel::Random(seed)).sequences;
    };
    EXPECT_EQ(derived(1), derived(1)) << row.name;
    if (row.kind != DerivedKind::settings && row.kind != DerivedKind::walks) {
      EXPECT_EQ(derived(1).size(), 20U) << row.name;
      EXPECT_NE(derived(1), derived(2)) << row.name;
    }
  }
}

TEST(DerivedSequences, SaysHowManyThereAreAndHowManyItTook) {
  const SequenceVocabulary vocabulary = two_words();
  const DerivedSequences all = all_of(DerivedKind::faults, vocabulary);
  EXPECT_EQ(all.taken, all.singles);
  EXPECT_EQ(all.sequences.size(), 10'000U);
  const DerivedSequences few = derived_sequences(DerivedKind::faults, vocabulary, 7, kernel::Random(1));
  EXPECT_EQ(few.taken, 7U);
  EXPECT_EQ(few.singles, all.singles);
  EXPECT_EQ(few.sequences.size(), 7U);
}

TEST(DerivedCases, ARoleWithoutSettingsHasNoCaseOfThem) {
  const SequenceRole role{invented_case("p/role/check/follows_the_reference"),
                          two_words(),
                          {{DerivedKind::faults, {"mutant", "reason"}}}};
  std::vector<std::string> ids;
  for (const TestCase& one : derived_cases(role)) {
    ids.push_back(one.id);
    EXPECT_TRUE(derived_kind(one)) << one.id;
  }
  EXPECT_THAT(ids, Contains("p/role/derived/each_unit_spoilt"));
  EXPECT_THAT(ids, Not(Contains("p/role/derived/each_setting_at_its_ends")));
  EXPECT_FALSE(derived_kind(role.test_case));
}

// What a case says of its sequences.
class DerivedVerdict : public testing::Test {
 protected:
  judge::CaseResult one(judge::Verdict verdict, std::string reason = {}, bool has_driven = true) const {
    judge::CaseResult result;
    result.verdict = verdict;
    result.reason = std::move(reason);
    result.has_driven = has_driven;
    if (verdict >= judge::Verdict::fail) result.findings.resize(1);
    return result;
  }

  // Where a command says such a number.
  auto fails_when(bool (*is_wrong)(std::int64_t)) const {
    return [this, is_wrong](const Sequence& sequence) {
      const bool fails = std::ranges::any_of(sequence.commands, [&](const SequenceCommand& command) {
        return command.word == 0 && is_wrong(command.numbers[0]);
      });
      return fails ? one(judge::Verdict::fail, "valves_wrong") : one(judge::Verdict::pass);
    };
  }

  judge::CaseResult run(std::vector<judge::CaseResult> answers) {
    std::size_t next = 0;
    return run([&](const Sequence&) { return answers[std::min(next++, answers.size() - 1)]; });
  }

  judge::CaseResult run(std::function<judge::CaseResult(const Sequence&)> runs) {
    return run_derived_case(
        {.test_case = case_, .vocabulary = vocabulary_, .parts = {{derived_, std::move(runs)}}});
  }

  SequenceVocabulary vocabulary_ = two_words();
  TestCase case_ = invented_case("p/role/derived/each_unit_spoilt");
  DerivedSequences derived_ = derived_sequences(DerivedKind::faults, vocabulary_, 3, kernel::Random(1));
};

TEST_F(DerivedVerdict, IsThatOfTheFirstThatFails) {
  const judge::CaseResult result =
      run({one(judge::Verdict::pass), one(judge::Verdict::fail, "valves_wrong"), one(judge::Verdict::pass)});
  EXPECT_EQ(result.verdict, judge::Verdict::fail);
  EXPECT_EQ(result.reason, "valves_wrong");
  EXPECT_THAT(result.findings.at(0).step, HasSubstr("sequence 2 of 3: "));
}

TEST_F(DerivedVerdict, ShowsTheSmallestSequenceThatFailsForThatReason) {
  const judge::CaseResult result = run(fails_when([](std::int64_t value) { return value > 63; }));
  EXPECT_THAT(result.findings.at(0).step, EndsWith(": say value 90"));
}

TEST_F(DerivedVerdict, SaysWhatDecidesAndWhatWasTriedInstead) {
  derived_ = all_of(DerivedKind::values, vocabulary_);
  const judge::CaseResult result = run(fails_when([](std::int64_t value) { return value < 64; }));
  EXPECT_THAT(
      result.findings.at(0).decisive,
      ElementsAre("value 63 in command 1, say: with 64 it passes, with 62 it fails, too, with 90 it passes"));
}

TEST_F(DerivedVerdict, EqualCommandsInARowAreOneThatDecides) {
  const SequenceCommand say = simple_command(vocabulary_, 0);
  derived_ = {.sequences = {{.commands = std::vector<SequenceCommand>(20, say)}}};
  const judge::CaseResult result = run([&](const Sequence& sequence) {
    const bool fails = std::ranges::count(sequence.commands, std::size_t{0}, &SequenceCommand::word) >= 20;
    return fails ? one(judge::Verdict::fail, "valves_wrong") : one(judge::Verdict::pass);
  });
  EXPECT_THAT(result.findings.at(0).decisive, ElementsAre("command 1, say: once less it passes"));
}

TEST_F(DerivedVerdict, WhatWasNotTriedIsSaid) {
  derived_ = {
      .sequences = {{.commands = std::vector<SequenceCommand>(1, simple_command(vocabulary_, 0, {{0, 7}}))}}};
  for (std::int64_t n = 0; n < 200; ++n)
    derived_.sequences[0].commands.push_back(simple_command(vocabulary_, 0, {{0, n}}));
  const std::size_t whole = derived_.sequences[0].commands.size();
  const judge::CaseResult result = run([&](const Sequence& sequence) {
    const bool fails = sequence.commands.size() == whole;
    return fails ? one(judge::Verdict::fail, "valves_wrong") : one(judge::Verdict::pass);
  });
  EXPECT_THAT(result.findings.at(0).decisive, Contains("more was not tried"));
}

TEST_F(DerivedVerdict, OfAVerdictThatIsNotExplainedNothingMoreIsRun) {
  std::size_t runs = 0;
  const judge::CaseResult result =
      run_derived_case({.test_case = case_,
                        .vocabulary = vocabulary_,
                        .parts = {{derived_,
                                   [&](const Sequence&) {
                                     ++runs;
                                     return one(judge::Verdict::fail, "valves_wrong");
                                   }}},
                        .most_shrinking_commands = 0});
  EXPECT_EQ(runs, 1U);
  EXPECT_EQ(result.reason, "valves_wrong");
}

// Who confirms a failure does not explain it again, and holds the fingerprints against each other.
TEST_F(DerivedVerdict, ExplainingAddsNothingToItsFingerprint) {
  const auto fingerprint_with = [&](std::size_t most_shrinking_commands) {
    const auto run_one = [this](const Sequence& sequence) {
      judge::CaseResult failed = one(judge::Verdict::fail, "valves_wrong");
      failed.fingerprint = 7 + sequence.commands.size();
      return failed;
    };
    return run_derived_case({.test_case = case_,
                             .vocabulary = vocabulary_,
                             .parts = {{derived_, run_one}},
                             .most_shrinking_commands = most_shrinking_commands})
        .fingerprint;
  };
  EXPECT_NE(fingerprint_with(0), 0U);
  EXPECT_EQ(fingerprint_with(kShrinkingCommands), fingerprint_with(0));
}

TEST_F(DerivedVerdict, OfOneThatHangsItDoesNotAskAgain) {
  std::size_t runs = 0;
  run([&](const Sequence&) {
    ++runs;
    return one(judge::Verdict::fail, "implementation_hangs");
  });
  EXPECT_EQ(runs, 1U);
}

TEST_F(DerivedVerdict, IsNoPassWhenNothingWasDriven) {
  const judge::CaseResult result = run({one(judge::Verdict::pass, {}, false)});
  EXPECT_EQ(result.verdict, judge::Verdict::inconclusive);
  EXPECT_THAT(result.findings, Not(IsEmpty()));
}

TEST_F(DerivedVerdict, IsNotApplicableWhenNoneOfThemCanBeDone) {
  const judge::CaseResult result =
      run({one(judge::Verdict::not_applicable, "nobody sees its valves", false)});
  EXPECT_EQ(result.verdict, judge::Verdict::not_applicable);
  EXPECT_EQ(result.reason, "nobody sees its valves");
}

TEST_F(DerivedVerdict, IsAPassWhenSomeCanBeDoneAndPass) {
  const judge::CaseResult result =
      run({one(judge::Verdict::not_applicable, "nobody sees its valves", false), one(judge::Verdict::pass)});
  EXPECT_EQ(result.verdict, judge::Verdict::pass);
}

}  // namespace
}  // namespace fieldproof::conformance

// Subject: sequence_draw.hpp and sequence_shrink.hpp
#include "conformance/sequence_draw.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

#include "conformance/interbus/slave_sequence.hpp"
#include "conformance/sequence_shrink.hpp"
#include "conformance/valve_bus/node_sequence.hpp"

namespace fieldproof::conformance {
namespace {

void expect_within_limits(const SequenceVocabulary& vocabulary, const SequenceCommand& command) {
  const SequenceWord& word = vocabulary.words.at(command.word);
  ASSERT_EQ(command.numbers.size(), word.numbers.size());
  for (std::size_t n = 0; n < command.numbers.size(); ++n) {
    EXPECT_GE(command.numbers[n], word.numbers[n].least);
    EXPECT_LE(command.numbers[n], word.numbers[n].most);
  }
  EXPECT_LE(command.octets.size(), word.most_octets);
  for (const SequenceFault& fault : command.faults) {
    EXPECT_LT(fault.unit, units_of(word, command));
    const bool is_flip = fault.kind == SequenceFaultKind::flip;
    EXPECT_TRUE(!is_flip || fault.value < vocabulary.levels_per_unit);
  }
}

TEST(SequenceDraw, StaysWithinTheVocabularyAndUsesAllOfIt) {
  for (const SequenceRole* role : {&node_sequence_role(), &slave_sequence_role()}) {
    const SequenceVocabulary& vocabulary = role->vocabulary;
    const SequenceSource source(vocabulary, 1);
    std::set<std::size_t> words;
    std::size_t faults = 0;
    for (std::uint64_t n = 0; n < 500; ++n) {
      const Sequence drawn = source.draw(n);
      EXPECT_LE(drawn.commands.size(), vocabulary.most_commands);
      for (const SequenceCommand& command : drawn.commands) {
        expect_within_limits(vocabulary, command);
        words.insert(command.word);
      }
      faults += faults_in(drawn);
    }
    EXPECT_EQ(words.size(), vocabulary.words.size());
    EXPECT_GT(faults, 500U);
  }
}

TEST(SequenceDraw, DependsOnSeedAndNumberOnly) {
  const SequenceSource source(node_sequence_role().vocabulary, 7);
  const SequenceSource again(node_sequence_role().vocabulary, 7);
  const SequenceSource other(node_sequence_role().vocabulary, 8);
  std::size_t different = 0;
  for (std::uint64_t n = 300; n < 320; ++n) {
    EXPECT_EQ(source.draw(n), again.draw(n));
    if (source.draw(n) != other.draw(n)) ++different;
  }
  EXPECT_GE(different, 19U);
}

TEST(SequenceDraw, BeginsEachSecondOneWithASituationAndASettingThatShowsThere) {
  const SequenceVocabulary vocabulary =
      with_situations(node_sequence_role().vocabulary,
                      {{{{"read"}, {"switches"}, {"read"}}, {{"boards", {{"bit_rate", 1'200}}}}},
                       {{{"wait"}, {"wait"}, {"wait"}}}});
  const SequenceSource source(vocabulary, 5);
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t shown = 0;
  for (std::uint64_t n = 0; n < 400; ++n) {
    const Sequence drawn = source.draw(n);
    const auto begins_with = [&](const SequenceSituation& one) {
      return drawn.commands.size() >= 3 &&
             std::ranges::equal(one.commands, std::span(drawn.commands).first(3));
    };
    if (begins_with(vocabulary.situations[1])) ++second;
    if (!begins_with(vocabulary.situations[0])) continue;
    ++first;
    const bool is_along = std::ranges::find(drawn.settings, "bit_rate",
                                            &field::Settings::value_type::first) != drawn.settings.end();
    const bool is_shown = std::ranges::find(drawn.settings, "boards", &field::Settings::value_type::first) !=
                          drawn.settings.end();
    EXPECT_TRUE(is_along);
    if (is_shown) ++shown;
  }
  EXPECT_NEAR(static_cast<double>(first), 100, 35);
  EXPECT_NEAR(static_cast<double>(second), 100, 35);
  EXPECT_GT(shown, 30U);  // a number in its range may be that of the bench
}

TEST(SequenceShrink, LeavesTheFewestCommandsFaultsAndSimpleNumbers) {
  const SequenceVocabulary& vocabulary = node_sequence_role().vocabulary;
  const auto word_at = [&](std::string_view word) {
    return static_cast<std::size_t>(vocabulary.find(word) - vocabulary.words.data());
  };
  // Fails with a write of at least 7 that has a flip, somewhere in front of a read.
  const SequenceFails fails = [&](const Sequence& sequence) {
    const auto write = std::ranges::find_if(sequence.commands, [&](const SequenceCommand& command) {
      return command.word == word_at("write") && command.numbers[0] >= 7 && flips_in({{command}}) > 0;
    });
    return std::find_if(write, sequence.commands.end(), [&](const SequenceCommand& command) {
             return command.word == word_at("read");
           }) != sequence.commands.end();
  };
  const SequenceSource source(vocabulary, 3);
  std::size_t found = 0;
  for (std::uint64_t n = 200; n < 400; ++n) {
    if (!fails(source.draw(n))) continue;
    ++found;
    const Sequence smallest = shrunk(source.smaller(n, fails), vocabulary, fails);
    ASSERT_EQ(smallest.commands.size(), 2U);
    EXPECT_EQ(smallest.commands[0].numbers, (std::vector<std::int64_t>{7, 0, 45}));
    EXPECT_EQ(smallest.commands[0].faults.size(), 1U);
    EXPECT_EQ(smallest.commands[1].numbers, (std::vector<std::int64_t>{0, 0, 45}));
    EXPECT_TRUE(smallest.commands[1].faults.empty());
  }
  EXPECT_GT(found, 5U);
}

}  // namespace
}  // namespace fieldproof::conformance

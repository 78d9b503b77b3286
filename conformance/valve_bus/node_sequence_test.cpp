#include "conformance/valve_bus/node_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "conformance/sequence_check.hpp"
#include "conformance/sequence_draw.hpp"
#include "conformance/valve_bus/node_vocabulary.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::uint64_t kFixedSeed = 1;

const Suite& valve_suite() {
  static const std::unique_ptr<Suite> suite = valve_bus_suite();
  return *suite;
}

SequenceSearch search_of(const std::string& uri, std::uint64_t cases) {
  SequenceSearch one;
  one.suite = &valve_suite();
  one.role = &node_sequence_role();
  one.setup.seed = kFixedSeed;
  one.setup.implementations = {{"node", 0, uri}};
  one.cases = cases;
  return one;
}

std::vector<std::string> nodes_for_check() {
  std::vector<std::string> names;
  for (const Mutant& mutant : valve_suite().mutants()) {
    if (mutant.is_for_check && mutant.role == "node") names.push_back(mutant.name);
  }
  return names;
}

std::string told(const Sequence& sequence) {
  std::string text;
  for (const std::string& line : sequence_lines(sequence, node_sequence_role().vocabulary))
    text += line + "\n";
  return text;
}

TEST(NodeSequence, TheReferenceIsNeverAccused) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SequenceSearch one = search_of("ref", kernel::kIsSanitized ? 140 : 700);
    one.setup.seed = seed;
    const SequenceSearchResult result = search(one);
    EXPECT_EQ(result.passed, one.cases) << seed << "\n"
                                        << told(result.found ? result.found->smallest : Sequence{});
  }
}

// A word that sends more than one command.
bool is_several(const SequenceCommand& command) {
  const auto word = static_cast<NodeWord>(command.word);
  return word == NodeWord::poll || word == NodeWord::sign || word == NodeWord::cancel ||
         word == NodeWord::wrong || word == NodeWord::others;
}

// Each of a setting, of an instant, or of many frames.
TEST(NodeSequence, FindsWhatTakesASettingOrAnInstant) {
  kernel::FewerIfSanitized few(5);
  for (const char* name :
       {"deaf_after_100_wrong_checks", "address_zero_is_one", "digits_above_nine_add_up", "tears_switches",
        "answer_not_cancelled", "drives_with_the_answer", "samples_bits_early", "samples_bits_late",
        "gives_up_on_collision", "stop_bit_ignored_with_parity", "not_kept_alive_by_equal_writes",
        "lets_go_in_silence_only", "lets_go_after_the_first_power_up_only",
        "deaf_after_power_lost_in_an_answer"}) {
    if (few.leaves_out()) continue;
    EXPECT_TRUE(search(search_of(std::string("mutant:") + name, 1'500)).found) << name;
  }
}

TEST(NodeSequence, FindsEachNodeForCheckWithAtMostFourCommands) {
  ASSERT_EQ(nodes_for_check().size(), 16U);
  std::size_t n = 0;
  for (const std::string& name : nodes_for_check()) {
    if (kernel::kIsSanitized && n++ % 4 != 0) continue;  // what it looks for does not depend on who plays
    const SequenceSearchResult result = search(search_of("mutant:" + name, 5'000));
    ASSERT_TRUE(result.found) << name;
    EXPECT_TRUE(result.found->is_confirmed) << name;
    EXPECT_LE(result.found->smallest.commands.size(), 4U) << name << "\n" << told(result.found->smallest);
    EXPECT_TRUE(result.found->smallest.commands.size() + result.found->smallest.settings.size() >= 2U ||
                is_several(result.found->smallest.commands.front()))
        << name << "\n"
        << told(result.found->smallest);
    EXPECT_LE(flips_in(result.found->smallest), 2U) << name << "\n" << told(result.found->smallest);
    for (const judge::Finding& finding : result.found->outcome.result.findings) {
      // What is a frame is this project's choice, and so is what follows from it; that there is one response
      // is the paper's.
      const bool is_of_the_paper = finding.reason == "answered_twice";
      EXPECT_EQ(finding.reference.standing, is_of_the_paper ? judge::Standing::seed : judge::Standing::own)
          << name << ": " << finding.reason;
    }
  }
}

// Else it would be no fault of sequences.
TEST(NodeSequence, NoSingleCommandTellsThem) {
  const SequenceSource source(node_sequence_role().vocabulary, kFixedSeed);
  std::vector<Sequence> single;
  for (std::uint64_t n = 0; single.size() < (kernel::kIsSanitized ? 60U : 300U); ++n) {
    for (const SequenceCommand& command : source.draw(n).commands) {
      if (!is_several(command)) single.push_back({{command}});
    }
  }
  for (const std::string& name : nodes_for_check()) {
    const conformance::Setup setup = search_of("mutant:" + name, 1).setup;
    for (const Sequence& sequence : single) {
      const Outcome outcome = run_sequence(valve_suite(), node_sequence_role(), sequence, setup);
      EXPECT_EQ(outcome.result.verdict, judge::Verdict::pass) << name << "\n" << told(sequence);
    }
  }
}

TEST(NodeSequence, WhatIsFoundIsTheSameAgain) {
  const SequenceSearch one = search_of("mutant:buffer_not_cleared", 1'000);
  const SequenceSearchResult result = search(one);
  const SequenceSearchResult again = search(one);
  ASSERT_TRUE(result.found && again.found);
  EXPECT_EQ(result.found->smallest, again.found->smallest);
  EXPECT_EQ(result.found->outcome.result.fingerprint, again.found->outcome.result.fingerprint);
  const Outcome replayed = run_sequence(*one.suite, *one.role, result.found->smallest, one.setup);
  EXPECT_EQ(replayed.result.fingerprint, result.found->outcome.result.fingerprint);
}

TEST(NodeSequence, AStopEndsSearchAndShrinking) {
  std::stop_source stop;
  SequenceSearch one = search_of("ref", 1'000);
  one.stop = stop.get_token();
  one.on_progress = [&](std::uint64_t done) {
    if (done == 5) stop.request_stop();
  };
  EXPECT_EQ(search(one).passed, 6U);
}

// What receivers may differ about is no finding, and ends the sequence.
TEST(NodeSequence, ASilenceAtALimitIsNotJudged) {
  const SequenceVocabulary& words = node_sequence_role().vocabulary;
  const auto write = static_cast<std::size_t>(words.find("write") - words.words.data());
  for (std::int64_t silence = 0; silence < 60; ++silence) {
    const Sequence sequence{{{write, {1, 0, silence}}, {write, {2, 0, 100}}}};
    for (const char* uri : {"ref", "mutant:buffer_not_cleared"}) {
      const Outcome outcome =
          run_sequence(valve_suite(), node_sequence_role(), sequence, search_of(uri, 1).setup);
      EXPECT_EQ(outcome.result.verdict, judge::Verdict::pass) << uri << " " << silence;
    }
  }
}

// A wrong instant is no wrong value.
TEST(NodeSequence, ValvesThatMoveTooLateAreCalledLate) {
  const SequenceVocabulary& words = node_sequence_role().vocabulary;
  const auto write = static_cast<std::size_t>(words.find("write") - words.words.data());
  const Sequence sequence{{{write, {1, 2, 100}}, {write, {3, 4, 1'000}}}};
  const judge::CaseResult result =
      run_sequence(valve_suite(), node_sequence_role(), sequence, search_of("mutant:valves_late", 1).setup)
          .result;
  EXPECT_EQ(result.reason, "valves_too_late");
  conformance::Setup setup;
  setup.volume = Volume::quick;
  setup.implementations = {{"node", 0, "mutant:valves_late"}};
  std::size_t n = 0;
  for (const TestCase& one : valve_suite().cases()) {
    if (one.role() != "node" || !has_tag(one, "derived")) continue;
    if (kernel::kIsSanitized && n++ > 0) continue;
    EXPECT_EQ(valve_suite().run(one, setup).result.reason, "valves_too_late") << one.id;
  }
}

}  // namespace
}  // namespace fieldproof::conformance

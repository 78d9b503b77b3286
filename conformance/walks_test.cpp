#include "conformance/walks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace fieldproof::conformance {
namespace {

// A machine of tables: from state and command to state and answer.
struct Machine {
  std::vector<std::vector<std::size_t>> next;
  std::vector<std::vector<std::uint64_t>> answers;

  std::size_t commands() const { return next.front().size(); }
  std::uint64_t answer(const WalkWord& word) const {
    std::size_t state = 0;
    for (std::size_t n = 0; n + 1 < word.size(); ++n) state = next[state][word[n]];
    return answers[state][word.back()];
  }
  bool answers_as(const Machine& other, const std::vector<WalkWord>& words) const {
    for (const WalkWord& word : words) {
      WalkWord begun;
      for (const std::size_t command : word) {
        begun.push_back(command);
        if (answer(begun) != other.answer(begun)) return false;
      }
    }
    return true;
  }
  // All that any words show: the pairs of states that both reach together.
  bool is(const Machine& other) const {
    std::set<std::pair<std::size_t, std::size_t>> seen{{0, 0}};
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, 0}};
    while (!open.empty()) {
      const auto [mine, theirs] = open.back();
      open.pop_back();
      for (std::size_t command = 0; command < commands(); ++command) {
        if (answers[mine][command] != other.answers[theirs][command]) return false;
        const std::pair both(next[mine][command], other.next[theirs][command]);
        if (seen.insert(both).second) open.push_back(both);
      }
    }
    return true;
  }
};

Machine drawn_machine(std::size_t states, std::size_t commands) {
  Machine machine;
  for (std::size_t state = 0; state < states; ++state) {
    auto& next = machine.next.emplace_back();
    auto& answers = machine.answers.emplace_back();
    for (std::size_t command = 0; command < commands; ++command) {
      next.push_back(*rc::gen::inRange<std::size_t>(0, states));
      answers.push_back(*rc::gen::inRange<std::uint64_t>(0, 3));
    }
  }
  return machine;
}

// States that two commands tell apart, but no single one, are one here; such machines are left out.
bool are_told_by_single_commands(const Machine& machine) {
  std::set<std::vector<std::uint64_t>> rows(machine.answers.begin(), machine.answers.end());
  return rows.size() == machine.answers.size();
}

Walks walks_of(const Machine& machine, WalkBounds bounds) {
  return explore(machine.commands(), [&](const WalkWord& word) { return machine.answer(word); }, bounds);
}

// The drawn one but for one change, with a state of its own where it may have more.
Machine changed(Machine machine, std::size_t more) {
  if (more > 0) {
    machine.next.push_back(*rc::gen::elementOf(machine.next));
    machine.answers.push_back(*rc::gen::elementOf(machine.answers));
  }
  const std::size_t state = *rc::gen::inRange<std::size_t>(0, machine.next.size());
  const std::size_t command = *rc::gen::inRange<std::size_t>(0, machine.commands());
  machine.next[state][command] = *rc::gen::inRange<std::size_t>(0, machine.next.size());
  if (*rc::gen::arbitrary<bool>()) machine.answers[state][command] = 7;
  return machine;
}

RC_GTEST_PROP(WalksTest, AMachineOfAsManyStatesThatAnswersTheSameIsTheSame, ()) {
  const std::size_t states = *rc::gen::inRange<std::size_t>(1, 4);
  const Machine machine = drawn_machine(states, *rc::gen::inRange<std::size_t>(2, 4));
  RC_PRE(are_told_by_single_commands(machine));
  const std::size_t more = *rc::gen::inRange<std::size_t>(0, 2);
  const Walks walks = walks_of(machine, {.most_states = 24, .more = more});
  RC_PRE(walks.states == states);  // what is not reached may be reached after the change
  RC_ASSERT(walks.is_whole);
  const Machine other = changed(machine, more);
  RC_ASSERT(other.answers_as(machine, walks.words) == other.is(machine));
}

TEST(WalksTest, OneStateMoreIsFoundByTheWalksThatAllowForIt) {
  const Machine machine{{{0, 0}}, {{0, 1}}};
  // Answers otherwise to the second command after the first one.
  const Machine other{{{1, 0}, {0, 0}}, {{0, 1}, {0, 2}}};
  EXPECT_TRUE(other.answers_as(machine, walks_of(machine, {.most_states = 9}).words));
  EXPECT_FALSE(other.answers_as(machine, walks_of(machine, {.most_states = 9, .more = 1}).words));
}

// Two states that only two commands tell apart: single commands take them for one.
TEST(WalksTest, StatesThatSingleCommandsDoNotTellApartAreASurprise) {
  const auto surprise_of = [](const Machine& machine) {
    return first_surprise(machine.commands(), [&](const WalkWord& word) { return machine.answer(word); },
                          {.most_states = 9});
  };
  EXPECT_EQ(surprise_of({{{1, 0}, {2, 1}, {0, 2}}, {{0, 0}, {0, 0}, {0, 1}}}), (WalkWord{0, 0, 1}));
  EXPECT_EQ(surprise_of({{{1, 0}, {0, 1}}, {{0, 0}, {0, 1}}}), std::nullopt);
}

TEST(WalksTest, SaysThatThereAreMoreStatesThanItLookedFor) {
  // Each state answers with its own number.
  Machine machine;
  for (std::uint64_t state = 0; state < 10; ++state) {
    machine.next.push_back({(state + 1) % 10});
    machine.answers.push_back({state});
  }
  EXPECT_TRUE(walks_of(machine, {.most_states = 10}).is_whole);
  const Walks few = walks_of(machine, {.most_states = 9});
  EXPECT_FALSE(few.is_whole);
  EXPECT_EQ(few.states, 9U);
}

TEST(WalksTest, NoWordIsTheBeginningOfAnother) {
  const Machine machine{{{1, 0}, {1, 0}}, {{0, 1}, {2, 1}}};
  const Walks walks = walks_of(machine, {.most_states = 9});
  for (const WalkWord& one : walks.words) {
    for (const WalkWord& other : walks.words) {
      const bool begins = one.size() <= other.size() && std::equal(one.begin(), one.end(), other.begin());
      EXPECT_EQ(begins, &one == &other);
    }
  }
}

}  // namespace
}  // namespace fieldproof::conformance

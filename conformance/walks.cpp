#include "conformance/walks.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "conformance/derived_sequences.hpp"

namespace fieldproof::conformance {
namespace {

class Exploration {
 public:
  Exploration(std::size_t commands, const WalkAnswer& answer, const WalkBounds& bounds)
      : commands_(commands), answer_(answer), bounds_(bounds) {}

  Walks run() {
    find_states();
    return {states_.size(), is_whole_, words()};
  }

  std::optional<WalkWord> surprise() {
    find_states();
    for (const State& state : states_) {
      for (const Reached& one : one_further(one_further({{state.access, place_of(state.row)}}))) {
        if (one.state == kUnknown) continue;
        const Row row = row_after(one.word);
        const auto [expected, answered] = std::ranges::mismatch(states_[one.state].row, row);
        if (answered != row.end()) return then(one.word, static_cast<std::size_t>(answered - row.begin()));
      }
    }
    return std::nullopt;
  }

 private:
  // What each command brings after the word that leads to a state.
  using Row = std::vector<std::uint64_t>;
  struct State {
    WalkWord access;
    Row row;
    std::vector<std::size_t> next{};  // by command
  };

  Row row_after(const WalkWord& word) const {
    Row row;
    for (std::size_t command = 0; command < commands_; ++command) row.push_back(answer_(then(word, command)));
    return row;
  }

  static WalkWord then(WalkWord word, std::size_t command) {
    word.push_back(command);
    return word;
  }

  // In the order of their shortest words.
  void find_states() {
    states_.push_back({{}, row_after({})});
    for (std::size_t from = 0; from < states_.size(); ++from) {
      for (std::size_t command = 0; command < commands_; ++command) {
        WalkWord word = then(states_[from].access, command);
        Row row = row_after(word);
        const std::size_t to = place_of(row);
        if (to == states_.size() && to == bounds_.most_states) {
          is_whole_ = false;
          states_[from].next.push_back(kUnknown);
          continue;
        }
        if (to == states_.size()) states_.push_back({std::move(word), std::move(row)});
        states_[from].next.push_back(to);
      }
    }
  }

  std::size_t place_of(const Row& row) const {
    const auto found = std::ranges::find(states_, row, &State::row);
    return static_cast<std::size_t>(found - states_.begin());
  }

  // The fewest commands, taken greedily, that tell this state from all others.
  std::vector<std::size_t> telling(std::size_t state) const {
    std::vector<std::size_t> others;
    for (std::size_t other = 0; other < states_.size(); ++other)
      if (other != state) others.push_back(other);
    std::vector<std::size_t> chosen;
    const auto is_told = [&](std::size_t other, std::size_t command) {
      return states_[other].row[command] != states_[state].row[command];
    };
    while (!others.empty()) {
      std::size_t best = 0;
      std::ptrdiff_t most = 0;
      for (std::size_t command = 0; command < commands_; ++command) {
        const auto count =
            std::ranges::count_if(others, [&](std::size_t one) { return is_told(one, command); });
        if (count > most) std::tie(best, most) = std::pair(command, count);
      }
      chosen.push_back(best);
      std::erase_if(others, [&](std::size_t one) { return is_told(one, best); });
    }
    return chosen;
  }

  void find_what_tells() {
    std::set<std::size_t> any{0};  // of one state: that it answers at all
    for (std::size_t state = 0; state < states_.size(); ++state) {
      telling_.push_back(telling(state));
      any.insert(telling_.back().begin(), telling_.back().end());
      if (telling_.back().empty()) telling_.back().push_back(0);
    }
    telling_any_.assign(any.begin(), any.end());
  }

  struct Reached {
    WalkWord word;
    std::size_t state;
  };
  std::vector<Reached> one_further(const std::vector<Reached>& reached) const {
    std::vector<Reached> further;
    for (const auto& [word, at] : reached) {
      for (std::size_t command = 0; command < commands_; ++command)
        further.push_back({then(word, command), at == kUnknown ? kUnknown : states_[at].next[command]});
    }
    return further;
  }

  static void ask(const WalkWord& word, const std::vector<std::size_t>& commands, std::set<WalkWord>& all) {
    for (const std::size_t command : commands) all.insert(then(word, command));
  }

  // Each state, and what so many commands more lead to, is told from all; what one more leads to, from the
  // state that it should be. Where nobody knows which that is, from all.
  std::vector<WalkWord> words() {
    find_what_tells();
    std::set<WalkWord> all;
    for (std::size_t state = 0; state < states_.size(); ++state) {
      std::vector<Reached> reached{{states_[state].access, state}};
      for (std::size_t length = 0; length <= bounds_.more; ++length) {
        for (const Reached& one : reached) ask(one.word, telling_any_, all);
        reached = one_further(reached);
      }
      for (const auto& [word, at] : reached) ask(word, at == kUnknown ? telling_any_ : telling_[at], all);
    }
    return without_beginnings(all);
  }

  static std::vector<WalkWord> without_beginnings(const std::set<WalkWord>& all) {
    std::vector<WalkWord> words;
    for (auto one = all.begin(); one != all.end(); ++one) {
      // In their order the next one is what begins with it, if any does.
      const auto next = std::next(one);
      const bool is_beginning = next != all.end() && next->size() > one->size() &&
                                std::equal(one->begin(), one->end(), next->begin());
      if (!is_beginning) words.push_back(*one);
    }
    return words;
  }

  static constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

  std::size_t commands_;
  const WalkAnswer& answer_;
  WalkBounds bounds_;
  bool is_whole_ = true;
  std::vector<State> states_;
  std::vector<std::vector<std::size_t>> telling_;  // by state
  std::vector<std::size_t> telling_any_;
};

}  // namespace

Walks explore(std::size_t commands, const WalkAnswer& answer, const WalkBounds& bounds) {
  return Exploration(commands, answer, bounds).run();
}

std::optional<WalkWord> first_surprise(std::size_t commands, const WalkAnswer& answer,
                                       const WalkBounds& bounds) {
  return Exploration(commands, answer, bounds).surprise();
}

std::vector<SequenceCommand> walk_alphabet(const SequenceVocabulary& vocabulary, std::size_t most) {
  std::vector<SequenceCommand> telling;
  for (const std::vector<SequenceCommand>& beginning : vocabulary.beginnings) {
    for (const SequenceCommand& command : beginning)
      if (std::ranges::find(telling, command) == telling.end()) telling.push_back(command);
  }
  std::vector<SequenceCommand> alphabet;
  for (const SequenceCommand& simple : one_of_each(vocabulary).commands) {
    const auto first = std::ranges::find(telling, simple.word, &SequenceCommand::word);
    alphabet.push_back(first == telling.end() ? simple : *first);
  }
  for (SequenceCommand& command : telling)
    if (std::ranges::find(alphabet, command) == alphabet.end()) alphabet.push_back(std::move(command));
  alphabet.resize(std::min(alphabet.size(), most));
  return alphabet;
}

}  // namespace fieldproof::conformance

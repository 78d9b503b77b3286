#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "conformance/suite.hpp"

// For tests of suites: a PICS declares any two answers together, and the reference is not accused.
namespace fieldproof::conformance {

struct AnswerPairs {
  std::string role{};
  std::size_t declarations = 0;  // that were run
  std::size_t pairs = 0;         // of answers to two items
  std::size_t refused = 0;       // of these, those that contradict themselves: the suite takes no such PICS
  std::vector<std::string> accused{};
  std::set<std::string> left_open{};  // cases that were inconclusive with some of them
};

// Who does what is declared, where the reference does it in another way; nothing: the reference.
using PlaysDeclared = std::function<std::optional<Assignment>(const std::string& role, const judge::Pics&)>;

struct PlayersOfAnswers {
  PlaysDeclared plays{};
  std::string left_out{};  // a role
};

// One row for each role with two items at least. Both truths are declared, each word that a text may be, and
// of a number or time the ends of its range and what is next to them. Of the declarations each `one_of`th is
// run.
std::vector<AnswerPairs> pairs_of_answers(const Suite& suite, unsigned one_of = 1,
                                          const PlayersOfAnswers& players = {});

}  // namespace fieldproof::conformance

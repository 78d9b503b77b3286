#pragma once

#include <cstddef>
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
};

// One row for each role with two items at least. Both truths are declared, and of a number or time the ends
// of its range and what is next to them; nothing of a text, because what it says the reference is not. What a
// setup cannot show a case may leave open. Of the declarations each `one_of`th is run.
std::vector<AnswerPairs> pairs_of_answers(const Suite& suite, unsigned one_of = 1);

}  // namespace fieldproof::conformance

// A run as GitHub Actions shows it: annotations, which are lines that a step prints, and the summary of a
// step in Markdown.
//
// Contract: GitHub shows ten errors of a step and drops the rest, so the nine worst cases have a line each,
// and the tenth says how many more there are. No text of an implementation makes a command, markup or a
// link: what workflow commands reserve is written as %NN, and in Markdown every character of punctuation as
// a character reference.
#pragma once

#include <string>
#include <string_view>

#include "reports/outcome.hpp"
#include "reports/results.hpp"

namespace fieldproof::reports {

std::string github_annotations(const Run& run, const OutcomeRules& rules);
std::string github_summary(const Run& run, const OutcomeRules& rules);

// What a step prints for people, with every line that would be a command changed so that it is none.
std::string github_log(std::string_view text);

}  // namespace fieldproof::reports

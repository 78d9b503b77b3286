// `fieldproof campaign` before it runs and while it runs elsewhere.
#pragma once

#include <cstddef>

#include "cli/verbs.hpp"

namespace fieldproof::cli {

// `--dry-run`: counts the jobs of each row, and runs the first job of each to say how long all of them take
// in so many slots. Answers with the exit code of a job that is refused, else 0.
int estimate_campaign(Session& session, std::size_t slots);

// `--watch DIR`: until nobody works on it any more. Answers with the exit code of the campaign; 2 while it is
// not complete.
int watch_campaign(Session& session);

}  // namespace fieldproof::cli

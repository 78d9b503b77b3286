// Whether two stored runs are of the same thing.
#pragma once

#include <string>

#include "reports/results.hpp"

namespace fieldproof::cli {

// What of that which decides the outcome is not the same, as a sentence without its end: "the seed was 1, not
// 2"; empty: all is. What is compared is what the options mean, not how they are written: stored ones name
// their files from anywhere.
std::string difference(const reports::RunIdentity& stored, const reports::RunIdentity& now);

}  // namespace fieldproof::cli

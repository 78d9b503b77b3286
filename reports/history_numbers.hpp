// The numbers that can be followed from run to run: what cases measured, and what documents of other verbs in
// the folder of a run say.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "reports/page_content.hpp"
#include "reports/results.hpp"

namespace fieldproof::reports {

struct Number {
  std::string name;
  std::string unit;
  double value = 0;
};

// Of documents: the thresholds of `emc`, and of `measure` the mean of each distribution on the quiet line. A
// file that is no such document, or a damaged one, has no numbers. A name comes twice where it is measured
// twice; of documents of one kind and network the first by name of the file counts.
std::vector<Number> numbers_of(const std::filesystem::path& folder, const Run& run,
                               std::span<const DocumentKind> kinds);

}  // namespace fieldproof::reports

// The journal of a run: the result of every case, stored the moment it is known (checked_lines.hpp), so that
// a verdict that was printed is never lost.
//
// Limits: a case may stand in the journal more than once (it was run again on resume); the last line counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "harness/judge/checked_lines.hpp"
#include "harness/judge/finding.hpp"

namespace fieldproof::judge {

class Journal {
 public:
  // Creates the file, or continues it, as CheckedLines does.
  explicit Journal(std::filesystem::path path, Durability durability = Durability::written);

  // Call it before the verdict is printed.
  void append(const CaseResult& result);

 private:
  CheckedLines lines_;
};

struct JournalContent {
  std::vector<CaseResult> results;  // one per case, in the order of their first appearance
  bool is_torn = false;             // the last line was incomplete and is not among the results
  std::uintmax_t intact_size = 0;   // octets up to the end of the last intact line
};

JournalContent read_journal(const std::filesystem::path& path);

}  // namespace fieldproof::judge

// The folders of runs below a folder, in the order of their time.
//
// Contract: links are not followed, so `latest` is nobody's second run, and below a run nothing is looked
// for. What is damaged or of another program is named with its reason and left out; only a folder that is not
// there, or holds no run at all, is a kernel::Error(configuration).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "reports/run_directory.hpp"

namespace fieldproof::reports {

struct LeftOut {
  std::string name;  // relative to the folder
  std::string why;

  friend bool operator==(const LeftOut&, const LeftOut&) = default;
};

struct FoundRuns {
  std::size_t older = 0;  // that are there, and not looked at
  std::vector<LeftOut> left_out;
};

// Calls `take` with each of the last `most` runs, the newest first.
FoundRuns for_each_run(const std::filesystem::path& folder, std::size_t most,
                       const std::function<void(const std::string& name, const std::filesystem::path& path,
                                                const StoredRun& run)>& take);

}  // namespace fieldproof::reports

// What searches of many jobs have shown together: how coverage grew, and the corpus that is left of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "campaign/outcome.hpp"

namespace fieldproof::campaign {

// The corpora of jobs that searched the same implementation in the same way, merged.
struct MergedCorpus {
  std::string name;                 // its folder is corpus/<name> of the campaign
  std::string command;              // that merged them
  std::vector<std::uint64_t> jobs;  // rising
  std::uint64_t sequences = 0;
  std::uint64_t edges = 0;  // that all of them pass together
  std::string message;      // why it is only collected and not made smaller; empty: it is
};

struct JointGrowth {
  std::uint64_t run = 0;    // of each job, or as many as it had
  std::uint64_t all = 0;    // of all jobs together by then
  std::uint64_t edges = 0;  // the most that one job had passed by then
};

// At the numbers 1, 2, 5, 10, 20, 50 ..., and at the end.
std::vector<JointGrowth> joint_growth(std::span<const Outcome* const> jobs);

// "edges 120 after 1,000, 131 after 10,000": the last of its powers of ten, and the end.
std::string text_of(std::span<const JointGrowth> growth);

}  // namespace fieldproof::campaign

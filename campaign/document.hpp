// campaign.json: all that a campaign has shown, made from the outcomes of its jobs.
//
// Contract: equal outcomes give equal octets; nothing of time, machine or number of workers is in it. The
// JSON is valid against campaign_result.schema.json for every content.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "campaign/confidence.hpp"
#include "campaign/growth.hpp"
#include "campaign/outcome.hpp"

namespace fieldproof::campaign {

struct Report {
  std::string title;
  std::string suite_version;
  std::string plan_hash;
  std::uint64_t planned = 0;       // jobs
  std::string incomplete_because;  // empty: complete
  int exit_code = 0;
  const std::map<std::uint64_t, Outcome>* outcomes = nullptr;
  std::function<std::string(std::uint64_t id)> command;  // of a job
  std::vector<MergedCorpus> corpora;                     // what searches have left
  const Confidence* confidence = nullptr;                // null: no such goal
  UpperBound bound;
};

// The sums over all jobs.
struct Totals {
  std::map<int, std::uint64_t> by_exit_code;
  std::map<std::string, std::uint64_t> by_headline;  // "pass", "B"
  std::uint64_t killed = 0;
  std::uint64_t failed_cases = 0;
  Counts cases;   // of run, by verdict
  Counts ledger;  // of emc
  Counts search;  // of fuzz: "jobs", "run", "found"
  std::set<std::string> caveats;
};
Totals totals_of(const std::map<std::uint64_t, Outcome>& outcomes);

// The exit code of a campaign is that of its worst job, by the order in which the program knows them: 70, 64,
// 65, 74, 5, 1, 3, 2, 0; 4 only where nothing at all was judged.
int worst_exit_code(const std::map<std::uint64_t, Outcome>& outcomes);

std::string document_text(const Report& report);
// For a person: counts, sums, what failed (the first of them), and how it comes again.
std::string report_text(const Report& report);

}  // namespace fieldproof::campaign

// The failures that whoever runs a suite knows of and lives with for a while: `--baseline FILE`.
//
//   { "expected": [ { "case": "PROTOCOL/ROLE/write/drives_the_valves", "finding": "valves_too_late",
//                     "reason": "slow driver of board B", "expires": "2027-03-31" } ] }
//
// Contract: each entry names one case by its id, why its failure is accepted, and the last day of that; with
// `finding` only a failure with this reason code is. A baseline says what is so: an entry whose case passes,
// does not apply or has expired is stale, and makes a run fail that is good otherwise. Cases that a run does
// not judge are neither.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "conformance/catalogue.hpp"
#include "reports/results.hpp"

namespace fieldproof::cli {

class Baseline {
 public:
  // `today` is the day of the run, UTC. Throws kernel::Error(configuration) with file, line and what would be
  // right, also for a case that the catalogue does not have.
  static Baseline load(const std::filesystem::path& file, const conformance::Catalogue& catalogue,
                       std::chrono::year_month_day today);

  // Says in the result that it is expected, if it is.
  void mark(judge::CaseResult& result) const;
  // What is not as the baseline says, a sentence for each entry, in their order.
  std::vector<std::string> stale(const reports::Run& run) const;

 private:
  struct Entry {
    std::string id;
    std::string finding;  // empty: any
    std::string reason;
    std::string expires;  // "2027-03-31"
    bool has_expired = false;
    std::string place;  // "baseline.json:4"
  };

  bool is_about(const Entry& entry, const judge::CaseResult& result) const;

  std::vector<Entry> entries_;
};

std::chrono::year_month_day today_utc();

}  // namespace fieldproof::cli

// One run while it happens: its directory, its journal, and the results so far.
//
// Contract: a result is in the journal before its verdict is printed; whatever ends the run, `close` writes
// the partial or whole result, in catalogue order, marked incomplete when a reason is given. Without `close`
// (SIGKILL) the directory is readable and holds every verdict that was printed.
#pragma once

#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/baseline.hpp"
#include "cli/run_setup.hpp"
#include "harness/judge/journal.hpp"
#include "reports/outcome.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {

// The options of a run, in its directory: what `--config` reads.
inline constexpr const char* kConfigurationFile = "configuration.json";

class RunBook {
 public:
  // A new run below runs/, or exactly at `out` when that is not empty.
  RunBook(const std::string& out, reports::Manifest manifest, reports::RunIdentity identity,
          std::vector<conformance::Entry> selected, const std::string& configuration);
  // Continues a stored run. The journal was opened before the run was loaded, so that nobody else wrote
  // since.
  RunBook(reports::RunDirectory directory, std::unique_ptr<judge::Journal> journal, reports::StoredRun stored,
          std::vector<conformance::Entry> selected);

  const reports::RunDirectory& directory() const { return directory_; }
  const reports::Manifest& manifest() const { return manifest_; }
  const reports::Run& run() const { return run_; }

  // The selected cases that have no result yet.
  std::vector<conformance::Entry> open_cases() const;

  void add(const conformance::CaseRun& done);
  // Which failures of all cases are expected, also of those that were judged before a resumption under
  // another baseline; and what the baseline says and the run does not show.
  void hold_against(const Baseline& baseline);
  void close(const std::string& incomplete_because, int exit_code, const reports::OutcomeRules& rules);

 private:
  void sort_by_catalogue();

  reports::RunDirectory directory_;
  reports::Manifest manifest_;
  reports::Run run_;
  std::vector<conformance::Entry> selected_;
  std::unique_ptr<judge::Journal> journal_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace fieldproof::cli

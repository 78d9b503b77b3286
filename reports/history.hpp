// What many runs show that one does not: how the counts went, which cases change their verdict to and fro,
// which began to fail and when, and which measured numbers drift.
//
// Contract: only runs of one setup are compared with each other: the same implementations, network, PICS,
// plan of faults and volume. A case is flaky when its verdict came back to what it was before under one
// suite; what began to fail failed in the newest run that judged it, and passed before. Numbers are those
// that cases measured, and those of documents of `emc` and `measure` that lie in the folder of the run. A
// drift is said to be one only if chance would show it in one of twenty histories with as many numbers as
// this one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "reports/history_folders.hpp"
#include "reports/page_content.hpp"
#include "reports/trend.hpp"

namespace fieldproof::reports {

struct HistoryRun {
  std::string name;
  std::string started;
  std::size_t setup = 0;  // place in History::setups
  std::string suite_version;
  std::uint64_t seed = 0;
  judge::Verdict verdict = judge::Verdict::none;
  std::string sentence;
  std::size_t passed = 0;  // also with a warning, or as the baseline expects
  std::size_t failed = 0;  // also in an error
  std::size_t inconclusive = 0;
  std::size_t not_run = 0;
  std::uint64_t wall_time_us = 0;
};

struct FlakyCase {
  std::string id;
  std::size_t setup = 0;
  std::string suite_version;
  bool has_equal_seeds = false;  // other verdicts though the seed was the same
  std::vector<std::pair<std::size_t, judge::Verdict>> verdicts;  // places of runs, the oldest first
};

struct BrokenCase {
  std::string id;
  std::size_t setup = 0;
  std::size_t last_good = 0;  // places of runs
  std::size_t first_bad = 0;
  std::string reason;
};

struct Quantity {
  std::string name;
  std::string unit;
  std::size_t setup = 0;
  std::vector<std::pair<std::size_t, double>> values;  // places of runs, the oldest first
  Trend trend;
};

enum class Drifts : std::uint8_t { untested, no, perhaps, yes };

struct History {
  std::string folder;
  std::vector<HistoryRun> runs;  // the oldest first
  std::vector<std::string> setups;
  std::vector<FlakyCase> flaky;
  std::vector<BrokenCase> broken;
  std::vector<Quantity> quantities;  // the surest drift first
  std::size_t varying = 0;           // of the quantities: those that could drift
  FoundRuns found;

  Drifts drifts(const Quantity& quantity) const;
};

// The last `most` runs below `folder`.
History history_of(const std::filesystem::path& folder, std::size_t most,
                   std::span<const DocumentKind> kinds);

// "drifts: by +0.2 us from run to run (p = 0.0003)".
std::string drift_text(const History& history, const Quantity& quantity);
std::string history_text(const History& history);
nlohmann::ordered_json history_json(const History& history);  // for the page

}  // namespace fieldproof::reports

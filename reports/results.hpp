// What a run was and what came out of it: the model that every report is written from.
//
// Two halves, so that equal runs are equal bytes: RunIdentity and the results hold only what seed, suite and
// configuration decide (results.json; the same for any number of jobs); Manifest adds what the occasion
// decided: when, where, by which build, for how long (manifest.json, timings.json).
//
// Every text may come from an implementation under test; the writers escape.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/fault/plan_part.hpp"
#include "harness/judge/finding.hpp"
#include "harness/judge/input_file.hpp"

namespace fieldproof::reports {

// Who played which role. `position` 1 is next to the master; 0 is the protocol's default.
struct Implementation {
  std::string role;
  int position = 0;
  std::string uri;

  friend bool operator==(const Implementation&, const Implementation&) = default;
};

// What decides the outcome of a run.
struct RunIdentity {
  std::string tool_version;
  std::string suite_version;
  std::uint64_t seed = 1;
  std::string volume;                 // of the repetitions: "quick", "full"
  std::string plan_hash;              // of the declared faults; empty: none
  std::vector<fault::PlanPart> plan;  // its parts, in the order of CaseResult::planned_hits
  std::string network_hash;           // of the network file; empty: the suites' own networks
  std::vector<std::string> caveats;   // what must be said about all results of the run; sentences
  std::string pics_hash;              // of the answers of the PICS; empty: none
  // What the baseline of expected failures says and the run does not show; sentences.
  std::vector<std::string> stale_expectations;
  std::vector<std::string> selectors;
  std::vector<Implementation> implementations;
  std::vector<judge::InputFile> inputs;  // that the options name, also programs and libraries
  // Every option of the command line that decides the outcome, quoted for a shell, without the selector:
  // "--seed 7 --iut slave=mutant:crc_preset_zero".
  std::string reproduce_options;
  std::size_t selected = 0;        // cases selected, also those that an interrupted run never judged
  std::string incomplete_because;  // empty: complete; "interrupted by SIGINT"
  int exit_code = 0;
};

struct Run {
  RunIdentity identity;
  std::vector<judge::CaseResult> cases;  // in the order of the catalogue

  bool is_complete() const { return identity.incomplete_because.empty(); }
};

// What the occasion decided.
struct Manifest {
  std::string build_type;
  std::string compiler;
  std::string host;
  std::vector<std::string> arguments;  // the command line as it was typed, program first
  std::string started;                 // UTC, "2026-11-21T05:18:28Z"
  std::string finished;                // UTC; empty while the run goes on, and for ever after a kill
  std::uint64_t wall_time_us = 0;
  unsigned jobs = 1;
};

inline constexpr std::size_t kVerdicts = 7;

// Counts by verdict with their denominators.
struct Counts {
  std::size_t selected = 0;
  std::size_t judged = 0;  // a verdict from pass to error: not "none", not "not-applicable"
  std::array<std::size_t, kVerdicts> by_verdict{};
  std::size_t expected = 0;  // of those that do not pass: the baseline lists them

  std::size_t of(judge::Verdict verdict) const { return by_verdict.at(static_cast<std::size_t>(verdict)); }
  std::size_t not_run() const;  // selected cases without a result, and those whose verdict is none
};

Counts count(const Run& run);

// What a result counts as where it is decided whether a run is good: a failure that is expected passes.
judge::Verdict counted_verdict(const judge::CaseResult& result);

// The heaviest of what its results count as; none when there are no results.
judge::Verdict headline(const Run& run);

// Verdicts, from pass to error, of cases whose source is unverified.
std::size_t unverified_verdicts(const Run& run);

// What a part of the plan of faults did in the cases that ran under it.
struct PlannedFault {
  fault::PlanPart part;
  std::uint64_t hits = 0;     // in all of them; the largest number stands for more
  std::size_t cases_hit = 0;  // in which it hit at all
  std::size_t cases = 0;
};
std::vector<PlannedFault> planned_faults(const Run& run);

// The command that runs this case again: "fieldproof run PROTOCOL/ROLE/x --seed 7".
std::string reproduce_command(const RunIdentity& identity, const std::string& case_id);

// `word` as one word of a POSIX shell, quoted only where it must be.
std::string shell_quoted(const std::string& word);

}  // namespace fieldproof::reports

// What a campaign keeps of a job that ended: what its document and its journal say, in one line of JSON. The
// documents of the job itself lie in its folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/job.hpp"

namespace fieldproof::campaign {

// Numbers by their names, which are those of the documents.
using Counts = std::map<std::string, std::uint64_t, std::less<>>;

// How far a search had come after so many sequences.
struct GrowthPoint {
  std::uint64_t run = 0;
  std::uint64_t edges = 0;
};

struct Outcome {
  std::uint64_t id = 0;
  int exit_code = 0;                 // of the verb; 1 for a job that could not be brought to an end
  std::string killed;                // how its process ended each time: a finding. Empty: it ended by itself
  std::string headline;              // the document in a word: "pass", "B", "holds". Empty: it has none
  std::string message;               // the last line of standard error of a call that was refused
  std::vector<std::string> files;    // below its folder, besides its document and corpus
  std::uint64_t kept = 0;            // files below its folder, all of them
  Counts cases;                      // of run: cases by verdict
  std::vector<std::string> failed;   // of run: ids of cases that failed, in the order of the suite
  Counts search;                     // of fuzz: "run", "stored", "edges", "kept", "found"
  std::vector<GrowthPoint> growth;   // of fuzz, rising
  Counts ledger;                     // of emc: its error ledgers, added up
  std::vector<std::string> caveats;  // what must be said about its numbers
  std::uint64_t wall_time_ms = 0;    // of the occasion: in no document
};

// A document of a kind that is not known gives no more than the exit code.
Outcome outcome_of(const JobResult& result);

std::string to_json(const Outcome& outcome);
// Throws kernel::Error(configuration) with `place` for what is none.
Outcome outcome_from_json(std::string_view text, const std::string& place);

// A file of a job that is a sequence of its corpus.
bool is_of_corpus(std::string_view name);

// Adds each number to the one of the same name.
void add(const Counts& more, Counts& sum);
// 0 where there is none.
std::uint64_t count_of(const Counts& counts, std::string_view name);

}  // namespace fieldproof::campaign

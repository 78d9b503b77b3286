// A job of a campaign: one call of one verb. JSON in, JSON out, and it depends on nothing else: where it
// runs, in which process, on which machine, decides nothing of its result.
//
// The texts are for processes of one build: they carry what this version writes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/judge/input_file.hpp"

namespace fieldproof::campaign {

// A file that the job writes into its own folder.
struct OutputFile {
  std::string option;  // "--json"
  std::string name;    // below the folder: "document.json"
};

// The document of a job: what its verb writes as JSON.
inline constexpr const char* kDocument = "document.json";

// The folder of a job with the sequences that its search leaves: a file each.
inline constexpr const char* kCorpus = "corpus";

struct Job {
  std::uint64_t id = 0;  // 1, 2, 3 ...
  std::string verb;
  std::vector<std::string> arguments;  // after the verb
  std::vector<std::string> manner;     // further ones that decide nothing: "--quiet", "--jobs", "1"
  std::vector<OutputFile> outputs;
  std::vector<judge::InputFile> inputs;  // and what must be in them, wherever the job runs
  std::chrono::milliseconds limit{};     // after which its process is killed
};

struct KeptFile {
  std::string name;
  std::string text;
};

struct JobResult {
  std::uint64_t id = 0;
  int exit_code = 0;
  // How its process was ended before it ended by itself: "was ended by signal 9 (Killed)". Empty: it was not.
  std::string loss;
  // Why this place cannot do the job at all, and the exit code of that. Empty: it can.
  std::string obstacle;
  int obstacle_code = 0;
  std::string log;              // the last lines of standard error
  std::vector<KeptFile> files;  // what it wrote: documents and case files
  std::uint64_t wall_time_ms = 0;

  // The text of a file of that name; empty when there is none.
  std::string_view file(std::string_view name) const;
};

// The command that does what the job does: "fieldproof run PROTOCOL/ROLE/** --seed=7".
std::string command_of(const Job& job);

std::string to_json(const Job& job);
std::string to_json(const JobResult& result);
Job job_from_json(std::string_view text);
JobResult result_from_json(std::string_view text);

}  // namespace fieldproof::campaign

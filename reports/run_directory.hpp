// The directory of a run:
//
//   manifest.json  results.json  timings.json  junit.xml  journal.jsonl
//   cases/<id>/{case.json,trace.txt,timeline.json,trace.pcapng,playback.json,log.txt}
//
// Contract: a file appears under its name only when it is whole (written beside and renamed). manifest.json
// and results.json are there from the beginning, marked incomplete, so that also a killed run is a run:
// `load` takes what results.json does not have from the journal. Case ids are paths of words joined by '/';
// in a directory's name '/' becomes '+' and every octet outside [A-Za-z0-9._-] becomes %NN, so no id leaves
// cases/ and two ids never share a directory. Whatever cannot be done throws kernel::Error naming the path.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reports/results.hpp"

namespace fieldproof::reports {

struct StoredRun {
  Manifest manifest;
  Run run;
  bool journal_was_torn = false;
};

class RunDirectory {
 public:
  // Creates PARENT/<utc>-<seed>, with "-2", "-3" ... appended when it exists, points PARENT/latest at it, and
  // writes the first manifest.json and results.json (marked incomplete: "the run did not end").
  static RunDirectory create(const std::filesystem::path& parent, const Manifest& manifest,
                             const RunIdentity& identity);

  // The same at exactly this path, without `latest`; refuses a path that is there and not an empty directory.
  static RunDirectory create_at(const std::filesystem::path& path, const Manifest& manifest,
                                const RunIdentity& identity);

  // An existing run, or `latest` of a directory of runs. Anything else is an Error(configuration) that says
  // what is missing.
  static RunDirectory open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  // What could not be done beside the run itself: a `latest` that is no link. Empty: nothing.
  const std::string& warning() const { return warning_; }
  std::filesystem::path journal() const { return path_ / "journal.jsonl"; }
  std::filesystem::path case_directory(std::string_view case_id) const;

  // results.json, timings.json, manifest.json, in this order.
  void store(const Manifest& manifest, const Run& run) const;

  // Any other file of the run, whole or not at all.
  void write(std::string_view name, std::string_view content) const;
  void write_case(std::string_view case_id, std::string_view name, std::string_view content) const;
  std::string read_case(std::string_view case_id, std::string_view name) const;

  // Manifest, results and wall times; results that only the journal has (the run was killed) follow the
  // stored ones in the order of the journal. An unreadable or newer document is an Error(configuration).
  StoredRun load() const;

 private:
  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  void begin(const Manifest& manifest, const RunIdentity& identity) const;

  std::filesystem::path path_;
  std::string warning_;
};

// The name of a case's directory below cases/.
std::string case_directory_name(std::string_view case_id);

// The whole file, or kernel::Error(configuration): what config::read_text takes. Writing replaces atomically
// and creates missing parents; `check_writable` refuses now what writing would refuse later.
void check_writable(const std::filesystem::path& path);
std::string read_text_file(const std::filesystem::path& path);
void write_text_file(const std::filesystem::path& path, std::string_view content);
// The first at `path`, the others beside it: "ci.xml", "ci-2.xml", "ci-3.xml". Into a device or a pipe they
// go one after another.
void write_files(const std::filesystem::path& path, const std::vector<std::string>& contents);

}  // namespace fieldproof::reports

// The folder of a campaign:
//
//   manifest.json  plan.json  journal.jsonl  jobs/<id>/{document.json,...}  campaign.json
//
// Contract: a file appears under its name only when it is whole. A job's line is in the journal after its
// files are there. campaign.json is written at the end, also of an interrupted campaign; manifest.json and
// plan.json are there from the beginning.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "campaign/job.hpp"

namespace fieldproof::campaign {

// What a campaign must be to be the same one, and what the occasion decided.
struct Manifest {
  std::string suite_version;
  std::string plan_hash;                 // of what the plan says, not of how it is written
  std::vector<judge::InputFile> inputs;  // all files that jobs read
  std::uint64_t jobs = 0;                // planned
  std::string folder;                    // in which it was begun: where relative paths lead
  std::string started;                   // UTC
};

class Folder {
 public:
  // Exactly this path, which must not exist or be an empty folder.
  static Folder create_at(const std::filesystem::path& path, const Manifest& manifest, std::string_view plan);
  // PARENT/STEM, or with -2, -3 ... appended when it exists.
  static Folder create_below(const std::filesystem::path& parent, const std::string& stem,
                             const Manifest& manifest, std::string_view plan);
  // One that is there; kernel::Error(configuration) for what is none.
  static Folder open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const Manifest& manifest() const { return manifest_; }
  std::filesystem::path plan() const { return path_ / "plan.json"; }
  std::filesystem::path journal() const { return path_ / "journal.jsonl"; }
  std::filesystem::path document() const { return path_ / "campaign.json"; }

  void write_job(const JobResult& result) const;
  // Whether so many files of a job are still there.
  bool holds(std::uint64_t job, std::uint64_t files) const;
  void write_document(std::string_view text) const;

 private:
  Folder(std::filesystem::path path, Manifest manifest)
      : path_(std::move(path)), manifest_(std::move(manifest)) {}
  void begin(std::string_view plan) const;

  std::filesystem::path path_;
  Manifest manifest_;
};

}  // namespace fieldproof::campaign

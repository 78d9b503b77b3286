// What the distributor of a campaign can take: outcomes that have just come, each with its document, are kept
// and on the disk before the next job is given. Jobs here take no time, so this rate over that of one rank is
// the number of ranks at which the distributor becomes the narrow place.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "bench/rows.hpp"
#include "campaign/distribution.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kJobs = 200;
constexpr std::size_t kRanks = 64;

// As that of a burst report of one level.
const std::string& document() {
  static const std::string text = [] {
    std::string ledger = R"("sent": 1000, "balance": {"data_differed": 10}, "wrong_cycles": 0)";
    std::string json =
        R"({"schema": "fieldproof/emc/1", "unverified": ["a caveat"], "channels": [], "tests": [)";
    for (int test = 0; test < 20; ++test)
      json += fmt::format(R"({}{{"criterion": "B", "ledger": {{{}}}}})", test == 0 ? "" : ", ", ledger);
    return json + "]}";
  }();
  return text;
}

class EmptyFolder {
 public:
  EmptyFolder() : path_(fs::temp_directory_path() / fmt::format("fieldproof-bench-{}", ::getpid())) {
    fs::remove_all(path_);
  }
  EmptyFolder(const EmptyFolder&) = delete;
  EmptyFolder& operator=(const EmptyFolder&) = delete;
  ~EmptyFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Ranks whose jobs are done at once; what they send has been a message, as that of a rank elsewhere.
class SwiftSlots final : public campaign::Slots {
 public:
  std::size_t free() const override { return kRanks - ended_.size(); }
  void give(const campaign::Job& job) override {
    const campaign::Job received = campaign::job_from_json(campaign::to_json(job));
    campaign::JobResult result;
    result.id = received.id;
    result.files.push_back({campaign::kDocument, document()});
    ended_.push_back(campaign::result_from_json(campaign::to_json(result)));
  }
  std::vector<campaign::JobResult> wait(std::chrono::milliseconds) override {
    return std::exchange(ended_, {});
  }
  void abandon() override { ended_.clear(); }

 private:
  std::vector<campaign::JobResult> ended_;
};

campaign::Job job_of(std::uint64_t id) {
  campaign::Job job;
  job.id = id;
  job.verb = "emc";
  job.arguments = {"interbus", fmt::format("--seed={}", id)};
  return job;
}

Batch distribution() {
  return []() -> std::uint64_t {
    const EmptyFolder folder;
    campaign::Manifest manifest;
    manifest.jobs = kJobs;
    campaign::Distribution::Plan plan;
    plan.count = kJobs;
    plan.job = job_of;
    const campaign::Folder of_campaign = campaign::Folder::create_at(folder.path(), manifest, "{}");
    campaign::Distribution all(plan, of_campaign);
    SwiftSlots slots;
    all.run(slots, {});
    FIELDPROOF_CHECK(all.is_complete(), "each job has been done");
    return kJobs;
  };
}

// Files of the same size and a synced line of a journal, and nothing else.
Batch files_and_lines() {
  return []() -> std::uint64_t {
    const EmptyFolder folder;
    fs::create_directories(folder.path() / "jobs");
    const int journal =
        ::open((folder.path() / "journal.jsonl").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    FIELDPROOF_CHECK(journal >= 0, "the temporary folder can be written");
    const std::string line(300, 'x');
    for (std::uint64_t id = 1; id <= kJobs; ++id) {
      const fs::path of_job = folder.path() / "jobs" / std::to_string(id);
      fs::create_directory(of_job);
      std::ofstream(of_job / campaign::kDocument) << document();
      const bool is_kept = ::write(journal, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                           ::fdatasync(journal) == 0;
      FIELDPROOF_CHECK(is_kept, "the temporary folder takes what is written");
    }
    ::close(journal);
    return kJobs;
  };
}

const Rows kRows({{.group = "outcomes of a campaign",
                   .name = "files and synced lines",
                   .unit = "outcomes",
                   .against = "",
                   .target_ratio = 0,
                   .make = files_and_lines,
                   .waits = true},
                  {.group = "outcomes of a campaign",
                   .name = "fieldproof, kept by the distributor",
                   .unit = "outcomes",
                   .against = "files",
                   .target_ratio = 0.3,
                   .make = distribution,
                   .waits = true}});

}  // namespace
}  // namespace fieldproof::bench

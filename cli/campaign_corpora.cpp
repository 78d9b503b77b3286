#include "cli/campaign_corpora.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "campaign/local_slots.hpp"
#include "cli/sequence_corpus.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// What jobs that share a corpus may differ in.
bool is_of_one_job(std::string_view word) {
  constexpr std::array<std::string_view, 3> kOptions = {"--seed=", "--cases=", "--corpus="};
  return std::ranges::any_of(kOptions, [&](std::string_view option) { return word.starts_with(option); });
}

struct Group {
  std::vector<std::string> words;  // of all its jobs
  std::string seed;                // of its first job, as it was given
  campaign::MergedCorpus corpus;
};

std::string name_of(const std::string& role, std::set<std::string>& taken) {
  std::string stem = role;
  std::ranges::replace(stem, '/', '-');
  std::string name = stem;
  for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}-{}", stem, n);
  return name;
}

std::vector<Group> groups_of(const CampaignPlan& plan,
                             const std::map<std::uint64_t, campaign::Outcome>& outcomes) {
  std::vector<Group> groups;
  std::set<std::string> names;
  for (const auto& [id, outcome] : outcomes) {
    if (outcome.search.empty()) continue;
    const campaign::Job job = plan.job(id);
    std::vector<std::string> words = job.arguments;
    std::erase_if(words, is_of_one_job);
    auto group = std::ranges::find(groups, words, &Group::words);
    if (group == groups.end()) {
      groups.push_back({words, {}, {}});
      group = groups.end() - 1;
      group->corpus.name = name_of(words.front(), names);
      for (const std::string& word : job.arguments)
        if (word.starts_with("--seed=")) group->seed = word;
    }
    group->corpus.jobs.push_back(id);
  }
  return groups;
}

fs::path corpus_of(const campaign::Folder& folder, std::uint64_t job) {
  return folder.path() / "jobs" / std::to_string(job) / campaign::kCorpus;
}

// Equal sequences have one name. Gives how many are there now.
std::size_t collect(const fs::path& corpus, const fs::path& into) {
  std::error_code failure;
  if (fs::is_directory(corpus, failure)) {
    for (const fs::path& file : corpus_files(corpus)) {
      if (!fs::exists(into / file.filename(), failure))
        reports::write_text_file(into / file.filename(), reports::read_text_file(file));
    }
  }
  return fs::is_directory(into, failure) ? corpus_files(into).size() : 0;
}

campaign::Job merging_job(const Group& group, const fs::path& collected, std::chrono::milliseconds limit) {
  campaign::Job job;
  job.verb = "fuzz";
  job.arguments = group.words;
  if (!group.seed.empty()) job.arguments.push_back(group.seed);
  job.arguments.emplace_back("--cases=0");
  job.manner = {"--quiet", "--corpus=" + collected.string()};
  job.outputs = {
      {"--json", campaign::kDocument}, {"--case", "found.case.json"}, {"--corpus-out", campaign::kCorpus}};
  job.limit = limit;
  return job;
}

std::optional<campaign::JobResult> run_alone(const campaign::Job& job,
                                             const std::function<bool()>& is_interrupted) {
  constexpr std::chrono::milliseconds kLook{200};
  campaign::LocalSlots slots(1);
  slots.give(job);
  while (!is_interrupted()) {
    std::vector<campaign::JobResult> ended = slots.wait(kLook);
    if (!ended.empty()) return std::move(ended.front());
  }
  return std::nullopt;
}

// Why a result is none of a merge; empty: it is one.
std::string objection_to(const campaign::JobResult& result) {
  if (!result.loss.empty()) return "the process that merges them " + result.loss;
  if (!result.obstacle.empty()) return result.obstacle;
  if (result.exit_code == 1) return "a sequence that had passed fails now";
  if (result.file(campaign::kDocument).empty()) return fmt::format("exit code {}", result.exit_code);
  return {};
}

void replace(const fs::path& folder, const campaign::JobResult& result, campaign::MergedCorpus& corpus) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  corpus.sequences = 0;
  corpus.edges = nlohmann::json::parse(result.file(campaign::kDocument)).at("edges").get<std::uint64_t>();
  for (const campaign::KeptFile& file : result.files) {
    if (!campaign::is_of_corpus(file.name)) continue;
    reports::write_text_file(folder / fs::path(file.name).filename(), file.text);
    ++corpus.sequences;
  }
}

// A part of the jobs at a time, in the order of their ids: a campaign may leave more than a process can hold.
// False: it was told to end.
bool merge(const CampaignPlan& plan, const campaign::Folder& folder, const fs::path& collected, Group& group,
           const std::function<bool()>& is_interrupted) {
  constexpr std::size_t kAtOnce = 5000;
  campaign::MergedCorpus& corpus = group.corpus;
  const campaign::Job job = merging_job(group, collected, plan.job(corpus.jobs.front()).limit);
  corpus.command = command_of(job) + " --corpus=DIR";
  for (const std::uint64_t& id : corpus.jobs) {
    corpus.sequences = collect(corpus_of(folder, id), collected);
    const bool is_last = &id == &corpus.jobs.back();
    if (corpus.sequences == 0 || (!is_last && corpus.sequences < kAtOnce)) continue;
    if (!corpus.message.empty()) continue;  // then they are only collected
    const auto result = run_alone(job, is_interrupted);
    if (!result) return false;
    corpus.message = objection_to(*result);
    if (corpus.message.empty()) replace(collected, *result, corpus);
  }
  return true;
}

}  // namespace

std::vector<campaign::MergedCorpus> merge_corpora(const CampaignPlan& plan, const campaign::Folder& folder,
                                                  const std::map<std::uint64_t, campaign::Outcome>& outcomes,
                                                  const std::function<bool()>& is_interrupted) {
  std::vector<campaign::MergedCorpus> merged;
  std::error_code ignored;
  for (Group& group : groups_of(plan, outcomes)) {
    const fs::path collected = folder.path() / "merging" / group.corpus.name;
    const fs::path target = folder.path() / campaign::kCorpus / group.corpus.name;
    fs::remove_all(collected, ignored);
    if (is_interrupted() || !merge(plan, folder, collected, group, is_interrupted)) break;
    fs::remove_all(target, ignored);
    if (group.corpus.sequences == 0) continue;
    fs::create_directories(target.parent_path(), ignored);
    fs::rename(collected, target);
    merged.push_back(std::move(group.corpus));
  }
  fs::remove_all(folder.path() / "merging", ignored);
  return merged;
}

}  // namespace fieldproof::cli

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "campaign/distribution.hpp"
#include "campaign/document.hpp"
#include "campaign/folder.hpp"
#include "campaign/local_slots.hpp"
#include "campaign/rank_slots.hpp"
#include "campaign/ranks.hpp"
#include "cli/build_info.hpp"
#include "cli/campaign_corpora.hpp"
#include "cli/campaign_plan.hpp"
#include "cli/campaign_preview.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/verbs.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof campaign`: many jobs of other verbs, over processes of this machine or ranks of many.
namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostWorkers = 1024;

[[noreturn]] void refuse_call(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

campaign::Manifest manifest_for(const Session& session, const CampaignPlan& plan) {
  return {.suite_version = suite_version(session.catalogue()),
          .plan_hash = plan.hash(),
          .inputs = plan.inputs(),
          .jobs = plan.count(),
          .folder = fs::current_path().string(),
          .started = utc_now()};
}

// What is gone on with must be the same campaign.
void check_same_campaign(const campaign::Folder& folder, const campaign::Manifest& now) {
  const campaign::Manifest& stored = folder.manifest();
  const auto refuse_resumption = [&](const std::string& sentence) {
    refuse_call(fmt::format("--resume {}: {}; start a new campaign", folder.path().string(), sentence));
  };
  if (stored.plan_hash != now.plan_hash || stored.jobs != now.jobs)
    refuse_resumption("its plan says something else than this one");
  if (stored.suite_version != now.suite_version)
    refuse_resumption(fmt::format("the suite was {} and is {}", stored.suite_version, now.suite_version));
  for (const judge::InputFile& file : stored.inputs) {
    const auto same = std::ranges::find(now.inputs, file.path, &judge::InputFile::path);
    if (same == now.inputs.end())
      refuse_resumption(fmt::format("{} is not there any more, seen from this folder; it was begun in {}",
                                    file.path, stored.folder));
    if (same->hash != file.hash) refuse_resumption(fmt::format("{} has changed since", file.path));
  }
}

// The campaign of this call: its plan, and its folder.
struct Opened {
  CampaignPlan plan;
  campaign::Folder folder;
};

Opened open_campaign(const Session& session) {
  const Settings& settings = session.settings;
  if (settings.is_set("resume")) {
    campaign::Folder folder = campaign::Folder::open(settings.text("resume"));
    CampaignPlan plan(session.operands.empty() ? folder.plan() : fs::path(session.operands.front()),
                      session.catalogue());
    check_same_campaign(folder, manifest_for(session, plan));
    return {std::move(plan), std::move(folder)};
  }
  const fs::path file = session.operands.front();
  CampaignPlan plan(file, session.catalogue());
  const campaign::Manifest manifest = manifest_for(session, plan);
  campaign::Folder folder =
      settings.is_set("out")
          ? campaign::Folder::create_at(settings.text("out"), manifest, plan.text())
          : campaign::Folder::create_below("campaigns", file.stem().string(), manifest, plan.text());
  return {std::move(plan), std::move(folder)};
}

// One call of `campaign`: runs what is open, and writes the document whatever ends it.
class CampaignRun {
 public:
  explicit CampaignRun(Session& session)
      : session_(session), opened_(open_campaign(session)), interruption_(time_limit()) {
    if (opened_.plan.confidence()) confidence_.emplace(*opened_.plan.confidence(), bound());
  }

  int run(campaign::Slots& slots) {
    campaign::Distribution distribution(distribution_plan(), opened_.folder);
    session_.terminal.print(fmt::format("campaign of {} jobs, {}, plan {}, in {}\n", opened_.plan.count(),
                                        opened_.folder.manifest().suite_version, opened_.plan.hash(),
                                        opened_.folder.path().string()));
    if (!distribution.outcomes().empty())
      session_.terminal.log(fmt::format("{} of {} jobs are done already", distribution.outcomes().size(),
                                        opened_.plan.count()));
    if (distribution.without_files() > 0)
      session_.terminal.log(fmt::format("the files of {} jobs are gone from {}; these are done again",
                                        distribution.without_files(),
                                        (opened_.folder.path() / "jobs").string()));
    session_.terminal.begin_progress(opened_.plan.count(), "jobs");
    try {
      distribution.run(slots, interruption_.token());
    } catch (const kernel::Error& error) {
      session_.terminal.end_progress();
      end(distribution, error.what(), error.exit_code());
      throw;
    }
    session_.terminal.end_progress();
    const std::string why = distribution.is_complete() ? "" : reason();
    return end(distribution, why, code_of(distribution));
  }

 private:
  static campaign::UpperBound bound() {
    return [](std::uint64_t wrong, std::uint64_t total, double confidence) {
      return emc::upper_bound_of_share(wrong, total, confidence);
    };
  }

  std::optional<std::chrono::milliseconds> time_limit() const {
    const auto by_call = session_.settings.duration("max-time");
    const auto by_plan = opened_.plan.time();
    return by_call && by_plan ? std::min(*by_call, *by_plan) : by_call ? by_call : by_plan;
  }

  std::string reason() const {
    return interruption_.is_out_of_time() && interruption_.signal() == 0 ? "its time was over"
                                                                         : interruption_.reason();
  }

  campaign::Distribution::Plan distribution_plan() {
    campaign::Distribution::Plan plan;
    plan.count = opened_.plan.count();
    plan.job = [this](std::uint64_t id) { return opened_.plan.job(id); };
    if (confidence_)
      plan.in_order = [this](const campaign::Outcome& outcome) { return confidence_->add(outcome); };
    plan.on_progress = [this](std::uint64_t done) { session_.terminal.progress(done); };
    return plan;
  }

  int code_of(const campaign::Distribution& distribution) {
    if (confidence_ && distribution.is_complete()) confidence_->end();
    if (!distribution.is_complete() && interruption_.signal() != 0)
      return kSignalBase + interruption_.signal();
    const int worst = campaign::worst_exit_code(distribution.outcomes());
    const bool is_open =
        !distribution.is_complete() || (confidence_ && confidence_->decision() == campaign::Decision::open);
    return is_open && (worst == kAllAsExpected || worst == kNothingJudged) ? kInconclusive : worst;
  }

  int end(const campaign::Distribution& distribution, const std::string& incomplete_because, int code) {
    campaign::Report report;
    report.title = opened_.plan.title();
    report.suite_version = opened_.folder.manifest().suite_version;
    report.plan_hash = opened_.plan.hash();
    report.planned = opened_.plan.count();
    report.incomplete_because = incomplete_because;
    report.exit_code = code;
    report.outcomes = &distribution.outcomes();
    report.command = [this](std::uint64_t id) { return command_of(opened_.plan.job(id)); };
    // When it was told to end at once, --resume does it.
    const auto is_interrupted = [this] { return interruption_.signal() != 0; };
    report.corpora = merge_corpora(opened_.plan, opened_.folder, distribution.outcomes(), is_interrupted);
    report.confidence = confidence_ ? &*confidence_ : nullptr;
    report.bound = bound();
    session_.terminal.print(campaign::report_text(report));
    if (!incomplete_because.empty())
      session_.terminal.print(fmt::format("go on: fieldproof campaign --resume {}\n",
                                          reports::shell_quoted(opened_.folder.path().string())));
    opened_.folder.write_document(campaign::document_text(report));
    return code;
  }

  Session& session_;
  Opened opened_;
  Interruption interruption_;
  std::optional<campaign::Confidence> confidence_;
};

void check_call(const Session& session) {
  const Settings& settings = session.settings;
  if (settings.is_set("resume") && settings.origin("out") == Origin::command_line)
    settings.refuse("out", "a campaign that goes on stays in the folder of --resume; leave one of them out");
  if (settings.is_set("watch")) {
    if (!session.operands.empty()) refuse_call("--watch shows a folder; leave the file out");
    return;
  }
  if (settings.is_set("dry-run") && settings.is_set("resume"))
    refuse_call("a campaign that goes on is not estimated; leave out --dry-run or --resume");
  if (session.operands.empty() && !settings.is_set("resume"))
    refuse_call(
        "campaign needs a file; write for example: fieldproof campaign examples/campaigns/small.json");
}

}  // namespace

int run_campaign(Session& session) {
  const std::string program =
      fmt::format("fieldproof {} ({}, {})", suite_version(session.catalogue()), build_type(), compiler());
  const auto ranks = campaign::Ranks::of_this_process(fs::read_symlink("/proc/self/exe"));
  const bool is_one_each = ranks && session.settings.origin("workers") == Origin::fallback;
  const auto workers =
      is_one_each ? 1 : static_cast<std::size_t>(session.settings.number("workers", 1, kMostWorkers));
  if (ranks && ranks->rank() > 0) {
    campaign::serve_as_rank(*ranks, workers, program);
    return kAllAsExpected;
  }
  std::unique_ptr<campaign::Slots> slots;
  const std::size_t slots_of_all = ranks ? workers * static_cast<std::size_t>(ranks->count()) : workers;
  if (ranks) {
    slots = std::make_unique<campaign::RankSlots>(*ranks, workers, program);
  } else {
    slots = std::make_unique<campaign::LocalSlots>(workers);
  }
  check_call(session);
  if (session.settings.is_set("watch")) return watch_campaign(session);
  if (session.settings.is_set("dry-run")) return estimate_campaign(session, slots_of_all);
  return CampaignRun(session).run(*slots);
}

}  // namespace fieldproof::cli

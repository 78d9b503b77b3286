#include "cli/campaign_preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "campaign/local_slots.hpp"
#include "campaign/outcome.hpp"
#include "campaign/watch.hpp"
#include "cli/campaign_plan.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/results.hpp"

namespace fieldproof::cli {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kBetweenLooks{500};

std::string time_text(double seconds) {
  constexpr double kMinute = 60;
  constexpr double kHour = 3600;
  if (seconds < 2 * kMinute) return fmt::format("{:.1f} s", seconds);
  if (seconds < 2 * kHour) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

// Nothing when it was stopped before.
std::optional<campaign::JobResult> result_of(const campaign::Job& job, const Interruption& interruption) {
  campaign::LocalSlots slots(1);
  slots.give(job);
  while (!interruption.token().stop_requested()) {
    for (campaign::JobResult& result : slots.wait(milliseconds(100))) return std::move(result);
  }
  return std::nullopt;
}

// The call, a file, or the implementation cannot be used: no job of its kind can.
bool is_refused(int code) {
  return code == kUsage || code == 65 || code == 5;
}

std::string bad_line(const campaign::Outcome& outcome) {
  if (!outcome.killed.empty()) return fmt::format("job {}: its process {}\n", outcome.id, outcome.killed);
  return fmt::format("job {}: exit code {}{}{}\n", outcome.id, outcome.exit_code,
                     outcome.message.empty() ? "" : ": ", kernel::escaped_line(outcome.message));
}

}  // namespace

int estimate_campaign(Session& session, std::size_t slots) {
  const CampaignPlan plan(session.operands.front(), session.catalogue());
  const Interruption interruption(session.settings.duration("max-time"));
  int code = kAllAsExpected;
  double seconds = 0;
  session.terminal.print("      jobs  each about  first job\n");
  for (std::size_t row = 0; row < plan.rows() && plan.first_of(row) <= plan.count(); ++row) {
    const campaign::Job job = plan.job(plan.first_of(row));
    const auto result = result_of(job, interruption);
    if (!result) {
      session.terminal.log(interruption.reason());
      return interruption.signal() != 0 ? kSignalBase + interruption.signal() : kInconclusive;
    }
    const std::uint64_t jobs = std::min(plan.count_of(row), plan.count() + 1 - plan.first_of(row));
    const double each = static_cast<double>(result->wall_time_ms) / 1000;
    seconds += each * static_cast<double>(jobs);
    session.terminal.print(
        fmt::format("{:>10}  {:>10}  {}\n", jobs, time_text(each), kernel::escaped_line(command_of(job))));
    const campaign::Outcome outcome = outcome_of(*result);
    if (!is_refused(outcome.exit_code)) continue;
    session.terminal.print(bad_line(outcome));
    code = code == kAllAsExpected ? outcome.exit_code : code;
  }
  session.terminal.print(
      fmt::format("{} jobs, about {} in {} at a time; jobs of a row may take longer than its first\n",
                  plan.count(), time_text(seconds / static_cast<double>(slots)), slots));
  return code;
}

int watch_campaign(Session& session) {
  const auto folder = campaign::Folder::open(session.settings.text("watch"));
  const Interruption interruption(session.settings.duration("max-time"));
  campaign::Watch watch(folder);
  session.terminal.print(fmt::format("campaign of {} jobs, begun {}\n", folder.manifest().jobs,
                                     kernel::escaped_line(folder.manifest().started)));
  session.terminal.begin_progress(folder.manifest().jobs, "jobs");
  // One that is just starting is seen at the second look.
  bool was_running = true;
  while (!interruption.token().stop_requested()) {
    const bool is_running = watch.is_running();
    const bool has_all = watch.look();
    for (const campaign::Outcome& outcome : watch.bad()) session.terminal.print(bad_line(outcome));
    session.terminal.progress(watch.done());
    if (!has_all) continue;
    if (!is_running && !was_running) break;
    was_running = is_running;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  session.terminal.end_progress();
  session.terminal.print(fmt::format("{} of {} jobs done, {} not as expected, {} processes lost\n",
                                     watch.done(), folder.manifest().jobs, watch.failed(), watch.losses()));
  if (interruption.token().stop_requested())
    return interruption.signal() != 0 ? kSignalBase + interruption.signal() : kInconclusive;
  const auto end = watch.end();
  if (end && end->incomplete_because.empty()) {
    session.terminal.print(fmt::format("ended with exit code {}\n", end->exit_code));
    return end->exit_code;
  }
  session.terminal.print(fmt::format("nobody works on it any more; go on: fieldproof campaign --resume {}\n",
                                     reports::shell_quoted(folder.path().string())));
  return kInconclusive;
}

}  // namespace fieldproof::cli

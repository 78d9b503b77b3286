#include "cli/stored_emc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "cli/bits_that_matter.hpp"
#include "cli/emc_run.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/shown_recording.hpp"
#include "cli/stored_end.hpp"
#include "cli/stored_sequence.hpp"
#include "conformance/minimise.hpp"
#include "harness/judge/result_json.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

using kernel::Time;

std::string header_of(const Session& session, const EmcCase& test) {
  return simulation_header(session, test.seed, test.request.file, test.protocol->network.own_network);
}

std::string end_text(const EmcRun& run) {
  const emc::ImmunityResult& result = run.result;
  std::string text = fmt::format(
      "criterion {}: {}\n", emc::name(result.criterion),
      result.decided_by.empty() ? emc::text_of(result.criterion) : std::string_view(result.decided_by));
  if (!result.complaint.empty()) text += fmt::format("  {}\n", reports::escaped_line(result.complaint));
  if (!result.first_wrong_text.empty())
    text += fmt::format("  the first {}\n", reports::escaped_line(result.first_wrong_text));
  return text;
}

class EmcShrink {
 public:
  EmcShrink(EmcCase stored, std::stop_token stop)
      : response_(stored.bursts.profile.coupling), smallest_(std::move(stored)), stop_(std::move(stop)) {}

  // As it is stored; false: it does not fail so, or time is over.
  bool run_stored() {
    last_ = run(smallest_);
    const EmcEnd now = end_of(last_.result);
    if (!last_.result.is_complete || now.criterion <= smallest_.worst || now.reason != smallest_.end.reason)
      return false;
    smallest_.end = now;
    struck_ = last_.struck.size();
    return true;
  }

  void shrink() {
    cut();
    if (!smallest_.plan) keep_few_bursts();
    const FlippedBits struck = last_.struck;
    const auto fails_by_bits = [this](const FlippedBits& some) {
      EmcCase tried = smallest_;
      tried.windows.clear();
      tried.plan = plan_with(some);
      return still_fails(tried);
    };
    auto bits = bits_that_matter(struck, fails_by_bits);
    if (!bits || bits->size() > 1) {
      if (const auto moved = moved_bit_that_matters(bits.value_or(struck), fails_by_bits)) bits = moved;
    }
    if (!bits) return;
    bits_ = *bits;
    smallest_.windows.clear();
    smallest_.plan = plan_with(*bits);
    cut();
  }

  // Once more, while there is time.
  bool confirm() {
    const bool is_same_again = stop_.stop_requested() || still_fails(smallest_) || stop_.stop_requested();
    smallest_.end = end_of(last_.result);
    return is_same_again;
  }

  const EmcCase& smallest() const { return smallest_; }
  const EmcRun& last() const { return last_; }
  const std::optional<FlippedBits>& bits() const { return bits_; }
  std::size_t struck() const { return struck_; }
  std::size_t runs() const { return runs_; }

 private:
  EmcRun run(const EmcCase& test) {
    ++runs_;
    return run_emc_case(test, response_, false, stop_);
  }

  bool still_fails(const EmcCase& test) {
    if (stop_.stop_requested()) return false;
    EmcRun tried = run(test);
    const emc::ImmunityResult& result = tried.result;
    if (!result.is_complete || result.criterion != smallest_.end.criterion ||
        result.reason != smallest_.end.reason)
      return false;
    last_ = std::move(tried);
    return true;
  }

  bool still_fails_for(kernel::Duration duration) {
    EmcCase tried = smallest_;
    tried.duration = duration;
    if (!still_fails(tried)) return false;
    smallest_ = std::move(tried);
    return true;
  }

  // To the instant at which it failed first, or else by halves, to a millisecond.
  void cut() {
    const emc::ImmunityResult& result = last_.result;
    if (result.decided_at) {
      const kernel::Duration until = *result.decided_at - result.on + kernel::kPicosecond;
      if (until >= smallest_.duration || still_fails_for(until)) return;
    }
    const std::int64_t milliseconds = smallest_.duration / kernel::kMillisecond;
    if (milliseconds > 1) {
      conformance::simplest(milliseconds, std::int64_t{1},
                            [this](std::int64_t n) { return still_fails_for(n * kernel::kMillisecond); });
    }
  }

  void keep_few_bursts() {
    const std::vector<EmcWindow> all = bursts_in(last_.changed);
    const auto last = [&all](std::size_t most) {
      const std::size_t count = std::min(most, all.size());
      return std::vector<EmcWindow>(all.end() - static_cast<std::ptrdiff_t>(count), all.end());
    };
    const auto fails_with = [this](const std::vector<EmcWindow>& some) {
      EmcCase tried = smallest_;
      tried.windows = some;
      return !some.empty() && still_fails(tried);
    };
    if (const auto few = fewest_of_the_last<EmcWindow>(fails_with, last)) smallest_.windows = *few;
  }

  // What arrived otherwise, with a pause where no burst lasts so long.
  static std::vector<EmcWindow> bursts_in(std::vector<Time> changed) {
    constexpr kernel::Duration kPause = 100 * kernel::kMillisecond;
    std::ranges::sort(changed);
    std::vector<EmcWindow> bursts;
    for (const Time start : changed) {
      if (bursts.empty() || start - bursts.back().to > kPause) bursts.push_back({start, start});
      bursts.back().to = start + kernel::kPicosecond;
    }
    return bursts;
  }

  emc::LineResponse response_;
  EmcCase smallest_;
  std::stop_token stop_;
  EmcRun last_;  // that failed: of the smallest
  std::optional<FlippedBits> bits_;
  std::size_t struck_ = 0;
  std::size_t runs_ = 0;
};

std::string what_disturbs(const EmcShrink& shrunk) {
  const EmcRun& run = shrunk.last();
  if (shrunk.bits() && shrunk.bits()->empty())
    return "it fails without any struck bit: nothing is disturbed any more\n";
  const std::string changes = change_lines(run.changes, run.channels, *run.dissector);
  if (shrunk.bits()) return bit_lines(*shrunk.bits()) + changes;
  std::string text = "it is not shown that bits alone do it: the disturbance is left on\n";
  for (const EmcWindow& one : shrunk.smallest().windows)
    text += fmt::format("  from {} to {}\n", kernel::describe(one.from), kernel::describe(one.to));
  return text + changes;
}

}  // namespace

int replay_emc(Session& session) {
  const std::string& file = session.operands.front();
  const bool is_other = session.settings.origin("iut") != Origin::fallback;
  const EmcCase stored = load_emc_case(file, session, is_other);
  session.terminal.print(header_of(session, stored));
  EmcRun run = run_emc_case(stored, emc::LineResponse(stored.bursts.profile.coupling), true);
  const bool is_cut = run.recording.is_cut;
  show_recording(session, {std::move(run.recording), run.dissector, nullptr, is_cut}, file);
  session.terminal.print(end_text(run));
  const EmcEnd now = end_of(run.result);
  const EmcEnd& end = stored.end;
  const std::array members{
      StoredAndNow{"criterion", std::string(emc::name(end.criterion)), std::string(emc::name(now.criterion))},
      StoredAndNow{"reason", end.reason, now.reason}, StoredAndNow{"number", end.decided_by, now.decided_by},
      StoredAndNow{"fingerprint", judge::fingerprint_text(end.fingerprint),
                   judge::fingerprint_text(now.fingerprint)}};
  return compared(session.terminal, members, is_other,
                  now.criterion > stored.worst ? kFailed : kAllAsExpected);
}

int shrink_emc(Session& session, const std::filesystem::path& file) {
  EmcCase stored = load_emc_case(session.operands.front(), session);
  reports::check_writable(file);
  const Interruption interruption(session.settings.duration("max-time"));
  session.terminal.print(header_of(session, stored));
  const kernel::Duration duration = stored.duration;
  const std::string stored_reason = stored.end.reason;
  EmcShrink shrinking(std::move(stored), interruption.token());
  const bool fails = shrinking.run_stored();
  const bool is_stopped = interruption.token().stop_requested();
  if (!fails && !is_stopped) {
    session.terminal.print(
        end_text(shrinking.last()) +
        fmt::format("the stored test does not fail with '{}' this time: nothing to shrink\n",
                    reports::escaped_line(stored_reason)));
    return kDiffers;
  }
  if (fails) shrinking.shrink();
  const bool is_confirmed = !fails || shrinking.confirm();
  write_emc_case(file, shrinking.smallest());
  const EmcRun& run = shrinking.last();
  if (fails) {
    session.terminal.print(
        end_text(run) +
        fmt::format("shrunk from {} and {} struck bits to {} and {}, in {} runs\n{}reproduce: {}\n",
                    kernel::describe(duration), shrinking.struck(),
                    kernel::describe(shrinking.smallest().duration), run.struck.size(), shrinking.runs(),
                    what_disturbs(shrinking), replay_command(file.string())));
  }
  const std::string why = interruption.reason();
  if (!why.empty()) session.terminal.log(why);
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  if (!is_confirmed) {
    session.terminal.print("not confirmed: the network did not do the same again\n");
    return kDiffers;
  }
  if (shrinking.bits() && !shrinking.bits()->empty()) return kAllAsExpected;
  return interruption.token().stop_requested() ? kInconclusive : kDiffers;
}

}  // namespace fieldproof::cli

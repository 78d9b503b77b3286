#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/case_file.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/verbs.hpp"
#include "harness/iut/serial_line.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"
#include "reports/text_summary.hpp"

// `fieldproof verify`: runs cases several times; equal seeds must give equal fingerprints, verdicts and
// reasons. A case that is equal each time has its verdict, and with it the exit code.
namespace fieldproof::cli {
namespace {

constexpr std::uint64_t kMostRuns = 1'000'000;

struct Target {
  std::vector<conformance::Entry> entries;
  conformance::Setup setup;
  std::unique_ptr<StoredEntry> stored{};  // of a case file
};

Target target_of(Session& session) {
  const std::string& first = session.operands.front();
  if (session.operands.size() == 1 && first.ends_with(".json") && std::filesystem::exists(first)) {
    CaseFile stored = load_case(first, session.catalogue());
    stored.setup.limits = limits_from(session.settings);
    Target target{{}, stored.setup, std::make_unique<StoredEntry>(stored, session)};
    target.entries.push_back(**target.stored);
    return target;
  }
  Target target;
  target.entries = session.catalogue().select(session.operands);
  target.setup = setup_from(session.settings, session.catalogue(), target.entries);
  return target;
}

bool is_equal(const judge::CaseResult& a, const judge::CaseResult& b) {
  return a.fingerprint == b.fingerprint && a.verdict == b.verdict && a.reason == b.reason;
}

// "fail 0123456789abcdef (late_answer)"
std::string told(const judge::CaseResult& result) {
  const std::string reason =
      result.reason.empty() ? "" : fmt::format(" ({})", reports::escaped_line(result.reason));
  return fmt::format("{} {}{}", judge::name(result.verdict), judge::fingerprint_text(result.fingerprint),
                     reason);
}

// The first line in which two recordings differ, or where the shorter one ends.
std::string first_divergence(const conformance::Entry& entry, const conformance::Setup& setup) {
  const auto once =
      conformance::run_case(entry, setup, {conformance::KeptRecordings::all}).outcome.recording.lines();
  const auto again =
      conformance::run_case(entry, setup, {conformance::KeptRecordings::all}).outcome.recording.lines();
  const auto [a, b] = std::mismatch(once.begin(), once.end(), again.begin(), again.end());
  if (a == once.end() && b == again.end()) return "  two further runs with their recordings kept are equal\n";
  const auto line = [](auto at, auto end) {
    return at == end ? "(the recording ends)" : reports::escaped_line(*at);
  };
  return fmt::format("  first difference in line {} of the recording:\n    {}\n    {}\n",
                     a - once.begin() + 1, line(a, once.end()), line(b, again.end()));
}

// One pass over all cases; what differs from the first pass is told and remembered.
class Comparison {
 public:
  Comparison(Session& session, const Target& target) : session_(session), target_(target) {}

  // False when the stop came first.
  bool pass(std::stop_token stop, std::size_t done_before) {
    std::size_t index = 0;
    conformance::Plan plan;
    plan.entries = target_.entries;
    plan.setup = target_.setup;
    plan.jobs = jobs_from(session_.settings);
    plan.stop = std::move(stop);
    plan.on_case = [&](conformance::CaseRun&& done) {
      on_case(index++, done.outcome.result);
      return true;
    };
    plan.on_progress = [&](std::size_t finished) { session_.terminal.progress(done_before + finished); };
    return conformance::run(plan) == plan.entries.size();
  }

  const std::vector<judge::CaseResult>& first() const { return first_; }
  std::size_t differing() const { return differing_.size(); }

 private:
  void on_case(std::size_t index, judge::CaseResult& result) {
    if (index >= first_.size()) {
      first_.push_back(std::move(result));
      return;
    }
    const judge::CaseResult& before = first_[index];
    if (is_equal(before, result) ||
        std::find(differing_.begin(), differing_.end(), index) != differing_.end())
      return;
    differing_.push_back(index);
    session_.terminal.print(fmt::format("differs: {}: {}, then {}\n", result.id, told(before), told(result)));
    session_.terminal.print(first_divergence(target_.entries[index], target_.setup));
  }

  Session& session_;
  const Target& target_;
  std::vector<judge::CaseResult> first_;
  std::vector<std::size_t> differing_;
};

// What differs goes before the verdicts, because then no verdict is that of the case.
int code_of(const Comparison& comparison, const Settings& settings) {
  reports::Run run;
  run.cases = comparison.first();
  ExitRules rules;
  rules.allows_inconclusive = settings.is_set("allow-inconclusive");
  const int by_verdicts = exit_code(run, rules);
  return comparison.differing() > 0 && by_verdicts != kInternal ? kDiffers : by_verdicts;
}

// ", and 2 of them fail each time"
std::string failing_text(const Comparison& comparison) {
  const auto failing = std::ranges::count_if(comparison.first(), [](const judge::CaseResult& result) {
    return result.verdict == judge::Verdict::fail || result.verdict == judge::Verdict::error;
  });
  if (failing == 0 || comparison.differing() > 0) return "";
  return fmt::format(", and {} of them {} each time", failing, failing == 1 ? "fails" : "fail");
}

}  // namespace

int verify(Session& session) {
  const Target target = target_of(session);
  for (const conformance::Assignment& one : target.setup.implementations) {
    if (!one.uri.starts_with(iut::kSerialUri)) continue;
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("'{}': what happens on a real line happens once, so there are no equal runs", one.uri));
  }
  const auto runs = static_cast<std::size_t>(session.settings.number("runs", 2, kMostRuns));
  session.terminal.print(reports::run_header(identity_of(session, target.setup, target.entries.size()),
                                             manifest_of(session, 1)));
  const Interruption interruption(std::nullopt);
  Comparison comparison(session, target);
  session.terminal.begin_progress(runs * target.entries.size(), "runs");
  bool is_complete = true;
  for (std::size_t i = 0; i < runs && is_complete; ++i) {
    is_complete = comparison.pass(interruption.token(), i * target.entries.size());
  }
  session.terminal.end_progress();
  if (!is_complete) {
    session.terminal.print(fmt::format("incomplete: {}\n", interruption.reason()));
    return kSignalBase + interruption.signal();
  }
  const std::size_t equal = target.entries.size() - comparison.differing();
  session.terminal.print(fmt::format("{} of {} cases are equal in {} runs{}\n", equal, target.entries.size(),
                                     runs, failing_text(comparison)));
  return code_of(comparison, session.settings);
}

}  // namespace fieldproof::cli

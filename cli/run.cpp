#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "cli/baseline.hpp"
#include "cli/copies.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/page_catalogue.hpp"
#include "cli/reset_hook.hpp"
#include "cli/run_book.hpp"
#include "cli/run_setup.hpp"
#include "cli/same_run.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/github_writer.hpp"
#include "reports/html_writer.hpp"
#include "reports/text_summary.hpp"

// `fieldproof run`: judges an implementation by the selected cases and stores the result.
namespace fieldproof::cli {
namespace {

using judge::Verdict;

bool is_failure(const judge::CaseResult& result) {
  const Verdict verdict = reports::counted_verdict(result);
  return verdict == Verdict::fail || verdict == Verdict::error;
}

// Gives what the stored run was configured with to the options that were not given now.
void take_over_configuration(Session& session, const reports::RunDirectory& directory) {
  session.settings.add_file(directory.path() / kConfigurationFile, Origin::stored_run);
}

// `--failed` may swallow a selector: what is no directory of a run is one.
std::string failed_directory(Session& session) {
  std::string given = session.settings.text("failed");
  if (given.empty()) return "runs";
  if (std::filesystem::is_directory(given)) return given;
  try {
    session.catalogue().select(std::array{given});
  } catch (const kernel::Error& refused) {
    session.settings.refuse("failed",
                            fmt::format("'{}' is no folder, and as a selector: {}", given, refused.what()));
  }
  session.operands.insert(session.operands.begin(), given);
  return "runs";
}

// Narrows the selection to what did not pass in a stored run.
std::vector<conformance::Entry> failed_entries(Session& session) {
  const auto directory = reports::RunDirectory::open(failed_directory(session));
  take_over_configuration(session, directory);
  std::vector<std::string> failed;
  for (const judge::CaseResult& result : directory.load().run.cases) {
    if (is_failure(result) || reports::counted_verdict(result) == Verdict::inconclusive) {
      failed.push_back(result.id);
    }
  }
  session.terminal.log(
      fmt::format("{} of the cases of {} did not pass", failed.size(), directory.path().string()));
  // The part of a whole that the stored run was is what it has failed in.
  session.settings.reset("shard");
  if (failed.empty()) return {};
  std::vector<conformance::Entry> entries = session.catalogue().select(failed);
  if (!session.operands.empty()) {
    const std::vector<conformance::Entry> chosen = session.catalogue().select(session.operands);
    std::erase_if(entries, [&](const conformance::Entry& entry) {
      return std::none_of(chosen.begin(), chosen.end(), [&](const conformance::Entry& other) {
        return other.test_case == entry.test_case;
      });
    });
  }
  session.operands.clear();
  for (const conformance::Entry& entry : entries) session.operands.push_back(entry.test_case->id);
  return entries;
}

conformance::RunOptions manner_from(const Settings& settings) {
  constexpr unsigned kMostConfirmations = 1000;
  conformance::RunOptions manner;
  manner.keeps_recordings = static_cast<conformance::KeptRecordings>(settings.choice("record"));
  manner.confirmations = static_cast<unsigned>(settings.number("confirm", 0, kMostConfirmations));
  if (settings.is_set("reset")) manner.reset = reset_hook(settings.text("reset"));
  return manner;
}

// A thing that is reset between two cases is one thing.
unsigned jobs_of(const Settings& settings) {
  return settings.is_set("reset") ? 1 : jobs_from(settings);
}

std::optional<Baseline> baseline_from(const Session& session) {
  if (!session.settings.is_set("baseline")) return std::nullopt;
  return Baseline::load(session.settings.text("baseline"), session.catalogue(), today_utc());
}

struct Prepared {
  conformance::Setup setup;
  std::optional<Baseline> baseline;
  std::unique_ptr<RunBook> book;
};

void refuse_resume(const reports::RunDirectory& directory, const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("--resume {}: {}; start a new run", directory.path().string(), sentence));
}

// A resumed run must be the same run: nothing that decides its outcome may have changed.
void check_same_run(const reports::RunDirectory& directory, const reports::RunIdentity& stored,
                    const reports::RunIdentity& now) {
  if (const std::string sentence = difference(stored, now); !sentence.empty())
    refuse_resume(directory, sentence);
  for (const judge::InputFile& file : stored.inputs) {
    const auto same = std::ranges::find(now.inputs, file.path, &judge::InputFile::path);
    if (same != now.inputs.end() && same->hash != file.hash)
      refuse_resume(directory,
                    fmt::format("{} has changed since, so its verdicts would be of two", file.path));
  }
}

Prepared prepare_resumed(Session& session) {
  auto directory = reports::RunDirectory::open(session.settings.text("resume"));
  auto journal = std::make_unique<judge::Journal>(directory.journal());
  reports::StoredRun stored = directory.load();
  if (!session.operands.empty() || session.settings.is_set("shard"))
    refuse_resume(directory, "it has its selection already, leave out the selectors and --shard");
  take_over_configuration(session, directory);
  session.operands = stored.run.identity.selectors;
  const std::vector<conformance::Entry> selected =
      shard_of(session.settings, session.catalogue().select(session.operands));
  if (selected.size() != stored.run.identity.selected) {
    refuse_resume(directory, fmt::format("it selected {} cases, and its selectors are {} now",
                                         stored.run.identity.selected, selected.size()));
  }
  Prepared prepared{setup_from(session.settings, session.catalogue(), selected), baseline_from(session),
                    nullptr};
  const reports::RunIdentity now = identity_of(session, prepared.setup, selected.size());
  check_same_run(directory, stored.run.identity, now);
  session.terminal.log(
      fmt::format("{} of {} cases are judged already", stored.run.cases.size(), selected.size()));
  prepared.book =
      std::make_unique<RunBook>(std::move(directory), std::move(journal), std::move(stored), selected);
  return prepared;
}

Prepared prepare(Session& session) {
  const bool is_failed_only = session.settings.is_set("failed");
  if (session.settings.is_set("resume")) {
    if (is_failed_only) session.settings.refuse("failed", "goes not with --resume; give one of them");
    return prepare_resumed(session);
  }
  if (is_failed_only && session.settings.is_set("shard")) {
    session.settings.refuse("shard", "goes not with --failed; give one of them");
  }
  // A stored run that was a part of a whole has failed in this part only.
  const std::vector<conformance::Entry> selected =
      is_failed_only ? failed_entries(session)
                     : shard_of(session.settings, session.catalogue().select(session.operands));
  Prepared prepared{setup_from(session.settings, session.catalogue(), selected), baseline_from(session),
                    nullptr};
  reports::RunIdentity identity = identity_of(session, prepared.setup, selected.size());
  prepared.book =
      std::make_unique<RunBook>(session.settings.text("out"), manifest_of(session, jobs_of(session.settings)),
                                std::move(identity), selected, session.settings.as_file());
  return prepared;
}

// Judges what is open and tells each verdict after it is stored. Answers why the run is not complete.
class Judging {
 public:
  Judging(Session& session, Prepared& prepared) : session_(session), prepared_(prepared) {}

  std::string run(const Interruption& interruption) {
    conformance::Plan plan;
    plan.entries = prepared_.book->open_cases();
    plan.setup = prepared_.setup;
    plan.jobs = jobs_of(session_.settings);
    plan.manner = manner_from(session_.settings);
    plan.stop = interruption.token();
    plan.on_case = [this](conformance::CaseRun&& done) {
      if (prepared_.baseline) prepared_.baseline->mark(done.outcome.result);
      return on_case(done);
    };
    plan.on_progress = [this](std::size_t finished) { session_.terminal.progress(finished); };
    session_.terminal.begin_progress(plan.entries.size(), "cases");
    const std::size_t delivered = conformance::run(plan);
    session_.terminal.end_progress();
    if (delivered == plan.entries.size()) return {};
    return stopped_by_.empty() ? interruption.reason()
                               : fmt::format("--fail-fast: {} did not pass", stopped_by_);
  }

  bool has_differed() const { return has_differed_; }

 private:
  bool on_case(const conformance::CaseRun& done) {
    const judge::CaseResult& result = done.outcome.result;
    prepared_.book->add(done);
    if (!session_.terminal.is_quiet()) {
      session_.terminal.print(reports::case_line(result, {.colour = session_.terminal.has_colour()}));
      if (session_.settings.is_set("measurements")) {
        session_.terminal.print(reports::measurement_lines(result));
      }
    }
    if (!done.is_repeatable) {
      has_differed_ = true;
      session_.terminal.log(
          fmt::format("{} did not repeat: its second run has another fingerprint", result.id));
    }
    if (!session_.settings.is_set("fail-fast") || !is_failure(result)) return true;
    stopped_by_ = result.id;
    return false;
  }

  Session& session_;
  Prepared& prepared_;
  std::string stopped_by_;
  bool has_differed_ = false;
};

// The page of a run stands in its directory, and is read from there like any other; so are the copies.
void write_reports(const Session& session, const RunBook& book, const reports::OutcomeRules& rules) {
  reports::PageContent content;
  content.catalogue = page_catalogue(session.catalogue());
  content.runs.push_back(reports::page_run(book.directory()));
  const std::string page = reports::html_page(content);
  book.directory().write("report.html", page);
  if (session.settings.is_set("html")) reports::write_text_file(session.settings.text("html"), page);
  write_copies(session, content.runs.front(), rules);
}

}  // namespace

int run(Session& session) {
  manner_from(session.settings);  // refuses before anything is stored
  check_copies(session.settings);
  const Interruption interruption(session.settings.duration("max-time"));
  Prepared prepared = prepare(session);
  RunBook& book = *prepared.book;
  const reports::OutcomeRules outcomes = outcome_rules(session.settings);
  if (const std::string& warning = book.directory().warning(); !warning.empty())
    session.terminal.log(warning);
  session.terminal.print(reports::run_header(book.run().identity, book.manifest()));
  Judging judging(session, prepared);
  std::string incomplete_because;
  try {
    incomplete_because = judging.run(interruption);
  } catch (const kernel::Error& error) {
    session.terminal.end_progress();
    book.close(error.what(), error.exit_code(), outcomes);
    write_reports(session, book, outcomes);
    throw;
  }
  if (prepared.baseline) book.hold_against(*prepared.baseline);
  ExitRules rules;
  rules.is_stale = !book.run().identity.stale_expectations.empty();
  rules.is_strict = session.settings.is_set("strict");
  rules.allows_inconclusive = session.settings.is_set("allow-inconclusive");
  rules.differs = judging.has_differed();
  rules.is_incomplete = !incomplete_because.empty();
  rules.signal = interruption.signal();
  const int code = exit_code(book.run(), rules);
  book.close(incomplete_because, code, outcomes);
  session.terminal.log(fmt::format("the result is in {}", book.directory().path().string()));
  const std::string summary = reports::summary_text(book.run(), {.colour = session.terminal.has_colour()});
  session.terminal.print(session.settings.is_set("github") ? reports::github_log(summary) : summary);
  write_reports(session, book, outcomes);
  return code;
}

}  // namespace fieldproof::cli

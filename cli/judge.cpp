#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "cli/case_file.hpp"
#include "cli/exit_code.hpp"
#include "cli/run_setup.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof judge`: judges a stored run again from its recordings, without the implementation.
namespace fieldproof::cli {
namespace {

constexpr std::string_view kNoRecording =
    "no recording of the implementation is stored; "
    "--record failed keeps those of cases that fail, --record all each";

// Why a case of the run cannot be judged again, or nothing.
std::string reason_not_judgeable(const CaseFile& stored) {
  if (stored.playback.empty()) return std::string(kNoRecording);
  if (stored.is_truncated) return "its recording reached the bound";
  return {};
}

std::string change_text(const judge::CaseResult& before, const judge::CaseResult& now) {
  const std::string id = reports::escaped_line(before.id);
  if (now.verdict == before.verdict && now.reason == before.reason)
    return fmt::format("changed: {} has another fingerprint\n", id);
  return fmt::format("changed: {} was {} '{}', is {} '{}'\n", id, judge::name(before.verdict),
                     reports::escaped_line(before.reason), judge::name(now.verdict),
                     reports::escaped_line(now.reason));
}

// Nothing where it cannot be: what one case lacks does not end the others.
std::optional<judge::CaseResult> judged_again(Session& session, const judge::CaseResult& before,
                                              const std::filesystem::path& file, std::size_t& damaged) {
  try {
    CaseFile stored = load_case(file, session.catalogue());
    if (const std::string why = reason_not_judgeable(stored); !why.empty()) {
      session.terminal.log(fmt::format("{} is not judged again: {}", before.id, why));
      return std::nullopt;
    }
    const conformance::Entry& entry = session.catalogue().at(before.id);
    stored.setup.playback_file = stored.playback.string();
    return conformance::run_case(entry, stored.setup).outcome.result;
  } catch (const kernel::Error& error) {
    session.terminal.log(fmt::format("{} is not judged again: {}", before.id, error.what()));
    ++damaged;
    return std::nullopt;
  }
}

}  // namespace

int judge_again(Session& session) {
  const auto directory = reports::RunDirectory::open(session.operands.front());
  const reports::StoredRun stored_run = directory.load();
  session.terminal.print(reports::run_header(stored_run.run.identity, stored_run.manifest));
  reports::Run again{stored_run.run.identity, {}};
  std::size_t changed = 0;
  std::size_t missing = 0;  // failed, and nothing is stored of them; or it is damaged
  for (const judge::CaseResult& before : stored_run.run.cases) {
    const std::filesystem::path file = directory.case_directory(before.id) / "case.json";
    if (!std::filesystem::exists(file)) {
      if (before.verdict != judge::Verdict::fail) continue;
      session.terminal.log(fmt::format("{} failed in the run, and nothing of it is stored: '{}' is not there",
                                       reports::escaped_line(before.id), file.string()));
      ++missing;
      continue;
    }
    const std::optional<judge::CaseResult> judged = judged_again(session, before, file, missing);
    if (!judged) continue;
    const judge::CaseResult& result = *judged;
    if (!session.terminal.is_quiet()) {
      session.terminal.print(reports::case_line(result, {.colour = session.terminal.has_colour()}));
    }
    if (result.verdict != before.verdict || result.reason != before.reason ||
        result.fingerprint != before.fingerprint) {
      ++changed;
      session.terminal.print(change_text(before, result));
    }
    again.cases.push_back(result);
  }
  again.identity.selected = again.cases.size();
  session.terminal.print(fmt::format("{} of {} cases were judged again, {} of them otherwise than before\n",
                                     again.cases.size(), stored_run.run.cases.size(), changed));
  if (again.cases.empty()) session.terminal.print(fmt::format("{}\n", kNoRecording));
  const std::size_t selected = stored_run.run.identity.selected;
  const std::size_t never = selected - std::min(selected, stored_run.run.cases.size());
  if (never > 0) {
    session.terminal.print(fmt::format(
        "{} of the {} selected cases have no result: the run did not end, or not all of it is here\n", never,
        selected));
  }
  ExitRules rules;
  rules.allows_inconclusive = session.settings.is_set("allow-inconclusive");
  rules.differs = changed > 0;
  const int code = exit_code(again, rules);
  const bool is_open = missing > 0 || (never > 0 && !rules.allows_inconclusive);
  return code == kAllAsExpected && is_open ? kInconclusive : code;
}

}  // namespace fieldproof::cli

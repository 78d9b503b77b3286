#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "cli/case_file.hpp"
#include "cli/exit_code.hpp"
#include "cli/implementations.hpp"
#include "cli/run_setup.hpp"
#include "cli/sequence_file.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
#include "harness/judge/result_json.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof replay`: runs a stored case again and holds verdict, reason and fingerprint against the stored
// ones.
namespace fieldproof::cli {
namespace {

reports::RunIdentity identity_for(Session& session, const CaseFile& stored) {
  reports::RunIdentity identity = identity_of(session, stored.setup, 1);
  identity.reproduce_options = fmt::format("--seed {}", stored.setup.seed);
  for (const conformance::Assignment& assignment : stored.setup.implementations) {
    const std::string position = assignment.position > 0 ? fmt::format("@{}", assignment.position) : "";
    const std::string role = assignment.role.empty() ? "" : fmt::format("{}{}=", assignment.role, position);
    identity.reproduce_options += fmt::format(" --iut {}", reports::shell_quoted(role + assignment.uri));
  }
  if (stored.setup.volume == conformance::Volume::quick) identity.reproduce_options += " --volume quick";
  for (const auto& [option, file] : {std::pair{"network", stored.setup.network_file},
                                     {"faults", stored.setup.plan_file},
                                     {"pics", stored.pics_file}}) {
    if (!file.empty())
      identity.reproduce_options += fmt::format(" --{} {}", option, reports::shell_quoted(file));
  }
  return identity;
}

struct Export {
  const char* option;
  std::string (*write)(const conformance::CaseRun&);
};

constexpr std::array kExports = {Export{"pcapng", capture_of}, Export{"vcd", wave_dump_of}};

// Also by another path, or through a link.
bool is_one_file(const std::string& one, const std::string& other) {
  std::error_code failure;
  const auto path_of = [&](const std::string& name) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(name), failure);
  };
  return one == other || path_of(one) == path_of(other);
}

// Refused before the case is run.
void check_exports(const Settings& settings) {
  for (const Export& one : kExports) {
    if (!settings.is_set(one.option)) continue;
    for (const Export& other : kExports) {
      if (&other == &one) break;
      if (settings.is_set(other.option) &&
          is_one_file(settings.text(other.option), settings.text(one.option)))
        settings.refuse(one.option,
                        fmt::format("--{} is written to the same file; name another", other.option));
    }
    reports::check_writable(settings.text(one.option));
  }
}

void show_recording(Session& session, const conformance::CaseRun& done) {
  const conformance::Recording& recording = done.outcome.recording;
  bool is_shown = session.settings.is_set("bits");
  if (is_shown) {
    for (const std::string& line : recording.lines())
      session.terminal.print(reports::escaped_line(line) + "\n");
  }
  for (const Export& one : kExports) {
    if (!session.settings.is_set(one.option)) continue;
    reports::write_text_file(session.settings.text(one.option), one.write(done));
    is_shown = true;
  }
  if (is_shown && recording.truncated) session.terminal.log("the recording is not whole: it has a bound");
}

}  // namespace

int replay(Session& session) {
  check_exports(session.settings);
  if (is_sequence_file(session.operands.front())) return replay_sequence(session);
  CaseFile stored = load_case(session.operands.front(), session.catalogue);
  stored.setup.limits = limits_from(session.settings);
  const StoredEntry stored_entry(stored, session);
  const conformance::Entry& entry = *stored_entry;
  const bool is_other = session.settings.origin("iut") != Origin::fallback;
  if (is_other) {
    stored.setup.implementations =
        parse_implementations(session.settings.list("iut"), session.catalogue, std::span(&entry, 1));
  }
  conformance::check_setup(std::span(&entry, 1), stored.setup);
  reports::Run run{identity_for(session, stored), {}};
  session.terminal.print(reports::run_header(run.identity, manifest_of(session, 1)));
  const conformance::CaseRun done =
      conformance::run_case(entry, stored.setup, {conformance::KeptRecordings::all});
  show_recording(session, done);
  const judge::CaseResult& result = done.outcome.result;
  run.cases = {result};
  reports::TextOptions options;
  options.colour = session.terminal.has_colour();
  if (stored.is_quiet) options.reproduce = replay_command(session.operands.front());
  session.terminal.print(reports::finding_text(run.identity, result, options));
  ExitRules rules;
  rules.allows_inconclusive = session.settings.is_set("allow-inconclusive");
  if (done.outcome.happens_once) {
    session.terminal.print("what happens on a real line happens once: not compared with the stored run\n");
    return exit_code(run, rules);
  }
  return compared(session.terminal, stored.end, result, is_other, exit_code(run, rules));
}

}  // namespace fieldproof::cli

#include <fmt/format.h>

#include <string>
#include <utility>

#include "cli/case_file.hpp"
#include "cli/emc_case.hpp"
#include "cli/exit_code.hpp"
#include "cli/implementations.hpp"
#include "cli/run_setup.hpp"
#include "cli/sequence_file.hpp"
#include "cli/shown_recording.hpp"
#include "cli/stored_emc.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
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

}  // namespace

int replay(Session& session) {
  check_exports(session.settings);
  if (is_sequence_file(session.operands.front())) return replay_sequence(session);
  if (has_schema(session.operands.front(), kEmcCaseSchema)) return replay_emc(session);
  CaseFile stored = load_case(session.operands.front(), session.catalogue());
  stored.setup.limits = limits_from(session.settings);
  const StoredEntry stored_entry(stored, session);
  const conformance::Entry& entry = *stored_entry;
  const bool is_other = session.settings.origin("iut") != Origin::fallback;
  if (is_other) {
    stored.setup.implementations =
        parse_implementations(session.settings.list("iut"), session.catalogue(), std::span(&entry, 1));
  }
  conformance::check_setup(std::span(&entry, 1), stored.setup);
  reports::Run run{identity_for(session, stored), {}};
  session.terminal.print(reports::run_header(run.identity, manifest_of(session, 1)));
  const conformance::CaseRun done =
      conformance::run_case(entry, stored.setup, {conformance::KeptRecordings::all});
  show_recording(session, done.outcome.recording, done.outcome.result.id);
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

#include "conformance/matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "cli/detection_text.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/matrix_text.hpp"
#include "cli/run_setup.hpp"
#include "cli/sequence_file.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "conformance/detection.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

// `fieldproof matrix`: every case of a protocol against every mutant of its role; with `--sequences` random
// sequences in the place of the cases.
namespace fieldproof::cli {
namespace {

constexpr std::uint64_t kMostSeeds = 1'000;
constexpr std::uint64_t kMostCommands = 1'000'000'000;

std::uint64_t seed_of(const Session& session) {
  return session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
}

// What is not complete was stopped.
int stopped(Session& session, const Interruption& interruption) {
  session.terminal.log(interruption.reason());
  return interruption.signal() != 0 ? kSignalBase + interruption.signal() : kNothingJudged;
}

void keep_matrix(Session& session, const std::string& json) {
  if (!session.settings.is_set("json")) return;
  write_document(session, "matrix", json);
  session.terminal.log(fmt::format("the matrix is in {}", session.settings.text("json")));
}

int matrix_of_cases(Session& session, const Interruption& interruption) {
  const std::string& protocol = session.operands.front();
  if (const auto end = protocol.find('/'); end != std::string::npos) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("the matrix of cases is one of a protocol: write matrix {}, or matrix {} --sequences",
                    protocol.substr(0, end), protocol));
  }
  const conformance::Suite& suite = session.catalogue().suite(protocol);
  conformance::MatrixPlan plan;
  plan.seed = seed_of(session);
  plan.jobs = jobs_from(session.settings);
  plan.declared_only = session.settings.is_set("declared");
  plan.stop = interruption.token();
  bool has_begun = false;
  plan.on_progress = [&](std::size_t finished, std::size_t planned) {
    if (!has_begun) session.terminal.begin_progress(planned, "runs");
    has_begun = true;
    session.terminal.progress(finished);
  };
  const conformance::Matrix made = conformance::make_matrix(suite, plan);
  session.terminal.end_progress();
  session.terminal.print(matrix_text(made));
  keep_matrix(session, matrix_json(made));
  if (!made.is_complete) return stopped(session, interruption);
  return made.holes.empty() ? kAllAsExpected : kFailed;
}

using RoleOfSuite = std::pair<const conformance::Suite*, const conformance::SequenceRole*>;

// One role, or all of a protocol.
std::vector<RoleOfSuite> roles_at(const Session& session) {
  const std::string& path = session.operands.front();
  if (path.find('/') != std::string::npos) return {sequence_role_at(path, session.catalogue())};
  const conformance::Suite& suite = session.catalogue().suite(path);
  std::vector<RoleOfSuite> roles;
  for (const conformance::SequenceRole& role : suite.sequence_roles()) roles.emplace_back(&suite, &role);
  if (roles.empty())
    throw kernel::Error(kernel::ErrorKind::usage, fmt::format("no role of {} has sequences", path));
  return roles;
}

int matrix_of_sequences(Session& session, const Interruption& interruption) {
  std::vector<conformance::DetectionTable> tables;
  for (const auto& [suite, role] : roles_at(session)) {
    conformance::DetectionPlan plan{.suite = suite, .role = role};
    plan.setup.seed = seed_of(session);
    plan.seeds = session.settings.number("seeds", 1, kMostSeeds);
    plan.most_commands = session.settings.number("commands", 1, kMostCommands);
    plan.jobs = jobs_from(session.settings);
    plan.stop = interruption.token();
    tables.push_back(conformance::detect_mutants(plan));
    session.terminal.print(detection_text(tables.back()));
    keep_matrix(session, detection_json(tables));
    if (!tables.back().is_complete) return stopped(session, interruption);
  }
  const bool is_good = std::ranges::all_of(
      tables, [](const auto& table) { return table.false_alarms.empty() && is_detected_enough(table); });
  return is_good ? kAllAsExpected : kFailed;
}

}  // namespace

int matrix(Session& session) {
  const bool is_of_sequences = session.settings.is_set("sequences");
  for (const char* option : {"seeds", "commands"}) {
    if (!is_of_sequences && session.settings.origin(option) != Origin::fallback)
      throw kernel::Error(kernel::ErrorKind::usage,
                          fmt::format("--{} is one of --sequences; add that", option));
  }
  if (session.settings.is_set("json")) reports::check_writable(session.settings.text("json"));
  const Interruption interruption(session.settings.duration("max-time"));
  return is_of_sequences ? matrix_of_sequences(session, interruption)
                         : matrix_of_cases(session, interruption);
}

}  // namespace fieldproof::cli

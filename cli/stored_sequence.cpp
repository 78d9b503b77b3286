#include "cli/stored_sequence.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "cli/case_file.hpp"
#include "cli/exit_code.hpp"
#include "cli/implementations.hpp"
#include "cli/run_setup.hpp"
#include "cli/sequence_corpus.hpp"
#include "conformance/sequence_octets.hpp"
#include "harness/judge/result_json.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

std::string size_text(const conformance::Sequence& sequence) {
  const auto counted = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  const std::size_t settings = sequence.settings.size();
  return fmt::format("{}{}, {} ({})", settings == 0 ? "" : counted(settings, "setting") + ", ",
                     counted(sequence.commands.size(), "command"),
                     counted(conformance::faults_in(sequence), "fault"),
                     counted(conformance::flips_in(sequence), "flipped bit"));
}

std::string lines_of(const SequenceFile& file) {
  const conformance::SequenceVocabulary& vocabulary = file.role->vocabulary;
  std::string text;
  if (!file.sequence.settings.empty())
    text += fmt::format("  settings\n    {}\n", settings_text(file.sequence.settings, vocabulary));
  text += "  commands\n";
  std::size_t number = 0;
  for (const std::string& line : command_lines(file.sequence, vocabulary)) {
    text += fmt::format("    {}. {}\n", ++number, line);
  }
  return text;
}

constexpr std::size_t kLongestInput = 512;  // of the fuzz targets of roles

// Octets as libFuzzer keeps them: the first is the seed, the rest the sequence.
void take_octets(const Session& session, const std::string& text, SequenceFile& target) {
  if (text.size() < 2 || text.size() > kLongestInput) {
    session.settings.refuse(
        "input", fmt::format("an input of a fuzz target has 2 to {} octets, this one has {}", kLongestInput,
                             text.size()));
  }
  const std::vector<std::uint8_t> octets(text.begin(), text.end());
  target.setup.seed = octets.front();
  target.sequence = conformance::sequence_of_octets(std::span(octets).subspan(1), target.role->vocabulary);
}

int code_of(const judge::CaseResult& result) {
  reports::Run run;
  run.cases = {result};
  return exit_code(run, {});
}

}  // namespace

void assign_implementations(const Session& session, SequenceFile& file) {
  const std::vector<std::string> cases_of_role{role_path(*file.role) + "/**"};
  file.setup.implementations = parse_implementations(session.settings.list("iut"), session.catalogue(),
                                                     session.catalogue().select(cases_of_role));
  const std::string role = file.role->test_case.role();
  for (const conformance::Assignment& one : file.setup.implementations) {
    if (one.role.empty() || one.role == role) continue;
    session.settings.refuse(
        "iut", fmt::format("'{}={}' plays another role than {}, whose sequences these are; write {}={}",
                           one.role, one.uri, role_path(*file.role), role, one.uri));
  }
}

std::string sequence_text(const Session& session, const SequenceFile& file, const judge::CaseResult& result,
                          const std::string& reproduce) {
  reports::TextOptions options;
  options.colour = session.terminal.has_colour();
  options.reproduce = reproduce;
  return reports::finding_text(identity_of(session, file.setup, 1), result, options) + lines_of(file);
}

void keep_sequence(Session& session, SequenceFile file, const judge::CaseResult& result,
                   const std::string& path) {
  file.end = end_of(result);
  // What was found is said first: the disk may be full.
  session.terminal.print(sequence_text(session, file, result, replay_command(path)));
  reports::write_text_file(path, sequence_file_text(file));
}

std::string shrunk_text(const conformance::Sequence& before, const conformance::Sequence& after,
                        std::uint64_t runs) {
  return fmt::format("shrunk from {} to {}, in {} runs\n", size_text(before), size_text(after), runs);
}

std::string replay_command(const std::string& file) {
  return fmt::format("fieldproof replay {}", reports::shell_quoted(file));
}

int case_of_input(Session& session, SequenceFile& target, const std::string& path) {
  const Settings& settings = session.settings;
  for (const char* other : {"corpus", "corpus-out", "max-time", "json"}) {
    if (settings.is_set(other)) settings.refuse(other, "one input is no search; leave it out, or --input");
  }
  const std::string file = settings.text("input");
  if (has_schema(file, kCorpusSchema)) {
    target.sequence =
        read_corpus_file(file, *target.role, target.suite->vocabulary(*target.role, target.setup));
  } else {
    take_octets(session, config::read_text(file), target);
  }
  session.terminal.print(reports::run_header(identity_of(session, target.setup, 1), manifest_of(session, 1)));
  const conformance::Outcome outcome =
      conformance::run_sequence(*target.suite, *target.role, target.sequence, target.setup);
  keep_sequence(session, target, outcome.result, path);
  return code_of(outcome.result);
}

int replay_sequence(Session& session) {
  const std::string& path = session.operands.front();
  SequenceFile stored = load_sequence_file(path, session.catalogue());
  stored.setup.limits = limits_from(session.settings);
  const bool is_other = session.settings.origin("iut") != Origin::fallback;
  if (is_other) assign_implementations(session, stored);
  stored.suite->check(stored.role->test_case, stored.setup);
  session.terminal.print(reports::run_header(identity_of(session, stored.setup, 1), manifest_of(session, 1)));
  conformance::Setup recorded = stored.setup;
  recorded.record = true;
  const conformance::Outcome outcome =
      conformance::run_sequence(*stored.suite, *stored.role, stored.sequence, recorded);
  const judge::CaseResult& result = outcome.result;
  if (session.settings.is_set("bits")) {
    for (const std::string& line : outcome.recording.lines())
      session.terminal.print(reports::escaped_line(line) + "\n");
  }
  session.terminal.print(sequence_text(session, stored, result, replay_command(path)));
  return compared(session.terminal, stored.end, result, is_other, code_of(result));
}

}  // namespace fieldproof::cli

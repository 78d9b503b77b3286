#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cli/attachments.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/pics_file.hpp"
#include "cli/pics_roles.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
#include "fuzz/search/sequence_search.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof check`: random sequences of commands and faults against the reference of the role; `fieldproof
// fuzz`: the same, mutated towards what the implementation has not passed yet. What fails is made as small as
// it can be and stored as a case file.
namespace fieldproof::cli {
namespace {

constexpr std::uint64_t kMostCases = 1'000'000'000;

SequenceFile target_of(const Session& session) {
  const Settings& settings = session.settings;
  SequenceFile target;
  std::tie(target.suite, target.role) = sequence_role_at(session.operands.front(), session.catalogue);
  target.setup.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  target.setup.limits = limits_from(settings);
  if (settings.is_set("pics")) {
    target.setup.pics = load_pics(settings.text("pics"), session.catalogue.pics_items());
    expect_items_of({role_path(*target.role)}, *target.setup.pics, settings.text("pics"), session.catalogue);
  }
  assign_implementations(session, target);
  target.suite->check(target.role->test_case, target.setup);
  return target;
}

std::string case_path(const Session& session, const SequenceFile& target) {
  if (session.settings.origin("case") != Origin::fallback) return session.settings.text("case");
  std::string name = role_path(*target.role);
  std::ranges::replace(name, '/', '-');
  return fmt::format("{}-{}.case.json", name, target.setup.seed);
}

constexpr std::string_view kDroveNothing =
    "; the implementation drove nothing in any of them, which shows nothing: take more sequences";

template <typename Result>
bool is_silent(const Result& result) {
  return result.passed > 0 && result.silent == result.passed;
}

template <typename Result>
int code_of(const Result& result) {
  if (result.passed == 0) return kNothingJudged;
  return result.inconclusive > 0 || is_silent(result) ? kInconclusive : kAllAsExpected;
}

std::string passed_text(const conformance::SequenceSearchResult& result, std::uint64_t cases,
                        const Interruption& interruption) {
  const std::string why = interruption.reason();
  std::string text = fmt::format("{} of {} sequences, and the reference agrees with {}", result.run, cases,
                                 result.passed == result.run ? "each" : std::to_string(result.passed));
  if (result.not_applicable > 0)
    text += fmt::format("; {} ask for what cannot be done to it", result.not_applicable);
  if (result.inconclusive > 0) text += fmt::format("; {} are inconclusive", result.inconclusive);
  if (is_silent(result)) text += kDroveNothing;
  return text + (why.empty() ? "" : "; " + why) + "\n";
}

// Stores and prints what was found after so many sequences.
int keep_found(Session& session, SequenceFile& target, const std::string& path,
               const conformance::SequenceFound& found, std::uint64_t run, const Interruption& interruption) {
  // Of one that does not do the same again the file keeps what was seen.
  target.sequence = found.is_confirmed ? found.smallest : found.drawn;
  keep_sequence(session, target, found.is_confirmed ? found.outcome.result : found.first, path);
  session.terminal.print(fmt::format("sequence {} failed; {}", run + 1,
                                     shrunk_text(found.drawn, found.smallest, found.shrinking_runs)));
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  if (found.is_confirmed) return kFailed;
  session.terminal.print("not confirmed: the implementation did not do the same again\n");
  return kDiffers;
}

// How the implementation would report its coverage.
std::string how_to_be_guided(const conformance::Setup& setup) {
  constexpr std::string_view kCompile = "compiled with -fsanitize-coverage=trace-pc";
  const std::string uri = setup.implementations.empty() ? "" : setup.implementations.front().uri;
  if (is_in_process(uri)) return fmt::format("its library is not {}", kCompile);
  if (is_plugin_uri(uri)) {
    return fmt::format(
        "its library runs in a process of its own, where coverage is not seen; write {}?in-process, {}", uri,
        kCompile);
  }
  return fmt::format("that is seen of a library in this process alone: plugin:./library.so?in-process, {}",
                     kCompile);
}

std::string fuzzed_text(const fuzz::SequenceFuzzResult& result, const conformance::Setup& setup,
                        const Interruption& interruption) {
  const std::string why = interruption.reason();
  std::string text =
      fmt::format("{} sequences without a finding; {} of them passed new edges", result.run, result.kept);
  if (!result.has_coverage) {
    text = fmt::format(
        "{} sequences without a finding; the implementation reports no coverage ({}), so they were drawn as "
        "check draws them",
        result.run, kernel::escaped_line(how_to_be_guided(setup)));
  }
  if (result.inconclusive > 0) text += fmt::format("; {} are inconclusive", result.inconclusive);
  if (is_silent(result)) text += kDroveNothing;
  return text + (why.empty() ? "" : "; " + why) + "\n";
}

}  // namespace

int check(Session& session) {
  SequenceFile target = target_of(session);
  const std::string path = case_path(session, target);
  reports::check_writable(path);
  conformance::SequenceSearch search;
  search.suite = target.suite;
  search.role = target.role;
  search.setup = target.setup;
  search.cases = session.settings.number("cases", 1, kMostCases);
  session.terminal.print(reports::run_header(identity_of(session, target.setup, 1), manifest_of(session, 1)));
  const Interruption interruption(session.settings.duration("max-time"));
  search.stop = interruption.token();
  search.on_progress = [&](std::uint64_t done) { session.terminal.progress(static_cast<std::size_t>(done)); };
  session.terminal.begin_progress(static_cast<std::size_t>(search.cases), "sequences");
  const conformance::SequenceSearchResult result = conformance::search(search);
  session.terminal.end_progress();
  if (!result.found) {
    session.terminal.print(passed_text(result, search.cases, interruption));
    return interruption.signal() != 0 ? kSignalBase + interruption.signal() : code_of(result);
  }
  return keep_found(session, target, path, *result.found, result.run, interruption);
}

int fuzz_role(Session& session) {
  SequenceFile target = target_of(session);
  const std::string path = case_path(session, target);
  reports::check_writable(path);
  const Settings& settings = session.settings;
  // With a limit in time there is none in number, unless it is given.
  const bool is_endless = settings.is_set("max-time") && settings.origin("cases") == Origin::fallback;
  fuzz::SequenceFuzz search;
  search.suite = target.suite;
  search.role = target.role;
  search.setup = target.setup;
  search.runs = is_endless ? kMostCases : settings.number("cases", 1, kMostCases);
  session.terminal.print(reports::run_header(identity_of(session, target.setup, 1), manifest_of(session, 1)));
  const Interruption interruption(settings.duration("max-time"));
  search.stop = interruption.token();
  search.on_progress = [&](std::uint64_t done) { session.terminal.progress(static_cast<std::size_t>(done)); };
  session.terminal.begin_progress(static_cast<std::size_t>(search.runs), "sequences");
  const fuzz::SequenceFuzzResult result = fuzz::search(search);
  session.terminal.end_progress();
  if (result.found) return keep_found(session, target, path, *result.found, result.run, interruption);
  session.terminal.print(fuzzed_text(result, target.setup, interruption));
  return interruption.signal() != 0 ? kSignalBase + interruption.signal() : code_of(result);
}

}  // namespace fieldproof::cli

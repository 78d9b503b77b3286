#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "cli/interruption.hpp"
#include "cli/pics_file.hpp"
#include "cli/pics_roles.hpp"
#include "cli/run_setup.hpp"
#include "cli/searched_role.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof check`: random sequences of commands and faults against the reference of the role. What fails
// is made as small as it can be and stored as a case file.
namespace fieldproof::cli {
namespace {

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

}  // namespace

SequenceFile searched_role(const Session& session) {
  const Settings& settings = session.settings;
  SequenceFile target;
  std::tie(target.suite, target.role) = sequence_role_at(session.operands.front(), session.catalogue());
  target.setup.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  target.setup.limits = limits_from(settings);
  if (settings.is_set("pics")) {
    target.setup.pics = load_pics(settings.text("pics"), session.catalogue().pics_items());
    expect_items_of({role_path(*target.role)}, *target.setup.pics, settings.text("pics"),
                    session.catalogue());
  }
  assign_implementations(session, target);
  target.suite->check(target.role->test_case, target.setup);
  return target;
}

std::string found_path(const Session& session, const SequenceFile& target) {
  if (session.settings.origin("case") != Origin::fallback) return session.settings.text("case");
  std::string name = role_path(*target.role);
  std::ranges::replace(name, '/', '-');
  return fmt::format("{}-{}.case.json", name, target.setup.seed);
}

int keep_found(Session& session, SequenceFile& target, const std::string& path,
               const conformance::SequenceFound& found, const std::string& which,
               const Interruption& interruption) {
  // Of one that does not do the same again the file keeps what was seen.
  target.sequence = found.is_confirmed ? found.smallest : found.drawn;
  keep_sequence(session, target, found.is_confirmed ? found.outcome.result : found.first, path);
  session.terminal.print(
      fmt::format("{} failed; {}", which, shrunk_text(found.drawn, found.smallest, found.shrinking_runs)));
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  if (found.is_confirmed) return kFailed;
  session.terminal.print("not confirmed: the implementation did not do the same again\n");
  return kDiffers;
}

int check(Session& session) {
  SequenceFile target = searched_role(session);
  const std::string path = found_path(session, target);
  reports::check_writable(path);
  conformance::SequenceSearch search;
  search.suite = target.suite;
  search.role = target.role;
  search.setup = target.setup;
  search.cases = session.settings.number("cases", 1, kMostSearched);
  session.terminal.print(reports::run_header(identity_of(session, target.setup, 1), manifest_of(session, 1)));
  const Interruption interruption(session.settings.duration("max-time"));
  search.stop = interruption.token();
  search.on_progress = [&](std::uint64_t done) { session.terminal.progress(static_cast<std::size_t>(done)); };
  session.terminal.begin_progress(static_cast<std::size_t>(search.cases), "sequences");
  const conformance::SequenceSearchResult result = conformance::search(search);
  session.terminal.end_progress();
  if (!result.found) {
    session.terminal.print(passed_text(result, search.cases, interruption));
    return interruption.signal() != 0 ? kSignalBase + interruption.signal() : code_of_search(result);
  }
  return keep_found(session, target, path, *result.found, fmt::format("sequence {}", result.run + 1),
                    interruption);
}

}  // namespace fieldproof::cli

#include "reports/diff.hpp"

#include "cli/exit_code.hpp"
#include "cli/verbs.hpp"
#include "reports/run_directory.hpp"

// `fieldproof diff`: what changed from one run to another; 1 when a case fails that did not, 2 when a run is
// incomplete or has lost cases: of what is not judged any more nobody knows.
namespace fieldproof::cli {

int diff(Session& session) {
  const reports::Run before = reports::RunDirectory::open(session.operands.at(0)).load().run;
  const reports::Run after = reports::RunDirectory::open(session.operands.at(1)).load().run;
  const reports::Difference difference = reports::compare(before, after);
  session.terminal.print(reports::diff_text(difference, {.colour = session.terminal.has_colour()}));
  if (session.settings.is_set("json")) {
    reports::write_text_file(session.settings.text("json"), reports::diff_json(difference));
  }
  if (!difference.new_failures.empty()) return kFailed;
  const bool is_whole = difference.incomplete.empty() && difference.disappeared.empty();
  return is_whole ? kAllAsExpected : kInconclusive;
}

}  // namespace fieldproof::cli

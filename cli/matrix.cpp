#include "conformance/matrix.hpp"

#include <fmt/format.h>

#include <limits>

#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/matrix_text.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "reports/run_directory.hpp"

// `fieldproof matrix`: every case of a protocol against every mutant of its role.
namespace fieldproof::cli {

int matrix(Session& session) {
  const conformance::Suite& suite = session.catalogue.suite(session.operands.front());
  const std::string file = session.settings.text("json");
  if (!file.empty()) reports::check_writable(file);
  const Interruption interruption(session.settings.duration("max-time"));
  conformance::MatrixPlan plan;
  plan.seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  plan.jobs = jobs_from(session.settings);
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
  if (!file.empty()) {
    write_document(session, "matrix", matrix_json(made));
    session.terminal.log(fmt::format("the matrix is in {}", file));
  }
  if (!made.is_complete) {
    session.terminal.log(interruption.reason());
    return interruption.signal() != 0 ? kSignalBase + interruption.signal() : kNothingJudged;
  }
  return made.holes.empty() ? kAllAsExpected : kFailed;
}

}  // namespace fieldproof::cli

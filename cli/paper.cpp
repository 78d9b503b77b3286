#include "papers/catalogue.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof paper`: what a paper published beside what is reproduced of it.
namespace fieldproof::cli {

int paper(Session& session) {
  const papers::Paper& chosen =
      session.operands.empty() ? papers::catalogue().front() : papers::paper_named(session.operands.front());
  papers::Settings settings;
  settings.seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  settings.duration = virtual_time_from(session.settings);
  if (settings.duration < chosen.shortest) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("--duration {}: the sections of paper {} need {} at least",
                    kernel::describe(settings.duration), chosen.name, kernel::describe(chosen.shortest)));
  }
  session.terminal.print(simulation_header(session, settings.seed, "", chosen.network));
  reports::Publication publication{std::string(chosen.title), settings.seed, {}};
  session.terminal.begin_progress(chosen.sections.size(), "sections");
  for (const papers::Reproduce reproduce : chosen.sections) {
    publication.sections.push_back(reproduce(settings));
    session.terminal.progress(publication.sections.size());
  }
  session.terminal.end_progress();
  session.terminal.print(reports::publication_text(publication));
  write_document(session, "paper", reports::publication_json(publication));
  if (reports::rows_that(publication, reports::Reproduction::differs) > 0) return kFailed;
  const bool is_decided = reports::rows_that(publication, reports::Reproduction::inconclusive) == 0;
  return is_decided ? kAllAsExpected : kInconclusive;
}

}  // namespace fieldproof::cli

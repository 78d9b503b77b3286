#include <fmt/format.h>

#include "cli/burst_shrink.hpp"
#include "cli/case_file.hpp"
#include "cli/emc_case.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_emc.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof shrink`: a stored case that fails, made smaller.
namespace fieldproof::cli {
namespace {

constexpr std::string_view kJson = ".json";

std::string smaller_path(const Session& session) {
  if (session.settings.origin("case") != Origin::fallback) return session.settings.text("case");
  const std::string& path = session.operands.front();
  const std::size_t stem = path.ends_with(kJson) ? path.size() - kJson.size() : path.size();
  return path.substr(0, stem) + ".shrunk.json";
}

int shrink_sequence(Session& session, SequenceFile stored, const std::string& path) {
  reports::check_writable(path);
  stored.setup.limits = limits_from(session.settings);
  stored.suite->check(stored.role->test_case, stored.setup);
  session.terminal.print(reports::run_header(identity_of(session, stored.setup, 1), manifest_of(session, 1)));
  const Interruption interruption(session.settings.duration("max-time"));
  const auto found =
      conformance::shrink(*stored.suite, *stored.role, stored.sequence, stored.setup, interruption.token());
  if (!found) {
    session.terminal.print("the stored commands do not fail: nothing to make smaller\n");
    return kDiffers;
  }
  stored.sequence = found->smallest;
  keep_sequence(session, stored, found->outcome.result, path);
  session.terminal.print(shrunk_text(found->drawn, found->smallest, found->shrinking_runs));
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  if (found->smallest == found->drawn) {
    session.terminal.print("nothing is smaller: each part that can be left out was tried\n");
    return kDiffers;
  }
  return found->is_confirmed ? kAllAsExpected : kDiffers;
}

}  // namespace

int shrink(Session& session) {
  const std::string& file = session.operands.front();
  const std::string path = smaller_path(session);
  if (is_sequence_file(file))
    return shrink_sequence(session, load_sequence_file(file, session.catalogue()), path);
  if (has_schema(file, kEmcCaseSchema)) return shrink_emc(session, path);
  CaseFile stored = load_case(file, session.catalogue());
  stored.setup.limits = limits_from(session.settings);
  reports::check_writable(path);
  return shrink_bursts(session, stored, path);
}

}  // namespace fieldproof::cli

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof plan`: what keeps the bounds of a network file, found and proven by simulation. Which protocol
// plans it is told by the key that the file has.
namespace fieldproof::cli {
namespace {

constexpr std::size_t kLimitOfText = 1 << 20;

const Planner& planner_of(const config::Document& file) {
  std::vector<std::string> known;
  const Planner* found = nullptr;
  config::read_open_object(file.root(), [&](config::ObjectReader& object) {
    for (const ProtocolEntry& protocol : protocols()) {
      const Planner& planner = protocol.planner;
      if (planner.plan == nullptr) continue;
      known.push_back(fmt::format("\"{}\" ({}/{})", planner.key, protocol.name, planner.file));
      if (found == nullptr && object.optional(planner.key)) found = &planner;
    }
  });
  if (found != nullptr) return *found;
  if (known.empty())
    throw kernel::Error(kernel::ErrorKind::usage, "no protocol of this program has anything to plan");
  config::fail(file.root(), fmt::format("no protocol plans this file; one that is planned has {}",
                                        fmt::join(known, " or ")));
}

}  // namespace

int plan(Session& session) {
  const std::uint64_t seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  const auto file = config::Document::load(session.operands.front(), {.size = kLimitOfText});
  const Planned planned = planner_of(file).plan(file, seed);
  session.terminal.print(planned.text);
  write_document(session, "plan", planned.json);
  if (planned.is_open) return kInconclusive;
  return planned.is_proven ? kAllAsExpected : kFailed;
}

}  // namespace fieldproof::cli

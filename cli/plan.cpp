#include <limits>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof plan`: what keeps the bound of a network file, found and proven by simulation.
namespace fieldproof::cli {

int plan(Session& session) {
  const std::uint64_t seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  for (const ProtocolEntry& protocol : protocols()) {
    if (protocol.plan == nullptr) continue;
    const Planned planned = protocol.plan(session.operands.front(), seed);
    session.terminal.print(planned.text);
    if (planned.is_open) return kInconclusive;
    return planned.is_proven ? kAllAsExpected : kFailed;
  }
  throw kernel::Error(kernel::ErrorKind::usage, "no protocol of this program has anything to plan");
}

}  // namespace fieldproof::cli

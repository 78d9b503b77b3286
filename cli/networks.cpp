#include "cli/networks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/attachments.hpp"
#include "cli/implementations.hpp"
#include "cli/run_setup.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {

const ProtocolEntry& network_entry_of(const Session& session, std::string_view verb) {
  const std::string& protocol = session.operands.front();
  std::vector<std::string_view> names;
  for (const ProtocolEntry& entry : protocols()) {
    if (entry.network.plan == nullptr) continue;
    if (entry.name == protocol) return entry;
    names.push_back(entry.name);
  }
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}' runs no network of '{}'; there are '{}'",
                                                            verb, protocol, fmt::join(names, "', '")));
}

std::unique_ptr<conformance::PlannedNetwork> plan_network(const Session& session,
                                                          const ProtocolEntry& entry) {
  const Settings& settings = session.settings;
  if (!entry.network.has_latch_models && settings.origin("latch") == Origin::command_line) {
    settings.refuse("latch", "the stations of this network have no latch model; leave it out");
  }
  const auto entries = session.catalogue.select(std::vector{session.operands.front() + "/**"});
  return entry.network.plan({.file = settings.text("network"),
                             .implementations = parse_implementations(settings.list("iut"), session.catalogue,
                                                                      entries, kAnyPosition),
                             .limits = limits_from(settings),
                             .attach = attachments(),
                             .latch = settings.choice("latch")});
}

}  // namespace fieldproof::cli

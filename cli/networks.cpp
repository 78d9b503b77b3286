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
  return network_entry_named(session.operands.front(), verb);
}

const ProtocolEntry& network_entry_named(std::string_view protocol, std::string_view verb) {
  std::vector<std::string_view> names;
  for (const ProtocolEntry& entry : protocols()) {
    if (entry.network.plan == nullptr) continue;
    if (entry.name == protocol) return entry;
    names.push_back(entry.name);
  }
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}' runs no network of '{}'; there are '{}'",
                                                            verb, protocol, fmt::join(names, "', '")));
}

conformance::NetworkRequest network_request(const Session& session, const ProtocolEntry& entry) {
  const Settings& settings = session.settings;
  if (!entry.network.has_latch_models && settings.origin("latch") == Origin::command_line) {
    settings.refuse("latch", "the stations of this network have no latch model; leave it out");
  }
  return {.file = settings.text("network"),
          .implementations = network_implementations(session, entry),
          .limits = limits_from(settings),
          .attach = attachments(),
          .latch = settings.choice("latch")};
}

std::vector<conformance::Assignment> network_implementations(const Session& session,
                                                             const ProtocolEntry& entry) {
  const std::vector<std::string> typed = session.settings.list("iut");
  if (typed.empty()) return {};
  const auto entries = session.catalogue().select(std::vector{std::string(entry.name) + "/**"});
  return parse_implementations(typed, session.catalogue(), entries, kAnyPosition);
}

std::unique_ptr<conformance::PlannedNetwork> plan_network(const Session& session,
                                                          const ProtocolEntry& entry) {
  return entry.network.plan(network_request(session, entry));
}

bool is_no_reference(const conformance::Assignment& one) {
  return one.uri != conformance::kReferenceUri;
}

std::string players_of(const std::vector<conformance::Assignment>& implementations) {
  std::string text;
  for (const conformance::Assignment& one : implementations) {
    if (!is_no_reference(one)) continue;
    text += fmt::format("{}{}@{}={}", text.empty() ? "" : " ", one.role, std::max(one.position, 1), one.uri);
  }
  return text;
}

std::string players_text(const std::vector<conformance::Assignment>& implementations) {
  std::string text;
  for (const conformance::Assignment& one : implementations) {
    if (!is_no_reference(one)) continue;
    text += fmt::format("{}{}@{} ({})", text.empty() ? "in it: " : ", ", one.role, std::max(one.position, 1),
                        reports::escaped_line(one.uri));
  }
  return text.empty() ? text : text + "; whoever is not named is a reference\n";
}

}  // namespace fieldproof::cli

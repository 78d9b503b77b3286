#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/station_on_line.hpp"
#include "cli/verbs.hpp"
#include "conformance/valve_bus/node_deviations.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/server.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/node.hpp"

// `fieldproof station`: a built-in station, or one in a shared library, as an implementation in a process of
// its own. A built-in one shows that the bench judges it there as it does inside, and stands in for an
// implementation that is not there yet.
namespace fieldproof::cli {
namespace {

constexpr std::string_view kNode = "valve_bus/node";

std::unique_ptr<valve_bus::NodeDevice> node_of(const std::string& uri,
                                               const valve_bus::NodeConfiguration& configuration) {
  constexpr std::string_view kDeviant = "deviant:";
  if (uri == "ref") return std::make_unique<valve_bus::Node>(configuration);
  if (uri.starts_with(kDeviant)) {
    return conformance::make_node_deviation(uri.substr(kDeviant.size()), configuration);
  }
  throw kernel::Error(
      kernel::ErrorKind::usage,
      fmt::format("'{}' is no built-in station; write ref, deviant:NAME or plugin:LIBRARY", uri));
}

// Lock step and virtual time, at the standard streams.
void play_in_lock_step(const std::string& uri) {
  constexpr std::string_view kPlugin = "plugin:";
  const bool is_plugin = uri.starts_with(kPlugin);
  if (!is_plugin) node_of(uri, {});
  iut::serve(
      STDIN_FILENO, STDOUT_FILENO,
      [&](const iut::RoleName& role) -> std::unique_ptr<iut::Device> {
        if (fmt::format("{}/{}", role.protocol, role.role) != kNode) return nullptr;
        if (is_plugin) return iut::load_plugin(uri.substr(kPlugin.size()), role.protocol, role.role);
        return std::make_unique<valve_bus::ServedNode>(
            [uri](const valve_bus::NodeConfiguration& configuration) { return node_of(uri, configuration); });
      },
      fmt::format("fieldproof {}", uri));
}

}  // namespace

int station(Session& session) {
  const std::string& wanted = session.operands.front();
  if (wanted != kNode) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("no station '{}' can be played; there is '{}'", wanted, kNode));
  }
  const std::string uri = session.operands.size() > 1 ? session.operands[1] : "ref";
  if (session.settings.is_set("serial")) {
    play_on_line(session, uri, [&](const valve_bus::NodeConfiguration& configuration) {
      return node_of(uri, configuration);
    });
  } else {
    play_in_lock_step(uri);
  }
  return kAllAsExpected;
}

}  // namespace fieldproof::cli

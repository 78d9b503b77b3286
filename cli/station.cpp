#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>

#include "cli/attachments.hpp"
#include "cli/exit_code.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/station_on_line.hpp"
#include "cli/verbs.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/server.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof station`: a built-in station, or one in a shared library, as an implementation in a process of
// its own. A built-in one shows that the bench judges it there as it does inside, and stands in for an
// implementation that is not there yet.
namespace fieldproof::cli {
namespace {

bool wants_telegrams(const Session& session, const Role& role, const std::string& uri) {
  const std::string units = session.settings.text("units");
  if (units == "levels") return false;
  if (units != "telegrams") session.settings.refuse("units", "there are 'levels' and 'telegrams'");
  if (role.in_telegrams == nullptr) {
    session.settings.refuse("units", fmt::format("there are no telegrams for '{}'", role.path()));
  }
  if (is_plugin_uri(uri)) session.settings.refuse("units", "a library says itself what it receives");
  return true;
}

// Lock step and virtual time, at the standard streams.
void play_in_lock_step(const Role& role, const std::string& uri, bool in_telegrams) {
  const bool is_plugin = is_plugin_uri(uri);
  if (!is_plugin) role.serve(uri);
  iut::serve(
      STDIN_FILENO, STDOUT_FILENO, {std::string(role.protocol), std::string(role.name)},
      [&](const iut::RoleName& wanted) -> std::unique_ptr<iut::Device> {
        if (wanted.protocol != role.protocol || wanted.role != role.name) return nullptr;
        if (is_plugin) return library_of(uri, wanted);
        if (!in_telegrams) return role.serve(uri);
        return role.in_telegrams(role.serve(uri));
      },
      is_plugin ? iut::own_name_of_plugin(plugin_path(uri)) : fmt::format("fieldproof {}", uri));
}

}  // namespace

int station(Session& session) {
  const Role& role = role_named(session.operands.front());
  const std::string uri = session.operands.size() > 1 ? session.operands[1] : "ref";
  const bool in_telegrams = wants_telegrams(session, role, uri);
  if (!session.settings.is_set("serial")) {
    play_in_lock_step(role, uri, in_telegrams);
  } else if (role.uart != nullptr) {
    play_on_line(session, role, uri);
  } else {
    session.settings.refuse("serial", no_serial_line_for(role));
  }
  return kAllAsExpected;
}

}  // namespace fieldproof::cli

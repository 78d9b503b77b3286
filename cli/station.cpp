#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cli/attachments.hpp"
#include "cli/exit_code.hpp"
#include "cli/roles.hpp"
#include "cli/station_on_line.hpp"
#include "cli/verbs.hpp"
#include "harness/iut/server.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/telegram_speaker.hpp"

// `fieldproof station`: a built-in station, or one in a shared library, as an implementation in a process of
// its own. A built-in one shows that the bench judges it there as it does inside, and stands in for an
// implementation that is not there yet.
namespace fieldproof::cli {
namespace {

const Role& role_named(const std::string& path) {
  const auto found = std::ranges::find(roles(), path, &Role::path);
  if (found != roles().end()) return *found;
  std::vector<std::string> known;
  for (const Role& role : roles()) known.push_back(role.path());
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("no station '{}' can be played; there are '{}'",
                                                            path, fmt::join(known, "', '")));
}

bool wants_telegrams(const Session& session, const Role& role, const std::string& uri) {
  const std::string units = session.settings.text("units");
  if (units == "levels") return false;
  if (units != "telegrams") session.settings.refuse("units", "there are 'levels' and 'telegrams'");
  if (role.telegram_ports == 0) {
    session.settings.refuse("units", fmt::format("there are no telegrams for '{}'", role.path()));
  }
  if (is_plugin_uri(uri)) session.settings.refuse("units", "a library says itself what it hears");
  return true;
}

// Lock step and virtual time, at the standard streams.
void play_in_lock_step(const Role& role, const std::string& uri, bool in_telegrams) {
  const bool is_plugin = is_plugin_uri(uri);
  if (!is_plugin) role.serve(uri);
  iut::serve(
      STDIN_FILENO, STDOUT_FILENO,
      [&](const iut::RoleName& wanted) -> std::unique_ptr<iut::Device> {
        if (wanted.protocol != role.protocol || wanted.role != role.name) return nullptr;
        if (is_plugin) return library_of(uri, wanted);
        if (!in_telegrams) return role.serve(uri);
        return std::make_unique<interbus::TelegramSpeaker>(role.serve(uri), role.telegram_ports);
      },
      fmt::format("fieldproof {}", uri));
}

}  // namespace

int station(Session& session) {
  const Role& role = role_named(session.operands.front());
  const std::string uri = session.operands.size() > 1 ? session.operands[1] : "ref";
  const bool in_telegrams = wants_telegrams(session, role, uri);
  if (!session.settings.is_set("serial")) {
    play_in_lock_step(role, uri, in_telegrams);
  } else if (role.path() == kRoleOnLines) {
    play_on_line(session, uri);
  } else {
    session.settings.refuse("serial", fmt::format("there is no line for '{}'; '{}' can be played on one",
                                                  role.path(), kRoleOnLines));
  }
  return kAllAsExpected;
}

}  // namespace fieldproof::cli

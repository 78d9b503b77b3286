#include "cli/station_on_line.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "cli/attachments.hpp"
#include "cli/pics_file.hpp"
#include "harness/iut/line_player.hpp"
#include "harness/iut/server.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using iut::LinePlayer;

// A built-in station, or one outside as a station of levels.
LinePlayer::MakeStation maker_of(const Role& role, const std::string& uri) {
  if (!is_attachment(uri)) {
    role.serve(uri);  // refuses before anything is opened
    return [&role, uri](const iut::CaseBegin&) { return role.serve(uri); };
  }
  return [&role, uri, attach = attachments()](const iut::CaseBegin& begin) {
    const iut::RoleName name{std::string(role.protocol), std::string(role.name)};
    return role.in_levels(*attach(name, {uri, begin.id, begin.seed, {}}), begin);
  };
}

// One connection of a bench, or its whole life at the standard streams.
void serve_bench(int input, int output, iut::SerialLine& line, const Role& role,
                 const LinePlayer::MakeStation& make_station, const std::string& name) {
  LinePlayer* player = nullptr;
  iut::serve(
      input, output, {std::string(role.protocol), std::string(role.name)},
      [&](const iut::RoleName& wanted) -> std::unique_ptr<iut::Device> {
        if (wanted.protocol != role.protocol || wanted.role != role.name) return nullptr;
        auto made = std::make_unique<LinePlayer>(
            line, role.uart, std::vector<iut::Item>(role.inputs.begin(), role.inputs.end()), make_station);
        player = made.get();
        return made;
      },
      name,
      [&](int descriptor) {
        if (player != nullptr) player->play(descriptor);
      });
}

[[noreturn]] void refuse_socket(const std::string& path, const std::string& why) {
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("--upper '{}': {}", path, why));
}

iut::Descriptor listen_at(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    refuse_socket(path, "the path of a socket has at most 107 characters");
  std::memcpy(address.sun_path, path.data(), path.size());
  if (std::filesystem::is_socket(path)) ::unlink(path.c_str());
  iut::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.number(), 1) != 0) {
    refuse_socket(path, std::system_category().message(errno));
  }
  return socket;
}

// What a station that is ended by a signal takes away: its socket, and its name as long as that leads to its
// terminal.
struct Leavings {
  std::array<char, PATH_MAX> link{};
  std::array<char, PATH_MAX> terminal{};
  std::array<char, PATH_MAX> socket{};
};
Leavings leavings;

extern "C" void take_leavings_away(int signal) {
  std::array<char, PATH_MAX> leads_to{};
  const ssize_t length = ::readlink(leavings.link.data(), leads_to.data(), leads_to.size() - 1);
  if (length > 0 && std::strcmp(leads_to.data(), leavings.terminal.data()) == 0)
    ::unlink(leavings.link.data());
  if (leavings.socket.front() != '\0') ::unlink(leavings.socket.data());
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void keep(std::array<char, PATH_MAX>& place, const std::string& path) {
  if (path.size() < place.size()) std::ranges::copy(path, place.begin());
}

// Of a line that was made here, and of the socket at its side.
void clear_at_the_end(const std::string& link, const std::string& upper) {
  std::error_code failure;
  const std::filesystem::path terminal = std::filesystem::read_symlink(link, failure);
  if (!failure && terminal.string().starts_with("/dev/pts/")) {
    keep(leavings.link, link);
    keep(leavings.terminal, terminal.string());
  }
  if (std::filesystem::is_socket(upper)) keep(leavings.socket, upper);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, take_leavings_away);
}

void serve_socket(const std::string& path, const std::string& link, iut::SerialLine& line, const Role& role,
                  const LinePlayer::MakeStation& make_station, const std::string& name) {
  const iut::Descriptor listener = listen_at(path);
  clear_at_the_end(link, path);
  while (true) {
    const iut::Descriptor bench(::accept4(listener.number(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!bench) continue;
    try {
      serve_bench(bench.number(), bench.number(), line, role, make_station, name);
    } catch (const kernel::Error& error) {
      fmt::print(stderr, "{}\n", error.what());  // of this bench; the next one is served
    }
  }
}

// The name of a terminal whose maker was killed, which may be that of another terminal by now: one that was
// made after the name.
bool is_left_behind(const std::string& path) {
  struct stat link{};
  struct stat device{};
  if (::lstat(path.c_str(), &link) != 0 || !S_ISLNK(link.st_mode)) return false;
  if (::stat(path.c_str(), &device) != 0) return true;
  if (!std::filesystem::read_symlink(path).string().starts_with("/dev/pts/")) return false;
  const auto instant = [](const timespec& at) { return std::pair(at.tv_sec, at.tv_nsec); };
  return instant(link.st_mtim) < instant(device.st_ctim);
}

iut::SerialLine line_at(const std::string& path) {
  const iut::WallClock clock;
  const bool is_new = is_left_behind(path) ||
                      std::filesystem::symlink_status(path).type() == std::filesystem::file_type::not_found;
  return is_new ? iut::SerialLine::at_new_terminal(path, clock) : iut::SerialLine(path, clock);
}

}  // namespace

void play_on_line(Session& session, const Role& role, const std::string& uri) {
  const LinePlayer::MakeStation make_station = maker_of(role, uri);
  iut::SerialLine line = line_at(session.settings.text("serial"));
  const std::string upper = session.settings.text("upper");
  const std::string name = fmt::format("fieldproof {} on a line", uri);
  clear_at_the_end(session.settings.text("serial"), "");
  if (upper == "-") return serve_bench(STDIN_FILENO, STDOUT_FILENO, line, role, make_station, name);
  if (upper != "none")
    return serve_socket(upper, session.settings.text("serial"), line, role, make_station, name);
  if (role.alone == nullptr) {
    session.settings.refuse("upper",
                            fmt::format("'{}' does nothing by itself: what it is asked comes through "
                                        "the upper channel",
                                        role.path()));
  }
  judge::Pics pics;
  if (session.settings.is_set("pics"))
    pics = load_pics(session.settings.text("pics"), session.catalogue().pics_items());
  LinePlayer player(line, role.uart, {}, make_station);
  player.begin_alone(role.alone(pics));
  player.play(-1);
}

}  // namespace fieldproof::cli

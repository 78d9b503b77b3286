#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/embedded_devices.hpp"
#include "cli/exit_code.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"
#include "reports/results.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof new`: a device of a role to begin with. It is judged as it is, and does nothing yet.
namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// In the order of the words of `--lang`.
struct Language {
  std::string_view file;
  std::string_view text;
  std::string_view build;  // {0}: the folder; empty: nothing is built
  std::string_view iut;
};
constexpr std::array kLanguages = {
    Language{"device.py", device_py_text, "", "exec:python3 {0}/device.py"},
    Language{"device.c", device_c_text,
             "cc -O2 -shared -fPIC -fvisibility=hidden -o {0}/libdevice.so {0}/device.c",
             "plugin:{0}/libdevice.so"},
    Language{"device.cpp", device_cpp_text,
             "c++ -std=c++17 -O2 -shared -fPIC -fvisibility=hidden -o {0}/libdevice.so {0}/device.cpp",
             "plugin:{0}/libdevice.so"},
};
constexpr std::string_view kHeaderFile = "fieldproof_plugin.h";

std::string_view unit_of(const Role& role) {
  if (role.uart != nullptr) return "CHARACTERS";
  return role.in_telegrams != nullptr ? "TELEGRAMS" : "LEVELS";
}

std::string filled_in(std::string text, const Role& role) {
  const std::array<std::pair<std::string_view, std::string>, 4> words = {
      {{"@PROTOCOL@", std::string(role.protocol)},
       {"@ROLE@", std::string(role.name)},
       {"@PATH@", role.path()},
       {"@UNIT@", std::string(unit_of(role))}}};
  for (const auto& [word, value] : words) {
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += value.size()) {
      text.replace(at, word.size(), value);
    }
  }
  return text;
}

// What somebody has written stays.
void write_new(const Session& session, const fs::path& file, const std::string& text) {
  if (fs::exists(fs::symlink_status(file))) {
    session.settings.refuse("out", fmt::format("'{}' is there already; name another folder", file.string()));
  }
  reports::write_text_file(file, text);
}

}  // namespace

int new_device(Session& session) {
  const Role& role = role_named(session.operands.front());
  const Language& language = kLanguages.at(session.settings.choice("lang"));
  std::string folder = session.settings.text("out");
  if (folder.empty()) folder = std::string(role.name);
  const fs::path file = fs::path(folder) / language.file;
  write_new(session, file, filled_in(std::string(language.text), role));
  if (!language.build.empty() && !fs::exists(fs::path(folder) / kHeaderFile)) {
    write_new(session, fs::path(folder) / kHeaderFile, std::string(fieldproof_plugin_h_text));
  }
  // A library without a folder would be looked for where the system has its own.
  const std::string place = fs::path(folder).is_absolute() ? folder : "./" + folder;
  const auto in_place = [](std::string_view words, const std::string& where) {
    return fmt::format(fmt::runtime(words), where);
  };
  // A library is one path, a process a command line.
  const bool is_command = language.iut.starts_with("exec:");
  std::string text = fmt::format("{} is a {} of {} that does nothing yet. It is judged by\n", file.string(),
                                 role.name, role.protocol);
  if (!language.build.empty())
    text += fmt::format("  {}\n", in_place(language.build, reports::shell_quoted(place)));
  text += fmt::format(
      "  fieldproof run {} --iut {}\n", reports::shell_quoted(role.path() + "/**"),
      reports::shell_quoted(in_place(language.iut, is_command ? reports::shell_quoted(place) : place)));
  session.terminal.print(reports::escaped_block(text));
  return kAllAsExpected;
}

}  // namespace fieldproof::cli

#include "cli/shown_recording.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "cli/case_file.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

struct Export {
  const char* option;
  std::string (*write)(const conformance::Recording&, const std::string& id);
};

constexpr std::array kExports = {Export{"pcapng", capture_of}, Export{"vcd", wave_dump_of}};

// Also by another path, or through a link.
bool is_one_file(const std::string& one, const std::string& other) {
  std::error_code failure;
  const auto path_of = [&](const std::string& name) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(name), failure);
  };
  return one == other || path_of(one) == path_of(other);
}

}  // namespace

void check_exports(const Settings& settings) {
  for (const Export& one : kExports) {
    if (!settings.is_set(one.option)) continue;
    for (const Export& other : kExports) {
      if (&other == &one) break;
      if (settings.is_set(other.option) &&
          is_one_file(settings.text(other.option), settings.text(one.option)))
        settings.refuse(one.option,
                        fmt::format("--{} is written to the same file; name another", other.option));
    }
    reports::check_writable(settings.text(one.option));
  }
}

void show_recording(Session& session, const conformance::Recording& recording, const std::string& id) {
  bool is_shown = session.settings.is_set("bits");
  if (is_shown) {
    for (const std::string& line : recording.lines())
      session.terminal.print(reports::escaped_line(line) + "\n");
  }
  for (const Export& one : kExports) {
    if (!session.settings.is_set(one.option)) continue;
    reports::write_text_file(session.settings.text(one.option), one.write(recording, id));
    is_shown = true;
  }
  if (is_shown && recording.truncated) session.terminal.log("the recording is not whole: it has a bound");
}

}  // namespace fieldproof::cli

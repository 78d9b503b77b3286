// For tests: fieldproof_probe called in a folder of its own.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {

class Program : public ProgramFixture {
 protected:
  Call call(std::vector<std::string> arguments) const {
    return prepared(std::move(arguments), FIELDPROOF_PROBE);
  }
  Called probe(std::vector<std::string> arguments) const { return call(std::move(arguments)).run(); }
  int code(std::vector<std::string> arguments) const { return probe(std::move(arguments)).exit_code; }

  std::filesystem::path case_file(const std::filesystem::path& run) const {
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder_ / run)) {
      if (file.path().filename() == "case.json") return file.path();
    }
    return {};
  }
};

inline std::string last_line(const std::string& text) {
  std::stringstream lines(text);
  std::string line;
  std::string last;
  while (std::getline(lines, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

// The words of a shell around a call of the probe: which streams are open.
inline Call in_shell(Call call, const std::string& redirections) {
  std::string words = "\"$0\" \"$@\" " + redirections;
  call.arguments.insert(call.arguments.begin(), {"-c", words, call.program});
  call.program = "/bin/sh";
  return call;
}

}  // namespace fieldproof::cli

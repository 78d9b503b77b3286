// For tests: programs of others that open what this folder writes. A machine may lack them: then
// `is_available` is false, `output` is the sentence that says what to install, and a test skips with it.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {

using Reading = AjvJudgement;

inline Reading read_with(const std::string& program, const std::string& arguments) {
  Reading missing;
  missing.output = program + " is not installed; run script/setup";
  if (run_for_judgement("command -v " + program + " >/dev/null").exit_code != 0) return missing;
  return run_for_judgement(program + " " + arguments);
}

// tshark with the dissector of `source`, the top folder of the project. Its configuration is of a folder that
// is not there, so that nothing of the machine plays a part.
inline Reading read_with_tshark(const std::filesystem::path& source, const std::filesystem::path& capture,
                                const std::string& arguments) {
  const std::filesystem::path script = source / "reports" / "wireshark" / "fieldproof.lua";
  return read_with("tshark", "-X lua_script:" + shell_word(script.string()) + " -r " +
                                 shell_word(capture.string()) + " " + arguments +
                                 " 2>&1 | grep -v '^Running as user'");
}

// One row for each line, one column for each tab.
inline std::vector<std::vector<std::string>> table_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& row = rows.emplace_back();
    std::size_t begin = 0;
    for (std::size_t tab = 0; (tab = line.find('\t', begin)) != std::string::npos; begin = tab + 1) {
      row.push_back(line.substr(begin, tab - begin));
    }
    row.push_back(line.substr(begin));
  }
  return rows;
}

}  // namespace fieldproof::reports

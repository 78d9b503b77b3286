// For tests: asks ajv, through validate.mjs, whether JSON files satisfy a JSON Schema.
//
// The judge needs node and the installed package, which a machine may lack: then `is_available` is false,
// `output` is the sentence that says what to install, and a test skips with it. Paths may hold any character
// but NUL.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace fieldproof::reports {

struct AjvJudgement {
  bool is_available = false;
  int exit_code = -1;  // 0 all valid, 1 a file is invalid, 2 the schema is unusable
  std::string output;  // a line for each file, in order
};

inline std::string shell_word(const std::string& word) {
  std::string quoted = "'";
  for (const char octet : word) quoted += octet == '\'' ? std::string("'\\''") : std::string(1, octet);
  return quoted + "'";
}

inline AjvJudgement run_for_judgement(const std::string& command) {
  AjvJudgement judgement;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    judgement.output = "no shell can be started";
    return judgement;
  }
  char block[4096];
  for (std::size_t size = 0; (size = std::fread(block, 1, sizeof block, pipe)) > 0;) {
    judgement.output.append(block, size);
  }
  const int status = pclose(pipe);
  judgement.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  judgement.is_available = true;
  return judgement;
}

// `source` is the top folder of the project.
inline AjvJudgement judge_with_ajv(const std::filesystem::path& source, const std::filesystem::path& schema,
                                   const std::vector<std::filesystem::path>& files) {
  const std::filesystem::path folder = source / "reports" / "schema";
  AjvJudgement missing;
  missing.output = "JSON Schemas are judged by node, which is not installed; run script/setup";
  if (run_for_judgement("node --version 2>/dev/null").exit_code != 0) return missing;
  missing.output = "JSON Schemas are judged by ajv, which is not installed; run \"npm ci\" in reports/schema";
  if (!std::filesystem::exists(folder / "node_modules" / "ajv")) return missing;
  std::string command =
      "node " + shell_word((folder / "validate.mjs").string()) + " " + shell_word(schema.string());
  for (const auto& file : files) command += " " + shell_word(file.string());
  return run_for_judgement(command + " 2>&1");
}

}  // namespace fieldproof::reports

// For tests of verbs: fieldproof called in a folder of its own, which is gone with the test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/probe/called_program.hpp"
#include "cli/probe/source_folder.hpp"
#include "reports/approved_text.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {

class ProgramFixture : public testing::Test {
 protected:
  Call prepared(std::vector<std::string> arguments, std::string program = FIELDPROOF_EXE) const {
    Call call;
    call.program = std::move(program);
    call.arguments = std::move(arguments);
    call.folder = folder_;
    return call;
  }
  Called call(std::vector<std::string> arguments) const { return prepared(std::move(arguments)).run(); }

  // Files of the folder; one that is not there reads as an empty one.
  std::string read(const std::filesystem::path& file) const {
    std::ifstream input(folder_ / file);
    return {std::istreambuf_iterator<char>(input), {}};
  }
  // The files of one of its folders, by name.
  std::map<std::string, std::string> read_all(const std::filesystem::path& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
      files[entry.path().filename().string()] = read(name / entry.path().filename());
    return files;
  }
  nlohmann::json json(const std::filesystem::path& file) const { return nlohmann::json::parse(read(file)); }
  void write(const std::filesystem::path& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
  }

  // Asks ajv, or skips the test where it is not installed.
  void expect_valid(const std::vector<std::filesystem::path>& files, const std::string& schema) const {
    std::vector<std::filesystem::path> here;
    for (const auto& file : files) here.push_back(folder_ / file);
    const auto judgement = reports::judge_with_ajv(
        kSourceFolder, kSourceFolder / "reports/schema" / (schema + ".schema.json"), here);
    if (!judgement.is_available) GTEST_SKIP() << judgement.output;
    EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
  }

 private:
  reports::TemporaryFolder temporary_;

 protected:
  const std::filesystem::path folder_ = temporary_.path();
};

}  // namespace fieldproof::cli

#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << "in\n" << (text)

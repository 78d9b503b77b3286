// Subject: the network schema and the network reader, which must judge alike.
// Holds the schema of network files and their reader together: both take every good file, both refuse every
// bad one, and what only the reader can refuse is kept apart. Lies here because it joins a protocol and a
// report.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = FIELDPROOF_SOURCE_DIR;

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kSource / folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Each file must be judged as `expected`: "valid" or "invalid".
void expect_all(const std::vector<fs::path>& files, const std::string& expected) {
  ASSERT_FALSE(files.empty());
  const auto judgement =
      reports::judge_with_ajv(kSource, kSource / "protocols/interbus/network.schema.json", files);
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  std::istringstream lines(judgement.output);
  std::string line;
  for (const fs::path& file : files) {
    ASSERT_TRUE(std::getline(lines, line)) << judgement.output;
    const std::string wanted = file.string() + ": " + expected;
    EXPECT_TRUE(line == wanted || line.starts_with(wanted + ":")) << line;
  }
}

TEST(NetworkSchemaTest, TakesWhatTheReaderTakes) {
  expect_all(json_files("protocols/interbus/network_corpus/good"), "valid");
}

TEST(NetworkSchemaTest, RefusesWhatTheReaderRefuses) {
  expect_all(json_files("protocols/interbus/network_corpus/bad"), "invalid");
}

// When the schema learns one of these, the file moves to bad/.
TEST(NetworkSchemaTest, CannotSayWhatNeedsTheWholeNetwork) {
  expect_all(json_files("protocols/interbus/network_corpus/bad_semantic"), "valid");
}

TEST(NetworkSchemaTest, TakesTheNetworksOfTheExamples) {
  expect_all({kSource / "examples/paper.json", kSource / "examples/paper_printed_reading.json",
              kSource / "examples/mixed_line.json"},
             "valid");
}

}  // namespace
}  // namespace fieldproof::cli

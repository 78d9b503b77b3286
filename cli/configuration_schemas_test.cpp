// Subject: schemas of configuration files and their readers, which must judge alike.
// Holds each schema and its reader together: both take every good file of a corpus, both refuse every bad
// one, and what only the reader can refuse is kept apart. Lies here because it joins what reads with a
// report.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cli/probe/source_folder.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kNetwork = "protocols/interbus/network";
const fs::path kBurstProfile = "emc/profile";

fs::path with_suffix(const fs::path& stem, const char* suffix) {
  return kSourceFolder / (stem.string() + suffix);
}

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Each file must be judged as `expected`: "valid" or "invalid".
void expect_all(const fs::path& stem, const std::vector<fs::path>& files, const std::string& expected) {
  ASSERT_FALSE(files.empty());
  const auto judgement = reports::judge_with_ajv(kSourceFolder, with_suffix(stem, ".schema.json"), files);
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  std::istringstream lines(judgement.output);
  std::string line;
  for (const fs::path& file : files) {
    ASSERT_TRUE(std::getline(lines, line)) << judgement.output;
    const std::string wanted = file.string() + ": " + expected;
    EXPECT_TRUE(line == wanted || line.starts_with(wanted + ":")) << line;
  }
}

void expect_corpus(const fs::path& stem, const char* part, const std::string& expected) {
  expect_all(stem, json_files(with_suffix(stem, "_corpus") / part), expected);
}

TEST(NetworkSchemaTest, TakesWhatTheReaderTakes) {
  expect_corpus(kNetwork, "good", "valid");
}

TEST(NetworkSchemaTest, RefusesWhatTheReaderRefuses) {
  expect_corpus(kNetwork, "bad", "invalid");
}

// When the schema learns one of these, the file moves to bad/.
TEST(NetworkSchemaTest, CannotSayWhatNeedsTheWholeNetwork) {
  expect_corpus(kNetwork, "bad_semantic", "valid");
}

TEST(NetworkSchemaTest, TakesTheNetworksOfTheExamples) {
  expect_all(kNetwork,
             {kSourceFolder / "examples/paper.json", kSourceFolder / "examples/paper_printed_reading.json",
              kSourceFolder / "examples/mixed_line.json"},
             "valid");
}

TEST(TokenNetworkSchemaTest, TakesTheNetworkOfTheExamples) {
  expect_all("protocols/fieldbus_dll/token_network", {kSourceFolder / "examples/foundation.json"}, "valid");
}

TEST(RingNetworkSchemaTest, TakesTheNetworksOfTheExamples) {
  expect_all("protocols/token_bus/ring_network",
             {kSourceFolder / "examples/picnet.json", kSourceFolder / "examples/picnet_channels.json"},
             "valid");
}

TEST(BandwidthNetworkSchemaTest, TakesTheNetworkOfTheExamples) {
  expect_all("protocols/bandwidth/bandwidth_network", {kSourceFolder / "examples/bandwidth.json"}, "valid");
}

TEST(BurstProfileSchemaTest, TakesWhatTheReaderTakes) {
  expect_corpus(kBurstProfile, "good", "valid");
}

TEST(BurstProfileSchemaTest, RefusesWhatTheReaderRefuses) {
  expect_corpus(kBurstProfile, "bad", "invalid");
}

TEST(BurstProfileSchemaTest, CannotSayWhatNeedsTheBuiltInProfilesOrTwoParameters) {
  expect_corpus(kBurstProfile, "bad_semantic", "valid");
}

}  // namespace
}  // namespace fieldproof::cli

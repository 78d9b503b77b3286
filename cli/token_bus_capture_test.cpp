// Subject: the captures of runs of the token bus as tshark reads them, held against the recording in words.
// The dissector finds frames and computes frame checks by itself, so it and this program must agree on every
// transmission.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/probe/capture_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// The last frame of a transmission, in a word: its type, or what is wrong with it.
std::string token_bus_kind(const std::string& info) {
  const std::size_t last = info.rfind("; ");
  const std::string words = last == std::string::npos ? info : info.substr(last + 2);
  return words.substr(0, words.find(','));
}

// The same of what trace.txt has.
std::string token_bus_kind_in_words(const std::string& text) {
  const std::size_t last = text.rfind(" | ");
  std::string words = last == std::string::npos ? text : text.substr(last + 3);
  for (const std::string error : {"non-silence", "frame fragment", "FCS error", "E bit error",
                                  "frame too long", "no frame of this network"}) {
    if (words.starts_with(error)) return error;
  }
  return words.substr(0, words.find(','));
}

TEST_F(CaptureFixture, OfTheTokenBusSaysWhatTheRecordingSays) {
  call({"run", "token_bus/station/reception/**", "token_bus/station/failure/**",
        "token_bus/station/joining/**", "token_bus/station/initialisation/the_last*",
        "token_bus/station/passing/contention*", "--volume", "quick", "--record", "all", "--out", "run",
        "--quiet"});
  std::map<std::string, std::size_t> kinds;
  for (const auto& entry : fs::directory_iterator(folder_ / "run" / "cases")) {
    const fs::path capture = entry.path() / "trace.pcapng";
    if (!fs::exists(capture)) continue;
    const reports::Reading reading = reports::read_with_tshark(
        kSourceFolder, capture,
        "-T fields -e fieldproof.arrived -e _ws.col.Info -e _ws.malformed -e fieldproof.variant");
    if (!reading.is_available) GTEST_SKIP() << reading.output;
    std::vector<std::string> recorded;
    for (const TraceLine& line : lines_in(entry.path() / "trace.txt")) {
      if (line.is_transmission()) recorded.push_back(token_bus_kind_in_words(line.words()));
    }
    std::vector<std::string> driven;
    for (const auto& row : reports::table_of(reading.output)) {
      EXPECT_TRUE(row.at(2).empty()) << entry.path();
      EXPECT_EQ(row.at(3), "2");
      if (is_true(row.at(0))) continue;
      driven.push_back(token_bus_kind(row.at(1)));
      ++kinds[driven.back()];
    }
    std::ranges::sort(recorded);
    std::ranges::sort(driven);
    EXPECT_EQ(driven, recorded) << entry.path();
  }
  for (const char* kind : {"claim_token", "solicit_successor_1", "solicit_successor_2", "who_follows",
                           "resolve_contention", "token", "set_successor", "data", "non-silence", "FCS error",
                           "E bit error", "frame fragment", "frame too long", "no frame of this network"}) {
    EXPECT_GT(kinds[kind], 0U) << kind;
  }
}

}  // namespace
}  // namespace fieldproof::cli

// Subject: the captures of runs of the data link as tshark reads them, held against the recording in words.
// The dissector finds frames and DLPDUs and computes frame checks by itself, so it and this program must
// agree on every transmission.
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

constexpr const char* kLinkFields =
    "-T fields -e fieldproof.arrived -e frame.packet_flags_crc_error -e fieldbus_dll.type -e "
    "fieldbus_dll.frame.end -e fieldbus_dll.check.good -e _ws.malformed -e fieldproof.variant";

// What a transmission of one frame is in a word: its type, or what is wrong with it.
std::string kind_of(const std::vector<std::string>& row) {
  if (row.at(3).empty()) return "no frame";
  if (!row.at(2).empty()) return row.at(2);
  if (row.at(3) != "whole") return row.at(3);
  return is_true(row.at(4)) ? "no DLPDU" : "check wrong";
}

// The same of what trace.txt tells.
std::string kind_told(const std::string& words) {
  if (words == "no frame") return words;
  const std::size_t open = words.find('(');
  if (open == std::string::npos) return words.substr(0, words.find_first_of(" ,"));
  return words.substr(open + 1, words.find(')') - open - 1);
}

TEST_F(CaptureFixture, OfTheDataLinkSaysWhatTheRecordingSays) {
  call({"run", "fieldbus_dll/isa_dle/duration/**", "fieldbus_dll/isa_dle/rejection/broken*",
        "fieldbus_dll/isa_dle/rejection/other_*", "fieldbus_dll/isa_dle/data/**",
        "fieldbus_dll/isa_dle/compelling/**", "fieldbus_dll/isa_las/transfer/**",
        "fieldbus_dll/ff_device/publisher/**", "fieldbus_dll/ff_device/frame/unknown*",
        "fieldbus_dll/ff_las/live_list/**", "fieldbus_dll/ff_las/claim/**", "--volume", "quick", "--record",
        "all", "--out", "run", "--quiet"});
  std::map<std::string, std::size_t> kinds;
  std::map<std::string, std::size_t> variants;
  for (const auto& entry : fs::directory_iterator(folder_ / "run" / "cases")) {
    const fs::path capture = entry.path() / "trace.pcapng";
    if (!fs::exists(capture)) continue;
    const reports::Reading reading = reports::read_with_tshark(kSourceFolder, capture, kLinkFields);
    if (!reading.is_available) GTEST_SKIP() << reading.output;
    std::vector<std::string> told;
    for (const TraceLine& line : lines_in(entry.path() / "trace.txt")) {
      if (line.is_transmission()) told.push_back(kind_told(line.words()));
    }
    std::vector<std::string> driven;
    for (const auto& row : reports::table_of(reading.output)) {
      EXPECT_TRUE(row.at(5).empty()) << entry.path();
      ++variants[row.at(6)];
      if (is_true(row.at(0))) continue;
      driven.push_back(kind_of(row));
      EXPECT_EQ(is_true(row.at(1)), driven.back() == "check wrong") << entry.path();
      ++kinds[driven.back()];
    }
    std::ranges::sort(told);
    std::ranges::sort(driven);
    EXPECT_EQ(driven, told) << entry.path();
  }
  EXPECT_GT(variants["0"], 100U);
  EXPECT_GT(variants["1"], 100U);
  for (const char* kind : {"CD",
                           "DT",
                           "DU",
                           "ET",
                           "ES",
                           "EE",
                           "TL",
                           "PT",
                           "RT",
                           "PN",
                           "PR",
                           "CL",
                           "IDLE",
                           "TD",
                           "DT1",
                           "DT3",
                           "SR",
                           "code violation",
                           "part of an octet",
                           "signal lost",
                           "check wrong",
                           "no DLPDU"}) {
    EXPECT_GT(kinds[kind], 0U) << kind;
  }
}

// A reader with a window goes through a capture without showing it, and shows packets later.
TEST_F(CaptureFixture, OfTheDataLinkSaysTheSameInASecondPass) {
  const fs::path left = run("fieldbus_dll/ff_las/live_list/a_node_that_answers_is_activated", {});
  const reports::Reading first = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kLinkFields);
  if (!first.is_available) GTEST_SKIP() << first.output;
  const std::string twice = std::string("-2 ") + kLinkFields;
  EXPECT_EQ(reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", twice).output, first.output);
}

}  // namespace
}  // namespace fieldproof::cli

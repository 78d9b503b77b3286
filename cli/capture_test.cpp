// Subject: the captures of a run as programs of others read them, held against the recording in words. The
// dissector computes frame checks by itself, so it and this program must agree on every transmission.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/probe/capture_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChangedTelegram = "A fault changed this telegram on the way";
constexpr const char* kFields =
    "-T fields -e fieldproof.arrived -e fieldproof.changed -e frame.packet_flags_crc_error -e "
    "interbus.fcs.good -e interbus.fcs -e interbus.telegram.stop -e interbus.telegram.data -e "
    "_ws.expert.message -e _ws.malformed -e frame.comment";

// Flips one level of a telegram each, at two places of the ring.
constexpr const char* kPlan = R"({"rules": [
  {"when": {"receiver": "slave@1/in", "frame": "data_cycle", "frame_number": {"every": 5}, "unit": 3,
            "field": "data", "bit": 2}, "effect": {"flip": {}}},
  {"when": {"receiver": "master/in", "frame": "data_cycle", "frame_number": {"every": 7}, "unit": 1,
            "field": "data", "bit": 0}, "effect": {"flip": {}}},
  {"when": {"receiver": "master/in", "frame": "data_cycle", "frame_number": {"every": 14}, "unit": 2,
            "field": "data", "bit": 7}, "effect": {"flip": {}}}
]})";

struct Packet {
  bool has_arrived = false;
  bool is_changed = false;
  bool has_error_flag = false;
  std::size_t checks = 0;
  std::size_t wrong_checks = 0;
  std::size_t telegrams = 0;
  std::size_t data_telegrams = 0;
  std::size_t changed_telegrams = 0;
  std::string notes;
  bool is_malformed = false;
  std::string comment;
};

Packet packet_of(const std::vector<std::string>& row) {
  Packet packet;
  packet.has_arrived = is_true(row.at(0));
  packet.is_changed = is_true(row.at(1));
  packet.has_error_flag = is_true(row.at(2));
  packet.checks = entries_of(row.at(4));
  packet.wrong_checks = false_entries_of(row.at(3));
  packet.telegrams = entries_of(row.at(5));
  packet.data_telegrams = entries_of(row.at(6));
  packet.changed_telegrams = count_of(row.at(7), kChangedTelegram);
  packet.notes = row.at(7);
  packet.is_malformed = !row.at(8).empty();
  packet.comment = row.at(9);
  return packet;
}

// What trace.txt says: transmissions, their telegrams, faults.
struct Decoded {
  std::size_t transmissions = 0;
  std::size_t telegrams = 0;
  std::size_t data_telegrams = 0;
  std::size_t faults = 0;
};

// "data A55A 1234 | check 29CC 0000 | 37 status"
void add_telegrams(const std::string& text, Decoded& told) {
  std::istringstream words(text);
  std::string before;
  for (std::string word; words >> word; before = word) {
    if (word == "status") {
      told.telegrams += std::stoul(before);
    } else if (word.size() == 4 && word.find_first_not_of("0123456789ABCDEF") == std::string::npos) {
      told.data_telegrams += 2;
      told.telegrams += 2;
    }
  }
}

Decoded told_in(const std::vector<TraceLine>& lines) {
  Decoded told;
  for (const TraceLine& line : lines) {
    if (line.is_fault()) {
      ++told.faults;
    } else if (line.is_transmission()) {
      ++told.transmissions;
      add_telegrams(line.words(), told);
    }
  }
  return told;
}

using Capture = CaptureFixture;

std::vector<Packet> packets_in(const std::string& output) {
  std::vector<Packet> packets;
  for (const auto& row : reports::table_of(output)) packets.push_back(packet_of(row));
  return packets;
}

constexpr const char* kNetworkCase = "interbus/network/exchange/nothing_is_rejected_without_faults";

TEST_F(Capture, OfACleanRunShowsEveryTelegramAndNothingIsWrong) {
  const fs::path left = run(kNetworkCase, {});
  const reports::Reading reading = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kFields);
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  const Decoded told = told_in(lines_in(left / "trace.txt"));
  const std::vector<Packet> packets = packets_in(reading.output);
  EXPECT_EQ(packets.size(), told.transmissions);
  ASSERT_GT(told.transmissions, 100U);
  std::size_t telegrams = 0;
  std::size_t data_telegrams = 0;
  std::size_t checks = 0;
  for (const Packet& packet : packets) {
    EXPECT_FALSE(packet.is_malformed);
    EXPECT_EQ(packet.notes, "");
    EXPECT_FALSE(packet.has_error_flag || packet.has_arrived || packet.is_changed);
    EXPECT_EQ(packet.wrong_checks, 0U);
    telegrams += packet.telegrams;
    data_telegrams += packet.data_telegrams;
    checks += packet.checks;
  }
  EXPECT_EQ(telegrams, told.telegrams);
  EXPECT_EQ(data_telegrams, told.data_telegrams);
  EXPECT_EQ(checks, count_of(read(left / "trace.txt"), "check "));
}

TEST_F(Capture, OfAFaultedRunFlagsExactlyWhatWasCorrupted) {
  std::ofstream(folder_ / "plan.json") << kPlan;
  const fs::path left = run(kNetworkCase, {"--faults", "plan.json"});
  const reports::Reading reading = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kFields);
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  const Decoded told = told_in(lines_in(left / "trace.txt"));
  const auto timeline = nlohmann::json::parse(read(left / "timeline.json"));
  ASSERT_FALSE(timeline["is_cut"].get<bool>());
  EXPECT_EQ(timeline["transmissions"].size(), told.transmissions);
  EXPECT_EQ(timeline["faults"].size(), told.faults);
  const auto changed = static_cast<std::size_t>(
      std::ranges::count_if(timeline["transmissions"], [](const auto& one) { return one["is_changed"]; }));
  ASSERT_GE(changed, 5U);
  ASSERT_GT(told.faults, changed) << "some transmission must have two corrupted telegrams";
  const std::vector<Packet> packets = packets_in(reading.output);
  EXPECT_EQ(packets.size(), told.transmissions + changed);
  std::size_t corrupted_telegrams = 0;
  std::size_t arrived = 0;
  std::size_t replaced = 0;
  for (const Packet& packet : packets) {
    EXPECT_FALSE(packet.is_malformed);
    EXPECT_EQ(packet.has_error_flag, packet.wrong_checks > 0) << "the two computations of the check agree";
    EXPECT_EQ(packet.has_arrived, packet.wrong_checks > 0) << "only what arrived changed is wrong";
    EXPECT_EQ(packet.has_arrived, packet.changed_telegrams > 0);
    EXPECT_EQ(packet.is_changed, packet.comment.find("flip level") != std::string::npos) << packet.comment;
    corrupted_telegrams += packet.changed_telegrams;
    if (packet.is_changed) ++(packet.has_arrived ? arrived : replaced);
  }
  EXPECT_EQ(corrupted_telegrams, told.faults);
  EXPECT_EQ(arrived, changed);
  EXPECT_EQ(replaced, changed);
}

// Lines that carry single telegrams, glitches, cut telegrams and other rates than the bits'.
TEST_F(Capture, OfDisturbedLinesIsTakenApartWithoutAMalformedPacket) {
  call({"run", "interbus/slave/telegram/**", "interbus/slave/immunity/**", "interbus/slave/timing/**",
        "interbus/master/rejection/**", "--volume", "quick", "--record", "all", "--out", "run", "--quiet"});
  std::size_t captures = 0;
  kernel::FewerIfSanitized few(4);
  for (const auto& entry : fs::directory_iterator(folder_ / "run" / "cases")) {
    if (!fs::exists(entry.path() / "trace.pcapng")) continue;
    ++captures;
    if (few.leaves_out()) continue;
    const reports::Reading reading =
        reports::read_with_tshark(kSourceFolder, entry.path() / "trace.pcapng", kFields);
    if (!reading.is_available) GTEST_SKIP() << reading.output;
    for (const Packet& packet : packets_in(reading.output)) {
      EXPECT_FALSE(packet.is_malformed) << entry.path();
      EXPECT_EQ(packet.has_error_flag, packet.wrong_checks > 0) << entry.path();
    }
  }
  EXPECT_GE(captures, 20U);
}

TEST_F(Capture, IsWrittenOnDemandByReplay) {
  const fs::path left = run(kNetworkCase, {});
  const std::string file = (left / "case.json").string();
  const Called called = call({"replay", file, "--pcapng", "a/b.pcapng", "--vcd", "c.vcd"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(read(folder_ / "a/b.pcapng"), read(left / "trace.pcapng"));
  const std::string dump = read(folder_ / "c.vcd");
  EXPECT_TRUE(dump.starts_with("$version fieldproof ")) << dump.substr(0, 80);
  EXPECT_NE(dump.find(" master/in $end"), std::string::npos);
  EXPECT_EQ(call({"replay", file, "--vcd", "."}).exit_code, 74) << "a folder";
}

TEST_F(Capture, OfWavesIsReadByAnotherProgram) {
  std::ofstream(folder_ / "plan.json") << kPlan;
  const fs::path left = run(kNetworkCase, {"--faults", "plan.json"});
  call({"replay", (left / "case.json").string(), "--vcd", "c.vcd"});
  const std::string files = reports::shell_word((folder_ / "c.vcd").string()) + " " +
                            reports::shell_word((folder_ / "c.fst").string());
  const reports::Reading there = reports::read_with("vcd2fst", files);
  if (!there.is_available) GTEST_SKIP() << there.output;
  ASSERT_EQ(there.exit_code, 0) << there.output;
  const reports::Reading back =
      reports::read_with("fst2vcd", reports::shell_word((folder_ / "c.fst").string()));
  for (const char* name : {" slave@1/in ", " slave@1/in/received ", " slave@1/in/faults ", " master/in "}) {
    EXPECT_NE(back.output.find(name), std::string::npos) << name;
  }
  const auto instants = [](const std::string& dump) { return count_of(dump, "\n#"); };
  EXPECT_EQ(instants(back.output), instants(read(folder_ / "c.vcd")));
}

}  // namespace
}  // namespace fieldproof::cli

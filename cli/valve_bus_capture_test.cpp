// Subject: the captures of valve bus runs as tshark reads them, held against the recording in words. The
// dissector finds characters and frames and computes block checks by itself, so it and this program must
// agree on every transmission.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/probe/capture_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChangedCharacter = "A fault changed this character on the way";
constexpr const char* kFields =
    "-T fields -e fieldproof.arrived -e frame.packet_flags_crc_error -e valve_bus.character -e "
    "valve_bus.check.good -e valve_bus.response.check.good -e _ws.expert.message -e _ws.malformed -e "
    "fieldproof.variant";

struct Packet {
  bool has_arrived = false;
  bool has_error_flag = false;
  std::string characters;  // "05 9C!"
  std::size_t commands = 0;
  std::size_t wrong_commands = 0;
  std::size_t responses = 0;
  std::size_t wrong_responses = 0;
  std::string notes;
  bool is_malformed = false;
  std::string variant;
};

std::vector<Packet> packets_in(const std::string& output) {
  std::vector<Packet> packets;
  for (const auto& row : reports::table_of(output)) {
    Packet packet;
    packet.has_arrived = is_true(row.at(0));
    packet.has_error_flag = is_true(row.at(1));
    packet.characters = row.at(2);
    std::ranges::replace(packet.characters, ',', ' ');
    packet.commands = entries_of(row.at(3));
    packet.wrong_commands = false_entries_of(row.at(3));
    packet.responses = entries_of(row.at(4));
    packet.wrong_responses = false_entries_of(row.at(4));
    packet.notes = row.at(5);
    packet.is_malformed = !row.at(6).empty();
    packet.variant = row.at(7);
    packets.push_back(packet);
  }
  return packets;
}

// What is in a capture in all.
struct Sum {
  std::size_t driven = 0;
  std::size_t arrived = 0;
  std::size_t commands = 0;
  std::size_t wrong_commands = 0;
  std::size_t responses = 0;
  std::size_t wrong_responses = 0;
  std::size_t changed_characters = 0;
  std::map<std::string, std::size_t> notes{};
};

class ValveBusCapture : public CaptureFixture {
 protected:
  // Holds the capture of a case against its trace.txt, packet by packet.
  static void hold(const fs::path& left, const std::vector<Packet>& packets, Sum& sum) {
    std::vector<std::string> told;
    for (const TraceLine& line : lines_in(left / "trace.txt")) {
      if (line.is_transmission()) told.push_back(line.words());
    }
    std::vector<std::string> driven;
    for (const Packet& packet : packets) {
      EXPECT_FALSE(packet.is_malformed) << left;
      EXPECT_EQ(packet.has_error_flag, packet.wrong_commands > 0) << left << ", the two computations agree";
      if (packet.has_arrived) {
        ++sum.arrived;
      } else {
        driven.push_back(packet.characters.empty() ? "no character" : packet.characters);
      }
      sum.commands += packet.commands;
      sum.wrong_commands += packet.wrong_commands;
      sum.responses += packet.responses;
      sum.wrong_responses += packet.wrong_responses;
      sum.changed_characters += count_of(packet.notes, kChangedCharacter);
      std::istringstream notes(packet.notes);
      for (std::string note; std::getline(notes, note, ',');) ++sum.notes[note];
    }
    sum.driven += driven.size();
    // Packets stand in order of their start, records in the order in which they were told.
    std::ranges::sort(told);
    std::ranges::sort(driven);
    EXPECT_EQ(driven, told) << left;
  }
};

TEST_F(ValveBusCapture, OfACleanRunShowsEveryFrameAndNothingIsWrong) {
  const fs::path left = run("valve_bus/node/read/switches_are_told_exactly", {});
  const reports::Reading reading = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kFields);
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  Sum sum;
  hold(left, packets_in(reading.output), sum);
  EXPECT_EQ(sum.driven, 256U);
  EXPECT_EQ(sum.commands, 32U);
  EXPECT_EQ(sum.responses, 32U);
  EXPECT_EQ(sum.arrived + sum.wrong_commands + sum.wrong_responses, 0U);
  EXPECT_TRUE(sum.notes.empty()) << sum.notes.begin()->first;
}

// The tester drives frames of five characters alone; each has one wrong bit or none.
TEST_F(ValveBusCapture, OfWrongFramesFindsEachCheckThatIsWrong) {
  const fs::path left = run("valve_bus/node/check/single_bit_errors_are_refused", {});
  const reports::Reading reading = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kFields);
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  Sum sum;
  hold(left, packets_in(reading.output), sum);
  std::size_t frames = 0;
  std::size_t wrong = 0;
  unsigned check = 0;
  std::size_t characters = 0;
  for (const TraceLine& line : lines_in(left / "trace.txt")) {
    if (!line.is_transmission() || line.channel != "tester/in") continue;
    check ^= static_cast<unsigned>(std::stoul(line.words(), nullptr, 16));
    if (++characters % 5 != 0) continue;
    ++frames;
    if (std::exchange(check, 0) != 0) ++wrong;
  }
  ASSERT_GE(wrong, 40U);
  EXPECT_EQ(sum.commands, frames);
  EXPECT_EQ(sum.wrong_commands, wrong);
}

TEST_F(ValveBusCapture, OfAFaultedRunShowsEachCharacterThatArrivedOtherwise) {
  write("plan.json", R"({"rules": [{"when": {"receiver": "node/in", "frame_number": {"from": 3, "every": 7},
                                             "bit": 3}, "effect": {"flip": {}}}]})");
  call({"run", "valve_bus/node/read/**", "valve_bus/node/write/**", "--volume", "quick", "--record", "all",
        "--out", "run", "--quiet", "--faults", "plan.json"});
  Sum sum;
  std::size_t faults = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "run" / "cases")) {
    const reports::Reading reading =
        reports::read_with_tshark(kSourceFolder, entry.path() / "trace.pcapng", kFields);
    if (!reading.is_available) GTEST_SKIP() << reading.output;
    hold(entry.path(), packets_in(reading.output), sum);
    for (const TraceLine& line : lines_in(entry.path() / "trace.txt")) faults += line.is_fault() ? 1U : 0U;
  }
  ASSERT_GE(faults, 5U);
  EXPECT_EQ(sum.arrived, faults);
  EXPECT_EQ(sum.changed_characters, faults);
}

// A reader with a window goes through a capture without showing it, and shows packets later.
TEST_F(ValveBusCapture, SaysTheSameInASecondPass) {
  const fs::path left = run("valve_bus/host/response/other_lengths_are_refused", {});
  const reports::Reading first = reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", kFields);
  if (!first.is_available) GTEST_SKIP() << first.output;
  const std::string twice = std::string("-2 ") + kFields;
  EXPECT_EQ(reports::read_with_tshark(kSourceFolder, left / "trace.pcapng", twice).output, first.output);
  EXPECT_HOLDS(first.output, "The frame before has 4 characters");
}

// Lines that carry glitches, wrong characters, frames of all lengths, collisions and other rates.
TEST_F(ValveBusCapture, OfDisturbedLinesIsTakenApartWithoutAMalformedPacket) {
  call({"run", "valve_bus/node/line/**", "valve_bus/node/framing/**", "valve_bus/node/timing/other*",
        "valve_bus/node/timing/wrong*", "valve_bus/host/response/**", "valve_bus/host/line/**",
        "valve_bus/host/dip/**", "--volume", "quick", "--record", "all", "--out", "run", "--quiet"});
  Sum sum;
  std::map<std::string, std::size_t> variants;
  for (const auto& entry : fs::directory_iterator(folder_ / "run" / "cases")) {
    if (!fs::exists(entry.path() / "trace.pcapng")) continue;
    const reports::Reading reading =
        reports::read_with_tshark(kSourceFolder, entry.path() / "trace.pcapng", kFields);
    if (!reading.is_available) GTEST_SKIP() << reading.output;
    const std::vector<Packet> packets = packets_in(reading.output);
    hold(entry.path(), packets, sum);
    if (!packets.empty()) ++variants[packets.front().variant];
  }
  EXPECT_GT(variants["0"], 10U);
  EXPECT_GT(variants["1"], 0U) << "a case with parity";
  EXPECT_GT(sum.wrong_responses, 10U);
  for (const char* note : {"The parity is wrong", "The stop bit is missing",
                           "The gap in front of this character spoils its frame",
                           "The block check does not fit the octets that it covers",
                           "The frame before has 4 characters", "The frame before has 6 characters"}) {
    EXPECT_GT(sum.notes[note], 0U) << note;
  }
}

}  // namespace
}  // namespace fieldproof::cli

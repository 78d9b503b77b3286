#include "protocols/interbus/network.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "harness/kernel/error.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = FIELDPROOF_SOURCE_DIR;
const fs::path kCorpus = kRoot / "protocols/interbus/network_corpus";

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

NetworkDescription read_text(const std::string& text) {
  const config::Document document = config::Document::parse(text, "net.json");
  return NetworkDescription::read(document.root());
}

std::string refusal_of(const std::string& text) {
  try {
    (void)read_text(text);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "";
}

std::string with_stations(const std::string& stations, const std::string& more = "") {
  return R"({"name": "x", "bit_rate": "500 kbit/s", "stations": [)" + stations + "]" + more + "}";
}

NetworkDescription stations_in_line(unsigned stations, std::uint16_t id_code) {
  NetworkDescription network;
  for (unsigned n = 0; n < stations; ++n) {
    network.stations.push_back({"s" + std::to_string(n), id_code, 0, false, {}});
  }
  return network;
}

TEST(NetworkCorpusTest, GoodFilesAreRead) {
  const auto files = files_in(kCorpus / "good");
  ASSERT_GE(files.size(), 10U);
  for (const fs::path& file : files) EXPECT_NO_THROW((void)NetworkDescription::load(file)) << file;
}

TEST(NetworkCorpusTest, BadFilesAreRefusedWithTheirPlace) {
  for (const char* folder : {"bad", "bad_semantic"}) {
    const auto files = files_in(kCorpus / folder);
    ASSERT_GE(files.size(), 20U);
    for (const fs::path& file : files) {
      try {
        (void)NetworkDescription::load(file);
        ADD_FAILURE() << file << " was read";
      } catch (const kernel::Error& error) {
        EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration) << file;
        EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ":")) << error.what();
      }
    }
  }
}

TEST(NetworkExamplesTest, PaperIs755Microseconds) {
  const auto network = NetworkDescription::load(kRoot / "examples/paper.json");
  EXPECT_EQ(network.formula, Formula::f4);
  EXPECT_EQ(cycle_time(network.formula, timing_input(network)), 755 * kernel::kMicrosecond);
  EXPECT_EQ(structural_cycle_time(network), 755 * kernel::kMicrosecond);
  ASSERT_EQ(network.copy.size(), 1U);
  EXPECT_EQ(network.copy[0].from, "di16");
  EXPECT_EQ(network.copy[0].to, "do16");
}

TEST(NetworkExamplesTest, PrintedReadingIs814Point8Microseconds) {
  const auto network = NetworkDescription::load(kRoot / "examples/paper_printed_reading.json");
  EXPECT_EQ(network.formula, Formula::f1);
  EXPECT_EQ(cycle_time(network.formula, timing_input(network)), 814'800 * kernel::kNanosecond);
  EXPECT_EQ(structural_cycle_time(network), 814'800 * kernel::kNanosecond);
}

TEST(NetworkExamplesTest, MixedLineHasItsStationsInRingOrder) {
  const auto network = NetworkDescription::load(kRoot / "examples/mixed_line.json");
  const auto ring = ring_order(network);
  std::vector<std::string> names;
  for (const RingPlace& place : ring) names.push_back(place.station->name);
  EXPECT_EQ(names, (std::vector<std::string>{"gate", "press_coupler", "press_di", "press_do", "press_aio",
                                             "drive_1", "drive_2", "branch_coupler", "valves", "oven_coupler",
                                             "oven_ai", "oven_do", "scale", "robot", "lamp"}));
  EXPECT_EQ(ring[11].level, 2U);
  const TimingInput input = timing_input(network);
  EXPECT_EQ(input.user_octets, 2U * (1 + 1 + 1 + 2 + 3 + 6 + 2 + 8 + 1 + 2 + 16 + 1));
  EXPECT_EQ(input.remote_stations, 10U);
  EXPECT_DOUBLE_EQ(input.cable_m, 867.5);
}

TEST(RingOrderTest, EachStationHangsOnTheInterfaceThatTheFileSays) {
  const auto network =
      read_text(with_stations(R"({"name": "a", "id_code": 8, "branch": [)"
                              R"({"name": "b", "id_code": "0x0103"}, {"name": "c", "id_code": 8}]},
         {"name": "d", "id_code": "0x0603"})"));
  const auto ring = ring_order(network);
  ASSERT_EQ(ring.size(), 4U);
  const auto expect = [&](std::size_t n, const char* name, int before, bool on_branch, unsigned level,
                          unsigned words) {
    EXPECT_EQ(ring[n].station->name, name);
    EXPECT_EQ(ring[n].before, before) << name;
    EXPECT_EQ(ring[n].on_branch, on_branch) << name;
    EXPECT_EQ(ring[n].level, level) << name;
    EXPECT_EQ(ring[n].words, words) << name;
  };
  expect(0, "a", -1, false, 0, 0);
  expect(1, "b", 0, true, 1, 1);
  expect(2, "c", 1, false, 1, 0);
  expect(3, "d", 0, false, 0, 8);
}

TEST(RingOrderTest, NothingOnTheLineIsAnEmptyRing) {
  EXPECT_TRUE(ring_order(NetworkDescription{}).empty());
}

TEST(IdCodeTest, LengthCodeIsNoNumberOfWords) {
  const Rules rules;
  EXPECT_EQ(words_of_id_code(0x0000, rules), 0U);
  EXPECT_EQ(words_of_id_code(0x0533, rules), 5U);
  EXPECT_EQ(words_of_id_code(0x0633, rules), 8U);
  EXPECT_EQ(words_of_id_code(0x1233, rules), 16U);
  EXPECT_EQ(words_of_id_code(0x1633, rules), 12U);
  EXPECT_EQ(words_of_id_code(0x0833, rules), std::nullopt);
  EXPECT_EQ(words_of_id_code(0xE533, rules), 5U);  // message bits do not count
  EXPECT_EQ(length_code_of(6, rules), 0x0E);
  EXPECT_EQ(length_code_of(11, rules), std::nullopt);
}

TEST(IdCodeTest, RulesMayReplaceTheTable) {
  Rules rules;
  rules.length_codes = {{0x06, 6}};
  EXPECT_EQ(words_of_id_code(0x0633, rules), 6U);
  EXPECT_EQ(words_of_id_code(0x0133, rules), std::nullopt);
  EXPECT_EQ(length_code_of(6, rules), 0x06);
}

RC_GTEST_PROP(IdCodeTest, CodeAndLengthAreInverse, ()) {
  const auto id_code = *rc::gen::arbitrary<std::uint16_t>();
  const auto words = words_of_id_code(id_code, Rules{});
  if (words) RC_ASSERT(length_code_of(*words, Rules{}) == ((id_code >> 8) & 0x1F));
}

TEST(IdCodeTest, DirectionBits) {
  EXPECT_TRUE(has_outputs(0x01BD) && !has_inputs(0x01BD));
  EXPECT_TRUE(!has_outputs(0x01BE) && has_inputs(0x01BE));
  EXPECT_TRUE(has_outputs(0x027F) && has_inputs(0x027F));
  EXPECT_TRUE(!has_outputs(0x0008) && !has_inputs(0x0008));
}

TEST(NetworkLimitsTest, ProgramsMayBuildWhatAFileMayNot) {
  EXPECT_EQ(check(stations_in_line(512, 0x0008)), std::nullopt);
  const NetworkDescription too_long = stations_in_line(513, 0x0008);
  EXPECT_EQ(ring_order(too_long).size(), 513U);
  const auto violation = check(too_long);
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->pointer, "/stations/512");
  EXPECT_NE(violation->sentence.find("at most 512"), std::string::npos) << violation->sentence;
}

TEST(NetworkLimitsTest, PointsEndAt4096) {
  EXPECT_EQ(check(stations_in_line(256, 0x0103)), std::nullopt);
  const auto violation = check(stations_in_line(257, 0x0103));
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->pointer, "/stations/256");
}

TEST(NetworkLimitsTest, NamelessAndBrokenStationsAreFound) {
  NetworkDescription network = stations_in_line(1, 0x0103);
  network.stations[0].name.clear();
  EXPECT_EQ(check(network)->pointer, "/stations/0/name");
  network = stations_in_line(1, 0x2103);
  EXPECT_EQ(check(network)->pointer, "/stations/0/id_code");
  network = stations_in_line(1, 0x0103);
  network.stations[0].cable_m = -1;
  EXPECT_EQ(check(network)->pointer, "/stations/0/cable");
}

TEST(NetworkErrorTest, NamesLinePointerAndRemedy) {
  EXPECT_EQ(refusal_of("{\"name\": \"x\",\n\"bit_rate\": \"500 kbit/s\",\n\"stations\": [\n"
                       "{\"name\": \"a\", \"id_code\": 8},\n{\"name\": \"b\", \"id_code\": \"0x0803\"}]}"),
            "net.json:5: /stations/1/id_code: 0803h has the undefined length code 08h in bits 8..12; write a "
            "code of "
            "the length table, for example 01h for one word");
}

TEST(NetworkErrorTest, PointsIntoBranchesAndCopies) {
  const std::string branch =
      R"({"name": "a", "id_code": 8, "branch": [{"name": "a", "id_code": "0x01BE", "bus": "local"}]})";
  EXPECT_NE(refusal_of(with_stations(branch)).find("/stations/0/branch/0/name: \"a\" is the name of another"),
            std::string::npos);
  const std::string copy = R"(, "copy": [{"from": "a", "to": "b"}])";
  EXPECT_NE(
      refusal_of(with_stations(R"({"name": "a", "id_code": "0x0103"})", copy)).find("/copy/0/to: no station"),
      std::string::npos);
}

TEST(NetworkErrorTest, DefaultIsBlamedOnItsObject) {
  const std::string copy = R"(, "copy": [{"from": "a", "to": "a"}])";
  const std::string refusal = refusal_of(with_stations(R"({"name": "a", "id_code": 3})", copy));
  EXPECT_NE(refusal.find("/copy/0: station \"a\" has no word 0"), std::string::npos) << refusal;
}

TEST(NetworkErrorTest, MisspelledKeysAndChecksNameTheirNeighbours) {
  EXPECT_NE(refusal_of(with_stations(R"({"name": "a", "id_code": "0x0203"})", R"(, "formla": "f1")"))
                .find("did you mean \"formula\""),
            std::string::npos);
  EXPECT_NE(refusal_of(with_stations(R"({"name": "a", "id_code": "0x0203"})",
                                     R"(, "rules": {"frame_check": "CRC-16/IBM-3470"})"))
                .find("CRC-16/IBM-3740"),
            std::string::npos);
}

TEST(NetworkReadingTest, RulesAreTakenAndTheOthersKept) {
  const auto network = read_text(with_stations(
      R"({"name": "a", "id_code": "0x0203"})",
      R"(, "cycle_time": "860 us", "rules": {"telegram": {"header": ["flag", "select", "control"],
      "data_flag_level": false}, "silence_limit": "30 ms", "loopback_word": "0x1234"})"));
  EXPECT_EQ(network.cycle_time, 860 * kernel::kMicrosecond);
  EXPECT_EQ(network.rules.telegram.header[0], line::HeaderLevel::flag);
  EXPECT_FALSE(network.rules.telegram.data_flag_level);
  EXPECT_TRUE(network.rules.telegram.select_level);
  EXPECT_EQ(network.rules.silence_limit, 30 * kernel::kMillisecond);
  EXPECT_EQ(network.rules.loopback_word, 0x1234);
  EXPECT_EQ(network.rules.frame_check, Rules{}.frame_check);
  EXPECT_EQ(network.rules.software_time, Rules{}.software_time);
}

TEST(NetworkReadingTest, FastRateShortensTheDistance) {
  const auto network = read_text(
      R"({"name": "x", "bit_rate": "2 Mbit/s", "stations": [{ "name": "a", "id_code": "0x0203" }]})");
  EXPECT_EQ(network.rules.bit_rate, 2'000'000);
  EXPECT_EQ(network.rules.max_distance_m, 150U);
}

}  // namespace
}  // namespace fieldproof::interbus

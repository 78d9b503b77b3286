// Subject: the verbs `measure` and `paper` as their user meets them, on the program itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using MeasureVerb = ProgramFixture;

TEST_F(MeasureVerb, PrintsTheoryBesideMeasurement) {
  const Called called =
      call({"measure", "interbus", "--signal", "50Hz,700Hz", "--duration", "10s", "--json", "m.json"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_EQ(called.out.rfind("fieldproof ", 0), 0U);
  for (const char* part : {"seed 1,", "latch model", "M2: inputs at the start", "cycle time",
                           "50 Hz from di16 word 0 to do16 word 0", "700 Hz from", "p99.99",
                           "share of lost pulses", "theory and measurement: holds"}) {
    EXPECT_HOLDS(called.out, part);
  }
  const Json measured = json("m.json");
  EXPECT_EQ(measured["schema"], "fieldproof/measurement/1");
  EXPECT_EQ(measured["agreement"], "holds");
  EXPECT_EQ(measured["series"].size(), 3U);
  EXPECT_EQ(measured["series"][0]["comparisons"][0]["measured"], 814.0);
}

TEST_F(MeasureVerb, EqualCallsGiveEqualOctetsAndOtherSeedsOthers) {
  const std::vector<std::string> arguments = {"measure",  "interbus", "--duration", "2s",
                                              "--signal", "150Hz",    "--seed"};
  const auto with_seed = [&](const char* seed) {
    std::vector<std::string> all = arguments;
    all.emplace_back(seed);
    return call(all).out;
  };
  EXPECT_EQ(with_seed("5"), with_seed("5"));
  EXPECT_NE(with_seed("5"), with_seed("6"));
}

TEST_F(MeasureVerb, TakesANetworkAndALatchModel) {
  const Called called =
      call({"measure", "interbus", "--network", (kSourceFolder / "examples/mixed_line.json").string(),
            "--signal", "50Hz", "--latch", "M3", "--duration", "10s"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  for (const char* part :
       {"M3: inputs at the end of the frame before", "from robot word 15 to oven_do word 0"}) {
    EXPECT_HOLDS(called.out, part);
  }
}

TEST_F(MeasureVerb, TooFewSamplesAreInconclusiveAndReproducible) {
  const Called called =
      call({"measure", "interbus", "--signal", "200Hz", "--duration", "1ms", "--seed", "3"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "theory and measurement: open");
  EXPECT_HOLDS(called.out, "reproduce: fieldproof measure interbus --seed 3 --signal 200Hz --duration 1ms");
}

TEST_F(MeasureVerb, RefusesWhatItCannotMeasure) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"measure"},
                                             {"measure", "interbux"},
                                             {"measure", "interbus", "--signal", "fast"},
                                             {"measure", "interbus", "--signal", "50Hz,"},
                                             {"measure", "interbus", "--signal", "2000kHz"},
                                             {"measure", "interbus", "--latch", "M4"},
                                             {"measure", "interbus", "--duration", "0s"},
                                             {"measure", "interbus", "--duration", "2h"},
                                             {"paper", "interbux"},
                                             {"paper", "--signal", "50Hz"}}) {
    const Called called = call(arguments);
    EXPECT_EQ(called.exit_code, 64) << testing::PrintToString(arguments) << called.err;
    EXPECT_EQ(called.err.rfind("fieldproof: ", 0), 0U) << called.err;
  }
}

// The theory holds between bursts, and edges during a burst are later.
TEST_F(MeasureVerb, EndsWithTheSignalsThatAreThrough) {
  const Called called =
      call({"measure", "interbus", "--duration", "1h", "--max-time", "300ms", "--json", "short.json"});
  EXPECT_EQ(called.exit_code, 4) << called.out << called.err;
  EXPECT_HOLDS(called.out, "the measurement was ended before");
  EXPECT_HOLDS(called.err, "--max-time");
}

// The longest cycle of the course is that of the distribution, in every protocol, and the points are bounded.
TEST_F(MeasureVerb, EachProtocolSaysWhenItsCyclesWereLong) {
  for (const std::string protocol : {"interbus", "valve_bus", "fieldbus_dll", "token_bus"}) {
    call({"measure", protocol, "--signal", "5Hz,7Hz", "--bursts", "4", "--duration", "3s", "--json",
          "m.json"});
    const Json document = json("m.json");
    std::size_t courses = 0;
    for (const Json& series : document.at("series")) {
      if (!series.contains("course")) continue;
      ++courses;
      const Json& course = series.at("course");
      ASSERT_EQ(course.at("runs").size(), 2U) << protocol;
      double longest = 0;
      std::uint64_t count = 0;
      for (const Json& run : course.at("runs")) {
        EXPECT_LE(run.at("points").size(), 3 * 200U);
        EXPECT_FALSE(run.at("bursts").empty()) << protocol;
        if (!run.at("longest").empty())
          longest = std::max(longest, run.at("longest")[0].at("value").get<double>());
        for (const Json& point : run.at("points")) count += point.at("count").get<std::uint64_t>();
      }
      double greatest = 0;
      std::uint64_t values = 0;
      for (const Json& phase : series.at("distributions").at(0).at("phases")) {
        greatest = std::max(greatest, phase.at("max").get<double>());
        values += phase.at("count").get<std::uint64_t>();
      }
      EXPECT_EQ(longest, greatest) << protocol;
      EXPECT_EQ(count, values) << protocol;
    }
    EXPECT_GE(courses, 1U) << protocol;
    expect_valid({"m.json"}, "measurement");
  }
}

TEST_F(MeasureVerb, TellsQuietBurstAndRecoveryApart) {
  const Called called = call({"measure", "interbus", "--signal", "50Hz", "--bursts", "2", "--duration", "30s",
                              "--json", "bursts.json"});
  EXPECT_EQ(called.exit_code, 0) << called.out;
  EXPECT_HOLDS(called.out, "5 kHz, +, level 2 (500 V), profile A");
  EXPECT_HOLDS(called.out, "not calibrated");
  const nlohmann::json document = json("bursts.json");
  for (const auto& distribution : document.at("series").at(1).at("distributions")) {
    EXPECT_EQ(distribution.at("phases").size(), 3U) << distribution.at("quantity");
  }
  const auto& delays = document.at("series").at(1).at("distributions").at(0).at("phases");
  EXPECT_GT(delays.at("burst").at("max").get<double>(), delays.at("quiet").at("max").get<double>());
  EXPECT_GT(delays.at("quiet").at("count").get<int>(), delays.at("burst").at("count").get<int>());
  const auto& run = document.at("series").at(0).at("course").at("runs").at(0);
  // One every 300 ms, give or take a fifth; none are so near to each other that they are joined.
  EXPECT_GE(run.at("bursts").size(), 80U);
  for (const auto& band : run.at("bursts")) EXPECT_EQ(band.at("count"), 1);
  EXPECT_EQ(run.at("longest").at(0).at("phase"), "burst");
  expect_valid({"bursts.json"}, "measurement");
}

// Pulses that a burst takes are no loss of the quiet phase.
TEST_F(MeasureVerb, LostPulsesOfBurstsRefuteNoTheory) {
  const Called called =
      call({"measure", "interbus", "--signal", "150Hz,400Hz", "--bursts", "4", "--duration", "20s"});
  EXPECT_EQ(called.exit_code, 0) << called.out;
}

TEST_F(MeasureVerb, ABusThatStopsIsAFailureWithItsReason) {
  write("impatient.json", R"({
    "name": "impatient", "bit_rate": "500 kbit/s", "formula": "f4",
    "rules": {"software_time": "450 us", "stop_after_bad_cycles": 3},
    "stations": [{"name": "a", "id_code": "0x0103", "cable": "5 m"}],
    "copy": [{"from": "a", "input_word": 0, "to": "a", "output_word": 0}]})");
  const Called called = call({"measure", "interbus", "--network", "impatient.json", "--signal", "50Hz",
                              "--bursts", "4", "--duration", "20s", "--json", "stopped.json"});
  EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
  EXPECT_HOLDS(called.out, "fail: 50 Hz: the bus stopped for good meanwhile, its last data ");
  EXPECT_EQ(json("stopped.json")["failures"].size(), 1U);
  expect_valid({"stopped.json"}, "measurement");
}

TEST_F(MeasureVerb, QuietBurstAndRecoveryAreComparedApart) {
  const Called called =
      call({"measure", "interbus", "--signal", "50Hz", "--bursts", "4", "--duration", "20s"});
  EXPECT_EQ(called.exit_code, 0) << called.out;
  EXPECT_HOLDS(called.out, "theory and measurement while quiet: holds");
  EXPECT_HOLDS(called.out, "the same, burst: differs");
  EXPECT_HOLDS(called.out, "jitter of the cycle, peak to peak, burst");
}

// Where a pulse is as often one cycle longer as not, few samples leave its standard deviation too small, down
// to 0.
TEST_F(MeasureVerb, FewPulsesOf128StationsRefuteNoTheory) {
  Json network = {{"name", "long"},
                  {"bit_rate", "500 kbit/s"},
                  {"formula", "f4"},
                  {"rules", {{"software_time", "450 us"}}},
                  {"copy", {{{"from", "s0"}, {"input_word", 0}, {"to", "s127"}, {"output_word", 0}}}}};
  for (int n = 0; n < 128; ++n)
    network["stations"].push_back(
        {{"name", "s" + std::to_string(n)}, {"id_code", "0x0103"}, {"cable", "5 m"}});
  write("long.json", network.dump());
  const Called called = call({"measure", "interbus", "--network", "long.json", "--signal", "10Hz",
                              "--duration", "3s", "--seed", "8"});
  EXPECT_EQ(called.exit_code, 2) << called.out;
  EXPECT_HOLDS(called.out, "theory and measurement: open");
}

TEST_F(MeasureVerb, ASignalThatTakesLongerThanAskedForSaysSo) {
  const Called called = call({"measure", "interbus", "--signal", "50Hz", "--duration", "1ms"});
  EXPECT_HOLDS(called.out, "50 Hz: one train of 8 periods and its rest take 1");
  const Called enough = call({"measure", "interbus", "--signal", "50Hz", "--duration", "1s"});
  EXPECT_EQ(enough.out.find("longer than asked for"), std::string::npos) << enough.out;
}

TEST_F(MeasureVerb, ASignalThatIsTooFastForTheCycleSaysSo) {
  const Called called = call({"measure", "valve_bus", "--signal", "25Hz,50Hz", "--duration", "1s"});
  EXPECT_HOLDS(called.out, "50 Hz: above 34.11 Hz a pulse may fall between two samples");
  EXPECT_EQ(called.out.find("25 Hz: above"), std::string::npos) << called.out;
}

TEST_F(MeasureVerb, TakesOneDisturbanceAtATime) {
  for (const std::string bursts :
       {"1..4", "0", "5", "two", "2,50kHz", "2,5kHz,plus", "2,5kHz,+,-", "x:0", "x:1000..4500:inf", ""}) {
    EXPECT_EQ(call({"measure", "interbus", "--bursts", bursts}).exit_code, 64) << bursts;
  }
  EXPECT_EQ(call({"measure", "interbus", "--bursts", "2", "--profile", "Z"}).exit_code, 64);
  EXPECT_HOLDS(call({"measure", "interbus", "--bursts", "x:800,100kHz,-", "--duration", "1s"}).out,
               "100 kHz, -, level X (800 V)");
}

TEST_F(MeasureVerb, ABadNetworkIsToldWithItsPlace) {
  write("bad.json", "{\n  \"name\": \"x\",\n  \"bit_rat\": \"500 kbit/s\"\n}\n");
  const Called bad = call({"measure", "interbus", "--network", "bad.json"});
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_HOLDS(bad.err, "bad.json:1: the top level: key \"bit_rate\" is missing");
  write("mute.json",
        "{\"name\": \"mute\", \"bit_rate\": \"500 kbit/s\","
        " \"stations\": [{\"name\": \"a\", \"id_code\": \"0x0103\"}]}");
  const Called mute = call({"measure", "interbus", "--network", "mute.json"});
  EXPECT_EQ(mute.exit_code, 65);
  EXPECT_HOLDS(mute.err, "nothing is copied from an input to an output");
}

TEST_F(MeasureVerb, ThePaperIsReproducedSideBySide) {
  const Called called = call({"paper", "interbus", "--duration", "5s", "--json", "paper.json"});
  EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
  for (const char* part : {"0.755 ms", "0.7550 ms", "0.814 ms", "0.8148 ms", "0.86 ms", "0.8600 ms",
                           "59.8 us", "exactly two telegrams", "614 Hz", "614.25 Hz", "0 of", "pictures",
                           "(no number)", "input  ", "output ", "agrees: 614.251 Hz of 614 Hz +- 0.5",
                           "DIFFERS: 0.8148 ms of 0.755 ms +- 0.0005", " own, "}) {
    EXPECT_HOLDS(called.out, part);
  }
}

// Pulses that fall between two samples measure nothing: of the usual signals those that the network carries.
TEST_F(MeasureVerb, TakesASignalThatTheNetworkCanCarry) {
  const Called slow = call({"measure", "fieldbus_dll", "--duration", "20s"});
  EXPECT_HOLDS(slow.out, "\n0.433 Hz from node");
  EXPECT_EQ(slow.out.find("50 Hz from"), std::string::npos);
  EXPECT_HOLDS(call({"measure", "valve_bus", "--duration", "1s"}).out, "\n14.906 Hz from");
  EXPECT_HOLDS(call({"measure", "interbus", "--duration", "1s"}).out, "\n200 Hz from");
  EXPECT_HOLDS(call({"measure", "valve_bus", "--signal", "50Hz", "--duration", "1s"}).out, "\n50 Hz from");
}

TEST_F(MeasureVerb, BothDocumentsAreValidForASchemaValidator) {
  ASSERT_EQ(call({"measure", "interbus", "--duration", "5s", "--json", "m.json"}).exit_code, 0);
  ASSERT_EQ(call({"paper", "--duration", "1s", "--json", "paper.json"}).exit_code, 1);
  expect_valid({"m.json"}, "measurement");
  expect_valid({"paper.json"}, "publication");
}

// Where the paper shows pictures, no number is called the paper's.
TEST_F(MeasureVerb, PicturesOfThePaperHaveNoNumber) {
  ASSERT_EQ(call({"paper", "--duration", "1s", "--json", "paper.json"}).exit_code, 1);
  const Json paper = json("paper.json");
  int pictures = 0;
  for (const Json& section : paper["sections"]) {
    if (section["heading"] != "Input and output at 50, 150 and 200 Hz") continue;
    EXPECT_EQ(section["traces"].size(), 3U);
    for (const Json& row : section["rows"]) {
      EXPECT_TRUE(row["published"].is_null()) << row;
      ++pictures;
    }
  }
  EXPECT_EQ(pictures, 6);
}

TEST_F(MeasureVerb, ThePapersBurstsFailWithoutAShieldAndNotBehindAProperOne) {
  ASSERT_EQ(call({"paper", "--duration", "12s", "--json", "paper.json"}).exit_code, 1);
  const Json section = json("paper.json")["sections"].back();
  EXPECT_HOLDS(section["heading"].get<std::string>(), "1000 to 4500 V");
  ASSERT_EQ(section["rows"].size(), 17U);  // eight voltages without and with a shield, and what they come to
  for (std::size_t n = 0; n < 16; ++n) {
    const Json& row = section["rows"][n];
    EXPECT_TRUE(row["published"].is_null()) << row;
    EXPECT_EQ(row["reproduced"].get<std::string>().starts_with("A: "), n % 2 == 1) << row;
    EXPECT_HOLDS(row["reproduced"].get<std::string>(), " 0 wrong words accepted");
  }
  EXPECT_EQ(section["rows"][16]["verdict"], "not checked");
}

// Whoever plays may be faster or slower, and not wrong.
TEST_F(MeasureVerb, WordsThatNobodyGaveAreAFailureOfAnyStation) {
  const Called called = call({"measure", "interbus", "--signal", "50Hz", "--duration", "1s", "--iut",
                              "slave@2=mutant:input_bit_stuck"});
  EXPECT_EQ(called.exit_code, 1) << called.out;
  EXPECT_HOLDS(called.out, " words that the input never had\n");
}

TEST_F(MeasureVerb, PulsesOfManyCyclesThatNeverArriveAreAFailureOfAnyStation) {
  const Called called = call({"measure", "valve_bus", "--signal", "5Hz", "--duration", "10s", "--iut",
                              "node@1=mutant:switches_latched_at_power_up"});
  EXPECT_EQ(called.exit_code, 1) << called.out;
  EXPECT_HOLDS(called.out, " pulses arrived, though each lasted for many cycles");
}

}  // namespace
}  // namespace fieldproof::cli

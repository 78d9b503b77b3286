// Subject: `fieldproof emc` as its user meets it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

class EmcVerb : public ProgramFixture {
 protected:
  Called call(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"emc", "interbus", "--quiet"});
    if (std::ranges::count(arguments, "--duration") == 0) {
      arguments.insert(arguments.end(), {"--duration", "1s"});
    }
    return ProgramFixture::call(std::move(arguments));
  }
};

TEST_F(EmcVerb, TellsEachTestAndTheLedger) {
  const Called called = call({"--test-levels", "1,x:1000..2000:500", "--json", "emc.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_NE(called.out.find("X (1500 V)"), std::string::npos) << called.out;
  EXPECT_NE(called.out.find("not calibrated"), std::string::npos) << called.out;
  const nlohmann::json document = json("emc.json");
  ASSERT_EQ(document.at("tests").size(), 16U);
  for (const auto& test : document.at("tests")) {
    EXPECT_GT(test.at("ledger").at("sent"), 1000);
    EXPECT_EQ(test.at("ledger").at("accepted_wrong_inputs"), 0);
  }
  EXPECT_EQ(document.at("total").at("accepted_wrong"), 0);
  EXPECT_EQ(document.at("seed"), "1");
  const auto& residual = document.at("residual");
  EXPECT_EQ(residual.at("frame_check"), "CRC-16/IBM-3740");
  EXPECT_DOUBLE_EQ(residual.at("expected_wrong_at_most").get<double>(),
                   residual.at("worst_share_of_corrupted").get<double>() *
                       document.at("total").at("balance").at("data_differed").get<double>());
}

TEST_F(EmcVerb, TheNumberOfThreadsChangesNothing) {
  EXPECT_EQ(call({"--jobs", "1", "--test-levels", "1..4", "--json", "one.json"}).exit_code, 0);
  EXPECT_EQ(call({"--jobs", "2", "--test-levels", "1..4", "--json", "two.json"}).exit_code, 0);
  EXPECT_EQ(read("one.json"), read("two.json"));
  EXPECT_FALSE(read("one.json").empty());
}

TEST_F(EmcVerb, ATestIsTheSameAloneAndAmongOthers) {
  ASSERT_EQ(call({"--test-levels", "1..4", "--json", "all.json"}).exit_code, 0);
  ASSERT_EQ(
      call({"--test-levels", "3", "--repetition", "5kHz", "--polarity", "-", "--json", "one.json"}).exit_code,
      0);
  const nlohmann::json alone = json("one.json").at("tests").at(0);
  const nlohmann::json tests = json("all.json").at("tests");
  EXPECT_EQ(std::ranges::count(tests, alone), 1) << alone;
}

TEST_F(EmcVerb, EndsWithOneWhereTheCriterionIsWorseThanAllowed) {
  EXPECT_EQ(call({"--test-levels", "3", "--worst", "A"}).exit_code, 1);
  EXPECT_EQ(call({"--test-levels", "3", "--worst", "A", "--profile", "C"}).exit_code, 0);
  const Called caught =
      call({"--test-levels", "3", "--iut", "slave@1=mutant:does_not_mark_status", "--duration", "5s"});
  EXPECT_EQ(caught.exit_code, 1);
  EXPECT_NE(caught.out.find("reproduce: fieldproof emc interbus"), std::string::npos) << caught.out;
}

TEST_F(EmcVerb, SearchesWhereEachCriterionIsSeenFirst) {
  const Called called = call({"--jobs", "1", "--json", "one.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  const std::size_t line = called.out.find("threshold search: A up to ");
  ASSERT_NE(line, std::string::npos) << called.out;
  EXPECT_LT(line, called.out.find("criterion")) << "above the table";
  EXPECT_HOLDS(called.out, "hint: all levels lie on one side, above where A ends; A was found up to ");
  const nlohmann::json document = json("one.json");
  EXPECT_HOLDS(called.out, "hint: " + document.at("hint").get<std::string>() + "\n");
  EXPECT_TRUE(std::regex_search(called.out, std::regex("the longest took \\d+\\.\\d{3} [mu]?s\n")))
      << called.out;
  EXPECT_EQ(document.at("tests").size(), 16U);
  const nlohmann::json& found = document.at("thresholds");
  const double a = found.at("a_up_to_volts").get<double>();
  const double b = found.at("b_from_volts").get<double>();
  EXPECT_GE(a, std::ceil(document.at("threshold_volts").get<double>()) - 1);
  EXPECT_GT(b, a);
  EXPECT_LT(b, a * 1.06 + 1);
  for (const auto& probe : found.at("probes"))
    EXPECT_EQ(probe.at("criterion") == "A", probe.at("volts").get<double>() <= a) << probe;
  EXPECT_EQ(found.at("tests").get<std::size_t>(), 4 * found.at("probes").size());
  expect_valid({"one.json"}, "emc");
  EXPECT_EQ(call({"--jobs", "2", "--json", "two.json"}).exit_code, 0);
  EXPECT_EQ(read("one.json"), read("two.json"));
}

// One wrong word in a probe of 1 s, and none in the test of the table that lasts as long.
TEST_F(EmcVerb, JudgesWhatTheSearchSawAtVoltagesThatTheTableReaches) {
  const auto searched = [&](const std::string& level) {
    return prepared({"emc", "valve_bus", "--test-levels", level, "--search", "--duration", "1s",
                     "--repetition", "100kHz", "--polarity", "+", "--seed", "1", "--json", "emc.json",
                     "--out", "kept"})
        .run();
  };
  const Called failed = searched("x:1500");
  EXPECT_EQ(failed.exit_code, 1) << failed.out << failed.err;
  EXPECT_HOLDS(failed.out, "seen by the search, in a test of 1.000 s");
  const nlohmann::json tests = json("emc.json").at("tests");
  ASSERT_EQ(tests.size(), 2U);
  EXPECT_EQ(tests[0].at("criterion"), "B");
  EXPECT_EQ(tests[1].at("criterion"), "D");
  EXPECT_EQ(tests[1].at("of_search_s"), 1.0);
  expect_valid({"emc.json"}, "emc");
  const Called again = prepared({"replay", "kept/valve_bus-1-2.case.json"}).run();
  EXPECT_HOLDS(again.out, "criterion D: 1 words were accepted and nobody had sent them");
  EXPECT_EQ(searched("x:600").exit_code, 0) << "it was seen above what is tested";
}

TEST_F(EmcVerb, SearchesBesideLevelsThatAreGivenWhereItIsAsked) {
  const Called given = call({"--test-levels", "4", "--profile", "C", "--json", "given.json"});
  EXPECT_FALSE(json("given.json").contains("thresholds"));
  EXPECT_HOLDS(given.out, "below where A ends; --search finds where that is");
  const Called asked = call({"--test-levels", "x:30,3", "--search", "--json", "asked.json"});
  EXPECT_EQ(asked.out.find("hint:"), std::string::npos) << asked.out;
  EXPECT_FALSE(json("asked.json").contains("hint"));
  EXPECT_EQ(json("asked.json").at("thresholds").at("searched_to_volts"), 4000);
  EXPECT_EQ(call({"--channel", "bsc:0.001", "--search"}).exit_code, 64);
}

// The seed draws the same bursts for both, so what differs is the device.
TEST_F(EmcVerb, ShowsReferencesInThePlaceOfTheDevice) {
  const Called caught = call({"--test-levels", "3", "--iut", "slave=mutant:does_not_mark_status",
                              "--duration", "5s", "--search", "--json", "caught.json"});
  EXPECT_EQ(caught.exit_code, 1);
  EXPECT_HOLDS(caught.out,
               "in it: slave@1 (mutant:does_not_mark_status); whoever is not named is a reference");
  EXPECT_HOLDS(caught.out, "\nreferences alone: A up to ");
  EXPECT_HOLDS(caught.out, "  references alone                   B");
  EXPECT_HOLDS(caught.out,
               "beside references alone, under bursts of the same seeds: the same to the last exchange in ");
  const nlohmann::json document = json("caught.json");
  EXPECT_TRUE(document.at("thresholds").contains("references"));
  const auto& tests = document.at("tests");
  EXPECT_TRUE(std::ranges::any_of(tests, [](const auto& test) { return test.at("criterion") == "D"; }));
  ASSERT_EQ(call({"--test-levels", "3", "--duration", "5s", "--json", "references.json"}).exit_code, 0);
  const nlohmann::json alone = json("references.json").at("tests");
  for (std::size_t n = 0; n < alone.size(); ++n) {
    EXPECT_FALSE(alone[n].contains("reference")) << "nobody else plays";
    const auto& reference = tests.at(n).at("reference");
    EXPECT_EQ(reference.at("criterion"), alone[n].at("criterion"));
    EXPECT_EQ(reference.at("exposed"), alone[n].at("ledger").at("balance").at("exposed"));
    EXPECT_EQ(reference.at("rejected"), alone[n].at("ledger").at("balance").at("rejected"));
    EXPECT_EQ(reference.at("accepted_wrong"), 0);
  }
}

TEST_F(EmcVerb, SaysOverWhichRangeOfEachParameterAVerdictHolds) {
  const Called called =
      call({"--test-levels", "x:55", "--polarity", "+", "--sensitivity", "--json", "emc.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "sensitivity at X (55 V): ");
  const nlohmann::json sensitivity = json("emc.json").at("sensitivity");
  bool changes = false;
  for (const auto& one : sensitivity.at("parameters")) {
    EXPECT_NE(one.at("name"), "source_ohm");
    EXPECT_LE(one.at("from"), one.at("value"));
    EXPECT_LE(one.at("value"), one.at("to"));
    changes = changes || !one.at("holds").get<bool>();
  }
  EXPECT_TRUE(changes) << "just above the threshold less coupling brings an A";
  expect_valid({"emc.json"}, "emc");
}

TEST_F(EmcVerb, RefusesWhatItCannotServe) {
  const auto refusal = [&](std::vector<std::string> arguments) {
    const Called called = call(std::move(arguments));
    EXPECT_EQ(called.exit_code, 64) << called.err;
    return called.err;
  };
  for (const char* level : {"5", "0", "x:", "x:0", "x:1000..500", "1..2..3", "one", "1.5", "x:nan"}) {
    EXPECT_NE(refusal({"--test-levels", level}).find("level"), std::string::npos) << level;
  }
  EXPECT_NE(refusal({"--repetition", "7kHz"}).find("2.5kHz"), std::string::npos);
  EXPECT_NE(refusal({"--polarity", "x"}).find("+, -"), std::string::npos);
  EXPECT_NE(refusal({"--profile", "G"}).find("profile"), std::string::npos);
  EXPECT_NE(refusal({"--iut", "slave@9=mutant:does_not_mark_status"}).find("slave@1 to slave@3"),
            std::string::npos);
  EXPECT_NE(refusal({"--duration", "2h"}).find("1 h"), std::string::npos);
}

TEST_F(EmcVerb, HoldsACountOnATextbookChannelAgainstTheTheory) {
  const Called called =
      call({"--channel", "bsc:0.0002,bsc:0.001", "--duration", "10s", "--json", "channels.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "bsc 0.001");
  EXPECT_EQ(called.out.find("not calibrated"), std::string::npos) << "no burst, no coupling";
  const nlohmann::json document = json("channels.json");
  EXPECT_TRUE(document.at("tests").empty());
  ASSERT_EQ(document.at("channels").size(), 2U);
  ASSERT_EQ(document.at("unverified").size(), 1U);
  EXPECT_HOLDS(document.at("unverified").front().get<std::string>(), "reading of the header");
  for (const auto& test : document.at("channels")) {
    EXPECT_GT(test.at("ledger").at("corrupted"), 1000);
    EXPECT_GT(test.at("undetected_by_code_word"), 0);
    EXPECT_GT(test.at("undetected_by_shift"), test.at("undetected_by_code_word"));
    EXPECT_GT(test.at("chance_of_count"), 1e-3);
  }
  EXPECT_GT(document.at("channels").at(1).at("expected_wrong_cycles_at_most"),
            document.at("channels").at(0).at("expected_wrong_cycles_at_most"));
  expect_valid({"channels.json"}, "emc");
}

// A master that takes what fails its check accepts more than theory lets pass.
TEST_F(EmcVerb, EndsWithOneWhereTheTheoryIsRefuted) {
  const Called called =
      call({"--channel", "bsc:0.001", "--duration", "10s", "--iut", "master=mutant:own_check_ignored"});
  EXPECT_EQ(called.exit_code, 1) << called.out;
  EXPECT_HOLDS(called.out, "reproduce: fieldproof emc interbus --iut master=mutant:own_check_ignored");
  EXPECT_HOLDS(called.out, "--channel bsc:0.001");
}

TEST_F(EmcVerb, AChannelOnWhichNothingComesThroughShowsNothing) {
  EXPECT_EQ(call({"--channel", "bsc:0.5", "--duration", "2s"}).exit_code, 2);
  const Called dead =
      call({"--channel", "bsc:0.001", "--duration", "5s", "--iut", "master=mutant:silent_after_error"});
  EXPECT_EQ(dead.exit_code, 1) << dead.out;
}

// Without a closed form of whole exchanges the code word of the frame is the bound.
TEST_F(EmcVerb, ANodeWithoutABlockCheckIsFoundOnAChannelOfTheTextbooks) {
  const auto on_channel = [&](const std::string& iut, const std::string& duration) {
    return ProgramFixture::call(
        {"emc", "valve_bus", "--channel", "bsc:0.001", "--duration", duration, "--quiet", "--iut", iut});
  };
  EXPECT_EQ(on_channel("node@3=ref", kernel::kIsSanitized ? "20s" : "120s").exit_code, 0);
  const Called unchecked = on_channel("node@3=mutant:write_not_checked", "120s");
  EXPECT_EQ(unchecked.exit_code, 1) << unchecked.out << unchecked.err;
}

// Else it would be said that bursts make it so, and from which voltage on.
TEST_F(EmcVerb, WhatIsWrongOnAQuietLineIsNotPutDownToBursts) {
  for (const auto& [iut, what] :
       {std::pair{"slave@2=mutant:output_octets_swapped", "'output to di16 word 0 (slave@2)' got 0x"},
        std::pair{"slave@2=mutant:input_bit_stuck", "'input of di16 word 0 (slave@2)' got 0x"}}) {
    const Called called = ProgramFixture::call(
        {"emc", "interbus", "--test-levels", "4", "--duration", "1s", "--json", "quiet.json", "--iut", iut});
    EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
    EXPECT_HOLDS(called.out, "the network does not work on a quiet line: ");
    EXPECT_HOLDS(called.out, what);
    EXPECT_FALSE(json("quiet.json").at("tests").at(0).at("came_up").get<bool>());
    expect_valid({"quiet.json"}, "emc");
  }
}

TEST_F(EmcVerb, WhereNoBurstMetAReceiverNothingIsShown) {
  const Called called = call({"--test-levels", "4", "--duration", "1ms"});
  EXPECT_EQ(called.exit_code, 2) << called.out;
  EXPECT_HOLDS(called.out, "no burst met a receiver: this shows nothing");
}

TEST_F(EmcVerb, ACampaignThatEndsEarlySaysSo) {
  const Called called = call({"--duration", "30s", "--max-time", "1ms", "--json", "short.json"});
  EXPECT_NE(called.exit_code, 0);
  EXPECT_FALSE(json("short.json").at("is_complete").get<bool>());
  EXPECT_NE(called.out.find("no test came to its end"), std::string::npos) << called.out;
  expect_valid({"short.json"}, "emc");
}

TEST_F(EmcVerb, WhatIsTypedWinsOverAChannelInAFile) {
  write("channel.json", R"({"channel": "bsc:0.001"})");
  const Called typed = call({"--config", "channel.json", "--test-levels", "1", "--quiet"});
  EXPECT_EQ(typed.exit_code, 0) << typed.err;
  EXPECT_HOLDS(typed.out, "1 (250 V)");
  EXPECT_HOLDS(call({"--config", "channel.json"}).out, "bsc 0.001");
  write("empty.json", R"({"levels": []})");
  EXPECT_EQ(call({"--config", "empty.json"}).exit_code, 65);
}

TEST_F(EmcVerb, RefusesAChannelThatIsNone) {
  for (const std::string text : {"bsc", "bsc:", "bsc:2", "bsc:0", "bsc:nan", "ge:0.1", ""}) {
    const Called called = call({"--channel", text});
    EXPECT_EQ(called.exit_code, 64) << text << called.out;
  }
  EXPECT_EQ(call({"--channel", "bsc:0.001", "--test-levels", "3"}).exit_code, 64);
}

TEST_F(EmcVerb, JsonIsValidForItsSchema) {
  ASSERT_EQ(call({"--test-levels", "1", "--json", "emc.json"}).exit_code, 0);
  expect_valid({"emc.json"}, "emc");
}

}  // namespace
}  // namespace fieldproof::cli

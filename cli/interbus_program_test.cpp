// Subject: the program as its user meets it. PICS, implementations, case files and recordings of INTERBUS, as
// fieldproof itself takes or refuses them.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"
#include "harness/kernel/sanitized.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// The real program on one case and on a mutant that the case catches.
class OfInterbus : public Program {
 protected:
  Called real(std::vector<std::string> arguments) const {
    Call made = call(std::move(arguments));
    made.program = FIELDPROOF_EXE;
    return made.run();
  }
  // One run of the case; the words follow.
  Called judged(std::vector<std::string> words) const {
    words.insert(words.begin(), {"run", kCase, "--volume", "quick"});
    return real(std::move(words));
  }

  const std::string kCase = "interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told";
  const std::string kMutant = "mutant:latches_in_spite_of_own_error";
};

TEST_F(OfInterbus, PicsItemThatNobodyKnowsIsRefusedWithTheNearest) {
  write("pics.json", "{\n\"items\": {\"ouputs\": true}\n}");
  const Called misspelled = judged({"--iut", kMutant, "--pics", "pics.json"});
  EXPECT_EQ(misspelled.exit_code, 65);
  EXPECT_HOLDS(misspelled.err, "pics.json:2: /items/ouputs: ");
  EXPECT_HOLDS(misspelled.err, "\"outputs\"");
  for (const char* answers : {R"({"outputs": "yes"})", R"({"words": true})", R"({"words": -1})",
                              R"({"outputs_while_outgoing_bus_is_reset": "hold"})"}) {
    write("pics.json", std::string("{\"items\": ") + answers + "}");
    EXPECT_EQ(judged({"--pics", "pics.json"}).exit_code, 65) << answers;
    EXPECT_EQ(real({"list", kCase, "--pics", "pics.json"}).exit_code, 65) << answers;
  }
}

TEST_F(OfInterbus, PicsLeavesWhatItDoesNotAnswerAsItIs) {
  write("pics.json", R"({"items": {"reconfiguration_button": true}})");
  EXPECT_EQ(judged({"--iut", kMutant, "--pics", "pics.json"}).exit_code, 1);
  const Called listed = real({"list", "interbus/slave/**", "--pics", "pics.json"});
  EXPECT_EQ(listed.out.find("not applicable"), std::string::npos) << listed.out;
  write("pics.json", R"({"items": {"outputs": false}})");
  EXPECT_HOLDS(real({"list", "interbus/slave/**", "--pics", "pics.json"}).out, "the slave has no outputs");
}

TEST_F(OfInterbus, PicsItemOfAnotherRoleIsRefused) {
  write("pics.json", R"({"items": {"loss_limit": "500 ms"}})");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"list", kCase, "--pics", "pics.json"},
        {"run", kCase, "--iut", "ref", "--pics", "pics.json"},
        {"check", "interbus/slave", "--cases", "1", "--pics", "pics.json"}}) {
    const Called called = real(words);
    EXPECT_EQ(called.exit_code, 65) << words.front();
    EXPECT_HOLDS(called.err, "\"loss_limit\" is an item of valve_bus/node; judged is interbus/slave");
  }
  EXPECT_EQ(real({"list", kCase, "valve_bus/node/**", "--pics", "pics.json"}).exit_code, 0);
}

TEST_F(OfInterbus, PicsIdCodeIsThatOfTheSlave) {
  write("pics.json", R"({"items": {"id_code": 1027, "words": 4}})");
  const std::string chapter = "interbus/slave/id_cycle/**";
  EXPECT_EQ(real({"run", chapter, "--volume", "quick", "--pics", "pics.json"}).exit_code, 0);
  write("pics.json", R"({"items": {"id_code": 515, "words": 4}})");
  const Called refused = real({"run", chapter, "--volume", "quick", "--pics", "pics.json"});
  EXPECT_EQ(refused.exit_code, 65);
  EXPECT_HOLDS(refused.err, "4 words; the length code 02h of its ID code 0203h says 2");
}

TEST_F(OfInterbus, PicsItemsOfARoleHaveTheirDefaults) {
  const Called slave = real({"list", "pics", "interbus/slave"});
  EXPECT_HOLDS(slave.out, "words  a whole number from 0 to 256, otherwise 2  ");
  EXPECT_EQ(slave.out.find("loss_limit"), std::string::npos);
  EXPECT_HOLDS(real({"list", "pics", "valve_bus/node"}).out, "loss_limit  ");
  EXPECT_HOLDS(real({"list", "pics", "token_bus/translator"}).out,
               "blanking_symbols  a whole number from 24 to 32, otherwise 28  ");
  EXPECT_HOLDS(real({"list", "pics", "interbus/slav"}).err, "'interbus/slave'");
}

TEST_F(OfInterbus, ACaseThatFailsWithoutBurstsHasNothingToShrink) {
  ASSERT_EQ(judged({"--iut", kMutant, "--out", "a"}).exit_code, 1);
  const Called folder = real({"replay", "a"});
  EXPECT_NE(folder.exit_code, 0);
  const auto at = folder.err.find("a/cases/");
  ASSERT_NE(at, std::string::npos) << folder.err;
  const std::string file = folder.err.substr(at, folder.err.find("case.json", at) + 9 - at);
  const Called shrunk = real({"shrink", file});
  EXPECT_EQ(shrunk.exit_code, 3);
  EXPECT_HOLDS(shrunk.out, "there is nothing to shrink");
  EXPECT_EQ(read(file.substr(0, file.size() - 5) + ".shrunk.json"), "");
}

TEST_F(OfInterbus, PicsItemsAreListed) {
  EXPECT_HOLDS(real({"list", "pics"}).out, "outputs  true or false  the slave has process data outputs\n");
  EXPECT_HOLDS(real({"list", "pics", "--json"}).out, "\"item\": \"outputs_while_outgoing_bus_is_reset\"");
}

TEST_F(OfInterbus, OnePlaceHasOneImplementation) {
  for (const char* other : {"slave=ref", "slave@1=ref", "ref"}) {
    const Called twice = judged({"--iut", "slave=" + kMutant, "--iut", other});
    EXPECT_EQ(twice.exit_code, 64) << other;
    EXPECT_HOLDS(twice.err, "slave=" + kMutant);
  }
  // Of two slaves at two places a case for a slave would judge one only; a network has room for both.
  EXPECT_EQ(judged({"--iut", "slave@1=" + kMutant, "--iut", "slave@2=ref"}).exit_code, 64);
  EXPECT_EQ(real({"run", "interbus/network/timing/cycles_do_not_jitter", "--volume", "quick", "--iut",
                  "slave@1=ref", "--iut", "slave@2=ref"})
                .exit_code,
            0);
}

TEST_F(OfInterbus, PositionIsOneThatANetworkHas) {
  EXPECT_EQ(judged({"--iut", "slave@16=ref"}).exit_code, 0);
  for (const char* far : {"slave@513=ref", "slave@4097=ref", "slave@2147483647=ref"}) {
    const Called called = judged({"--iut", far});
    EXPECT_EQ(called.exit_code, 64) << far << called.err;
    EXPECT_HOLDS(called.err, "at most 512 stations");
  }
}

TEST_F(OfInterbus, WrongFileIsFoundBeforeAnythingIsStored) {
  write("faults.json", "{\n\"rules\": 1}");
  write("network.json", "{\"name\": \"n\", \"bit_rate\": \"500 kbit/s\",\n\"stations\": 1}");
  for (const char* option : {"faults", "network"}) {
    const Called called = judged({std::string("--") + option, std::string(option) + ".json"});
    EXPECT_EQ(called.exit_code, 65);
    EXPECT_HOLDS(called.err, std::string(option) + ".json:2: ");
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
  }
}

TEST_F(OfInterbus, CaseFileIsHeldAgainstWhatThereIs) {
  ASSERT_EQ(judged({"--iut", "slave@2=" + kMutant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  const std::string good = read(file);
  const auto refused = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(part), part.size(), instead);
    write(file, text);
    const Called called = real({"replay", file.string()});
    EXPECT_EQ(called.exit_code, 65) << instead << called.out;
    EXPECT_HOLDS(called.err, "case.json:");
    return called.err;
  };
  EXPECT_HOLDS(refused(kMutant, "mutant:latches_in_spite_of_own_eror"), "latches_in_spite_of_own_error");
  EXPECT_HOLDS(refused(kMutant, "own"), "/implementations/0: ");
  EXPECT_HOLDS(refused("\"role\": \"slave\"", "\"role\": \"slvae\""), "'slvae'");
  EXPECT_HOLDS(refused("\"position\": 2", "\"position\": 513"), "at most 512 stations");
  EXPECT_HOLDS(refused("rejected_marked_and_told", "rejected_marked_and_tol"), "/case: ");
}

TEST_F(OfInterbus, CaseFileIsAsItsSchemaSays) {
  write("pics.json", R"({"items": {"outputs": true}})");
  ASSERT_EQ(judged({"--iut", kMutant, "--pics", "pics.json", "--out", "a"}).exit_code, 1);
  const fs::path file = case_file("a");
  const auto valid = reports::judge_with_ajv(kSourceFolder, kSourceFolder / "cli/case.schema.json", {file});
  if (!valid.is_available) GTEST_SKIP() << valid.output;
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  std::string text = read(fs::relative(file, folder_));
  text.replace(text.find("\"volume\": \"quick\""), 17, "\"volume\": \"loud\"");
  write(fs::relative(file, folder_), text);
  EXPECT_EQ(reports::judge_with_ajv(kSourceFolder, kSourceFolder / "cli/case.schema.json", {file}).exit_code,
            1);
  EXPECT_EQ(real({"replay", file.string()}).exit_code, 65);
}

TEST_F(OfInterbus, StoredTextDoesNotSteerTheTerminal) {
  ASSERT_EQ(judged({"--iut", kMutant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  std::string text = read(file);
  const std::size_t at = text.find("\"reason\": \"") + 11;
  write(file, text.insert(at, "\\u001b[2J\\u009b"));
  for (const Called& called : {real({"replay", file.string()}), real({"judge", "a"})}) {
    EXPECT_EQ(called.out.find_first_of("\x1b\x9b"), std::string::npos) << called.out;
  }
  write("lab.json", "{\"volume\": \"\\u001b[2J\", \"seed\": 2}");
  write("keys.json", "{\"s\\u009b\\u202eed\": 2}");
  write("cases.txt", "interbus/\x1b[2J\n");
  for (const Called& called : {real({"run", "--config", "lab.json"}), real({"run", "--config", "keys.json"}),
                               real({"list", "@cases.txt"})}) {
    EXPECT_GE(called.exit_code, 64);
    EXPECT_EQ(called.err.find("\x1b"), std::string::npos) << called.err;
    EXPECT_EQ(called.err.find("\xc2\x9b"), std::string::npos) << called.err;
    EXPECT_EQ(called.err.find("\xe2\x80\xae"), std::string::npos) << called.err;
  }
}

TEST_F(OfInterbus, ReplayNamesThePicsInTheCommandThatReproduces) {
  write("pics.json", R"({"items": {"reconfiguration_button": true}})");
  ASSERT_EQ(judged({"--iut", kMutant, "--pics", "pics.json", "--out", "a"}).exit_code, 1);
  const Called called = real({"replay", case_file("a").string()});
  EXPECT_HOLDS(called.out, "--pics ");
  EXPECT_HOLDS(called.out, "a/pics.json");
}

TEST_F(OfInterbus, RecordingOfAnotherSetupIsRefusedWithItsPlace) {
  ASSERT_EQ(judged({"--iut", kMutant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_).parent_path() / "playback.json";
  const std::string good = read(file);
  const auto judged_with = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(part), part.size(), instead);
    write(file, text);
    const Called called = real({"judge", "a"});
    EXPECT_EQ(called.exit_code, 4) << instead << called.out << called.err;
    EXPECT_HOLDS(called.err, "playback.json:");
  };
  EXPECT_EQ(real({"judge", "a"}).exit_code, 1);
  judged_with("\"at\":", "\"at\":\"now\",\"x\":");
  judged_with("\"call\":\"power\"", "\"call\":\"time\"");
  judged_with("\"call\":\"power\"", "\"call\":\"dance\"");
  judged_with("\"unit\":\"levels\"", "\"unit\":\"waves\"");
}

TEST_F(OfInterbus, PlanThatMakesTooMuchOfARunIsToldSo) {
  // Each level of each transmission: an arrival of its own, far in the future; a thousand levels more.
  for (kernel::FewerIfSanitized few(2);
       const char* effect : {R"({"delay": {"duration": "1000000 s"}})", R"({"repeat": {"count": 1000}})"}) {
    if (few.leaves_out()) continue;
    write("plan.json", std::string(R"({"rules": [{"scope": "level", "effect": )") + effect + "}]}");
    const Called called = real({"run", "interbus/network/timing/cycles_do_not_jitter", "--volume", "quick",
                                "--record", "none", "--faults", "plan.json"});
    EXPECT_EQ(called.exit_code, 2) << called.err;
    EXPECT_HOLDS(called.out, "plan_too_heavy");
  }
}

}  // namespace
}  // namespace fieldproof::cli

// Subject: tests of `emc` that end worse than they may: stored, run again, made smaller.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

constexpr int kBadFile = 65;
constexpr const char* kEqual = "equal: criterion, reason, number and fingerprint are those of the stored run";

class StoredEmc : public ProgramFixture {
 protected:
  // Stores what fails in `out`; gives the call.
  Called emc(const std::string& protocol, const std::string& iut, std::vector<std::string> more) const {
    more.insert(more.begin(), {"emc", protocol, "--iut", iut, "--quiet", "--out", "out"});
    return call(std::move(more));
  }
  static std::vector<std::string> bursts(const std::string& duration, const std::string& polarity) {
    return {"--test-levels", "4", "--repetition", "5kHz", "--polarity", polarity, "--duration", duration};
  }
  std::size_t bits_in(const nlohmann::json& test) const {
    std::size_t bits = 0;
    for (const auto& disturbance : test.at("plan").at("disturbances")) {
      for (const char* unit : {"bits", "levels"}) {
        const std::string key = std::string("flipped_") + unit;
        if (!disturbance.contains(key)) continue;
        for (const auto& transmission : disturbance.at(key)) bits += transmission.at(unit).size();
      }
    }
    return bits;
  }
  void expect_valid_case(const std::string& file) const { expect_valid({file}, "../../cli/emc_case"); }
};

TEST_F(StoredEmc, IsMadeSmallInEachProtocol) {
  struct Campaign {
    const char* protocol;
    const char* iut;
    std::vector<std::string> test;
    const char* reason;
  };
  for (const Campaign& row :
       {Campaign{"interbus", "slave@1=mutant:does_not_mark_status", bursts("5s", "+"), "wrong_word_accepted"},
        Campaign{"interbus", "master=mutant:silent_after_error", bursts("1s", "+"), "dead_after_start"},
        Campaign{"valve_bus", "node@3=mutant:write_not_checked", bursts("20s", "-"), "wrong_word_accepted"},
        Campaign{"fieldbus_dll",
                 "ff_device@1=mutant:takes_violated_frames",
                 {"--channel", "bsc:0.003", "--duration", "40s"},
                 "wrong_word_accepted"},
        Campaign{"token_bus",
                 "station@1=ref",
                 {"--worst", "A", "--test-levels", "4", "--repetition", "5kHz", "--polarity", "+",
                  "--duration", "300ms"},
                 "exchange_not_served_at_once"}}) {
    // Slow lines take a quarter of an hour under a sanitizer, which sees the same in the others.
    const std::string_view protocol = row.protocol;
    if (kernel::kIsSanitized && (protocol == "valve_bus" || protocol == "fieldbus_dll")) continue;
    std::filesystem::remove_all(folder_ / "out");
    const Called stored = emc(row.protocol, row.iut, row.test);
    ASSERT_EQ(stored.exit_code, kFailed) << row.iut << stored.out << stored.err;
    const std::string file = std::string("out/") + row.protocol + "-1-1.case.json";
    EXPECT_HOLDS(stored.out, "stored: " + file);
    EXPECT_EQ(json(file).at("reason"), row.reason) << row.iut;
    expect_valid_case(file);
    EXPECT_HOLDS(call({"replay", file}).out, kEqual);

    const Called shrunk = call({"shrink", file, "--case", "small.json"});
    EXPECT_EQ(shrunk.exit_code, kAllAsExpected) << row.iut << shrunk.out << shrunk.err;
    EXPECT_HOLDS(shrunk.out, "received  ");
    const nlohmann::json small = json("small.json");
    EXPECT_EQ(small.at("reason"), row.reason);
    EXPECT_EQ(small.at("criterion"), json(file).at("criterion"));
    EXPECT_GE(bits_in(small), 1U) << row.iut;
    EXPECT_LE(bits_in(small), 2U) << row.iut;
    expect_valid_case("small.json");
    const Called replayed = call({"replay", "small.json"});
    EXPECT_EQ(replayed.exit_code, kFailed) << replayed.err;
    EXPECT_HOLDS(replayed.out, kEqual);
  }
}

// The first wrong word has a file of its own, which ends where the word was accepted.
TEST_F(StoredEmc, TheFirstWrongWordIsTheEndOfItsFile) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("5s", "+,-")).exit_code, kFailed);
  const nlohmann::json first = json("out/interbus-1-1-first_wrong.case.json");
  EXPECT_EQ(first.at("decided_by"), "1 words were accepted and nobody had sent them");
  EXPECT_NE(first.at("duration"), "5.000 s");
  EXPECT_EQ(json("out/interbus-1-1.case.json").at("duration"), "5.000 s");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/interbus-1-2.case.json"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/interbus-1-2-first_wrong.case.json"));
  EXPECT_HOLDS(call({"replay", "out/interbus-1-1-first_wrong.case.json"}).out, kEqual);
}

TEST_F(StoredEmc, IsTheSameForAnyNumberOfJobs) {
  for (const char* jobs : {"1", "2"}) {
    std::vector<std::string> words = bursts("1s", "+,-");
    words.insert(words.end(), {"--jobs", jobs, "--worst", "A"});
    ASSERT_EQ(emc("interbus", "ref", words).exit_code, kFailed);
    std::filesystem::rename(folder_ / "out", folder_ / (std::string("jobs") + jobs));
  }
  for (const char* file : {"interbus-1-1.case.json", "interbus-1-2.case.json"}) {
    EXPECT_FALSE(read(std::string("jobs1/") + file).empty());
    EXPECT_EQ(read(std::string("jobs1/") + file), read(std::string("jobs2/") + file));
  }
}

// The copy of the network is moved with its cases; who plays is called again, wherever it is.
TEST_F(StoredEmc, TakesItsNetworkAndAnAttachmentAlong) {
  std::vector<std::string> words = bursts("5s", "-");
  words.insert(words.end(),
               {"--network", (kSourceFolder / "examples/valve_bus.json").string(), "--worst", "A"});
  ASSERT_EQ(emc("valve_bus", "node@3=exec:" VALVE_NODE_PROCESS, words).exit_code, kFailed);
  std::filesystem::rename(folder_ / "out", folder_ / "moved");
  EXPECT_EQ(json("moved/valve_bus-1-1.case.json").at("network"), "network.json");
  EXPECT_HOLDS(call({"replay", "moved/valve_bus-1-1.case.json"}).out, kEqual);
  const Called shrunk = call({"shrink", "moved/valve_bus-1-1.case.json", "--case", "small.json"});
  EXPECT_EQ(shrunk.exit_code, kAllAsExpected) << shrunk.out << shrunk.err;
  EXPECT_EQ(json("small.json").at("network"), "moved/network.json");
  EXPECT_HOLDS(call({"replay", "small.json"}).out, kEqual);
  const Called other = call({"replay", "small.json", "--iut", "node@3=ref"});
  EXPECT_HOLDS(other.out, "another implementation than the stored one: not compared");
}

TEST_F(StoredEmc, RefusesWhatIsNoTest) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("1s", "+")).exit_code, kFailed);
  const nlohmann::json good = json("out/interbus-1-1.case.json");
  const auto refusal = [&](const nlohmann::json& change) {
    nlohmann::json bad = good;
    bad.merge_patch(change);
    write("bad.json", bad.dump(1));
    const Called called = call({"replay", "bad.json"});
    EXPECT_EQ(called.exit_code, kBadFile) << change << called.out;
    EXPECT_EQ(call({"shrink", "bad.json"}).exit_code, kBadFile) << change;
    return called.err;
  };
  EXPECT_HOLDS(call({"verify", "out/interbus-1-1.case.json"}).err,
               "'fieldproof replay' and 'fieldproof shrink'");
  EXPECT_HOLDS(refusal({{"schema", "fieldproof/emc_case/2"}}), "fieldproof/emc_case/1");
  EXPECT_HOLDS(refusal({{"protocol", "profibus"}}), "/protocol");
  EXPECT_HOLDS(refusal({{"bursts", nullptr}}), R"(write either "bursts" or "binary_symmetric")");
  EXPECT_HOLDS(refusal({{"duration", "2 h"}}), "/duration");
  EXPECT_HOLDS(refusal({{"bursts", {{"level", 5}}}}), "/bursts/level");
  EXPECT_HOLDS(refusal({{"worst", "D"}}), "/worst");
  EXPECT_HOLDS(refusal({{"seed", "x"}}), "/seed");
  EXPECT_HOLDS(refusal({{"windows", {{{"from", "2 ms"}, {"to", "1 ms"}}}}}), "/windows/0/to");
  EXPECT_HOLDS(refusal({{"plan", {{"disturbance", nlohmann::json::array()}}}}), "/plan");
  EXPECT_HOLDS(refusal({{"network", "nowhere.json"}}), "nowhere.json");
  EXPECT_HOLDS(refusal({{"extra", 1}}), "extra");
  const auto implementation = [](int position, const char* uri) {
    return nlohmann::json{{"implementations", {{{"role", "slave"}, {"position", position}, {"uri", uri}}}}};
  };
  EXPECT_HOLDS(refusal(implementation(9, "ref")), "/implementations: --iut: 'ref'");
  EXPECT_HOLDS(refusal(implementation(1, "mutant:none_such")), "/implementations/0");
  EXPECT_EQ(call({"replay", "out/interbus-1-1.case.json", "--iut", "slave@9=ref"}).exit_code, kUsage);
}

TEST_F(StoredEmc, ReplayAndShrinkSayWhatIsNotAsStored) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("1s", "+")).exit_code, kFailed);
  nlohmann::json test = json("out/interbus-1-1.case.json");
  test["reason"] = "stopped";
  write("other.json", test.dump());
  const Called replayed = call({"replay", "other.json"});
  EXPECT_EQ(replayed.exit_code, kDiffers);
  EXPECT_HOLDS(replayed.out, "differs: reason was 'stopped', is 'wrong_word_accepted'");
  test["implementations"][0]["uri"] = "ref";
  write("reference.json", test.dump());
  const Called shrunk = call({"shrink", "reference.json"});
  EXPECT_EQ(shrunk.exit_code, kDiffers);
  EXPECT_HOLDS(shrunk.out, "the stored test does not fail with 'stopped' this time: nothing to shrink");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "reference.shrunk.json"));
}

// An implementation that goes while it is shrunk: another reason is not the stored one, and the stored one is
// shown with what was changed until then.
TEST_F(StoredEmc, OfAnImplementationThatGoesIsShrunkForThatReasonOnly) {
  const std::string station =
      std::string(FIELDPROOF_EXE) + " station valve_bus/node mutant:write_not_checked\n";
  write("node.sh", "exec " + station);
  std::vector<std::string> test = bursts("2s", "-");
  test.insert(test.end(), {"--worst", "A"});
  ASSERT_EQ(emc("valve_bus", "node@3=exec:sh node.sh", test).exit_code, kFailed);
  write("node.sh", "dd bs=1 count=20000 status=none | " + station);
  const Called shrunk = call({"shrink", "out/valve_bus-1-1.case.json", "--case", "small.json"});
  EXPECT_EQ(shrunk.exit_code, kDiffers) << shrunk.out << shrunk.err;
  EXPECT_HOLDS(shrunk.out, "this time: nothing to shrink");
  nlohmann::json stored = json("out/valve_bus-1-1.case.json");
  stored["reason"] = "implementation_crashed";
  write("gone.json", stored.dump());
  const Called gone = call({"shrink", "gone.json", "--case", "small.json"});
  EXPECT_EQ(gone.exit_code, kDiffers) << "no bit does it: " << gone.out;
  EXPECT_HOLDS(gone.out, "criterion D: an implementation crashed, hung or broke its contract");
  EXPECT_HOLDS(call({"replay", "small.json"}).out, "implementation_crashed");
  EXPECT_EQ(json("small.json").at("reason"), "implementation_crashed");
}

// Whatever is known by then is written, and replays.
TEST_F(StoredEmc, IsWrittenWhenTimeIsOver) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("20s", "+")).exit_code, kFailed);
  const Called shrunk =
      call({"shrink", "out/interbus-1-1.case.json", "--case", "small.json", "--max-time", "1ms"});
  EXPECT_EQ(shrunk.exit_code, kInconclusive) << shrunk.out << shrunk.err;
  EXPECT_HOLDS(shrunk.err, "--max-time");
  EXPECT_HOLDS(call({"replay", "small.json"}).out, kEqual);
}

TEST_F(StoredEmc, IsWrittenAfterASignal) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("20s", "+")).exit_code, kFailed);
  Call interrupted = prepared({"shrink", "out/interbus-1-1.case.json", "--case", "small.json"});
  interrupted.signal = SIGINT;
  interrupted.signal_after = "fieldproof ";
  const Called called = interrupted.run();
  EXPECT_EQ(called.exit_code, kSignalBase + SIGINT) << called.out << called.err;
  EXPECT_HOLDS(call({"replay", "small.json"}).out, kEqual);
}

TEST_F(StoredEmc, ShowsWhatIsOnTheLine) {
  ASSERT_EQ(emc("interbus", "slave@1=mutant:does_not_mark_status", bursts("1s", "+")).exit_code, kFailed);
  const Called shown =
      call({"replay", "out/interbus-1-1-first_wrong.case.json", "--bits", "--vcd", "wave.vcd"});
  EXPECT_HOLDS(shown.out, "slave@1/in  fault: burst pulse");
  EXPECT_FALSE(read("wave.vcd").empty());
}

}  // namespace
}  // namespace fieldproof::cli

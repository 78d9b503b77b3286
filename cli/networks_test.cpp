// Subject: `emc` and `measure` for every protocol, and with implementations outside in its networks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

class Networks : public ProgramFixture {
 protected:
  static std::string example(const char* name) { return (kSourceFolder / "examples" / name).string(); }
  Called emc(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "emc");
    arguments.insert(arguments.end(), {"--test-levels", "4", "--repetition", "5kHz", "--polarity", "+",
                                       "--quiet", "--jobs", "1", "--json", "emc.json"});
    return call(std::move(arguments));
  }
  nlohmann::json only_test() const { return json("emc.json").at("tests").at(0); }
};

TEST_F(Networks, OfEveryProtocolExchangeDataUnderBursts) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"interbus", "--duration", "1s"},
           {"valve_bus", "--duration", "1s"},
           {"fieldbus_dll", "--duration", "10s"},
           {"token_bus", "--duration", "300ms"},
           {"fieldbus_dll", "--iut", "isa_dle@1=ref", "--duration", "10s"}}) {
    const Called called = emc(arguments);
    EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
    const nlohmann::json test = only_test();
    EXPECT_GT(test.at("ledger").at("sent"), 50) << arguments.front();
    EXPECT_GT(test.at("ledger").at("corrupted"), 0) << arguments.front();
    EXPECT_EQ(test.at("ledger").at("accepted_wrong_inputs"), 0);
    int cycles = 0;
    for (const char* phase : {"quiet", "burst", "recovery"})
      cycles += test.at("cycles").at(0).at(phase).at("count").get<int>();
    EXPECT_GT(cycles, 10) << arguments.front();
    expect_valid({"emc.json"}, "emc");
  }
}

// A CD before it is activated has no answer: what it sends later answers something else.
TEST_F(Networks, CountNoTurnaroundOfWhatIsNotAnswered) {
  const std::string device =
      "ff_device@1=exec:" + std::string(FIELDPROOF_EXE) + " station fieldbus_dll/ff_device";
  ASSERT_EQ(emc({"fieldbus_dll", "--iut", device, "--duration", "1s"}).exit_code, 0);
  const nlohmann::json cycles = only_test().at("cycles");
  const auto turnaround = std::ranges::find(cycles, "turnaround time of ff_device@1",
                                            [](const auto& one) { return one.at("cycle"); });
  ASSERT_NE(turnaround, cycles.end());
  EXPECT_GT(turnaround->at("quiet").at("count"), 0);
  EXPECT_LE(turnaround->at("quiet").at("max_us"), turnaround->at("theory_us"));
}

// Of each protocol, with a reference and with one that accepts or loses what it should not.
TEST_F(Networks, BalanceTheirExchanges) {
  std::uint64_t wrong = 0;
  for (kernel::FewerIfSanitized few(2);
       const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"interbus", "--duration", "3s"},
           {"interbus", "--duration", "3s", "--iut", "slave@1=mutant:does_not_mark_status"},
           {"interbus", "--duration", "3s", "--iut", "master=mutant:own_check_ignored"},
           {"interbus", "--duration", "2s", "--channel", "bsc:0.001"},
           {"valve_bus", "--duration", "2s"},
           {"valve_bus", "--duration", "2s", "--iut", "node@3=mutant:write_not_checked"},
           {"fieldbus_dll", "--duration", "10s"},
           {"fieldbus_dll", "--duration", "10s", "--iut", "isa_dle@1=ref"},
           {"token_bus", "--duration", "300ms"}}) {
    if (few.leaves_out()) continue;
    std::vector<std::string> typed = arguments;
    typed.insert(typed.begin(), "emc");
    if (std::ranges::count(typed, "--channel") == 0) typed.insert(typed.end(), {"--test-levels", "1,4"});
    typed.insert(typed.end(), {"--quiet", "--json", "emc.json"});
    const std::string out = call(typed).out;
    const nlohmann::json document = json("emc.json");
    ASSERT_GT(document.at("tests").size() + document.at("channels").size(), 0U) << out;
    const auto balanced = [&](const nlohmann::json& balance) {
      const auto count = [&](const char* name) { return balance.at(name).get<std::uint64_t>(); };
      EXPECT_EQ(count("exposed"), count("untouched") + count("hit_without_effect") + count("rejected") +
                                      count("accepted_wrong"))
          << out;
      EXPECT_LE(count("data_differed"), count("rejected") + count("accepted_wrong"));
      wrong += count("accepted_wrong");
    };
    for (const char* tests : {"tests", "channels"}) {
      for (const nlohmann::json& test : document.at(tests)) {
        balanced(test.at("ledger").at("balance"));
        // Nothing rejected is what the letter says.
        const bool is_a = test.at("criterion") == "A";
        EXPECT_TRUE(!is_a || test.at("ledger").at("balance").at("rejected") == 0) << out;
        EXPECT_EQ(test.at("ledger").at("balance").at("exposed"), test.at("ledger").at("sent"));
      }
    }
    balanced(document.at("total").at("balance"));
    EXPECT_LT(document.at("total").at("balance").at("untouched"),
              document.at("total").at("balance").at("exposed"))
        << out;
    expect_valid({"emc.json"}, "emc");
  }
  EXPECT_GT(wrong, 0U);
}

TEST_F(Networks, SayWhatALetterRestsOnAndThatNothingWasHit) {
  const Called quiet = emc({"interbus", "--duration", "2s", "--profile", "C"});
  EXPECT_HOLDS(quiet.out, "no cycle was hit");
  EXPECT_HOLDS(quiet.out, "A: nothing rejected in ");
  EXPECT_EQ(quiet.out.find("pass unseen"), std::string::npos) << quiet.out;
  const Called hit = emc({"interbus", "--duration", "20s"});
  EXPECT_HOLDS(hit.out, "exchanges rejected in ");
  EXPECT_HOLDS(hit.out, "a longer run could still show C in up to ");
  const nlohmann::json test = only_test();
  const double bursts = test.at("bursts").get<double>();
  EXPECT_NEAR(bursts, 20 / 0.3, 15);
  EXPECT_NEAR(test.at("evidence").at("c_at_most").get<double>(), 1 - std::pow(0.05, 1 / bursts), 1e-9);
  const double differed = test.at("ledger").at("balance").at("data_differed").get<double>();
  EXPECT_NEAR(json("emc.json").at("total").at("upper_bound_of_share").get<double>(),
              1 - std::pow(0.05, 1 / differed), 1e-9);
}

TEST_F(Networks, TakeAnImplementationOutsideAtAnyPlace) {
  const Called node =
      emc({"valve_bus", "--network", example("valve_bus.json"), "--duration", "300ms", "--iut",
           "node@3=exec:" VALVE_NODE_PROCESS, "--iut", "node@5=mutant:ignores_writes"});
  EXPECT_EQ(node.exit_code, 64) << "no such mutant: " << node.err;
  const Called alone =
      emc({"valve_bus", "--network", example("valve_bus.json"), "--duration", "300ms", "--iut",
           "node@3=exec:" VALVE_NODE_PROCESS, "--iut", "node@5=exec:" VALVE_NODE_PROCESS});
  EXPECT_EQ(alone.exit_code, 0) << alone.out << alone.err;
  EXPECT_GT(only_test().at("ledger").at("sent"), 100);
  EXPECT_EQ(only_test().at("ledger").at("accepted_wrong_outputs"), 0);
  const Called measured = call({"measure", "valve_bus", "--network", example("valve_bus.json"), "--signal",
                                "20Hz", "--duration", "5s", "--iut", "node@1=plugin:" VALVE_NODE_PLUGIN});
  EXPECT_NE(measured.exit_code, 64) << measured.err;
  EXPECT_HOLDS(measured.out, "limit switches of 1 to valves of 42");
}

TEST_F(Networks, OneThatCannotBeAttachedEndsTheCall) {
  const Called called = emc({"valve_bus", "--duration", "300ms", "--iut", "node@2=exec:/bin/false"});
  EXPECT_EQ(called.exit_code, 5) << called.out << called.err;
}

TEST_F(Networks, JudgeTheReferenceOutsideAsInside) {
  for (kernel::FewerIfSanitized few(3);
       const char* role :
       {"fieldbus_dll/isa_dle", "fieldbus_dll/isa_las", "fieldbus_dll/ff_device", "fieldbus_dll/ff_las",
        "valve_bus/node", "valve_bus/host", "interbus/slave", "interbus/master", "token_bus/station"}) {
    if (few.leaves_out()) continue;
    const std::string path = role;
    const std::string protocol = path.substr(0, path.find('/'));
    const std::string name = path.substr(path.find('/') + 1);
    const auto test = [&](const std::string& iut) {
      const Called called = emc({protocol, "--duration", "1s", "--iut", name + "@1=" + iut});
      EXPECT_EQ(called.exit_code, 0) << iut << called.out << called.err;
      return only_test();
    };
    const nlohmann::json outside = test("exec:'" FIELDPROOF_EXE "' station " + path);
    const nlohmann::json inside = test("ref");
    EXPECT_EQ(outside.at("ledger"), inside.at("ledger")) << path;
    EXPECT_EQ(outside.at("reference").at("exposed"), inside.at("ledger").at("sent")) << path;
    EXPECT_EQ(outside.at("reference").at("rejected"), inside.at("ledger").at("balance").at("rejected"))
        << path;
    EXPECT_FALSE(inside.contains("reference")) << path;
  }
}

// A source of confirmed data, and who confirms them: through the user's port alone.
TEST_F(Networks, CarryTheServicesOfAStationOutsideAsOfTheReference) {
  const auto write_ring = [&](const std::string& channels) {
    write("ring.json", R"({"name": "services", "stations": [2, 4, 6], )" + channels + R"( "data": [
        {"from": 2, "to": 4, "service": "urgent", "every": "5 ms"},
        {"from": 4, "to": 2, "service": "periodic", "every": "7 ms", "octets": 32},
        {"from": 2, "to": 6, "service": "confirmed", "every": "10 ms", "octets": 64},
        {"from": 4, "to": 6, "service": "bulk", "load": "200 kbit/s", "octets": 300}]})");
  };
  const auto ledger = [&](const std::string& iut) {
    const Called called = emc({"token_bus", "--network", "ring.json", "--duration", "300ms", "--iut",
                               "station@1=" + iut, "--iut", "station@3=" + iut});
    EXPECT_EQ(called.exit_code, 0) << iut << called.out << called.err;
    return only_test().at("ledger");
  };
  for (const char* channels : {"", R"("channels": 2, )"}) {
    write_ring(channels);
    EXPECT_EQ(ledger("exec:'" FIELDPROOF_EXE "' station token_bus/station"), ledger("ref")) << channels;
  }
}

TEST_F(Networks, SayHowLongDataOfAServiceWait) {
  const Called called = call({"measure", "token_bus", "--network", example("picnet.json"), "--signal", "20Hz",
                              "--duration", "300ms", "--quiet"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  for (const char* row : {"longest token rotation, at most", "longest access delay, urgent, at most",
                          "longest access delay, periodic, at most", "data delivered twice",
                          "access delay, bulk, us", "class 6, this project's choice"})
    EXPECT_HOLDS(called.out, row);
  EXPECT_EQ(called.out.find("differs"), std::string::npos) << called.out;
}

TEST_F(Networks, SayWhichNumbersDecide) {
  const Called called = emc({"interbus", "--duration", "1s"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.out, "recovery_cycles");
  EXPECT_HOLDS(called.out, "Beckhoff BC4000");
  EXPECT_EQ(json("emc.json").at("acceptance").at(0).at("value"), "5 cycles");
  expect_valid({"emc.json"}, "emc");
  EXPECT_HOLDS(call({"explain", "network/acceptance"}).out, "silence_cycles");
  EXPECT_HOLDS(call({"explain", "limits_waited"}).out, "unverified");
}

// Each period of such a signal meets the schedule at the same phase: only trains differ.
TEST_F(Networks, MeasureSignalsInStepWithTheCycle) {
  for (const char* signal : {"0.5Hz", "0.25Hz"}) {
    const Called called = call({"measure", "fieldbus_dll", "--signal", signal, "--duration", "200s"});
    EXPECT_EQ(called.out.find("differs"), std::string::npos) << called.out;
    EXPECT_HOLDS(called.out, "mean delay, rising edges");
  }
}

TEST_F(Networks, RefuseWhatHasNoPlaceInThem) {
  const auto refusal = [&](std::vector<std::string> arguments) {
    const Called called = emc(std::move(arguments));
    EXPECT_EQ(called.exit_code, 64) << called.out << called.err;
    return called.err;
  };
  EXPECT_HOLDS(refusal({"valve_bus", "--iut", "node@9=exec:true"}), "node@1 to node@8");
  EXPECT_HOLDS(refusal({"valve_bus", "--iut", "slave=exec:true"}), "has no place");
  EXPECT_HOLDS(refusal({"modbus"}), "'interbus', 'valve_bus', 'fieldbus_dll'");
  EXPECT_HOLDS(refusal({"valve_bus", "--latch", "M3"}), "no latch model");
}

// Who takes whole frames is given those that a receiver finds in what bursts leave: as many as the reference.
TEST_F(Networks, GiveAStationOfTelegramsWhatAReceiverMakesOfBursts) {
  for (const auto& [role, program] : {std::pair{"ff_device", "examples/ff_device/device.py"},
                                      std::pair{"isa_dle", "examples/isa_dle/dle.py"}}) {
    const Called called =
        emc({"fieldbus_dll", "--iut",
             fmt::format("{}@1=exec:python3 '{}'", role, (kSourceFolder / program).string()), "--duration",
             "3s"});
    EXPECT_TRUE(called.exit_code == 0 || called.exit_code == 2) << role << called.out << called.err;
    const nlohmann::json test = only_test();
    EXPECT_GT(test.at("line").at("changed"), 0) << role << called.out;
    EXPECT_TRUE(test.at("came_up")) << role << called.out;
    EXPECT_EQ(test.at("ledger").at("sent"), test.at("reference").at("exposed")) << role << called.out;
  }
}

// A right node that answers earlier than the reference has another cycle time.
TEST_F(Networks, AreNotFailedForStationsThatAreNotTheReference) {
  const Called called = call({"measure", "valve_bus", "--iut", "node@2=mutant:turns_round_late", "--signal",
                              "2Hz", "--duration", "5s", "--quiet"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "'fieldproof run' judges each station");
}

// Two edges cannot show how late an edge may be.
TEST_F(Networks, SayNothingOfFewSamples) {
  const Called called =
      call({"measure", "fieldbus_dll", "--signal", "0.437Hz", "--duration", "5s", "--quiet"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_EQ(called.out.find("differs"), std::string::npos) << called.out;
}

TEST_F(Networks, NameWhatIsNotExposed) {
  write("long.json", R"({"name": "long", "nodes": 40, "cable": "2 km"})");
  const Called called = emc({"valve_bus", "--network", "long.json", "--duration", "200ms"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.out, "32 of 41 receivers are exposed");
  EXPECT_HOLDS(called.out, "not node@32/in: it lies after a repeater");
}

}  // namespace
}  // namespace fieldproof::cli

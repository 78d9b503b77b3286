#include "cli/serial_pool.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "cli/probe/mutants_in_c.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/iut/process.hpp"

// Nodes and hosts that play on pseudo terminals, judged in wall-clock time by the real program.
namespace fieldproof::cli {
namespace {

class SerialRuns : public ProgramFixture {
 protected:
  struct Case {
    std::string verdict;
    std::string reason;
    std::string findings;
  };
  using Cases = std::map<std::string, Case>;

  std::string line() const { return (folder_ / "line").string(); }
  std::string station(const std::string& node) const {
    return "'" FIELDPROOF_EXE "' station " + role_ + " " + node + " --serial '" + line() + "'";
  }
  std::string in_c(const std::string& mutant = {}) const {
    return station("\"exec:'" VALVE_NODE_PROCESS "' " + mutant + "\"");
  }
  std::string uri(const std::string& upper, int baud = 375'000, const std::string& more = {}) const {
    return "serial:" + line() + "?baud=" + std::to_string(baud) + "&format=8m1" + more +
           (upper.empty() ? "" : "&upper=" + upper);
  }

  Cases judged(const std::string& iut, const std::vector<std::string>& selectors) {
    const std::string out = "run" + std::to_string(++runs_);
    std::vector<std::string> words{"run",   "--volume", "quick", "--record", "failed",
                                   "--iut", iut,        "--out", out};
    for (const std::string& one : selectors) words.push_back(role_ + "/" + one);
    const Called called = call(words);
    EXPECT_TRUE(called.exit_code <= 2 || called.exit_code == 4) << called.exit_code << called.err;
    Cases found;
    if (read(out + "/results.json").empty()) return found;
    const nlohmann::json results = json(out + "/results.json");
    for (const auto& one : results.at("cases")) {
      const std::string id = one.at("id").get<std::string>().substr(role_.size() + 1);
      found[id] = {one.at("verdict"), one.at("reason"), one.at("findings").dump()};
    }
    return found;
  }

  // Again until this machine was quiet enough to judge, within a limit: where others keep it busy its
  // instants are in doubt, for a station that is wrong as for one that is right.
  Case judged_when_quiet(const std::string& iut, const std::string& id) {
    const auto begin = std::chrono::steady_clock::now();
    Case found;
    do {
      const Cases cases = judged(iut, {id});
      if (!cases.contains(id)) return {};
      found = cases.at(id);
    } while (found.reason == kInDoubt && std::chrono::steady_clock::now() - begin < std::chrono::seconds(30));
    return found;
  }

  // On a machine that is busy an instant may be in doubt; that is no verdict about the station.
  void expect_no_wrong_verdict(const Cases& cases) {
    EXPECT_FALSE(cases.empty());
    for (const auto& [id, one] : cases) {
      EXPECT_TRUE(one.verdict == "pass" || one.reason == kInDoubt)
          << id << ": " << one.verdict << one.reason << one.findings;
    }
  }

  static constexpr std::string_view kInDoubt = "timing_in_doubt";

  std::string role_ = "valve_bus/node";

 private:
  int runs_ = 0;
};

const std::vector<std::string> kSome{"read/is_answered",
                                     "read/data_is_not_looked_at",
                                     "write/drives_the_valves",
                                     "write/one_board_takes_the_first_octet",
                                     "address/switches_10_are_decimal",
                                     "framing/short_frames_are_discarded",
                                     "framing/joined_frames_are_no_write",
                                     "timing/turn_round_is_within_its_span",
                                     "timing/driver_is_on_for_the_answer_only",
                                     "timing/read_behind_write_is_served",
                                     "power/power_up_is_safe",
                                     "power/power_lost_in_a_frame"};

TEST_F(SerialRuns, ReferencePassesInWallClockTime) {
  expect_no_wrong_verdict(judged(uri("exec:" + station("ref")), kSome));
}

TEST_F(SerialRuns, NodeInCPassesAsAProcessAndAsALibrary) {
  expect_no_wrong_verdict(judged(uri("exec:" + in_c()), kSome));
  expect_no_wrong_verdict(judged(uri("exec:" + station("plugin:" VALVE_NODE_PLUGIN)), {"read/is_answered"}));
}

TEST_F(SerialRuns, CharactersAreSlowAtALowBitRate) {
  expect_no_wrong_verdict(judged(uri("exec:" + station("ref"), 9'600), {"read/is_answered"}));
}

// With an upper channel it is known what is on its way: no frame waits for as long as the line may take.
TEST_F(SerialRuns, ASlowWayToTheLineDoesNotSlowTheCases) {
  const auto begin = std::chrono::steady_clock::now();
  expect_no_wrong_verdict(judged(uri("exec:" + station("ref"), 375'000, "&latency=1000000us"), kSome));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(1));
}

TEST_F(SerialRuns, NodesATenthTooEarlyAndTooLateAreNeverRight) {
  const std::string id = "timing/turn_round_is_within_its_span";
  for (const auto& [node, reason] : {std::pair{"mutant:turns_round_a_tenth_early", "answer_too_early"},
                                     std::pair{"mutant:turns_round_a_tenth_late", "answer_too_late"}}) {
    const Case judged_one = judged(uri("exec:" + station(node), 2'400), {id}).at(id);
    EXPECT_TRUE(judged_one.reason == reason || judged_one.reason == kInDoubt)
        << node << judged_one.verdict << judged_one.findings;
  }
}

TEST_F(SerialRuns, WhatTheLineCannotDoDoesNotApply) {
  const Cases cases = judged(uri("exec:" + station("ref")),
                             {"line/break_is_no_frame", "framing/gaps_inside_a_frame",
                              "timing/wrong_bit_rates_are_not_understood", "read/snapshot_is_not_torn",
                              "timing/far_node_answers_in_time", "line/collision_does_not_change_the_node"});
  EXPECT_EQ(cases.size(), 6U);
  for (const auto& [id, one] : cases) {
    EXPECT_EQ(one.verdict, "not-applicable") << id << one.findings;
    EXPECT_NE(one.reason, "") << id;
  }
}

// Begins to play some time after it was started.
void wait_for(const std::string& path) {
  for (int n = 0; n < 20'000 && !std::filesystem::exists(path); ++n)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(SerialRuns, UpperChannelAtASocket) {
  const std::string socket = (folder_ / "upper").string();
  const iut::Process player(
      {FIELDPROOF_EXE, "station", "valve_bus/node", "ref", "--serial", line(), "--upper", socket});
  wait_for(socket);
  expect_no_wrong_verdict(judged(uri("unix:" + socket), {"read/is_answered"}));
  expect_no_wrong_verdict(judged(uri("unix:" + socket), {"write/drives_the_valves"}));
}

TEST_F(SerialRuns, AStationThatIsEndedTakesItsNameAndItsSocketAway) {
  const std::string socket = (folder_ / "upper").string();
  const std::string wait = "until [ -S '" + socket + "' ]; do sleep 0.05; done; ";
  const Called called = prepared({"-c", station("ref") + " --upper '" + socket + "' & " + wait +
                                            "sleep 0.2; kill -TERM $!; wait $!"},
                                 "/bin/sh")
                            .run();
  EXPECT_EQ(called.exit_code, 128 + SIGTERM) << called.err;
  EXPECT_EQ(std::filesystem::symlink_status(line()).type(), std::filesystem::file_type::not_found);
  EXPECT_FALSE(std::filesystem::exists(socket));
}

// A box of which nothing but the line is there.
TEST_F(SerialRuns, WithoutAnUpperChannelTheLineAloneIsJudged) {
  write("node.pics.json", R"({ "items": { "bit_rate": 9600, "address_tens": 0, "address_units": 5 } })");
  const iut::Process player({FIELDPROOF_EXE, "station", "valve_bus/node", "ref", "--serial", line(),
                             "--upper", "none", "--pics", (folder_ / "node.pics.json").string()});
  wait_for(line());
  // The box is a process of this machine: where others keep it from running it really is late, and told so.
  const auto is_right = [](const Case& one) { return one.verdict == "pass" || one.reason == kInDoubt; };
  Cases cases;
  for (int attempt = 0; attempt < 3 && (cases.empty() || !is_right(cases.at("read/is_answered")));
       ++attempt) {
    cases = judged(uri("", 9'600),
                   {"read/is_answered", "framing/short_frames_are_discarded", "write/drives_the_valves",
                    "power/power_up_is_safe", "address/switches_10_are_decimal"});
  }
  EXPECT_EQ(cases.at("write/drives_the_valves").verdict, "not-applicable");
  EXPECT_EQ(cases.at("power/power_up_is_safe").verdict, "not-applicable");
  EXPECT_EQ(cases.at("address/switches_10_are_decimal").verdict, "not-applicable");
  EXPECT_TRUE(is_right(cases.at("read/is_answered"))) << cases.at("read/is_answered").findings;
}

// What nobody sees is not judged, and what the line cannot do is no agreement with the model.
TEST_F(SerialRuns, CheckOfALineAloneFailsNoRightNode) {
  const iut::Process player(
      {FIELDPROOF_EXE, "station", "valve_bus/node", "ref", "--serial", line(), "--upper", "none"});
  wait_for(line());
  const Called called = call({"check", "valve_bus/node", "--iut", uri("", 375'000), "--cases", "12"});
  // An instant may be in doubt, as in all that is judged here.
  EXPECT_TRUE(called.exit_code == 0 || called.exit_code == 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "ask for what cannot be done to it");
}

// The host asks, the tester answers in the place of the nodes, and the upper channel in that of the PC.
class SerialRunsOfAHost : public SerialRuns {
 protected:
  SerialRunsOfAHost() { role_ = "valve_bus/host"; }
};

TEST_F(SerialRunsOfAHost, ReferencePassesInWallClockTime) {
  const std::vector<std::string> some{"request/write_is_sent_with_its_check",
                                      "request/undefined_commands_are_refused",
                                      "response/is_told_once_with_its_id",
                                      "response/each_wrong_bit_is_refused",
                                      "response/other_lengths_are_refused",
                                      "fifo/burst_keeps_its_order",
                                      "fifo/goes_round",
                                      "timing/write_is_left_alone",
                                      "timing/delimiter_is_in_front_of_each_request",
                                      "timing/driver_is_on_for_requests_only",
                                      "timing/unasked_octets_are_drained",
                                      "cycle/write_is_verified"};
  const Cases cases = judged(uri("exec:" + station("ref")), some);
  expect_no_wrong_verdict(cases);
  EXPECT_EQ(cases.size(), some.size());
}

TEST_F(SerialRunsOfAHost, WhatIsNotThereDoesNotApply) {
  const auto expect_none = [&](const std::string& uri, const std::string& id, const std::string& why) {
    const Case found = judged(uri, {id}).at(id);
    EXPECT_EQ(found.verdict, "not-applicable") << id << found.findings;
    EXPECT_NE(found.reason.find(why), std::string::npos) << found.reason;
  };
  const std::string read = "response/is_told_once_with_its_id";
  expect_none(uri("exec:" + station("ref")), "retry/response_just_in_time_is_taken", "not known so exactly");
  expect_none(uri("exec:" + station("ref")), "fifo/lost_command_is_lost_whole", "not known so exactly");
  expect_none(uri("exec:" + station("ref")), "dip/each_position_is_a_bit_rate", "cannot turn");
  expect_none(uri("exec:" + station("ref"), 31'250), read, "begins later than the host waits");
  const iut::SerialLine box = iut::SerialLine::at_new_terminal(line(), iut::WallClock());
  expect_none(uri(""), read, "without an upper channel");
}

TEST_F(SerialRunsOfAHost, BitRateThatItsSwitchesDoNotHaveIsRefused) {
  const Called called =
      call({"run", "valve_bus/host/response/is_told_once_with_its_id", "--iut", uri("", 9'600)});
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_HOLDS(called.err, "there are 375000, 187500");
}

TEST_F(SerialRuns, SilentBoxDoesNotAnswer) {
  const iut::SerialLine box = iut::SerialLine::at_new_terminal(line(), iut::WallClock());
  EXPECT_EQ(judged(uri(""), {"read/is_answered"}).at("read/is_answered").reason, "no_answer");
}

TEST_F(SerialRuns, FloodIsAVerdict) {
  iut::SerialLine box = iut::SerialLine::at_new_terminal(line(), iut::WallClock());
  std::jthread flood([&](const std::stop_token& stop) {
    const std::vector<std::uint8_t> octets(512, 0x55);
    try {
      while (!stop.stop_requested()) box.write(octets);
    } catch (const kernel::Error&) {
      // Nobody reads any more.
    }
  });
  // On a busy machine whoever floods may not get to it.
  Case flooded;
  for (int tries = 0; tries < 10 && flooded.reason != "implementation_floods"; ++tries)
    flooded = judged(uri(""), {"read/is_answered"}).at("read/is_answered");
  EXPECT_EQ(flooded.reason, "implementation_floods") << flooded.findings;
}

TEST_F(SerialRuns, BoxThatVanishesIsAVerdict) {
  auto box = std::make_unique<iut::SerialLine>(iut::SerialLine::at_new_terminal(line(), iut::WallClock()));
  std::jthread unplug([&] {
    iut::ask_for_real_time();
    // The end of the first command.
    for (std::size_t heard = 0; heard < 5;) {
      if (const auto arrival = box->read(kernel::kNever)) heard += arrival->octets.size();
    }
    box.reset();
  });
  // So slow that it has vanished before anybody gives its answer up.
  const Case gone = judged(uri("", 1'200), {"read/is_answered"}).at("read/is_answered");
  EXPECT_EQ(gone.reason, "implementation_gone") << gone.findings;
}

TEST_F(SerialRuns, WhatCannotBeUsedEndsTheRun) {
  const std::vector<std::pair<std::string, int>> all{
      {"serial:./nothing", 5},      {"serial:/dev/null", 5},          {"serial:", 64},
      {"serial:./line?baud=x", 64}, {"serial:./line?format=7e1", 64}, {"serial:./line?upper=exec:false", 5}};
  for (const auto& [wrong, code] : all)
    EXPECT_EQ(call({"run", "valve_bus/node/read/is_answered", "--iut", wrong}).exit_code, code) << wrong;
}

// What is wrong is told by the same case over the line as in lock step.
class SerialRunsMutants : public SerialRuns, public testing::WithParamInterface<MutantInC> {
 protected:
  void expect_found(const std::string& mutant) {
    const Case found = judged_when_quiet(uri("exec:" + mutant), GetParam().test_case);
    if (found.reason == kInDoubt)
      GTEST_SKIP() << "not judged: this machine was never quiet enough for " << GetParam().test_case;
    EXPECT_EQ(found.reason, GetParam().reason) << found.verdict << found.findings;
  }

 public:
  static std::string name_of(const testing::TestParamInfo<MutantInC>& one) { return one.param.name; }
};

class SerialRunsOfNodesInC : public SerialRunsMutants {};

TEST_P(SerialRunsOfNodesInC, IsFoundByTheCaseThatNamesIt) {
  expect_found(in_c(GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(InC, SerialRunsOfNodesInC, testing::ValuesIn(kMutantsInC),
                         SerialRunsMutants::name_of);

class SerialRunsOfWrongHosts : public SerialRunsMutants {
 protected:
  SerialRunsOfWrongHosts() { role_ = "valve_bus/host"; }
};

TEST_P(SerialRunsOfWrongHosts, IsFoundByTheCaseThatNamesIt) {
  expect_found(station(std::string("mutant:") + GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(
    OfTheReference, SerialRunsOfWrongHosts,
    testing::Values(
        MutantInC{"data_exchanged", "request/write_is_sent_with_its_check", "request_wrong"},
        MutantInC{"response_exchanged", "response/is_told_once_with_its_id", "response_wrong"},
        MutantInC{"delimiter_missing", "timing/delimiter_is_in_front_of_each_request", "no_delimiter"},
        MutantInC{"driver_stays_on", "timing/driver_is_on_for_requests_only", "driver_not_released"}),
    SerialRunsMutants::name_of);

}  // namespace
}  // namespace fieldproof::cli

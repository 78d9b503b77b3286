#include "cli/attachments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/probe/mutants_in_c.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/iut/peer.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/iut/process.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

const fs::path kExamples = kSourceFolder / "examples/valve_node";
constexpr std::string_view kSuite = "valve_bus/node/";

std::string in_quotes(const fs::path& path) {
  return "'" + path.string() + "'";
}

class Attachments : public ProgramFixture {
 protected:
  struct Case {
    std::string verdict;
    std::string reason;
    std::string fingerprint;
    std::string findings;

    friend bool operator==(const Case&, const Case&) = default;
  };
  using Cases = std::map<std::string, Case>;

  // The real program over these cases of the suite; under a sanitizer, which sees the same way to the
  // implementation in each of them, over a share of a whole suite.
  Cases judged(const std::string& uri, const std::string& cases = "**",
               const std::map<std::string, std::string>& environment = {}, const std::string& pics = {},
               const std::string& suite = std::string(kSuite)) {
    const std::string out = "run" + std::to_string(++runs_);
    std::vector<std::string> words{"run",  suite + cases, "--volume", "quick", "--record",
                                   "none", "--iut",       uri,        "--out", out};
    leave_out(suite, words);
    if (kernel::kIsSanitized && cases == "**")
      words.insert(words.end(), {"--shard", "1/" + std::to_string(kOneOf)});
    if (!pics.empty()) {
      write("node.pics.json", pics);
      words.insert(words.end(), {"--pics", "node.pics.json"});
    }
    Call made = prepared(words);
    made.environment = environment;
    const Called called = made.run();
    EXPECT_TRUE(called.exit_code == 0 || called.exit_code == 1) << called.exit_code << called.err;
    Cases found;
    if (read(out + "/results.json").empty()) return found;
    const nlohmann::json results = json(out + "/results.json");
    for (const auto& one : results.at("cases")) {
      const std::string id = one.at("id").get<std::string>().substr(suite.size());
      found[id] = {one.at("verdict"), one.at("reason"), one.at("fingerprint"), one.at("findings").dump()};
    }
    return found;
  }

  // Derived cases are most calls of a suite; what is attached another way once more need not answer them
  // again.
  void leave_out_derived() { leaves_out_derived_ = true; }

  // How many cases of a whole suite are judged.
  std::size_t count_of(const std::string& suite) {
    std::vector<std::string> words{"list", suite + "**", "--count"};
    leave_out(suite, words);
    const std::size_t all = std::stoul(prepared(words).run().out);
    return (all + kOneOf - 1) / kOneOf;
  }

  // A warn says something of the bus.
  static bool is_kept(const Case& one) { return one.verdict == "pass" || one.verdict == "warn"; }

  // Who hears telegrams hears whole ones: cases under bursts and about levels are not for it.
  void expect_passes(const std::string& uri, const std::string& suite = std::string(kSuite),
                     bool hears_telegrams = false) {
    const Cases cases = judged(uri, "**", {}, {}, suite);
    EXPECT_EQ(cases.size(), count_of(suite)) << uri;
    for (const auto& [id, one] : cases) {
      const bool is_left_out = hears_telegrams && (id.starts_with("immunity/") || kOfLevels.contains(id));
      EXPECT_TRUE(is_left_out ? one.verdict == "not-applicable" : is_kept(one))
          << uri << ": " << id << ": " << one.verdict << ": " << one.reason << one.findings;
    }
  }

 private:
  void leave_out(const std::string& suite, std::vector<std::string>& words) const {
    if (!leaves_out_derived_) return;
    words.emplace_back("!+derived");
    // Those of a basic station again.
    if (suite.ends_with("_las/")) words.push_back("!" + suite + "standby/**");
  }

  inline static const std::set<std::string> kOfLevels{
      "frame/without_its_code_is_none", "frame/a_start_delimiter_begins_anew",
      "frame/a_tail_is_no_silence",     "frame/two_in_one_transmission_are_received",
      "frame/levels_may_be_finer",      "frame/what_is_in_front_is_left",
      "frame/a_jabber_changes_nothing", "frame/jitter_is_taken"};
  static constexpr std::size_t kOneOf = kernel::kIsSanitized ? 8 : 1;

  int runs_ = 0;
  bool leaves_out_derived_ = false;
};

const std::string kStation = "exec:" + in_quotes(FIELDPROOF_EXE) + " station valve_bus/node ";
const std::string kInC = "exec:" + in_quotes(VALVE_NODE_PROCESS) + " ";
const std::string kPluginInC = "plugin:" VALVE_NODE_PLUGIN;

// A role, and two of its mutants with a case that says what is wrong.
struct Served {
  struct Wrong {
    const char* mutant;
    const char* test_case;
    const char* reason;
  };
  const char* role;
  std::array<Wrong, 2> wrong;

  friend void PrintTo(const Served& one, std::ostream* out) { *out << one.role; }
};

class ServedRoles : public Attachments, public testing::WithParamInterface<Served> {};

// Verdicts, findings and fingerprints of each case: to the bit.
TEST_P(ServedRoles, BuiltInStationInAProcessIsJudgedAsInside) {
  const std::string suite = std::string(GetParam().role) + "/";
  const std::string station = "exec:" + in_quotes(FIELDPROOF_EXE) + " station " + GetParam().role + " ";
  if (kernel::kIsSanitized) leave_out_derived();
  const Cases inside = judged("ref", "**", {}, {}, suite);
  EXPECT_EQ(inside.size(), count_of(suite));
  EXPECT_EQ(judged(station, "**", {}, {}, suite), inside);
  leave_out_derived();
  for (const auto& [mutant, test_case, reason] : GetParam().wrong) {
    const std::string cases = kernel::kIsSanitized ? test_case : "**";
    const Cases wrong = judged("mutant:" + std::string(mutant), cases, {}, {}, suite);
    EXPECT_EQ(wrong.at(test_case).reason, reason) << mutant;
    EXPECT_EQ(judged(station + "mutant:" + mutant, cases, {}, {}, suite), wrong) << mutant;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Roles, ServedRoles,
    testing::Values(
        Served{
            "valve_bus/node",
            {{{"turns_round_late", "read/is_answered", "answer_too_late"},
              {"any_command_reads", "command/undefined_commands_are_ignored", "acts_on_undefined_command"}}}},
        Served{"valve_bus/host",
               {{{"sends_any_command", "request/undefined_commands_are_refused", "undefined_command_sent"},
                 {"request_check_is_sum", "request/check_is_the_exclusive_or", "check_wrong"}}}},
        Served{
            "interbus/slave",
            {{{"output_octets_swapped", "data_cycle/process_data_is_exact", "output_word_wrong"},
              {"latches_late", "data_cycle/outputs_change_after_the_check_phase", "outputs_latched_late"}}}},
        Served{"interbus/master",
               {{{"outputs_torn", "application/outputs_change_as_a_whole", "outputs_torn"},
                 {"wrong_segment", "rejection/marked_status_names_the_segment", "wrong_segment"}}}},
        Served{"fieldbus_dll/isa_dle",
               {{{"no_frame_under_et", "single_token/one_frame_is_sent", "no_data_frame"},
                 {"priority_inverted", "single_token/lower_priorities_wait", "lower_priority_sent"}}}},
        Served{"fieldbus_dll/isa_las",
               {{{"schedule_late", "schedule/each_item_has_its_time", "delegation_late"},
                 {"never_retakes", "transfer/what_is_not_taken_is_retaken", "not_retaken"}}}},
        Served{"fieldbus_dll/ff_device",
               {{{"buffer_torn", "publisher/a_buffer_is_published_whole", "buffer_torn"},
                 {"fit_is_strict", "token/what_fits_exactly_is_sent_and_no_more", "exact_fit_not_sent"}}}},
        Served{"fieldbus_dll/ff_las",
               {{{"token_over_due", "schedule/each_item_has_its_time", "compelled_late"},
                 {"probes_unpolled", "circulation/each_probes", "probes_unpolled"}}}},
        Served{
            "token_bus/station",
            {{{"lowest_opens_one_window", "passing/the_lowest_opens_two_windows", "window_wrong"},
              {"error_bit_ignored", "reception/frames_with_the_error_bit_are_left", "acts_on_error_bit"}}}},
        Served{
            "token_bus/translator",
            {{{"pad_idle_as_zero", "encoding/preamble_and_start_delimiter_are_an_sfd", "preamble_is_no_sfd"},
              {"reset_enables_transmitter", "management/the_transmitter_waits_for_its_command",
               "sends_unasked"}}}},
        Served{"token_bus/channel_manager",
               {{{"sends_on_a_alone", "requests/go_out_on_both_channels", "not_on_both"},
                 {"reports_the_other_channel", "faults/a_missing_start_delimiter_is_reported",
                  "report_wrong"}}}}),
    [](const testing::TestParamInfo<Served>& one) {
      std::string name = one.param.role;
      std::ranges::replace(name, '/', '_');
      return name;
    });

// A slave takes part in the cases of a network as well, in a process of its own at each place; so does a
// master.
TEST_F(Attachments, StationsOfANetworkAreProcesses) {
  const std::string slave = "exec:" + in_quotes(FIELDPROOF_EXE) + " station interbus/slave ";
  const std::string suite = "interbus/network/";
  const Cases inside = judged("ref", "**", {}, {}, suite);
  EXPECT_EQ(inside.size(), count_of(suite));
  EXPECT_EQ(judged("slave@2=" + slave, "**", {}, {}, suite), inside);
  const std::string master = "exec:" + in_quotes(FIELDPROOF_EXE) + " station interbus/master ";
  EXPECT_EQ(judged("master=" + master, "**", {}, {}, suite), inside);
}

TEST_F(Attachments, NodeInCPassesAsAProcess) {
  expect_passes(kInC);
}

// Its driver comes and goes in transmissions of their own: at a low bit rate they are as many as characters.
TEST_F(Attachments, NodeInCPassesAtTheLowestBitRateWithAcknowledge) {
  leave_out_derived();
  const std::string pics = R"({ "items": { "bit_rate": 2404, "answers_writes": true } })";
  std::set<std::string> not_applicable;
  for (const auto& [id, one] : judged(kInC, "**", {}, pics)) {
    if (one.verdict == "not-applicable")
      not_applicable.insert(id);
    else
      EXPECT_TRUE(is_kept(one)) << id << ": " << one.reason << one.findings;
  }
  const std::set<std::string> at_other_rates{"loss/afterwards_the_node_serves_as_before",
                                             "loss/commands_to_it_are_signs_of_life",
                                             "loss/limit_of_8_milliseconds",
                                             "loss/of_12_ms_leaves_answers_whole",
                                             "loss/of_5_ms_leaves_answers_whole",
                                             "loss/spoilt_commands_are_no_signs_of_life",
                                             "loss/what_others_are_sent_delays_nothing",
                                             "loss/writes_that_are_answered_are_signs_of_life",
                                             "loss/wrong_parity_is_no_sign_of_life",
                                             "settings/serves_1000000_bits_per_second",
                                             "settings/serves_1200_bits_per_second",
                                             "settings/serves_187500_bits_per_second",
                                             "settings/serves_62500_bits_per_second",
                                             "settings/serves_9600_bits_per_second"};
  if (kernel::kIsSanitized)
    EXPECT_THAT(at_other_rates, testing::IsSupersetOf(not_applicable));
  else
    EXPECT_EQ(not_applicable, at_other_rates);
}

TEST_F(Attachments, NodeInCPassesAsALibraryInAProcessOfItsOwn) {
  leave_out_derived();
  expect_passes(kPluginInC);
}

TEST_F(Attachments, NodeInCPassesAsALibraryInTheBench) {
  expect_passes(kPluginInC + "?in-process");
}

TEST_F(Attachments, NodeInPythonPasses) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  expect_passes("exec:" + in_quotes(python) + " " + in_quotes(kExamples / "node.py"));
}

// Written from the page of the role.
TEST_F(Attachments, InterbusSlaveInPythonPasses) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path slave = kSourceFolder / "examples/interbus_slave/slave.py";
  expect_passes("exec:" + in_quotes(python) + " " + in_quotes(slave), "interbus/slave/");
}

// What looks at levels alone does not apply to one that hears telegrams; in a network both take part.
TEST_F(Attachments, InterbusSlaveInPythonPassesInTelegrams) {
  leave_out_derived();
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path slave = kSourceFolder / "examples/interbus_slave/slave_telegrams.py";
  const std::string uri = "exec:" + in_quotes(python) + " " + in_quotes(slave);
  // With this seed a disturbed telegram comes half a bit before the one before it is over.
  const Cases cases = judged(uri, "**", {{"FIELDPROOF_SEED", "3"}}, {}, "interbus/slave/");
  EXPECT_EQ(cases.size(), judged("ref", "**", {}, {}, "interbus/slave/").size());
  int not_applicable = 0;
  for (const auto& [id, one] : cases) {
    if (one.verdict == "not-applicable") {
      ++not_applicable;
    } else {
      EXPECT_EQ(one.verdict, "pass") << id << ": " << one.reason << one.findings;
    }
  }
  EXPECT_TRUE(not_applicable == 6 || kernel::kIsSanitized) << not_applicable;
  expect_passes("slave@2=" + uri, "interbus/network/");
}

// Its suite plays the ring; in a network slaves answer it.
TEST_F(Attachments, InterbusMasterInPythonPasses) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path master = kSourceFolder / "examples/interbus_master/master.py";
  const std::string uri = "exec:" + in_quotes(python) + " " + in_quotes(master);
  expect_passes(uri, "interbus/master/");
  expect_passes("master=" + uri, "interbus/network/");
}

TEST_F(Attachments, InterbusMasterInPythonPassesInTelegrams) {
  leave_out_derived();
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path master = kSourceFolder / "examples/interbus_master/master_telegrams.py";
  const std::string uri = "exec:" + in_quotes(python) + " " + in_quotes(master);
  expect_passes(uri, "interbus/master/");
  expect_passes("master=" + uri, "interbus/network/");
}

// What the page leaves to a master, or asks of it, each once accused or a fault of these.
TEST_F(Attachments, InterbusMastersInPythonAreRightInWhatIsTheirChoice) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const std::vector<std::pair<std::string, std::string>> sequences{
      {R"("silence_limit": 1238572000001)", ""},
      {R"("telegram_gap_millibits": 11201, "stop_after_bad_cycles": 1)",
       R"({"do": "extra", "kind": 2, "telegram": 0})"},
      {R"("end_telegrams": 897)", R"({"do": "outputs", "even": 0, "odd": 1}, {"do": "identify"})"},
      {R"("forward_delay_half_bits": 100)", R"({"do": "ring", "change": 1, "station": 0})"},
      {R"("stop_after_bad_cycles": 2)",
       R"({"do": "lost", "count": 2, "level": 1}, {"do": "start", "disturbed": 2})"},
      {R"("bit_rate": 10000000)", ""},
      {R"("end_telegrams": 749)", R"({"do": "bad", "count": 1}, {"do": "cycles", "count": 1},
                                     {"do": "cut", "station": 0})"},
      {"",
       R"({"do": "power", "ring": 0, "expects": 0, "copies": 1, "cycle_ms": 0, "disturbed": 0, "limits": 0},
              {"do": "ring", "change": 2, "station": 0}, {"do": "start", "disturbed": 0})"}};
  for (const char* file : {"master.py", "master_telegrams.py"}) {
    const std::string uri =
        "exec:" + in_quotes(python) + " " + in_quotes(kSourceFolder / "examples/interbus_master" / file);
    for (const auto& [settings, commands] : sequences) {
      write("case.json", R"({"schema": "fieldproof/sequence/1", "role": "interbus/master", "seed": "1",
             "implementations": [{"role": "master", "position": 0, "uri": "ref"}],
             "settings": {)" +
                             settings + R"(}, "commands": [)" + commands +
                             R"(], "verdict": "pass", "reason": "", "fingerprint": "0000000000000000"})");
      const Called called = prepared({"replay", "case.json", "--iut", uri}).run();
      EXPECT_EQ(called.exit_code, 0) << file << settings << commands << called.out << called.err;
      EXPECT_HOLDS(called.out, "pass ");
    }
  }
}

// Written from the pages of the roles; each of their faults that names a case is found by it.
struct FaultyProgram {
  const char* name;  // of the test
  const char* role;  // "PROTOCOL/ROLE"
  const char* file;  // of examples
  const char* options = "";
};

class FaultsInPython : public Attachments, public testing::WithParamInterface<FaultyProgram> {};

TEST_P(FaultsInPython, PassesAndBreaksAsItsFaultsSay) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path file = kSourceFolder / "examples" / GetParam().file;
  const std::string program = in_quotes(python) + " " + in_quotes(file) + " " + GetParam().options;
  const std::string role = GetParam().role;
  const std::string suite = role + "/";
  // What a sanitizer looks at is the same in each case.
  if (!kernel::kIsSanitized) expect_passes("exec:" + program, suite);
  const std::unique_ptr<FILE, int (*)(FILE*)> list(popen((program + " --list-faults").c_str(), "r"), pclose);
  ASSERT_NE(list, nullptr);
  std::array<char, 256> line{};
  unsigned faults = 0;
  for (kernel::FewerIfSanitized few(4); std::fgets(line.data(), line.size(), list.get()) != nullptr;) {
    std::istringstream words(line.data());
    std::string name;
    std::string test_case;
    words >> name >> test_case;
    // The whole lists of the data link hold what is judged by hand, too.
    if (test_case.find('/') == std::string::npos) continue;
    ++faults;
    // Under a sanitizer such a case has too few sequences to find what it finds.
    if (few.leaves_out() || (kernel::kIsSanitized && test_case.starts_with("derived/"))) continue;
    const Cases cases = judged(role + "=exec:" + program + " --fault " + name, test_case, {}, {}, suite);
    EXPECT_EQ(cases.at(test_case).verdict, "fail") << name;
  }
  EXPECT_GE(faults, 7U);
}

INSTANTIATE_TEST_SUITE_P(
    Roles, FaultsInPython,
    testing::Values(
        FaultyProgram{"station", "token_bus/station", "token_bus/station.py"},
        FaultyProgram{"translator", "token_bus/translator", "token_bus/translator.py"},
        FaultyProgram{"channel_manager", "token_bus/channel_manager", "token_bus/channel_manager.py"},
        FaultyProgram{"interbus_slave", "interbus/slave", "interbus_slave/faults.py"},
        FaultyProgram{"interbus_master", "interbus/master", "interbus_master/faults.py"},
        FaultyProgram{"ff_device", "fieldbus_dll/ff_device", "ff_device/device.py", "--units levels"},
        FaultyProgram{"isa_dle", "fieldbus_dll/isa_dle", "isa_dle/dle.py", "--units levels"},
        FaultyProgram{"valve_node", "valve_bus/node", "valve_node/node_faults.py"},
        FaultyProgram{"valve_host", "valve_bus/host", "valve_host/host_faults.py"}),
    [](const auto& one) { return std::string(one.param.name); });

// It hears frames; no case of its role drives anything else.
TEST_F(Attachments, FfDeviceInPythonPasses) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const fs::path device = kSourceFolder / "examples/ff_device/device.py";
  expect_passes("exec:" + in_quotes(python) + " " + in_quotes(device), "fieldbus_dll/ff_device/", true);
}

// Verdicts and reasons, where levels are not all that is looked at; cases are in conformance's test of it.
TEST_F(Attachments, BuiltInStationsInTelegramsAreJudgedAsInside) {
  leave_out_derived();
  for (const auto& [role, mutant, test_case] :
       {std::array{"slave", "output_octets_swapped", "data_cycle/process_data_is_exact"},
        std::array{"master", "wrong_segment", "rejection/marked_status_names_the_segment"}}) {
    const std::string suite = std::string("interbus/") + role + "/";
    const std::string station =
        "exec:" + in_quotes(FIELDPROOF_EXE) + " station interbus/" + role + " --units telegrams ";
    for (const auto& [id, one] : judged(station, "**", {}, {}, suite)) {
      EXPECT_TRUE(one.verdict == "pass" || one.verdict == "not-applicable") << id << one.findings;
    }
    const Case wrong = judged(station + "mutant:" + mutant, test_case, {}, {}, suite).at(test_case);
    EXPECT_EQ(wrong.verdict, "fail");
    EXPECT_EQ(wrong.reason,
              judged(std::string("mutant:") + mutant, test_case, {}, {}, suite).at(test_case).reason);
  }
  for (const char* wrong : {"valve_bus/node --units telegrams", "interbus/slave --units octets"}) {
    std::istringstream words(wrong);
    std::vector<std::string> call_of{"station"};
    for (std::string word; words >> word;) call_of.push_back(word);
    EXPECT_EQ(call(call_of).exit_code, 64) << wrong;
  }
}

TEST_F(Attachments, NodeInNodeJsPasses) {
  const std::string node = installed("node");
  ASSERT_FALSE(node.empty()) << "there is no node on the PATH; script/setup test installs it";
  expect_passes("exec:" + in_quotes(node) + " " + in_quotes(kExamples / "node.mjs"));
}

// Begins to listen some time after it was started.
void wait_for_listener(const std::string& path) {
  for (int n = 0; n < 20'000; ++n) {
    try {
      iut::Peer::at_unix_socket("unix:" + path, path);
      return;
    } catch (const kernel::Error&) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
  ADD_FAILURE() << "nobody listens at " << path;
}

TEST_F(Attachments, NodeBehindASocketPasses) {
  const std::string python = installed("python3");
  ASSERT_FALSE(python.empty()) << "there is no python3 on the PATH; script/setup test installs it";
  const std::string path = (folder_ / "socket").string();
  iut::Process listener({python, (kExamples / "node.py").string(), path});
  wait_for_listener(path);
  expect_passes("unix:" + path);
  EXPECT_FALSE(listener.has_ended(milliseconds(0))) << listener.how_it_ended();
}

TEST_F(Attachments, MutantOfALibraryIsSeenInBothPlaces) {
  const std::map<std::string, std::string> swapped{{"VALVE_NODE", "data_swapped"}};
  for (const char* place : {"", "?in-process"}) {
    const Cases cases = judged(kPluginInC + place, "write/drives_the_valves", swapped);
    EXPECT_EQ(cases.at("write/drives_the_valves").reason, "valves_wrong") << place;
  }
}

// Nothing can be judged: the run ends before it begins, with the words of whoever knows why.
TEST_F(Attachments, WhatCannotBeAttachedEndsTheRunWithAllThatIsKnown) {
  write("empty.so", "");
  const std::vector<std::pair<std::string, std::string>> all = {
      {"exec:false", "ended with exit code 1"},
      {"exec:echo 'Hello world'", "\"Hello world.\""},
      {"exec:sh -c 'echo cannot open the bus >&2; exit 3'", "log: cannot open the bus"},
      {"exec:./there_is_no_such_program", "cannot be started: "},
      {"unix:./nobody", "unix:./nobody: nobody can be reached there: "},
      {"plugin:./empty.so", "plugin:./empty.so: cannot be loaded: "},
      {"plugin:./empty.so?in-process", "plugin:./empty.so: cannot be loaded: "},
  };
  for (const auto& [uri, sentence] : all) {
    const Called called = call({"run", "valve_bus/node/read/is_answered", "--volume", "quick", "--iut", uri});
    EXPECT_EQ(called.exit_code, 5) << uri;
    EXPECT_HOLDS(called.err, sentence);
  }
}

// Hosts and masters are told orders in characters; the others ask no more of the library than that it serves
// the role.
TEST_F(Attachments, LibraryWithoutCharactersIsRefusedBeforeTheRunWhereTheRoleIsToldSome) {
  const std::string characters = "has no function 'receive'; its role receives characters";
  const std::vector<std::pair<std::string, std::string>> all = {
      {"valve_bus/node/read/is_answered", "does not serve the role 'valve_bus/node'"},
      {"valve_bus/host/request/check_is_the_exclusive_or", characters},
      {"interbus/slave/data_cycle/process_data_is_exact", "does not serve the role 'interbus/slave'"},
      {"interbus/master/application/outputs_change_as_a_whole", characters},
  };
  for (const std::string place : {"", "?in-process"}) {
    for (const auto& [test_case, sentence] : all) {
      const Called called =
          call({"run", test_case, "--volume", "quick", "--iut", "plugin:" ODD_PLUGIN_LEVELS_ONLY + place});
      EXPECT_EQ(called.exit_code, 5) << test_case << place;
      EXPECT_HOLDS(called.err, sentence);
    }
  }
}

// What can be read at once is one message: twenty of them end in the middle of the case.
TEST_F(Attachments, DeathInARunIsAVerdictWithEvidence) {
  const std::string one = "read/is_answered";
  write("dies.sh", "dd bs=65536 count=20 2>/dev/null | " + in_quotes(VALVE_NODE_PROCESS) +
                       "\necho the bus is gone >&2\nkill -SEGV $$\n");
  const Case dead = judged("exec:sh dies.sh", one).at(one);
  EXPECT_EQ(dead.verdict, "fail") << dead.findings;
  EXPECT_EQ(dead.reason, "implementation_crashed");
  EXPECT_HOLDS(dead.findings, "was ended by signal 11");
  EXPECT_HOLDS(dead.findings, "log: the bus is gone");
}

// Without protection it can end the program: not as if all had passed.
TEST_F(Attachments, ALibraryThatEndsTheProgramIsNoPass) {
  for (const std::string end : {"exit", "_exit"}) {
    if (kernel::kIsSanitized && end == "_exit") continue;  // theirs is not replaced
    write("ends.c", "void " + end + "(int);\n__attribute__((constructor)) static void ends(void) { " + end +
                        "(0); }\n");
    Call compiler = prepared({"-shared", "-fPIC", "ends.c", "-o", "ends.so"}, installed("cc"));
    ASSERT_EQ(compiler.run().exit_code, 0);
    const Called called = call({"run", "valve_bus/node/read/is_answered", "--volume", "quick", "--iut",
                                "plugin:./ends.so?in-process"});
    EXPECT_EQ(called.exit_code, 5) << end;
    EXPECT_HOLDS(called.err, "before all was done");
  }
}

class NobodyActs final : public iut::Bench {
  void set_driver(unsigned, bool, kernel::Time) override { ADD_FAILURE(); }
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override { ADD_FAILURE(); }
  void transmit(unsigned, line::Waveform&) override { ADD_FAILURE(); }
  void write(iut::Item, std::uint64_t, kernel::Time) override { ADD_FAILURE(); }
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

// It is in this process: dividing by a rate of none would end the test.
TEST(ExampleNode, HasARateOfItsOwnWhereNoneIsTold) {
  const auto node = iut::load_plugin(VALVE_NODE_PLUGIN, "valve_bus", "node");
  NobodyActs bench;
  const iut::Character heard{kernel::kStart, kernel::kStart + 176 * kernel::kMicrosecond, 0x163};
  for (const std::int64_t rate : {0, -1, 62'500}) {
    iut::CaseBegin begin{"valve_bus/node/any", 0, {{"bit_rate", rate}}};
    if (rate == 0) begin.settings.clear();
    ASSERT_TRUE(node->begin(begin, bench));
    node->set_power(true, kernel::kStart);
    node->receive(0, std::span(&heard, 1), heard.busy_until);
    // 4.5 characters of 11 bits and one bit, of 16 us each.
    EXPECT_EQ(node->next_time() - heard.busy_until, 808 * kernel::kMicrosecond) << rate;
    node->end();
  }
}

TEST_F(Attachments, CommandThatIsNoneIsAMistakeOfTheCommandLine) {
  for (const char* wrong : {"exec:", "exec:'./node", "tcp:host", "plugin:", "plugin:x.so?odd"}) {
    EXPECT_EQ(call({"run", "valve_bus/node/read/is_answered", "--iut", wrong}).exit_code, 64) << wrong;
  }
}

class AttachedMutants : public Attachments, public testing::WithParamInterface<MutantInC> {};

TEST_P(AttachedMutants, IsFoundByTheCaseThatNamesIt) {
  const auto [name, test_case, reason] = GetParam();
  const Cases cases = judged(kInC + name, test_case);
  ASSERT_TRUE(cases.contains(test_case));
  EXPECT_EQ(cases.at(test_case).verdict, "fail");
  EXPECT_EQ(cases.at(test_case).reason, reason) << cases.at(test_case).findings;
}

INSTANTIATE_TEST_SUITE_P(InC, AttachedMutants, testing::ValuesIn(kMutantsInC),
                         [](const testing::TestParamInfo<MutantInC>& one) {
                           return std::string(one.param.name);
                         });

}  // namespace
}  // namespace fieldproof::cli

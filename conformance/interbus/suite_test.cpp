#include "conformance/interbus/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "conformance/answer_pairs.hpp"
#include "conformance/catalogue.hpp"
#include "conformance/false_alarms.hpp"
#include "conformance/runner.hpp"
#include "conformance/stressed_receiver.hpp"
#include "harness/iut/device_recording.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"

namespace fieldproof::conformance {
namespace {

const Suite& suite() {
  static const std::unique_ptr<Suite> interbus = interbus_suite();
  return *interbus;
}

const TestCase& case_of(std::string_view id) {
  for (const TestCase& test_case : suite().cases()) {
    if (test_case.id == id) return test_case;
  }
  throw std::logic_error("no case " + std::string(id));
}

conformance::Setup setup_of(std::string role, std::string uri, std::uint64_t seed = 1) {
  conformance::Setup setup;
  setup.seed = seed;
  setup.volume = Volume::quick;
  if (!uri.empty()) setup.implementations = {{std::move(role), 0, std::move(uri)}};
  return setup;
}

TEST(InterbusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  for (std::uint64_t seed = 1; seed <= many_seeds(); ++seed) {
    EXPECT_THAT(false_alarms(suite(), seed), testing::IsEmpty());
  }
}

TEST(InterbusSuite, CanariesFail) {
  int canaries = 0;
  for (const TestCase& test_case : suite().cases()) {
    if (!is_canary(test_case)) continue;
    ++canaries;
    EXPECT_EQ(run_case({&suite(), &test_case}, setup_of("", "")).outcome.result.verdict,
              judge::Verdict::fail);
  }
  EXPECT_EQ(canaries, 3);
}

TEST(InterbusSuite, NoTwoAnswersOfAPicsAccuseAReference) {
  // The reference holds its outputs while an outgoing bus is reset.
  const auto plays = [](const std::string&, const judge::Pics& pics) -> std::optional<Assignment> {
    if (pics.text("outputs_while_outgoing_bus_is_reset", "held") == "held") return std::nullopt;
    return Assignment{"slave", 0, "mutant:outgoing_reset_clears_outputs"};
  };
  // What masters declare are texts, and the reference does one of the answers to each only.
  const std::vector<AnswerPairs> roles =
      pairs_of_answers(suite(), kernel::kIsSanitized ? 40 : 1, {.plays = plays, .left_out = "master"});
  ASSERT_EQ(roles.size(), 1U);
  for (const AnswerPairs& one : roles) {
    EXPECT_THAT(one.accused, testing::IsEmpty()) << one.role;
    EXPECT_THAT(one.left_open, testing::IsEmpty()) << one.role;
    EXPECT_GT(one.declarations, 0U) << one.role;
    EXPECT_LT(one.refused, one.pairs / 2) << one.role;
    RecordProperty(one.role, std::to_string(one.declarations) + " declarations of " +
                                 std::to_string(one.pairs) + " pairs");
  }
}

TEST(InterbusSuite, OneSeedReplaysEveryBit) {
  for (kernel::FewerIfSanitized few(4); const TestCase& test_case : suite().cases()) {
    if (few.leaves_out()) continue;
    const auto once = run_case({&suite(), &test_case}, setup_of("", ""));
    const auto again = run_case({&suite(), &test_case}, setup_of("", ""));
    EXPECT_EQ(once.outcome.result.fingerprint, again.outcome.result.fingerprint) << test_case.id;
  }
}

// Whether a stored recording of the implementation leads to the verdict that the implementation had.
void expect_same_verdict_from_recording(const std::string& id, const std::string& role,
                                        const std::string& uri) {
  conformance::Setup setup = setup_of(role, uri);
  setup.record = setup.as_device = true;
  const Outcome first = suite().run(case_of(id), setup);
  // Of the longest cases more is drawn than is kept of a trace; what the implementation did is whole.
  const bool is_long = id.ends_with("/each_value_of_each_word") || id.ends_with("/run_after_run") ||
                       id.ends_with("/each_of_twelve_stations") || has_tag(case_of(id), "derived");
  ASSERT_TRUE(is_long || !first.recording.truncated) << id;
  ASSERT_NE(first.recording.devices, nullptr);
  // A thousand rings that are recognised are more than is kept; `judge` says so.
  if (first.recording.devices->is_truncated()) {
    EXPECT_TRUE(has_tag(case_of(id), "derived")) << id;
    return;
  }
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) /
                                     ("playback_of_" + role + "_" + std::to_string(getpid()) + ".json");
  std::ofstream(path) << first.recording.devices->text();
  conformance::Setup playing = setup_of(role, uri);
  playing.as_device = true;
  playing.playback_file = path.string();
  const Outcome again = suite().run(case_of(id), playing);
  std::filesystem::remove(path);
  EXPECT_EQ(again.result.verdict, first.result.verdict) << id << " " << uri;
  EXPECT_EQ(again.result.reason, first.result.reason) << id << " " << uri;
}

TEST(InterbusSuite, ARecordingHasLinesForPeople) {
  conformance::Setup setup = setup_of("", "");
  setup.record = true;
  for (const char* id : {"interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told",
                         "interbus/master/rejection/marked_status_names_the_segment"}) {
    EXPECT_FALSE(suite().run(case_of(id), setup).recording.lines().empty()) << id;
  }
}

TEST(InterbusSuite, EveryCasesOwnRecordingIsJudgedLikeTheRun) {
  for (kernel::FewerIfSanitized few(4); const TestCase& test_case : suite().cases()) {
    if (few.leaves_out()) continue;
    expect_same_verdict_from_recording(test_case.id, test_case.role(), "ref");
  }
}

TEST(InterbusSuite, ARecordingIsJudgedLikeTheImplementationItself) {
  const std::string slave = "interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told";
  expect_same_verdict_from_recording(slave, "slave", "ref");
  expect_same_verdict_from_recording(slave, "slave", "mutant:does_not_mark_status");
  const std::string master = "interbus/master/rejection/marked_status_names_the_segment";
  expect_same_verdict_from_recording(master, "master", "ref");
  expect_same_verdict_from_recording(master, "master", "mutant:wrong_segment");
}

TEST(InterbusSuite, AStationOfTheCallersIsJudged) {
  int made = 0;
  const auto own = interbus_suite({.own = own_station<interbus::SlaveRole>(
                                       [&made](const IutRequest&, const interbus::SlaveConfiguration& of) {
                                         ++made;
                                         return std::make_unique<interbus::Slave>(of);
                                       })});
  // In the first one a slave is silent, and asked another time.
  const TestCase& test_case = own->cases()[1];
  EXPECT_EQ(own->run(test_case, setup_of("slave", "own")).result.verdict, judge::Verdict::pass);
  EXPECT_EQ(made, 1);
}

// A receiver after a cable that loses whatever is sent.
class Deaf final : public fault::Channel {
  bool pass(const line::Waveform&, line::Waveforms&) override { return true; }
};

TEST(InterbusSuite, CasesOfStressesAreThereWithStresses) {
  const auto has_stress_tag = [](const TestCase& test_case) { return has_tag(test_case, kStressTag); };
  EXPECT_EQ(std::ranges::count_if(suite().cases(), has_stress_tag), 0);
  const fault::Stress deaf{"nothing arrives for 2 ms", 2 * kernel::kMillisecond,
                           [](const fault::StressPlace&) { return std::make_unique<Deaf>(); }};
  const auto stressed = interbus_suite({.disturbances = {.stresses = {deaf}}});
  EXPECT_EQ(std::ranges::count_if(stressed->cases(), has_stress_tag), 3);
  for (const TestCase& test_case : stressed->cases()) {
    if (!has_stress_tag(test_case)) continue;
    EXPECT_EQ(stressed->run(test_case, setup_of(test_case.role(), "ref")).result.verdict,
              judge::Verdict::pass)
        << test_case.id;
  }
  EXPECT_EQ(stressed->mutants().size(), suite().mutants().size() + 4) << "networks that only bursts tell";
}

// A file that lives as long as the test needs it.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view text)
      : path_(std::filesystem::path(testing::TempDir()) / ("suite_" + std::to_string(getpid()) + ".json")) {
    std::ofstream(path_) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(InterbusSuite, AStationOfTheCallersTakesPartInEveryCaseThatHasItsRole) {
  const auto own =
      interbus_suite({.own = own_station<interbus::SlaveRole>(
                          [](const IutRequest&, const interbus::SlaveConfiguration& configuration) {
                            return std::make_unique<interbus::Slave>(configuration);
                          })});
  for (const TestCase& test_case : own->cases()) {
    const bool has_role = test_case.role() == "slave" || std::ranges::count(test_case.parts, "slave") > 0;
    if (!has_role || is_canary(test_case)) continue;
    if (kernel::kIsSanitized && has_tag(test_case, "derived")) continue;
    EXPECT_EQ(own->run(test_case, setup_of("slave", "own")).result.verdict, judge::Verdict::pass)
        << test_case.id;
  }
}

// The cycle is that of the network's frame, whichever of the published formulas it names.
TEST(InterbusSuite, TheCycleTimeIsJudgedByTheFrameWhateverFormulaIsNamed) {
  const TestCase& test_case = case_of("interbus/network/timing/cycle_time_is_that_of_the_formula");
  for (const std::string formula : {"f1", "f2", "f3", "f4", "f5"}) {
    for (const std::string rules : {R"({})", R"({"end_telegrams": 2})", R"({"software_time": "700 us"})"}) {
      const TemporaryFile network(R"({"name": "n", "bit_rate": "500 kbit/s", "formula": ")" + formula +
                                  R"(", "rules": )" + rules +
                                  R"(, "stations": [{"name": "a", "id_code": "0x0203"}]})");
      conformance::Setup setup = setup_of("", "");
      setup.network_file = network.path();
      const Outcome outcome = suite().run(test_case, setup);
      EXPECT_EQ(outcome.result.verdict, judge::Verdict::pass) << formula << " " << rules;
    }
  }
}

std::string refusal_of_plan(const std::string& text) {
  const TemporaryFile plan(text);
  conformance::Setup setup = setup_of("", "");
  setup.plan_file = plan.path();
  try {
    suite().run(case_of("interbus/network/timing/cycles_do_not_jitter"), setup);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "";
}

TEST(InterbusSuite, APlanThatNamesWhatARingDoesNotHaveIsRefused) {
  const auto with = [](const std::string& when) {
    return R"({"rules": [{"when": {)" + when + R"(}, "effect": {"flip": {}}, "times": 1}]})";
  };
  EXPECT_NE(refusal_of_plan(with(R"("receiver": "slave 1 in")")).find("slave@1/in"), std::string::npos);
  EXPECT_NE(refusal_of_plan(with(R"("field": "fcs")")).find("field \"fcs\""), std::string::npos);
  EXPECT_NE(refusal_of_plan(with(R"("frame": "data")")).find("data_cycle"), std::string::npos);
  EXPECT_NE(refusal_of_plan(with(R"("after": {"observation": "outputs"})")).find("\"output\""),
            std::string::npos);
  EXPECT_EQ(refusal_of_plan(with(R"("receiver": "slave@*", "field": "check", "frame": "data_cycle")")), "");
}

TEST(InterbusSuite, ARuleWaitsForWhatTheUpperTesterSees) {
  const TemporaryFile plan(R"({"rules": [{"when": {"receiver": "slave@1/in", "field": "check",
      "after": {"observation": "data_cycle_accepted", "nth": 10}}, "effect": {"flip": {}}, "times": 1}]})");
  conformance::Setup setup = setup_of("", "");
  const TestCase& test_case = case_of("interbus/network/exchange/nothing_is_rejected_without_faults");
  EXPECT_EQ(suite().run(test_case, setup).result.verdict, judge::Verdict::pass);
  setup.plan_file = plan.path();
  EXPECT_EQ(suite().run(test_case, setup).result.verdict, judge::Verdict::fail);
}

TEST(InterbusSuite, TheFingerprintKnowsTheOutputs) {
  const TestCase& test_case = case_of("interbus/slave/frame_check/leaves_for_what_the_slave_itself_sent");
  const auto fingerprint = [&](const std::string& uri) {
    return suite().run(test_case, setup_of("slave", uri)).result.fingerprint;
  };
  EXPECT_NE(fingerprint("mutant:output_octets_swapped"), fingerprint("ref"));
}

TEST(InterbusSuite, WhatCannotBeServedIsRefusedWithNearNames) {
  try {
    suite().run(suite().cases().front(), setup_of("slave", "mutant:crc_preset_zer"));
    FAIL() << "an unknown mutant was taken";
  } catch (const kernel::Error& error) {
    EXPECT_NE(std::string(error.what()).find("crc_preset_zero"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fieldproof::conformance

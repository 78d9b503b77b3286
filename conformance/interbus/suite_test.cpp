#include "conformance/interbus/suite.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "conformance/catalogue.hpp"
#include "conformance/matrix.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/error.hpp"
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

// Sanitizers make a run some twenty times slower; what they look for does not hide in the seeds.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FIELDPROOF_UNDER_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FIELDPROOF_UNDER_SANITIZER
#endif
#endif
#ifdef FIELDPROOF_UNDER_SANITIZER
constexpr std::uint64_t kSeeds = 3;
#else
constexpr std::uint64_t kSeeds = 100;
#endif

TEST(InterbusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const TestCase& test_case : suite().cases()) {
      if (is_canary(test_case)) continue;
      const CaseRun done = run_case({&suite(), &test_case}, setup_of("", "", seed));
      EXPECT_EQ(done.outcome.result.verdict, judge::Verdict::pass)
          << test_case.id << " seed " << seed << ": " << done.outcome.result.reason;
    }
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

TEST(InterbusSuite, TheMatrixHasNoHole) {
  MatrixPlan plan;
  plan.jobs = 2;
  const Matrix matrix = make_matrix(suite(), plan);
  for (const Hole& hole : matrix.holes) ADD_FAILURE() << hole.sentence;
}

TEST(InterbusSuite, OneSeedReplaysEveryBit) {
  for (const TestCase& test_case : suite().cases()) {
    const auto once = run_case({&suite(), &test_case}, setup_of("", ""));
    const auto again = run_case({&suite(), &test_case}, setup_of("", ""));
    EXPECT_EQ(once.outcome.result.fingerprint, again.outcome.result.fingerprint) << test_case.id;
  }
}

// Whether a stored recording of the implementation leads to the verdict that the implementation had.
void expect_same_verdict_from_recording(const std::string& id, const std::string& role,
                                        const std::string& uri) {
  conformance::Setup setup = setup_of(role, uri);
  setup.record = true;
  const Outcome first = suite().run(case_of(id), setup);
  ASSERT_FALSE(first.recording.truncated);
  ASSERT_FALSE(first.recording.playback.empty());
  EXPECT_FALSE(first.recording.lines.empty());
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) /
                                     ("playback_of_" + role + "_" + std::to_string(getpid()) + ".json");
  std::ofstream(path) << first.recording.playback;
  const Outcome again = suite().run(case_of(id), setup_of(role, "recorded:" + path.string()));
  std::filesystem::remove(path);
  EXPECT_EQ(again.result.verdict, first.result.verdict) << id << " " << uri;
  EXPECT_EQ(again.result.reason, first.result.reason) << id << " " << uri;
}

TEST(InterbusSuite, ARecordingIsJudgedLikeTheImplementationItself) {
  const std::string slave = "interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told";
  expect_same_verdict_from_recording(slave, "slave", "ref");
  expect_same_verdict_from_recording(slave, "slave", "deviant:does_not_mark_status");
  const std::string master = "interbus/master/rejection/marked_status_names_the_segment";
  expect_same_verdict_from_recording(master, "master", "ref");
  expect_same_verdict_from_recording(master, "master", "deviant:wrong_segment");
}

TEST(InterbusSuite, AStationOfTheCallersIsJudged) {
  int made = 0;
  const auto own = interbus_suite({.make_slave = [&made](const interbus::SlaveConfiguration& configuration) {
    ++made;
    return std::make_unique<interbus::Slave>(configuration);
  }});
  const TestCase& test_case = own->cases().front();
  EXPECT_EQ(own->run(test_case, setup_of("slave", "own")).result.verdict, judge::Verdict::pass);
  EXPECT_EQ(made, 1);
}

TEST(InterbusSuite, WhatCannotBeServedIsRefusedWithNearNames) {
  try {
    suite().run(suite().cases().front(), setup_of("slave", "deviant:crc_preset_zer"));
    FAIL() << "an unknown deviation was taken";
  } catch (const kernel::Error& error) {
    EXPECT_NE(std::string(error.what()).find("crc_preset_zero"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fieldproof::conformance

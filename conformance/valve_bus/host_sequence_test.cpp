#include "conformance/valve_bus/host_sequence.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "conformance/sequence_check.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_scene.hpp"
#include "conformance/valve_bus/host_vocabulary.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

const Suite& suite_with_hosts() {
  static const std::unique_ptr<Suite> suite = valve_bus_suite();
  return *suite;
}

SequenceSearch host_search_of(const std::string& uri, std::uint64_t cases) {
  SequenceSearch one;
  one.suite = &suite_with_hosts();
  one.role = &host_sequence_role();
  one.setup.implementations = {{"host", 0, uri}};
  one.cases = cases;
  return one;
}

std::string host_lines(const SequenceSearchResult& result) {
  if (!result.found) return "";
  std::string text = result.found->outcome.result.reason + "\n";
  for (const std::string& line : sequence_lines(result.found->smallest, host_sequence_role().vocabulary))
    text += line + "\n";
  return text;
}

TEST(HostSequence, TheReferenceIsNeverAccused) {
  for (kernel::FewerIfSanitized few(3); const std::uint64_t seed : {1U, 2U, 3U}) {
    if (few.leaves_out()) continue;
    SequenceSearch one = host_search_of("ref", kernel::kIsSanitized ? 140 : 700);
    one.setup.seed = seed;
    const SequenceSearchResult result = search(one);
    EXPECT_EQ(result.passed, one.cases) << seed << "\n" << host_lines(result);
  }
}

// An octet that begins when the last stop bit of a refresh is over and the driver still on: no host hears it.
TEST(HostSequence, AnOctetIntoTheDriverAccusesNobody) {
  const SequenceVocabulary& vocabulary = host_sequence_role().vocabulary;
  const auto word = [&](std::string_view name) {
    return static_cast<std::size_t>(vocabulary.find(name) - vocabulary.words.data());
  };
  const Sequence sequence{
      {{word("write"), {1, 0, 0}}, {word("write"), {2, 0, 0}}, {word("stray"), {0}, {0x00}}}};
  const HostCase one{host_sequence_role().test_case,
                     [&](HostBench& bench, CaseJudge& judge) { run_host_sequence(sequence, bench, judge); }};
  HostSetting setting;
  setting.pics.emplace().declare("dip", std::int64_t{7});
  const judge::CaseResult result = run_on_bench(one, setting);
  EXPECT_EQ(result.verdict, judge::Verdict::pass) << result.reason;
}

// What the block check does not see is said of the bus, and of nobody who is judged.
TEST(HostBench, WhatTheCheckDoesNotSeeIsAWarn) {
  for (const HostCase& one : host_cases()) {
    if (one.test_case.id != "valve_bus/host/response/two_wrong_bits_of_a_column_are_taken") continue;
    HostSetting setting;
    setting.volume = Volume::quick;
    const judge::CaseResult result = run_on_bench(one, setting);
    EXPECT_EQ(result.verdict, judge::Verdict::warn);
    EXPECT_EQ(result.reason, "check_does_not_see_it");
    ASSERT_EQ(result.findings.size(), 1U);
    EXPECT_TRUE(result.findings.front().actual.starts_with("24 of 24 responses"));
  }
}

// A character is known when it is over: what a host sends within its first one breaks no silence.
TEST(HostBench, ACharacterThatIsNotOverAccusesNobody) {
  const HostCase one{host_sequence_role().test_case, [](HostBench& bench, CaseJudge& judge) {
                       bench.wait(bench.time_out());
                       bench.write_later(octets_for(bench.read_of(1)), bench.characters(0.5));
                       bench.say(std::array<std::uint8_t, 3>{0x5A, 0xC3, 0x99});
                       const auto frame = bench.next_frame(bench.time_out());
                       judge.expect(frame.has_value(), "no_request", "it sends the read", "nothing");
                       expect_form(bench, judge, *frame);
                     }};
  const judge::CaseResult result = run_on_bench(one, HostSetting{});
  EXPECT_EQ(result.verdict, judge::Verdict::pass) << result.reason;
}

// Each with a fault that no order and no answer alone can show.
TEST(HostSequence, FindsWhatTakesManyCommandsOrAnInstant) {
  for (const char* name :
       {"loses_commands", "fifo_wraps_one_early", "overflow_drops_octets", "resyncs_early",
        "busy_told_as_silence", "requests_late_in_turns", "dip_read_in_operation", "write_distance_missing",
        "refreshes_each_100_ms", "refreshes_go_first", "time_out_fixed", "time_out_long", "late_not_counted",
        "takes_early_response", "right_after_wrong_taken"}) {
    const SequenceSearchResult result = search(host_search_of(std::string("mutant:") + name, 3'000));
    EXPECT_TRUE(result.found) << name;
  }
}

// Also with a host whose receiver stays on, or that reads after each write.
TEST(HostSequence, TheReferenceIsNeverAccusedWithItsOptions) {
  for (kernel::FewerIfSanitized few(3);
       const char* option : {"receives_own_echo", "verifies_writes", "answers_writes"}) {
    if (few.leaves_out()) continue;
    SequenceSearch one = host_search_of("ref", kernel::kIsSanitized ? 140 : 700);
    one.setup.pics.emplace().declare(option, true);
    const SequenceSearchResult result = search(one);
    EXPECT_EQ(result.passed, one.cases) << option << "\n" << host_lines(result);
  }
}

TEST(HostSequence, FindsEachHostForCheckWithAtMostFiveCommands) {
  unsigned found = 0;
  for (kernel::FewerIfSanitized few(3); const Mutant& mutant : suite_with_hosts().mutants()) {
    if (!mutant.is_for_check || mutant.role != "host" || few.leaves_out()) continue;
    const SequenceSearchResult result = search(host_search_of("mutant:" + mutant.name, 5'000));
    ASSERT_TRUE(result.found) << mutant.name;
    EXPECT_TRUE(result.found->is_confirmed) << mutant.name;
    EXPECT_LE(result.found->smallest.commands.size(), 5U) << mutant.name << "\n" << host_lines(result);
    // One that orders many commands is as much as several.
    const auto& smallest = result.found->smallest.commands;
    const bool is_long = smallest.front().word >= static_cast<std::size_t>(HostWord::burst);
    EXPECT_TRUE(is_long || smallest.size() >= 2U) << mutant.name << "\n" << host_lines(result);
    ++found;
  }
  EXPECT_EQ(found, kernel::kIsSanitized ? 2U : 6U);
}

// Each of a period, a setting, an attempt, or what lasts longer than a single order.
TEST(HostSequence, FindsWhatLastsAndWhatHappensDuringAnAttempt) {
  kernel::FewerIfSanitized few(8);
  for (const char* name :
       {"refreshes_when_idle", "any_acknowledge_taken", "acknowledge_not_awaited", "refresh_counts_from_rest",
        "new_write_refreshed_with_old", "milliseconds_of_16_bits", "busy_refresh_is_the_last",
        "refreshes_64_nodes", "part_over_power_loss", "verified_against_newest", "no_rest_behind_wrong",
        "late_behind_wrong", "first_late_counted", "late_counter_of_8_bits", "pc_restarts_time_out",
        "repeats_from_the_ring"}) {
    if (few.leaves_out()) continue;
    EXPECT_TRUE(search(host_search_of(std::string("mutant:") + name, 1'000)).found) << name;
  }
}

}  // namespace
}  // namespace fieldproof::conformance

// Subject: the sequence roles of several protocols: rules of their findings, references that were once
// accused, and the states that walks go through.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "conformance/derived_cases.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/reference_walks.hpp"
#include "conformance/sequence_check.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

struct TestedRole {
  std::unique_ptr<Suite> suite;
  const SequenceRole* sequences = nullptr;  // of the suite; none when there is no such role
};

TestedRole tested_role(const std::string& path) {
  const std::string protocol = path.substr(0, path.find('/'));
  TestedRole tested{protocol == "valve_bus"      ? valve_bus_suite()
                    : protocol == "interbus"     ? interbus_suite()
                    : protocol == "fieldbus_dll" ? fieldbus_dll_suite()
                                                 : token_bus_suite()};
  for (const SequenceRole& role : tested.suite->sequence_roles()) {
    if (path == protocol + "/" + role.test_case.role()) tested.sequences = &role;
  }
  return tested;
}

class SequenceRulesTest : public testing::TestWithParam<const char*> {};

// A sequence is about everything at once: its finding says which rule was broken, not that one of them was.
TEST_P(SequenceRulesTest, EachDeclaredReasonHasOne) {
  const TestedRole tested = tested_role(GetParam());
  ASSERT_NE(tested.sequences, nullptr);
  const TestCase& all = tested.sequences->test_case;
  for (const DerivedCatch& derived : tested.sequences->derived_catches)
    EXPECT_NE(all.requirement_of(derived.caught.reason), all.requirement) << derived.caught.reason;
  for (const TestCase& one : tested.suite->cases()) {
    if (one.role() != all.role() || one.requirement != all.requirement) continue;
    for (const MustCatch& caught : one.catches)
      EXPECT_NE(one.requirement_of(caught.reason), one.requirement) << one.id << " " << caught.reason;
  }
}

// Each three commands are tens of thousands: of them a run takes others with each seed.
TEST_P(SequenceRulesTest, AtFullVolumeAllThatIsAboutOneThingIsRun) {
  if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: a sanitizer takes fewer sequences";
  const TestedRole tested = tested_role(GetParam());
  ASSERT_NE(tested.sequences, nullptr);
  for (const DerivedExtent& one : derived_extents(*tested.sequences)) {
    EXPECT_GT(one.quick, 0U) << one.id;
    if (one.kind == DerivedKind::words) {
      EXPECT_GE(one.full, 5'000U) << one.id;
    } else {
      EXPECT_EQ(one.full, one.there_are) << one.id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Roles, SequenceRulesTest,
                         testing::Values("interbus/slave", "interbus/master", "valve_bus/node",
                                         "valve_bus/host", "fieldbus_dll/ff_device", "fieldbus_dll/ff_las",
                                         "fieldbus_dll/isa_dle", "fieldbus_dll/isa_las", "token_bus/station",
                                         "token_bus/translator", "token_bus/channel_manager"),
                         [](const auto& role) {
                           std::string name = role.param;
                           std::ranges::replace(name, '/', '_');
                           return name;
                         });

struct OnceAccused {
  const char* what;
  const char* role;
  field::Settings settings;
  std::vector<NamedCommand> commands{};
};

class ReferenceSequencesTest : public testing::TestWithParam<OnceAccused> {};

TEST_P(ReferenceSequencesTest, AreNotAccused) {
  const TestedRole tested = tested_role(GetParam().role);
  ASSERT_NE(tested.sequences, nullptr);
  const SequenceVocabulary& vocabulary = tested.sequences->vocabulary;
  const Sequence sequence{with_beginnings(vocabulary, {GetParam().commands}).beginnings.back(),
                          GetParam().settings};
  const judge::CaseResult result = run_sequence(*tested.suite, *tested.sequences, sequence, {}).result;
  EXPECT_EQ(result.verdict, judge::Verdict::pass) << result.reason;
}

INSTANTIATE_TEST_SUITE_P(
    Roles, ReferenceSequencesTest,
    testing::Values(OnceAccused{"a_stop_within_a_cycle_of_a_second",
                                "interbus/master",
                                {{"telegram_gap_millibits", 512'019}, {"end_telegrams", 1'000}},
                                {{"early_order", {{"state", 0}, {"order", 0}}}}},
                    OnceAccused{"a_recognition_with_cycles_of_two_seconds",
                                "interbus/master",
                                {{"telegram_gap_millibits", 1'000'000}, {"end_telegrams", 1'000}},
                                {{"early_order", {{"state", 1}, {"order", 2}}}}},
                    OnceAccused{"an_item_that_leaves_an_idle_no_time",
                                "fieldbus_dll/ff_las",
                                {{"response_delay_slots", 10}, {"inter_pdu_delay_octets", 47}}},
                    OnceAccused{"urgent_data_that_has_no_time_in_any_turn",
                                "fieldbus_dll/ff_las",
                                {{"response_delay_slots", 9}, {"inter_pdu_delay_octets", 38}},
                                {{"flood", {{"priority", 3}, {"count", 6}, {"size", 64}}}}},
                    OnceAccused{"a_token_spent_with_long_preambles",
                                "fieldbus_dll/ff_las",
                                {{"preamble_octets", 8}, {"response_delay_slots", 9}},
                                {{"spend"}, {"obey", {{"count", 5}}}}},
                    OnceAccused{"what_fits_but_for_picoseconds",
                                "fieldbus_dll/isa_dle",
                                {{"bit_rate", 31'330}},
                                {{"submit", {{"size", 0}}},
                                 {"sequence", {{"to", 0}, {"from", 0}, {"least", 2}, {"octets", 33}}}}},
                    OnceAccused{"tokens_that_were_not_passed_before_the_first_window",
                                "token_bus/station",
                                {{"transmitter_fault_limit", 8}},
                                {{"failures", {{"times", 7}}}, {"many", {{"what", 0}, {"times", 17}}}}}),
    [](const auto& one) { return std::string(one.param.what); });

struct ToldApart {
  const char* role;
  bool is_so;
};

class ReferenceWalksTest : public testing::TestWithParam<ToldApart> {};

// What queues and counts has states that only two commands or more tell apart: there, walks promise nothing
// about machines of as many states. docs/limits.md says so of each role.
TEST_P(ReferenceWalksTest, SingleCommandsTellItsStatesApart) {
  if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: under sanitizers there are fewer states";
  const TestedRole tested = tested_role(GetParam().role);
  ASSERT_NE(tested.sequences, nullptr);
  EXPECT_EQ(surprise_of(*tested.suite, *tested.sequences).empty(), GetParam().is_so) << GetParam().role;
}

INSTANTIATE_TEST_SUITE_P(
    Roles, ReferenceWalksTest,
    testing::Values(ToldApart{"valve_bus/node", true}, ToldApart{"token_bus/translator", true},
                    ToldApart{"interbus/slave", false}, ToldApart{"fieldbus_dll/ff_device", false},
                    ToldApart{"fieldbus_dll/isa_dle", false}, ToldApart{"token_bus/channel_manager", false}),
    [](const auto& one) {
      std::string name = one.param.role;
      std::ranges::replace(name, '/', '_');
      return name;
    });

}  // namespace
}  // namespace fieldproof::conformance

#include "conformance/fieldbus_dll/isa_sequence_check.hpp"

#include <gtest/gtest.h>

#include "conformance/fieldbus_dll/sequence_checks.hpp"

namespace fieldproof::conformance {
namespace {

const SequenceChecks& isa_dle_checks() {
  static const SequenceChecks checks{"isa_dle", isa_dle_sequence_role()};
  return checks;
}

TEST(IsaDleSequence, TheReferenceFollowsTheModel) {
  isa_dle_checks().expect_reference_follows(2'000);
}

TEST(IsaDleSequence, FindsEachStationForCheckWithFewCommands) {
  isa_dle_checks().expect_finds_each(10, 20'000, 6);
}

// Else it would be no fault of sequences.
TEST(IsaDleSequence, NoSingleCommandTellsThem) {
  isa_dle_checks().expect_single_commands_pass(250);
}

// V(FD) of more than eight bits needs a V(RR) of more, too: two settings that are seldom drawn together.
// Addresses are those that the frames of sequences have, and their user asks for what there is; cases have
// the rest.
TEST(IsaDleSequence, FindsWhatTheCatalogueNames) {
  isa_dle_checks().expect_finds_all_but(
      {"forms_within_eight_bits", "unknown_requests_taken", "orders_taken", "unknown_service_is_unit_data",
       "priority_zero_accepted", "priority_four_accepted", "waits_for_urgent_data", "waits_for_any_data",
       "lengths_of_the_usual_link", "first_address_of_the_usual_link", "last_address_of_the_usual_link",
       "impossible_rules_taken", "impossible_once_only", "deaf_behind_71_minutes"},
      20'000);
}

}  // namespace
}  // namespace fieldproof::conformance

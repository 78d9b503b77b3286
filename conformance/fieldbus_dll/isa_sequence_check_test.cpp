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
  isa_dle_checks().expect_finds_each(10, 4'000, 5);
}

// Else it would be no fault of sequences.
TEST(IsaDleSequence, NoSingleCommandTellsThem) {
  isa_dle_checks().expect_single_commands_pass(250);
}

// In a sequence the line is as it should be; what comes is of a kind and a length that the
// station knows, with normal priority; an exact fit and a check from another start do not come by chance, and
// its user is never late.
TEST(IsaDleSequence, FindsWhatTheCatalogueNames) {
  isa_dle_checks().expect_finds_all_but(
      {"does_not_recover_clock", "wants_exact_edges", "length_not_checked", "priority_zero_taken",
       "reserved_bit_ignored", "zero_is_for_ever", "tells_normal_priority", "fit_is_strict",
       "check_from_zero_too", "does_not_wait_for_user", "rr_runs_through_reply"},
      12'000);
}

}  // namespace
}  // namespace fieldproof::conformance

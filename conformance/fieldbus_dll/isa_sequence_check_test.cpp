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

// In a sequence the line has the clock that it should have, and what comes is of a kind that the station
// knows; a reserved bit and a check from another start do not come by chance.
TEST(IsaDleSequence, FindsWhatTheCatalogueNames) {
  isa_dle_checks().expect_finds_all_but(
      {
          "does_not_recover_clock",
          "wants_exact_edges",
          "reserved_bit_ignored",
          "zero_is_for_ever",
          "check_from_zero_too",
          "codes_of_the_usual_link",
          // Times that sequences do not set, or not to half a bit.
          "forms_within_the_usual_time",
          "forms_within_eight_bits",
          "forms_half_a_bit_longer",
          "waits_eight_bits",
      },
      20'000);
}

}  // namespace
}  // namespace fieldproof::conformance

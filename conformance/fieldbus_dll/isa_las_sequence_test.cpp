#include "conformance/fieldbus_dll/isa_las_sequence.hpp"

#include <gtest/gtest.h>

#include "conformance/fieldbus_dll/sequence_checks.hpp"

namespace fieldproof::conformance {
namespace {

const SequenceChecks& isa_las_checks() {
  static const SequenceChecks checks{"isa_las", isa_las_sequence_role()};
  return checks;
}

TEST(IsaLasSequence, TheReferenceFollowsTheRules) {
  isa_las_checks().expect_reference_follows(700);
}

TEST(IsaLasSequence, FindsEachSchedulerForCheckWithFewCommands) {
  isa_las_checks().expect_finds_each(6, 4'000, 5);
}

// Else it would be no fault of sequences.
TEST(IsaLasSequence, NoSingleCommandTellsThem) {
  isa_las_checks().expect_single_commands_pass(250);
}

// Nobody gives a scheduler in standby a token that it may use; its schedule is short, and goes round.
TEST(IsaLasSequence, FindsWhatTheCatalogueNames) {
  isa_las_checks().expect_finds_all_but(
      {"deaf_in_standby", "sixteen_items", "period_of_32_bits", "clock_of_32_bits",
       "no_data_after_its_schedule", "no_schedule_after_its_schedule", "items_in_32_bits",
       "duration_of_15_bits"},
      500);
}

}  // namespace
}  // namespace fieldproof::conformance

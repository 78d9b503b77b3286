#include "conformance/fieldbus_dll/ff_las_sequence.hpp"

#include <gtest/gtest.h>

#include "conformance/fieldbus_dll/sequence_checks.hpp"

namespace fieldproof::conformance {
namespace {

const SequenceChecks& ff_las_checks() {
  static const SequenceChecks checks{"ff_las", ff_las_sequence_role()};
  return checks;
}

TEST(FfLasSequence, TheReferenceFollowsTheModel) {
  ff_las_checks().expect_reference_follows(1'000);
}

TEST(FfLasSequence, FindsEachSchedulerForCheckWithFewCommands) {
  ff_las_checks().expect_finds_each(9, 4'000, 6);
}

// Else it would be no fault of sequences.
TEST(FfLasSequence, NoSingleCommandTellsThem) {
  ff_las_checks().expect_single_commands_pass(250);
}

// A rotation of V(TTRT) to an octet is left open, and no item is at the last instant of a macrocycle.
TEST(FfLasSequence, FindsWhatTheCatalogueNames) {
  ff_las_checks().expect_finds_all_but({"equal_rotation_is_fast", "refuses_its_last_instant"}, 2'000);
}

}  // namespace
}  // namespace fieldproof::conformance

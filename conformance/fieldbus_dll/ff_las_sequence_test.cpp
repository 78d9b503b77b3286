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
  ff_las_checks().expect_finds_each(11, 4'000, 5);
}

// Else it would be no fault of sequences.
TEST(FfLasSequence, NoSingleCommandTellsThem) {
  ff_las_checks().expect_single_commands_pass(250);
}

// Nobody else claims the link in a sequence, or gets it; nodes keep to their tokens and answer for
// themselves; the scheduler publishes nothing; a rotation of V(TTRT) to an octet is left open.
TEST(FfLasSequence, FindsWhatTheCatalogueNames) {
  ff_las_checks().expect_finds_all_but({"equal_rotation_is_fast",
                                        "claims_after_one_slot",
                                        "never_claims",
                                        "claims_a_slot_late",
                                        "claims_a_slot_early",
                                        "frames_do_not_save_the_link",
                                        "noise_does_not_save_the_link",
                                        "transfer_ignored",
                                        "transfer_not_checked",
                                        "takes_transfer_of_others",
                                        "never_leaves",
                                        "stays_behind_claim",
                                        "schedule_version_ignored",
                                        "order_ignored",
                                        "stays_behind_transfer",
                                        "deaf_in_standby",
                                        "never_retakes",
                                        "schedule_from_the_claim",
                                        "told_live_list_ignored",
                                        "holder_never_stopped",
                                        "return_of_anybody_taken",
                                        "probe_response_of_anybody_taken",
                                        "own_buffer_kept"},
                                       300);
}

}  // namespace
}  // namespace fieldproof::conformance

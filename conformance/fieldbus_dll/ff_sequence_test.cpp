#include "conformance/fieldbus_dll/ff_sequence.hpp"

#include <gtest/gtest.h>

#include "conformance/fieldbus_dll/sequence_checks.hpp"

namespace fieldproof::conformance {
namespace {

const SequenceChecks& ff_device_checks() {
  static const SequenceChecks checks{"ff_device", ff_device_sequence_role()};
  return checks;
}

TEST(FfDeviceSequence, TheReferenceFollowsTheModel) {
  ff_device_checks().expect_reference_follows(2'000);
}

TEST(FfDeviceSequence, FindsEachDeviceForCheckWithFewCommands) {
  ff_device_checks().expect_finds_each(13, 4'000, 5);
}

// Else it would be no fault of sequences.
TEST(FfDeviceSequence, NoSingleCommandTellsThem) {
  ff_device_checks().expect_single_commands_pass(250);
}

// In a sequence the device is live from the start, on a usual link; what comes is of a kind and a length that
// it knows, tokens are of 2000 octets at most, with short addresses and normal priority; an exact fit, 255
// writes and a check without its complement do not come by chance.
TEST(FfDeviceSequence, FindsWhatTheCatalogueNames) {
  ff_device_checks().expect_finds_all_but({"activated_by_anything",
                                           "activated_by_broadcast",
                                           "activated_by_its_users_data",
                                           "answers_cd_offline",
                                           "live_from_the_start",
                                           "silence_of_the_usual_link",
                                           "impossible_rules_taken",
                                           "two_octets_of_preamble",
                                           "es_is_pt",
                                           "priority_zero_taken",
                                           "tail_ignored",
                                           "long_read_as_short",
                                           "tells_normal_priority",
                                           "fit_is_strict",
                                           "counts_to_255",
                                           "takes_other_residue",
                                           "preamble_of_the_usual_link",
                                           "codes_of_the_usual_link",
                                           "duration_of_12_bits",
                                           "duration_with_sign",
                                           "deaf_to_long_frames",
                                           "subscribed_without_link"},
                                          2'000);
}

}  // namespace
}  // namespace fieldproof::conformance

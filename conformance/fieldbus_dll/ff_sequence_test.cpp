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
  ff_device_checks().expect_finds_each(13, 12'000, 6);
}

// Else it would be no fault of sequences.
TEST(FfDeviceSequence, NoSingleCommandTellsThem) {
  ff_device_checks().expect_single_commands_pass(250);
}

// In a sequence settings are possible; V(MID) of more than six bits needs a longer V(MRD) x V(ST), too: two
// settings that are seldom drawn together. Nor are there words for requests that there are not, other lists
// and data lengths, nodes above 7F, two frames for the station in a transmission, finer levels or an hour of
// silence, and the user submits between transmissions.
TEST(FfDeviceSequence, FindsWhatTheCatalogueNames) {
  ff_device_checks().expect_finds_all_but(
      {"impossible_rules_taken", "silence_of_six_bits", "unknown_requests_taken", "orders_taken",
       "priority_zero_accepted", "priority_four_accepted", "no_data_is_the_usual_data", "buffers_of_64",
       "four_buffers", "eight_subscriptions", "lost_beside_the_last", "node_with_sign", "bits_counted_on",
       "last_of_a_transmission", "deaf_behind_71_minutes", "levels_are_half_bits"},
      12'000);
}

}  // namespace
}  // namespace fieldproof::conformance

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
// settings that are seldom drawn together. Lists of settings, as of the data lengths, and how many buffers
// there are, are those of the bench.
TEST(FfDeviceSequence, FindsWhatTheCatalogueNames) {
  ff_device_checks().expect_finds_all_but(
      {"impossible_rules_taken", "silence_of_six_bits", "no_data_is_the_usual_data", "refuses_once",
       "thirty_two_buffers", "sixty_four_subscriptions"},
      12'000);
}

}  // namespace
}  // namespace fieldproof::conformance

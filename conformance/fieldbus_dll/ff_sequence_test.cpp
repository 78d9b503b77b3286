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

// In a sequence the codes are the usual ones, and settings are possible.
TEST(FfDeviceSequence, FindsWhatTheCatalogueNames) {
  ff_device_checks().expect_finds_all_but(
      {"silence_of_the_usual_link", "impossible_rules_taken", "es_is_pt", "takes_other_residue",
       "preamble_of_the_usual_link", "codes_of_the_usual_link",
       // Times and codes that sequences do not set, or not to half a bit; and how much is taken.
       "silence_of_six_bits", "slot_of_eight_bits", "waits_half_a_bit_longer", "time_by_the_usual_code",
       "half_a_bit_into_what_follows", "takes_256"},
      12'000);
}

}  // namespace
}  // namespace fieldproof::conformance

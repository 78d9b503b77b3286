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
  ff_device_checks().expect_finds_each(12, 4'000, 5);
}

// Else it would be no fault of sequences.
TEST(FfDeviceSequence, NoSingleCommandTellsThem) {
  ff_device_checks().expect_single_commands_pass(250);
}

}  // namespace
}  // namespace fieldproof::conformance

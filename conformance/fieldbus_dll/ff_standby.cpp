#include "conformance/fieldbus_dll/ff_standby.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/fieldbus_dll/ff_sequence.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::string_view kOfDevice = "fieldbus_dll/ff_device/";
constexpr std::string_view kOfStandby = "fieldbus_dll/ff_las/standby/";

// It would claim the link meanwhile; what bursts do at a receiver does not depend on who has the link.
constexpr std::array<std::string_view, 4> kOfDeviceOnly{
    "fieldbus_dll/ff_device/immunity/bursts_ask_for_nothing_at_31250_bit_s",
    "fieldbus_dll/ff_device/immunity/bursts_ask_for_nothing_at_1_mbit_s",
    "fieldbus_dll/ff_device/probe/a_long_silence_changes_nothing",
    "fieldbus_dll/ff_device/probe/after_72_minutes_it_is_what_it_was"};

constexpr std::int64_t kLongestWait = 200;  // octets, of the words

void put_in_standby(TestCase& test_case) {
  test_case.id = std::string(kOfStandby) + test_case.id.substr(kOfDevice.size());
  test_case.requirement = "In standby, too: " + test_case.requirement;
}

FfCase in_standby(const FfCase& of_device) {
  FfCase made = of_device;
  TestCase& test_case = made.test_case;
  put_in_standby(test_case);
  // An order to hand the link over is taken in standby.
  std::erase_if(test_case.catches, [](const MustCatch& one) { return one.mutant == "orders_taken"; });
  for (MustCatch& one : test_case.catches) one.mutant = std::string(kStandbyMutant) + one.mutant;
  made.needs.is_in_standby = true;
  if (made.asked_with) made.asked_with->is_in_standby = true;
  return made;
}

constexpr std::array<std::int64_t, 2> kWaitsInStandby{40, kLongestWait};
constexpr std::array<std::int64_t, 3> kRequestsInStandby{7, 0x80, 0xFF};

SequenceVocabulary words_in_standby(SequenceVocabulary vocabulary) {
  const auto word = [&](std::string_view name) -> SequenceWord& {
    return *std::ranges::find(vocabulary.words, name, &SequenceWord::word);
  };
  word("wait").numbers[0] = {"octets", 1, kLongestWait, 40, kWaitsInStandby};
  word("ask").numbers[0] = {"request", 4, 255, 7, kRequestsInStandby};
  FIELDPROOF_CHECK(vocabulary.words.back().word == "idle", "minutes of silence are the last word");
  vocabulary.words.pop_back();
  return vocabulary;
}

}  // namespace

std::vector<FfCase> ff_standby_cases(const std::vector<FfCase>& all) {
  std::vector<FfCase> made;
  for (const FfCase& one : all) {
    const std::string& id = one.test_case.id;
    if (!id.starts_with(kOfDevice) || is_canary(one.test_case) ||
        std::ranges::find(kOfDeviceOnly, id) != kOfDeviceOnly.end())
      continue;
    made.push_back(in_standby(one));
  }
  return made;
}

const SequenceRole& ff_standby_sequence_role() {
  static const SequenceRole role = [] {
    SequenceRole made = ff_device_sequence_role();
    put_in_standby(made.test_case);
    made.vocabulary = words_in_standby(without_settings(std::move(made.vocabulary)));
    std::erase_if(made.derived_catches,
                  [](const DerivedCatch& one) { return one.kind == DerivedKind::settings; });
    for (DerivedCatch& one : made.derived_catches)
      one.caught.mutant = std::string(kStandbyMutant) + one.caught.mutant;
    return made;
  }();
  return role;
}

// It claims the link after V(ST) x V(TN), and what takes it over has the version of another schedule.
FfNeeds ff_standby_sequence_needs() {
  FfNeeds needs = ff_device_sequence_needs();
  needs.is_in_standby = true;
  needs.change = [of_device = needs.change](fieldbus_dll::FfConfiguration& device) {
    of_device(device);
    device.rules.link.slot_time_octets *= 2;
    device.rules.link.response_delay_slots /= 2;
    ++device.schedule.version;
  };
  return needs;
}

}  // namespace fieldproof::conformance

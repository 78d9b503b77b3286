#include "conformance/fieldbus_dll/ff_standby.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

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

FfCase in_standby(const FfCase& of_device) {
  FfCase made = of_device;
  TestCase& test_case = made.test_case;
  test_case.id = std::string(kOfStandby) + test_case.id.substr(kOfDevice.size());
  test_case.requirement = "In standby, too: " + test_case.requirement;
  // An order to hand the link over is taken in standby.
  std::erase_if(test_case.catches, [](const MustCatch& one) { return one.mutant == "orders_taken"; });
  for (MustCatch& one : test_case.catches) one.mutant = std::string(kStandbyMutant) + one.mutant;
  made.needs.is_in_standby = true;
  if (made.asked_with) made.asked_with->is_in_standby = true;
  return made;
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

}  // namespace fieldproof::conformance

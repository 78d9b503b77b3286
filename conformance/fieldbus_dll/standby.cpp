#include "conformance/fieldbus_dll/standby.hpp"

#include <array>
#include <utility>

#include "conformance/fieldbus_dll/ff_sequence.hpp"
#include "conformance/fieldbus_dll/ff_standby.hpp"
#include "conformance/fieldbus_dll/isa_sequence_check.hpp"
#include "conformance/fieldbus_dll/isa_standby.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {

namespace {

constexpr std::array<std::string_view, 6> kSettingsInStandby{"most_data_1",
                                                             "most_data_2",
                                                             "most_data_3",
                                                             "preamble_octets",
                                                             "returns_with_last_data",
                                                             "supports_long_addresses"};

}  // namespace

void put_in_standby(MustCatch& caught) {
  caught.mutant = std::string(kStandbyMutant) + caught.mutant;
}

void put_in_standby(TestCase& test_case, const Standby& standby) {
  test_case.id = std::string(standby.of_master) + test_case.id.substr(standby.of_station.size());
  test_case.requirement = "In standby, too: " + test_case.requirement;
  // An order to hand the link over is taken in standby.
  std::erase_if(test_case.catches, [](const MustCatch& one) { return one.mutant == "orders_taken"; });
  for (MustCatch& one : test_case.catches) put_in_standby(one);
}

SequenceRole sequences_in_standby(SequenceRole of_station, const Standby& standby,
                                  void (*words)(SequenceVocabulary&)) {
  put_in_standby(of_station.test_case, standby);
  // The others move the instant at which it would claim the link.
  std::erase_if(of_station.vocabulary.settings, [](const SequenceSetting& one) {
    return std::ranges::find(kSettingsInStandby, one.name) == kSettingsInStandby.end();
  });
  words(of_station.vocabulary);
  for (DerivedCatch& one : of_station.derived_catches) put_in_standby(one.caught);
  return of_station;
}

bool is_caught(std::string_view mutant, const std::vector<MustCatch>& catches) {
  return std::ranges::any_of(catches, [&](const MustCatch& one) { return one.mutant == mutant; });
}

namespace {

SequenceWord& word_in(SequenceVocabulary& vocabulary, std::string_view name) {
  return *std::ranges::find(vocabulary.words, name, &SequenceWord::word);
}

// ---- FF-P ----

// It would claim the link meanwhile; what bursts do at a receiver does not depend on who has the link.
constexpr std::array<std::string_view, 4> kOfFfDeviceOnly{
    "fieldbus_dll/ff_device/immunity/bursts_ask_for_nothing_at_31250_bit_s",
    "fieldbus_dll/ff_device/immunity/bursts_ask_for_nothing_at_1_mbit_s",
    "fieldbus_dll/ff_device/probe/a_long_silence_changes_nothing",
    "fieldbus_dll/ff_device/probe/after_72_minutes_it_is_what_it_was"};
constexpr Standby kFfStandby{"fieldbus_dll/ff_device/", "fieldbus_dll/ff_las/standby/", kOfFfDeviceOnly};

// Without silences in which it would claim the link.
void ff_words_in_standby(SequenceVocabulary& vocabulary) {
  static constexpr std::int64_t kLongestWait = 200;  // octets
  static constexpr std::array<std::int64_t, 2> kWaits{40, kLongestWait};
  word_in(vocabulary, "wait").numbers[0] = {"octets", 1, kLongestWait, 40, kWaits};
  // 3 is the order of a link master.
  static constexpr std::array<std::int64_t, 3> kRequests{7, 0x80, 0xFF};
  word_in(vocabulary, "ask").numbers[0] = {"request", 4, 255, 7, kRequests};
  FIELDPROOF_CHECK(vocabulary.words.back().word == "idle", "minutes of silence are the last word");
  vocabulary.words.pop_back();
}

// ---- ISA-D ----

constexpr std::array<std::string_view, 2> kOfIsaStationOnly{
    "fieldbus_dll/isa_dle/immunity/bursts_ask_for_nothing_at_31250_bit_s",
    "fieldbus_dll/isa_dle/immunity/bursts_ask_for_nothing_at_1_mbit_s"};
constexpr Standby kIsaStandby{"fieldbus_dll/isa_dle/", "fieldbus_dll/isa_las/standby/", kOfIsaStationOnly};

}  // namespace

std::vector<FfCase> ff_standby_cases(const std::vector<FfCase>& all) {
  return cases_in_standby(all, kFfStandby);
}

const SequenceRole& ff_standby_sequence_role() {
  static const SequenceRole role =
      sequences_in_standby(ff_device_sequence_role(), kFfStandby, ff_words_in_standby);
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

std::vector<IsaCase> isa_standby_cases(const std::vector<IsaCase>& all) {
  return cases_in_standby(all, kIsaStandby);
}

const SequenceRole& isa_standby_sequence_role() {
  static const SequenceRole role =
      sequences_in_standby(isa_dle_sequence_role(), kIsaStandby, [](SequenceVocabulary&) {});
  return role;
}

IsaNeeds isa_standby_sequence_needs() {
  return {.is_in_standby = true};
}

}  // namespace fieldproof::conformance

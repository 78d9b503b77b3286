#include "conformance/interbus/master_vocabulary.hpp"

#include <array>
#include <utility>

#include "conformance/interbus/declarations.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "harness/line/telegram.hpp"
#include "protocols/interbus/master_settings.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::CycleFaults;
using interbus::VirtualStation;

constexpr std::array<std::int64_t, 4> kCounts{1, 2, 3, 12};
constexpr std::array<std::int64_t, 6> kBadCounts{1, 2, 1, 8, 9, 10};
constexpr std::array<std::int64_t, 5> kImageWords{0x0000, 0xFFFF, 0x0001, 0x8000, 0xA55A};
constexpr std::array<std::int64_t, 6> kShifts{-16, -8, -1, 1, 8, 16};
constexpr std::array<std::int64_t, 3> kMasks{0x01, 0x80, 0xFF};
constexpr std::array<std::int64_t, 5> kMarks{0x0001, 0x0080, 0x0100, 0x8000, 0xFFFF};
constexpr std::array<std::int64_t, 4> kFirstTelegrams{0, 1, 2, 3};
constexpr std::array<std::int64_t, 5> kRequests{0, 0, 1, 40, 70};
constexpr std::array<std::int64_t, 3> kMilliseconds{1, 30, 100};
constexpr std::array<std::int64_t, 4> kExpectations{0, 1, 1, 2};
// Of a cycle of the largest ring.
constexpr unsigned kMostTelegrams = 14;
constexpr std::int64_t kRings = 7;
constexpr std::array<std::int64_t, 4> kImagePlaces{0, 1, 7, 150};
constexpr std::int64_t kMostStations = 4;

SequenceNumber image_word(std::string_view name) {
  return {name, 0, 0xFFFF, 0, kImageWords};
}
SequenceNumber station() {
  return {"station", 0, kMostStations - 1, 0};
}
SequenceNumber telegram() {
  return {"telegram", 0, kMostTelegrams - 1, 0, kFirstTelegrams};
}
SequenceNumber disturbed() {
  return {"disturbed", 0, 3, 0};
}

std::vector<SequenceWord> words_of_answers() {
  return {
      {.word = "cycles",
       .meaning = "so many cycles come back as they are",
       .numbers = {{"count", 1, 30, 1, kCounts}},
       .weight = 6},
      {.word = "changed",
       .meaning = "a cycle comes back with flipped levels and without some telegrams",
       .units = kMostTelegrams,
       .weight = 6},
      {.word = "forged",
       .meaning = "an octet comes back changed, with a check that fits",
       .numbers = {telegram(), {"mask", 1, 0xFF, 1, kMasks}},
       .weight = 3},
      {.word = "extra",
       .meaning = "one telegram comes back twice, one is in front of it, or one is after the last",
       .numbers = {{"kind", 0, 3, 0}, telegram()},
       .weight = 2},
      {.word = "marked",
       .meaning = "a station marks the status word and reports that its check did not fit; so does another",
       .numbers = {station(), {"other", 0, kMostStations - 1, 0}, {"bits", 1, 0xFFFF, 0xFFFF, kMarks}},
       .weight = 3},
      {.word = "shifted",
       .meaning = "the register is so many bits longer, or shorter",
       .numbers = {{"bits", -16, 16, 1, kShifts}},
       .weight = 2},
      {.word = "lost",
       .meaning = "so many cycles do not come back, the line holds a level",
       .numbers = {{"count", 1, 12, 1, kBadCounts}, {"level", 0, 1, 1}},
       .weight = 3},
      {.word = "bad",
       .meaning = "so many cycles come back with one bit changed",
       .numbers = {{"count", 1, 12, 1, kBadCounts}},
       .weight = 4}};
}

std::vector<SequenceWord> words_of_users() {
  return {{.word = "inputs",
           .meaning = "the inputs of the stations stand like this, 0101h changed more from pair to pair",
           .numbers = {image_word("even"), image_word("odd")},
           .weight = 5},
          {.word = "outputs",
           .meaning = "the application writes all outputs, 0101h changed more from pair to pair",
           .numbers = {image_word("even"), image_word("odd")},
           .weight = 3},
          {.word = "output",
           .meaning = "the application writes one output",
           .numbers = {{"word", 0, 255, 0, kImagePlaces}, image_word("value")},
           .weight = 2},
          {.word = "identify", .meaning = "the application asks for an ID cycle", .weight = 3},
          {.word = "messages",
           .meaning = "a station has a peripheral fault (1) and asks to be reconfigured (2)",
           .numbers = {station(), {"bits", 0, 3, 1}},
           .weight = 3}};
}

std::vector<SequenceWord> words_of_rings() {
  return {{.word = "cut",
           .meaning = "the cable in front of a station is cut until the bus is given up",
           .numbers = {station()},
           .weight = 1},
          {.word = "ring",
           .meaning = "another station of the same length (0, 3, 4), one more, or one less",
           .numbers = {{"change", 0, 4, 0}, station()},
           .weight = 1},
          {.word = "stop",
           .meaning = "the application stops the bus; the last cycle comes back changed, and an output is "
                      "written after the order",
           .numbers = {{"disturbed", 0, 1, 0}},
           .weight = 2},
          {.word = "start",
           .meaning = "the application starts the bus; the first cycles come back changed",
           .numbers = {disturbed()},
           .weight = 4},
          {.word = "power",
           .meaning =
               "the supply goes and comes, with a ring, and the configuration expects any (0), this "
               "or another one (2): the last station elsewhere (3), on another interface (4), missing (5); "
               "no word is copied, two (1), or each (2)",
           .numbers = {{"ring", 0, kRings - 1, 0},
                       {"expects", 0, 5, 0, kExpectations},
                       {"copies", 0, 2, 0},
                       {"cycle_ms", 0, 70, 0, kRequests, true},
                       disturbed(),
                       {"limits", 0, 6, 0}},
           .weight = 2},
          {.word = "wait",
           .meaning = "so many milliseconds without cycles",
           .numbers = {{"ms", 1, 200, 1, kMilliseconds}},
           .weight = 1},
          {.word = "early_order",
           .meaning = "an order (0 start, 1 stop, 2 an ID cycle, 3 an output) in the state ready (0), "
                      "identification (1), locating (2), bus stop (3)",
           .numbers = {{"state", 0, 3, 0}, {"order", 0, 3, 0}},
           .weight = 1}};
}

// As many as a sequence has: the printed window takes a million cycles.
constexpr unsigned kQualityBadCycles = 3;
constexpr unsigned kQualityWindow = 20;

// The bits of a word each have a place of their own.
constexpr std::array<std::string_view, 3> kFixedOfMaster{"status_*", "control_*", "message_*"};

// Cycles that a sequence lives to see: a pause of a second has some 20 thousand status telegrams. The
// shortest has one, which shows the ring that a cycle is over.
constexpr std::int64_t kShortestPause = kernel::Duration{100 * kernel::kMicrosecond}.count();
constexpr std::int64_t kLongestPause = kernel::Duration{20 * kernel::kMillisecond}.count();
// Status telegrams of faster ones are more than an implementation may drive in a case.
constexpr std::int64_t kFastest = 10'000'000;
constexpr std::array kBoundsOfMaster{SettingBound{"bit_rate", {1'000, kFastest}},
                                     SettingBound{"cycle_time", {0, kLongestPause}},
                                     SettingBound{"software_time", {kShortestPause, kLongestPause}},
                                     SettingBound{"cable_delay_ps_per_m", {0, 100'000}},
                                     SettingBound{"max_cable_m", {0, 100'000}},
                                     SettingBound{"forward_delay_half_bits", {0, 100}},
                                     SettingBound{"return_delay_half_bits", {0, 100}},
                                     SettingBound{"stop_after_bad_cycles", {1, 20}},
                                     SettingBound{"quality_bad_cycles", {1, 100}},
                                     SettingBound{"quality_window_cycles", {1, 100}}};

}  // namespace

interbus::MasterConfiguration configuration_of_sequence(const field::Settings& settings) {
  interbus::MasterConfiguration configuration;
  configuration.rules.quality_bad_cycles = kQualityBadCycles;
  configuration.rules.quality_window_cycles = kQualityWindow;
  field::take_settings(interbus::kMasterTable, settings, configuration);
  return configuration;
}

namespace {

// With copies, after rejected cycles, with an ID cycle ordered, off, without a bus and on another ring.
std::vector<std::vector<NamedCommand>> states_of_a_master() {
  return {{{"power", {{"copies", 2}}}},
          {{"bad"}},
          {{"outputs", {{"even", 0xA55A}, {"odd", 1}}}, {"identify"}},
          {{"stop"}},
          {{"lost", {{"count", 12}}}},
          {{"power", {{"ring", 5}, {"expects", 1}}}}};
}

}  // namespace

SequenceVocabulary master_vocabulary() {
  SequenceVocabulary vocabulary{
      .words = words_of_answers(), .unit = "telegram", .levels_per_unit = line::kDataTelegramLevels};
  const interbus::MasterConfiguration as_given = configuration_of_sequence({});
  vocabulary.settings = sequence_settings(interbus::kMasterTable, &as_given, kFixedOfMaster, kBoundsOfMaster);
  vocabulary.objection = objection_of([](const field::Settings& settings) {
    const interbus::Rules rules = configuration_of_sequence(settings).rules;
    expect_time_for_silences(rules);
    if (kernel::kSecond.count() % rules.bit_rate != 0)
      throw kernel::Error(kernel::ErrorKind::configuration,
                          "a master of telegrams is asked at whole picoseconds: its bits are some");
  });
  for (auto group : {words_of_users, words_of_rings}) {
    for (SequenceWord& word : group()) vocabulary.words.push_back(std::move(word));
  }
  return with_beginnings(std::move(vocabulary), states_of_a_master());
}

namespace {

// Couplers at the second and the ninth place; what hangs on their branch comes before what follows them.
std::vector<VirtualStation> ring_of_twelve() {
  return {{0x0103, 1, -1, false}, {0x0008, 0, 0, false}, {0x01BE, 1, 1, true},  {0x0203, 2, 1, false},
          {0x0103, 1, 3, false},  {0x0103, 1, 4, false}, {0x0103, 1, 5, false}, {0x0103, 1, 6, false},
          {0x0008, 0, 7, false},  {0x01BE, 1, 8, true},  {0x01BE, 1, 9, false}, {0x0103, 1, 8, false}};
}

// Each coupler of a branch has the next one on its branch; then what follows each of them on its own level.
std::vector<VirtualStation> ring_of_four_levels() {
  return {{0x0008, 0, -1, false}, {0x0008, 0, 0, true},  {0x0008, 0, 1, true}, {0x01BE, 1, 2, true},
          {0x0103, 1, 2, false},  {0x0203, 2, 1, false}, {0x0103, 1, 0, false}};
}

}  // namespace

std::vector<VirtualStation> ring_of(std::int64_t number) {
  switch (number) {
    case 0:
      return interbus::line_of(2, 0x0103, 1);
    case 1:
      return paper_ring();
    case 2:
      return interbus::line_of(1, 0x0203, 2);
    case 3:
      return interbus::line_of(4, 0x0103, 1);
    case 4:
      return interbus::line_of(1, 0x0603, 8);
    case 6:
      return interbus::line_of(5, 0x1403, 32);
    case kLongRing:
      return ring_of_twelve();
    case kWideRing:
      return interbus::line_of(10, 0x1403, 32);
    case kDeepRing:
      return ring_of_four_levels();
    default:
      return {{0x0103, 1, -1, false}, {0x0008, 0, 0, false}, {0x01BE, 1, 1, true}, {0x0203, 2, 1, false}};
  }
}

std::vector<VirtualStation> changed_ring(std::vector<VirtualStation> ring, std::int64_t change,
                                         std::int64_t station) {
  constexpr std::uint16_t kOtherType = 0x0040;
  const std::size_t place = static_cast<std::size_t>(station) % ring.size();
  if (change == 0 || change > 2) {
    // The register stays as long, whatever its code says.
    constexpr std::array<std::uint16_t, 5> kOther{kOtherType, 0, 0, 0x0010, 0x0001};
    ring[place].id_code ^= kOther.at(static_cast<std::size_t>(change));
  } else if (change == 1) {
    ring.push_back({0x0103, 1, static_cast<int>(ring.size()) - 1, false});
  } else if (ring.size() > 1) {
    ring.pop_back();
  }
  return ring;
}

namespace {

// The ring with its last station elsewhere.
std::vector<VirtualStation> misplaced(std::vector<VirtualStation> ring, std::int64_t how) {
  VirtualStation& last = ring.back();
  if (how == 3) last.before = last.before < 0 ? 0 : last.before - 1;
  if (how == 4) last.on_branch = !last.on_branch;
  if (how == 5) ring.pop_back();
  return ring;
}

}  // namespace

MasterScene scene_of(const SequenceCommand& command) {
  const auto& numbers = command.numbers;
  MasterScene scene{.ring = ring_of(numbers[0])};
  if (numbers[1] == 1) scene.expected = scene.ring;
  if (numbers[1] == 2) scene.expected = ring_of((numbers[0] + 1) % kRings);
  if (numbers[1] > 2) scene.expected = misplaced(scene.ring, numbers[1]);
  if (numbers[1] >= kAnotherExpected)
    scene.expected = changed_ring(scene.ring, 0, numbers[1] - kAnotherExpected);
  scene.copies = static_cast<Copies>(numbers[2]);
  scene.cycle_time = numbers[3] * kernel::kMillisecond;
  scene.disturbed = static_cast<unsigned>(numbers[4]);
  scene.limits = static_cast<Limits>(numbers[5]);
  return scene;
}

CycleFaults faults_of(const SequenceCommand& command, std::size_t stations) {
  CycleFaults faults;
  const auto& numbers = command.numbers;
  const auto number = [&](std::size_t n) { return static_cast<int>(numbers.at(n)); };
  switch (static_cast<MasterWord>(command.word)) {
    case MasterWord::changed:
      for (const SequenceFault& fault : command.faults) {
        if (fault.kind == SequenceFaultKind::flip && fault.value < line::kDataTelegramLevels)
          faults.level_flips.push_back({fault.unit, fault.value});
        if (fault.kind == SequenceFaultKind::drop) faults.dropped = static_cast<int>(fault.unit);
      }
      break;
    case MasterWord::forged:
      faults.flips = {{static_cast<std::size_t>(number(0)), static_cast<std::uint8_t>(number(1)), true}};
      break;
    case MasterWord::extra:
      if (number(0) == 0) faults.duplicated = number(1);
      if (number(0) == 1) faults.inserted = number(1);
      if (number(0) == 2) faults.trailing_telegram = true;
      if (number(0) == 3) faults.status_flag_flipped = true;
      break;
    case MasterWord::marked:
      faults.marked_by = number(0) % static_cast<int>(stations);
      faults.also_marked_by = number(1) % static_cast<int>(stations);
      faults.mark = static_cast<std::uint16_t>(number(2));
      break;
    case MasterWord::shifted:
      faults.longer_bits = number(0);
      break;
    case MasterWord::lost:
      faults.stuck = number(1) != 0;
      break;
    case MasterWord::bad:
      faults.flips = {{0, 0x01, false}};
      break;
    default:
      break;
  }
  return faults;
}

}  // namespace fieldproof::conformance

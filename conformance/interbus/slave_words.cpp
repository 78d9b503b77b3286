#include "conformance/interbus/slave_words.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 7> kLikelyWords{0x0000, 0xFFFF, 0x0001, 0x8000, 0x7F80, 0xA55A, 0xFF00};
constexpr std::array<std::int64_t, 8> kErrors{0x0000, 0x0001, 0x0080, 0x0100, 0x8000, 0x00FF, 0xFF00, 0xFFFF};
constexpr std::array<std::int64_t, 10> kOctetsInFront{-3, -1, 0, 1, 2, 3, 5, 7, 60, 300};
constexpr std::array<std::int64_t, 5> kGaps{0, 1, 2, 13, 100};
constexpr std::array<std::int64_t, 3> kTimes{1, 2, 3};
constexpr std::array<std::int64_t, 4> kCounts{1, 2, 4, 40};
constexpr std::array<std::int64_t, 2> kMilliseconds{1, 40};
constexpr std::array<std::int64_t, 8> kManyCycles{1, 1, 1, 2, 2, 3, 210, 830};
constexpr std::array<std::int64_t, 4> kStopGaps{2, 2, 1, 13};
constexpr std::array<std::int64_t, 2> kOffRates{-60, 60};
constexpr std::array<std::int64_t, 2> kOffPulses{-3, 3};
constexpr std::array<std::int64_t, 3> kRightRates{0, -10, 10};
constexpr std::array<std::int64_t, 5> kCuts{1, 2, 4, 7, 12};
constexpr std::array<std::int64_t, 4> kPartLevels{1, 3, 11, 20};

SequenceNumber slave_word(std::string_view name, std::int64_t simple) {
  return {name, 0, 0xFFFF, simple, kLikelyWords};
}
SequenceNumber truth(std::string_view name, std::int64_t simple) {
  return {name, 0, 1, simple};
}

std::vector<SequenceNumber> cut_numbers() {
  return {{"telegram", 0, 13, 0}, {"level", 1, 12, 6, kCuts}, slave_word("word", 0x1234)};
}

// What data and ID cycles have in common.
std::vector<SequenceNumber> cycle_numbers(std::vector<SequenceNumber> numbers) {
  numbers.push_back({"check_error", 0, 0xFFFF, 0, kErrors});
  numbers.push_back({"mark", 0, 0xFFFF, 0, kErrors});
  numbers.push_back({"in_front", -4, 300, kFrontOfSlave, kOctetsInFront});
  numbers.push_back({"gap", 0, 100, 2, kGaps});
  numbers.push_back({"times", 1, 3, 1, kTimes});
  return numbers;
}

std::vector<SequenceNumber> telegram_numbers() {
  return {{"select", 0, 1, 0},      {"control", 0, 1, 0},          {"is_data", 0, 1, 1},
          {"octet", 0, 0xFF, 0x80}, {"count", 1, 100, 1, kCounts}, {"stop", 0, 1, 1}};
}

}  // namespace

std::vector<SequenceWord> slave_words() {
  constexpr unsigned kUnits = 14;  // of a slave of two words; loopback word, register, check and status word
  return {
      {"data", "data cycles, with the two words in turn",
       cycle_numbers({slave_word("word0", 0x1234), slave_word("word1", 0xFEDC)}), 0, kUnits, 8},
      {"id", "ID cycles; orders: 1 OUT1 off, 2 OUT2 off, 4 reset, 8 acknowledge",
       cycle_numbers({{"orders", 0, 15, slave_orders::kRemoteOff | slave_orders::kBranchOff},
                      {"reserved", 0, 0xFFFF, 0, kErrors}}),
       0, kUnits - 2, 6},
      {"telegrams", "telegrams outside of cycles", telegram_numbers(), 0, 4, 2},
      {"status", "status telegrams", {{"count", 1, 100, 1, kCounts}}, 0, 2, 1},
      {"inputs", "the inputs stand like this", {slave_word("word0", 0x4321), slave_word("word1", 0x8001)}},
      {"plugs", "what is plugged in", {truth("out1", 1), truth("out2", 1)}},
      {"periphery", "what is reported to the slave", {truth("fault", 1), truth("reconfiguration", 0)}},
      {"returns", "telegrams that come back after OUT1, or OUT2",
       [] {
         std::vector<SequenceNumber> numbers = telegram_numbers();
         numbers.insert(numbers.begin(), truth("out2", 0));
         return numbers;
       }(),
       0, 0, 2},
      {"silence",
       "silence: 0 half of the limit, 1 up to the limit, 2 beyond it, 3 three limits, 4 70 s, 5 beyond it by "
       "a quarter of its tolerance",
       {{"how_long", 0, 5, 2}},
       0,
       0,
       2},
      {"kept_alive",
       "status telegrams, counted from the last ID cycle: 0 for half of the time of a reset of the outgoing "
       "bus, 1 nearly to its end, 2 beyond it, 3 and 4 until a right ID cycle that follows would end a "
       "little "
       "before its end, or after it",
       {{"how_long", 0, 4, 2}}},
      {.word = "power",
       .meaning = "the supply goes and comes back",
       .numbers = {{"milliseconds", 1, 100, 1, kMilliseconds}},
       .is_loss = true},
      {"glitch", "a low pulse that is no start level", {{"eighths", 1, 3, 3}}},
      {"good",
       "so many right data cycles, with the two words in turn",
       {slave_word("word0", 0x1234), slave_word("word1", 0xFEDC), {"times", 1, 850, 1, kManyCycles, true}},
       0,
       0,
       3},
      {"no_stop",
       "a data cycle that is right but for the stop level of a telegram",
       {slave_word("word", 0x1234), {"telegram", 0, 13, 0}, {"gap", 1, 100, 2, kStopGaps}},
       0,
       0,
       2},
      {.word = "rate",
       .meaning =
           "a data cycle so many per mille faster than its bit rate; then the supply goes and comes back",
       .numbers = {{"per_mille", -60, 60, 60, kOffRates, true}, slave_word("word", 0xAAAA)},
       .is_loss = true,
       .is_no_frame = true},
      {.word = "pulses",
       .meaning = "a data cycle whose low pulses are so many twentieths of a bit longer, so many per mille "
                  "faster than its bit rate",
       .numbers = {{"longer", -3, 3, 3, kOffPulses},
                   slave_word("word", 0x1234),
                   {"per_mille", -10, 10, 0, kRightRates, true}},
       .is_no_frame = true},
      {.word = "parts",
       .meaning = "a right data cycle in two transmissions without a gap, cut at a level of a telegram",
       .numbers = {{"telegram", 0, 13, 0},
                   {"level", 1, 12, 6, kCuts},
                   slave_word("word", 0x1234),
                   {"gap", 0, 100, 2, kGaps}},
       .weight = 2},
      {.word = "right_id",
       .meaning = "a right ID cycle; orders: 1 OUT1 off, 2 OUT2 off, 4 reset, 8 acknowledge",
       .numbers = {{"orders", 0, 15, 0}, {"reserved", 0, 0xFFFF, 0, kErrors}},
       .weight = 4},
      {.word = "clock", .meaning = "right data cycles while a clock ticks at all inputs", .numbers = {}},
      {.word = "cut",
       .meaning = "a right data cycle whose transmission ends in front of a level of a telegram",
       .numbers = cut_numbers()},
      {.word = "lost_in_a_telegram",
       .meaning = "the same, and there the supply goes and comes back",
       .numbers = cut_numbers(),
       .is_loss = true},
      {.word = "three_parts",
       .meaning = "a right data cycle in three transmissions without a gap; the second has so many levels",
       .numbers =
           [] {
             std::vector<SequenceNumber> numbers = cut_numbers();
             numbers.push_back({"levels", 1, 40, 3, kPartLevels});
             return numbers;
           }()},
      {.word = "cut_without_stop",
       .meaning = "a data cycle that is right but for the stop level with which the first of its two "
                  "transmissions ends; no gap follows",
       .numbers = {{"telegram", 0, 12, 0}, slave_word("word", 0x1234)}},
      {.word = "glitch_within",
       .meaning = "a right data cycle with a low pulse that is no start level after a telegram",
       .numbers = {{"telegram", 0, 13, 0}, slave_word("word", 0x1234), {"eighths", 1, 3, 3}}},
      {.word = "returned_glitch",
       .meaning = "a low pulse that is no start level comes back after OUT1, or OUT2",
       .numbers = {truth("out2", 0), {"eighths", 1, 3, 3}}},
      {.word = "returned_pulses",
       .meaning =
           "data telegrams come back after OUT1, or OUT2, their low pulses so many twentieths of a bit "
           "longer, so many per mille faster than their bit rate",
       .numbers = {truth("out2", 0),
                   {"octet", 0, 0xFF, 0x80},
                   {"longer", -3, 3, 3, kOffPulses},
                   {"per_mille", -10, 10, 0, kRightRates, true}},
       .is_no_frame = true},
      {.word = "kept_alive_without_stop",
       .meaning = "beyond the limit of silence status telegrams whose stop level is missing, and no others",
       .numbers = {}}};
}

}  // namespace fieldproof::conformance

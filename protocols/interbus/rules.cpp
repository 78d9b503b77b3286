#include "protocols/interbus/rules.hpp"

#include <array>

namespace fieldproof::interbus {

namespace {

// 14h is the only entry that was not read in the table of the manual.
constexpr std::array<LengthCode, 17> kPublishedLengthCodes{{
    {0x00, 0},
    {0x01, 1},
    {0x02, 2},
    {0x03, 3},
    {0x04, 4},
    {0x05, 5},
    {0x0E, 6},
    {0x0F, 7},
    {0x06, 8},
    {0x07, 9},
    {0x15, 10},
    {0x16, 12},
    {0x17, 14},
    {0x12, 16},
    {0x13, 24},
    {0x11, 26},
    {0x14, 32},
}};
}  // namespace

std::span<const LengthCode> published_length_codes() {
  return kPublishedLengthCodes;
}

std::span<const LengthCode> length_codes_of(const Rules& rules) {
  if (rules.length_codes.empty()) return published_length_codes();
  return rules.length_codes;
}

}  // namespace fieldproof::interbus

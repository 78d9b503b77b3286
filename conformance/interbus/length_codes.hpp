#pragma once

#include <array>

#include "protocols/interbus/rules.hpp"

// The testers' own copy of the manual's table of length codes, so that a mistake in the rules, which the
// station under test may use, is not repeated here. 08h to 0Dh and 10h are said to be lengths below and
// between whole words; what they mean could not be verified, so nobody is judged by them.
namespace fieldproof::conformance {

inline constexpr std::array<interbus::LengthCode, 17> kLengthCodes{{{0x00, 0},
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
                                                                    {0x14, 32}}};
inline constexpr unsigned kLengthCodeFromMemory = 0x14;  // the only one that was not read
inline constexpr unsigned kFirstUndefinedLengthCode = 0x18;

}  // namespace fieldproof::conformance

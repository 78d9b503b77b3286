#pragma once

#include <string>

#include "harness/line/waveform.hpp"
#include "protocols/interbus/rules.hpp"

// INTERBUS telegrams written for a person, the same way everywhere: findings, recordings, tests.
//
//   data A55A 1234 | check 29CC 0000 | 37 status      a cycle and the pause after it
//   id A55A 0003 | id check 1D0F 0000                 an ID cycle
//   data A5 5! 1234                                   the stop bit of the telegram with 5x is missing
//   … cut 01001                                       levels at the end that make no whole telegram
//
// Octets are grouped in words from the beginning of each phase. `describe` decodes the waveform by itself, at
// any rate, as a receiver does.
namespace fieldproof::interbus {

std::string describe(const line::Waveform& wave, const Rules& rules);

}  // namespace fieldproof::interbus

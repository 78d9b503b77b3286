#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "harness/judge/verdict.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/rules.hpp"

// How long a data cycle lasts: the published formulas by name, and the time that the structure of the frame
// gives under a set of Rules. A measurement is held against these; nothing here runs a network.
//
//   n  user octets: the registers of all stations together, both directions share them
//   m  remote-bus stations; stations on a local bus are part of theirs
//
// All results are exact sums, rounded once per term to the nearest picosecond. Times are those of one data
// cycle without errors; ID cycles are longer or shorter and follow no published formula.
//
// Two findings about the formula as Park 2004 prints it (F1):
//
// 1. F1 with n = 2 gives the printed 755.0 us: (1.15 * 13 * 10 + 3) bit * 2 us + 450 us. But the network of
//    that paper, IB IL 24 DI 16 and IB IL 24 DO 16 after one coupler, has two registers of 16 bit: n = 4.
//    The same paper's text gives 6 octets of frame information, not 8, and F4, which has 6 + n, yields the
//    same 755.0 us with n = 4. The printed "(8 + n), n = 2" and "(6 + n), n = 4" are the same number of
//    telegrams, so 755.0 us cannot tell them apart.
// 2. F1 with n = 4 gives 814.8 us, and 0.814 ms is the shortest setting that the paper found to work
//    best. The difference of 59.8 us between the calculated and the best time is exactly two data telegrams
//    (2 * 1.15 * 13 bit * 2 us). The paper does not say so and calls the two times nearly equal, while they
//    are 7.9 % apart. Both are conformance values here; which reading a master follows is a parameter
//    (formula, n, Rules::end_telegrams), not a fact.
//
// A third, smaller one: a line of the paper's worked example multiplies with the bit time twice; its result
// counts it once, and so do we.
namespace fieldproof::interbus {

struct TimingInput {
  unsigned user_octets = 0;
  unsigned remote_stations = 0;
  std::int64_t bit_rate = 500'000;  // bit/s, positive
  // F1, F4 and F5 only; F2 and F3 print a constant of 0.2 ms instead.
  kernel::Duration software_time = 450 * kernel::kMicrosecond;
  double cable_m = 0;  // remote bus, once: forward and return line lie in the same cable
  // F1 and F4 name the time on the cable without a value; it is taken there and back. F3 and F5 print their
  // own.
  std::int64_t cable_delay_ps_per_m = 5'000;
};

// n, m, bit rate, software time and cable of a network.
TimingInput timing_input(const NetworkDescription& network);

kernel::Duration cycle_time(Formula formula, const TimingInput& input);

// Worst case from an input to an output that the master copies: a change just missed waits one cycle, data
// are valid after the end of the next (Beckhoff BC4000 documentation). See skew.hpp for what lies below it.
constexpr kernel::Duration reaction_time(kernel::Duration cycle_time) {
  return 2 * cycle_time;
}

struct FormulaDescription {
  Formula formula;
  std::string_view name;  // "f1", as in network files
  std::string_view text;
  std::string_view source;
  judge::Standing standing;
};

std::span<const FormulaDescription> formulas();
std::string_view name(Formula formula);

// The structure. From the start of the first telegram of a data cycle to the end of the last one's gap:
// loopback word, user octets, check and status word, end telegrams.
kernel::Duration frame_time(const Rules& rules, unsigned user_octets);

// A status telegram.
kernel::Duration shortest_telegram(const Rules& rules);

// From the master around the ring and back, without the registers: retiming of the stations, and the cable
// in both directions.
kernel::Duration ring_delay(const NetworkDescription& network);

// Shortest cycle of a master under the network's rules: frame, ring and software time. It is F4 where the
// rules are those of the reference and F1 with two end telegrams.
kernel::Duration structural_cycle_time(const NetworkDescription& network);

}  // namespace fieldproof::interbus

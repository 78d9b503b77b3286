#include "protocols/valve_bus/timing.hpp"

#include <algorithm>
#include <cmath>

#include "protocols/valve_bus/frame.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr unsigned kDriverOnBits = 1;  // of a reference station that begins as soon as it knows

}  // namespace

PollTime least_poll_time(const Rules& rules, kernel::Duration turnaround_time, kernel::Duration distance) {
  return {.command = half_characters(rules, 2 * kCommandOctets),
          .turnaround_time = turnaround_time,
          .response = half_characters(rules, 2 * kResponseOctets),
          .silence = delimiter(rules),
          .way = 2 * distance};
}

PollTime reference_poll_time(const Rules& rules, kernel::Duration distance) {
  const kernel::Duration sure = delimiter(rules) + character_notice(rules) + bits(rules, kDriverOnBits);
  PollTime time = least_poll_time(rules, std::max(delimiter(rules) + kNodeProcessing, sure), distance);
  time.silence = sure;
  return time;
}

kernel::Duration reference_write_time(const Rules& rules, kernel::Duration distance) {
  if (rules.answers_writes) return reference_poll_time(rules, distance).total();
  return half_characters(rules, 2 * kCommandOctets) + delimiter(rules) + rules.write_distance +
         bits(rules, kDriverOnBits);
}

kernel::Duration distance_of(const Rules& rules, unsigned node, unsigned nodes, double length_m) {
  const unsigned first = rules.unit_loads - 1;   // beside the host
  const unsigned others = rules.unit_loads - 2;  // between two repeaters
  const unsigned repeaters = node < first ? 0 : 1 + (node - first) / others;
  const double metres = length_m * (node + 1) / std::max(1U, nodes);
  const auto cable = std::llround(metres * static_cast<double>(rules.cable_delay_ps_per_m));
  return kernel::Duration{cable} + repeaters * rules.repeater_delay;
}

}  // namespace fieldproof::valve_bus

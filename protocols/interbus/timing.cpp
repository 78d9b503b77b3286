#include "protocols/interbus/timing.hpp"

#include <array>
#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::interbus {

namespace {

using judge::Standing;
using kernel::Duration;

constexpr std::array<FormulaDescription, 5> kFormulas{{
    {Formula::f1, "f1", "[1.15 * 13 * (8 + n) + 3 * m] * t_bit + t_phys + t_sw", "Park 2004, section 2.2",
     Standing::seed},
    {Formula::f2, "f2", "[13 * (6 + n) + 1.5 * m] * t_bit + 0.2 ms", "Beckhoff BC4000 documentation",
     Standing::searched},
    {Formula::f3, "f3", "(8 * n + 48 + 3 * m) * 3.35 us + 0.24 ms * L/km + 0.2 ms",
     "Lenze 2111 manual; the placement of the bracket is inferred", Standing::searched},
    {Formula::f4, "f4", "[1.15 * 13 * (6 + n) + 3 * m] * t_bit + t_phys + t_sw",
     "Phoenix Contact manuals from memory; 6 octets of frame information: Park 2004, section 2.2",
     Standing::memory},
    {Formula::f5, "f5", "[13 * (6 + n) + 4 * m] * t_bit + t_sw + 2 * 16 us * L/km", "literature from memory",
     Standing::memory},
}};

constexpr std::int64_t kFrameInformationOctets = 6;  // loopback word 2, check and status word 4
constexpr std::int64_t kDataTelegramBits = line::kDataTelegramLevels;
constexpr Duration kConstantOfF2AndF3 = 200 * kernel::kMicrosecond;

// `thousandths` of a bit, rounded once.
Duration bits_duration(std::int64_t thousandths, std::int64_t bit_rate) {
  FIELDPROOF_CHECK(bit_rate > 0, "a bit rate is positive");
  return kernel::levels_duration(thousandths, 1'000 * bit_rate);
}

Duration cable_time(double cable_m, double ps_per_m) {
  return Duration{std::llround(cable_m * ps_per_m)};
}

// F1 and F4: 1.15 * 13 = 14.95 bit a telegram.
Duration spread_telegrams(std::int64_t telegrams, const TimingInput& input) {
  const std::int64_t stations = input.remote_stations;
  return bits_duration(14'950 * telegrams + 3'000 * stations, input.bit_rate) +
         cable_time(input.cable_m, 2.0 * static_cast<double>(input.cable_delay_ps_per_m)) +
         input.software_time;
}

// F3 prints 3.35 us a bit of 500 kbit/s: 1.675 bit, about 1.03 * 13/8.
Duration bits_of_f3(const TimingInput& input) {
  const std::int64_t bits =
      std::int64_t{8} * input.user_octets + 48 + std::int64_t{3} * input.remote_stations;
  return bits_duration(1'675 * bits, input.bit_rate) + cable_time(input.cable_m, 240'000.0) +
         kConstantOfF2AndF3;
}

Duration dense_telegrams(const TimingInput& input, std::int64_t millibits_per_station) {
  const std::int64_t telegrams = kFrameInformationOctets + input.user_octets;
  return bits_duration(1'000 * kDataTelegramBits * telegrams + millibits_per_station * input.remote_stations,
                       input.bit_rate);
}

}  // namespace

TimingInput timing_input(const NetworkDescription& network) {
  TimingInput input;
  input.bit_rate = network.rules.bit_rate;
  input.software_time = network.rules.software_time;
  input.cable_delay_ps_per_m = network.rules.cable_delay_ps_per_m;
  for (const RingPlace& place : ring_order(network)) {
    input.user_octets += 2 * place.words;
    input.remote_stations += place.station->is_local ? 0 : 1;
    input.cable_m += place.station->cable_m;
  }
  return input;
}

Duration cycle_time(Formula formula, const TimingInput& input) {
  const std::int64_t octets = input.user_octets;
  switch (formula) {
    case Formula::f1:
      return spread_telegrams(8 + octets, input);
    case Formula::f2:
      return dense_telegrams(input, 1'500) + kConstantOfF2AndF3;
    case Formula::f3:
      return bits_of_f3(input);
    case Formula::f4:
      return spread_telegrams(kFrameInformationOctets + octets, input);
    case Formula::f5:
      return dense_telegrams(input, 4'000) + input.software_time + cable_time(input.cable_m, 2.0 * 16'000.0);
  }
  FIELDPROOF_CHECK(false, "every formula has its line above");
  return Duration::zero();
}

std::span<const FormulaDescription> formulas() {
  return kFormulas;
}

std::string_view name(Formula formula) {
  return kFormulas[static_cast<std::size_t>(formula)].name;
}

Duration shortest_telegram(const Rules& rules) {
  return kernel::levels_duration(line::kStatusTelegramLevels, rules.bit_rate);
}

Duration frame_time(const Rules& rules, unsigned user_octets) {
  const std::int64_t telegrams = kFrameInformationOctets + user_octets + rules.end_telegrams;
  return bits_duration(telegrams * (1'000 * kDataTelegramBits + rules.telegram_gap_millibits),
                       rules.bit_rate);
}

Duration ring_delay(const NetworkDescription& network) {
  const Rules& rules = network.rules;
  std::int64_t half_bits = 0;
  double cable_m = 0;
  for (const RingPlace& place : ring_order(network)) {
    half_bits += place.station->is_local
                     ? rules.local_delay_half_bits
                     : std::int64_t{rules.forward_delay_half_bits} + rules.return_delay_half_bits;
    cable_m += place.station->cable_m;
  }
  return bits_duration(500 * half_bits, rules.bit_rate) +
         cable_time(cable_m, 2.0 * static_cast<double>(rules.cable_delay_ps_per_m));
}

Duration structural_cycle_time(const NetworkDescription& network) {
  return frame_time(network.rules, timing_input(network).user_octets) + ring_delay(network) +
         network.rules.software_time;
}

}  // namespace fieldproof::interbus

#include "protocols/valve_bus/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fieldproof::valve_bus {
namespace {

using judge::Standing;

constexpr std::string_view kPaper = "Kim, Seo and Lee, pneumatic control by fieldbus";
constexpr std::string_view kOwn = "this project's choice; the paper is silent";
constexpr std::string_view kReadsAs = "this project's reading of a contradiction in the paper";
constexpr std::string_view kController = "the bit rate follows from serial mode 2 of the 8051 family";
constexpr std::string_view kLoads = "TIA-485-A: 32 unit loads, repeaters and masters count";
constexpr std::string_view kChanged = "set for this bus or mutant; not from a source";

struct Row {
  std::string_view rule;
  std::string (*value)(const Rules&);
  std::string_view source;
  Standing standing;
};

std::string halves(unsigned count) {
  return fmt::format("{}.{} characters", count / 2, count % 2 == 0 ? 0 : 5);
}

const std::array kRows = {
    Row{"bit_rate", [](const Rules& r) { return fmt::format("{} bit/s", r.bit_rate); }, kPaper,
        Standing::seed},
    Row{"characters", [](const Rules& r) { return std::string(valve_bus::text_of(r.characters)); },
        kController, Standing::derived},
    Row{"longest_gap_half_characters", [](const Rules& r) { return halves(r.longest_gap_half_characters); },
        kOwn, Standing::own},
    Row{"delimiter_half_characters", [](const Rules& r) { return halves(r.delimiter_half_characters); }, kOwn,
        Standing::own},
    Row{"driver_on_bits", [](const Rules& r) { return fmt::format("{} bit", r.driver_on_bits); }, kOwn,
        Standing::own},
    Row{"driver_off_bits", [](const Rules& r) { return fmt::format("{} bit", r.driver_off_bits); }, kOwn,
        Standing::own},
    Row{"first_address", [](const Rules& r) { return fmt::format("{}", r.first_address); }, kPaper,
        Standing::seed},
    Row{"last_address", [](const Rules& r) { return fmt::format("{}", r.last_address); }, kPaper,
        Standing::seed},
    Row{"write_command", [](const Rules& r) { return fmt::format("{}", r.write_command); }, kPaper,
        Standing::seed},
    Row{"read_command", [](const Rules& r) { return fmt::format("{}", r.read_command); }, kPaper,
        Standing::seed},
    Row{"turnaround_time_span", [](const Rules& r) { return kernel::describe(r.turnaround_time_span); }, kOwn,
        Standing::own},
    Row{"actuation_limit", [](const Rules& r) { return kernel::describe(r.actuation_limit); }, kOwn,
        Standing::own},
    Row{"output_skew", [](const Rules& r) { return kernel::describe(r.output_skew); }, kOwn, Standing::own},
    Row{"answers_writes", [](const Rules& r) { return std::string(r.answers_writes ? "yes" : "no"); },
        kReadsAs, Standing::own},
    Row{"loss_limit",
        [](const Rules& r) {
          return r.loss_limit == kernel::Duration{} ? "valves hold" : kernel::describe(r.loss_limit);
        },
        kReadsAs, Standing::own},
    Row{"response_wait", [](const Rules& r) { return kernel::describe(r.response_wait); }, kOwn,
        Standing::own},
    Row{"write_distance", [](const Rules& r) { return kernel::describe(r.write_distance); }, kOwn,
        Standing::own},
    Row{"read_attempts", [](const Rules& r) { return fmt::format("{}", r.read_attempts); }, kOwn,
        Standing::own},
    Row{"refresh", [](const Rules& r) { return kernel::describe(r.refresh); }, kOwn, Standing::own},
    Row{"fifo_octets", [](const Rules& r) { return fmt::format("{} octets", r.fifo_octets); }, kOwn,
        Standing::own},
    Row{"partial_command_limit", [](const Rules& r) { return kernel::describe(r.partial_command_limit); },
        kOwn, Standing::own},
    Row{"unit_loads", [](const Rules& r) { return fmt::format("{}", r.unit_loads); }, kLoads, Standing::sure},
    Row{"max_nodes", [](const Rules& r) { return fmt::format("{}", r.max_nodes); }, kPaper, Standing::seed},
    Row{"max_length_m", [](const Rules& r) { return fmt::format("{} m", r.max_length_m); }, kPaper,
        Standing::seed},
    Row{"repeater_delay", [](const Rules& r) { return kernel::describe(r.repeater_delay); }, kOwn,
        Standing::own},
    Row{"cable_delay_ps_per_m", [](const Rules& r) { return fmt::format("{} ps/m", r.cable_delay_ps_per_m); },
        kOwn, Standing::own},
};

}  // namespace

line::CharacterFormat character_format(const Rules& rules) {
  line::CharacterFormat format;
  if (rules.characters == CharacterProfile::ninth_bit_one) format.data_bits = 9;
  if (rules.characters == CharacterProfile::even_parity) format.parity = line::Parity::even;
  return format;
}

unsigned written_character(const Rules& rules, std::uint8_t octet) {
  return rules.characters == CharacterProfile::ninth_bit_one ? 0x100U | octet : octet;
}

std::string_view text_of(CharacterProfile profile) {
  switch (profile) {
    case CharacterProfile::ninth_bit_one:
      return "P0";
    case CharacterProfile::even_parity:
      return "P1";
    case CharacterProfile::eight_bits:
      return "P2";
  }
  return "";
}

kernel::Duration half_characters(const Rules& rules, unsigned count) {
  // Quarter bits: half a character of eleven bits is no whole number of half bits times two.
  return kernel::levels_duration(std::int64_t{count} * character_format(rules).half_bits(),
                                 4 * rules.bit_rate);
}

kernel::Duration bits(const Rules& rules, std::int64_t count) {
  return kernel::levels_duration(count, rules.bit_rate);
}

kernel::Duration character_notice(const Rules& rules) {
  return character_time(rules) + bits(rules, 1);
}

kernel::Duration turnaround_time_span(const Rules& rules) {
  return std::max(rules.turnaround_time_span, 2 * character_notice(rules));
}

kernel::Duration actuation_limit(const Rules& rules) {
  return std::max(rules.actuation_limit, 2 * character_notice(rules));
}

kernel::Duration response_time_out(const Rules& rules) {
  return delimiter(rules) +
         std::max(rules.response_wait, turnaround_time_span(rules) + character_notice(rules));
}

std::span<const std::int64_t> dip_bit_rates() {
  // 12 MHz / 32 and / 64 (mode 2), then 12 MHz / (12 * 16 * n) and / (12 * 32 * n) with n = 1, 1, 3, 3,
  // 13, 13.
  static constexpr std::array<std::int64_t, 8> kRates{375'000, 187'500, 62'500, 31'250,
                                                      20'833,  10'417,  4'808,  2'404};
  return kRates;
}

std::vector<Fact> facts(const Rules& rules) {
  std::vector<Fact> all;
  for (const Row& row : kRows) {
    Fact& fact = all.emplace_back(Fact{row.rule, row.value(rules), row.source, row.standing});
    if (fact.value == row.value(Rules{})) continue;
    fact.source = kChanged;
    fact.standing = Standing::own;
  }
  return all;
}

}  // namespace fieldproof::valve_bus

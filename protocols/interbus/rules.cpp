#include "protocols/interbus/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace fieldproof::interbus {

namespace {

using judge::Standing;

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
constexpr std::uint8_t kLengthCodeFromMemory = 0x14;

constexpr std::string_view kOwn = "this project's choice; the standard was not at hand";
constexpr std::string_view kChanged = "set for this network or mutant; not from a source";

std::string bits(std::uint16_t word) {
  return fmt::format("{:04X}h", word);
}

std::string bit_rate_text(std::int64_t rate) {
  if (rate % 1'000'000 == 0) return fmt::format("{} Mbit/s", rate / 1'000'000);
  if (rate % 1'000 == 0) return fmt::format("{} kbit/s", rate / 1'000);
  return fmt::format("{} bit/s", rate);
}

std::string half_bits_text(unsigned half_bits) {
  return fmt::format("{}.{} bit", half_bits / 2, half_bits % 2 == 0 ? 0 : 5);
}

std::string telegram_text(const line::TelegramLayout& layout) {
  std::string text = "start 0";
  for (const line::HeaderLevel level : layout.header) {
    switch (level) {
      case line::HeaderLevel::select:
        text += fmt::format(", SL {} = set", layout.select_level ? 1 : 0);
        break;
      case line::HeaderLevel::control:
        text += fmt::format(", CR {} = set", layout.control_level ? 1 : 0);
        break;
      case line::HeaderLevel::flag:
        text += fmt::format(", FL {} = data", layout.data_flag_level ? 1 : 0);
        break;
    }
  }
  return text + (layout.most_significant_first ? ", D7..D0" : ", D0..D7") + ", stop 1";
}

std::string length_codes_text(std::span<const LengthCode> codes, bool from_memory) {
  std::string text;
  for (const LengthCode& entry : codes) {
    if ((entry.code == kLengthCodeFromMemory) != from_memory) continue;
    text += fmt::format("{}{:02X}h = {}", text.empty() ? "" : ", ", entry.code, entry.words);
  }
  return text.empty() ? "none" : text + (from_memory ? " words" : " words; other codes undefined");
}

void add_line_facts(std::vector<Fact>& table, const Rules& rules) {
  const bool is_fast = rules.bit_rate == 2'000'000;
  const std::string_view rate_source =
      is_fast ? "Lenze E94AYCIB manual; Park 2004 has 500 kbit/s" : "Park 2004, sections 1 and 2.2";
  table.insert(
      table.end(),
      {{"bit_rate", bit_rate_text(rules.bit_rate), rate_source,
        is_fast ? Standing::searched : Standing::seed},
       {"telegram", telegram_text(rules.telegram),
        "order and polarity are this project's choice; 5 + 8 bit: Park 2004, section 2.2", Standing::own},
       {"telegram_gap_millibits", fmt::format("{}/1000 bit", rules.telegram_gap_millibits),
        "the factor 1.15 of Park 2004 read as 0.15 * 13 bit of idle; the source does not explain it",
        Standing::own},
       {"status_pitch_bits", fmt::format("{} bit", rules.status_pitch_bits), kOwn, Standing::own},
       {"forward_delay_half_bits", half_bits_text(rules.forward_delay_half_bits),
        "half of the 3 bit a station of Park 2004; the equal halves are this project's choice",
        Standing::own},
       {"return_delay_half_bits", half_bits_text(rules.return_delay_half_bits),
        "half of the 3 bit a station of Park 2004; the equal halves are this project's choice",
        Standing::own},
       {"local_delay_half_bits", half_bits_text(rules.local_delay_half_bits),
        "m in the formula of Park 2004 counts remote-bus stations only", Standing::derived},
       {"cable_delay_ps_per_m", fmt::format("{} ps/m", rules.cable_delay_ps_per_m),
        "two thirds of the speed of light, usual for twisted pairs", Standing::memory}});
}

void add_cycle_facts(std::vector<Fact>& table, const Rules& rules) {
  const bool is_chip_3 = rules.software_time == 700 * kernel::kMicrosecond;
  const std::string_view end_source = rules.end_telegrams == 2
                                          ? "Park 2004, section 2.2, the formula: 8 + n telegrams"
                                          : "Park 2004, section 2.2, the text: loopback word 2, FCS 4 octets";
  table.insert(
      table.end(),
      {{"loopback_word", bits(rules.loopback_word), "the value is this project's choice; 16 bit: Park 2004",
        Standing::own},
       {"frame_check[polynomial, preset]", rules.frame_check,
        "CCITT polynomial: an encoder manual; registers preset with 1: Buesing/Meyer, Practical Guide",
        Standing::searched},
       {"frame_check[bit order, final XOR]", rules.frame_check, kOwn, Standing::own},
       {"status_clean", bits(rules.status_clean), kOwn, Standing::own},
       {"status_marked", bits(rules.status_marked), kOwn, Standing::own},
       {"end_telegrams", fmt::format("{}", rules.end_telegrams), end_source, Standing::seed},
       {"software_time", kernel::describe(rules.software_time),
        is_chip_3 ? "Park 2004, section 2.2: master chip generation 3"
                  : "Park 2004, section 2.2: master chip generation 4",
        Standing::seed}});
}

void add_supervision_facts(std::vector<Fact>& table, const Rules& rules) {
  table.insert(table.end(),
               {{"silence_limit", kernel::describe(rules.silence_limit),
                 "Phoenix Contact UK, operation and maintenance of INTERBUS", Standing::searched},
                {"silence_tolerance", kernel::describe(rules.silence_tolerance), kOwn, Standing::own},
                {"latch_limit", kernel::describe(rules.latch_limit), kOwn, Standing::own},
                {"stop_after_bad_cycles", fmt::format("{} in a row", rules.stop_after_bad_cycles), kOwn,
                 Standing::own},
                {"quality_bad_cycles", fmt::format("{} in a window", rules.quality_bad_cycles),
                 "literature from memory; that quality is evaluated statistically: Phoenix Contact UK",
                 Standing::memory},
                {"quality_window_cycles", fmt::format("{} data cycles", rules.quality_window_cycles),
                 "literature from memory", Standing::memory},
                {"published_recovery_cycles", fmt::format("{} cycles", rules.published_recovery_cycles),
                 "Beckhoff BC4000 documentation, propagation delay", Standing::searched}});
}

void add_limit_facts(std::vector<Fact>& table, const Rules& rules) {
  table.insert(
      table.end(),
      {{"max_stations", fmt::format("{}", rules.max_stations), "Park 2004, section 1", Standing::seed},
       {"max_io_points", fmt::format("{} bit of registers", rules.max_io_points),
        "Hyundai Hi5, Schneider and Beckhoff manuals: 512 octets in each direction", Standing::searched},
       {"max_levels", fmt::format("{}", rules.max_levels), "Hyundai Hi5 manual", Standing::searched},
       {"max_distance_m", fmt::format("{} m", rules.max_distance_m),
        "Lenze, Schneider and Beckhoff manuals: 400 m at 500 kbit/s, 150 m at 2 Mbit/s", Standing::searched},
       {"max_cable_m", fmt::format("{} m", rules.max_cable_m), "Lenze, Schneider and Beckhoff manuals",
        Standing::searched}});
}

void add_word_facts(std::vector<Fact>& table, const Rules& rules) {
  constexpr std::string_view kControl =
      "the coding is this project's choice; Practical Guide has such a register";
  constexpr std::string_view kMessage =
      "the meaning of each bit is this project's choice; bits 13..15: WAGO 750-304";
  const auto codes = length_codes_of(rules);
  table.insert(
      table.end(),
      {{"control_remote_off", bits(rules.control_remote_off), kControl, Standing::own},
       {"control_local_off", bits(rules.control_local_off), kControl, Standing::own},
       {"control_reset", bits(rules.control_reset), kControl, Standing::own},
       {"control_acknowledge", bits(rules.control_acknowledge), kControl, Standing::own},
       {"message_reconfiguration", bits(rules.message_reconfiguration), kMessage, Standing::own},
       {"message_check_error", bits(rules.message_check_error), kMessage, Standing::own},
       {"message_peripheral_fault", bits(rules.message_peripheral_fault), kMessage, Standing::own},
       {"length_codes[00h..13h, 15h..17h]", length_codes_text(codes, false),
        "Schneider 890USE196; three points also in the Schneider 170 series table", Standing::searched},
       {"length_codes[14h]", length_codes_text(codes, true), "literature from memory", Standing::memory}});
}

std::vector<Fact> published_facts(const Rules& rules) {
  std::vector<Fact> table;
  add_line_facts(table, rules);
  add_cycle_facts(table, rules);
  add_supervision_facts(table, rules);
  add_limit_facts(table, rules);
  add_word_facts(table, rules);
  return table;
}

// The other values that a source names.
bool is_published_alternative(const Fact& fact, const Rules& rules) {
  return (fact.rule == "bit_rate" && rules.bit_rate == 2'000'000) ||
         (fact.rule == "max_distance_m" && rules.bit_rate == 2'000'000 && rules.max_distance_m == 150) ||
         (fact.rule == "end_telegrams" && rules.end_telegrams == 2) ||
         (fact.rule == "software_time" && rules.software_time == 700 * kernel::kMicrosecond);
}

}  // namespace

std::span<const LengthCode> published_length_codes() {
  return kPublishedLengthCodes;
}

std::span<const LengthCode> length_codes_of(const Rules& rules) {
  if (rules.length_codes.empty()) return published_length_codes();
  return rules.length_codes;
}

std::vector<Fact> facts(const Rules& rules) {
  std::vector<Fact> table = published_facts(rules);
  const std::vector<Fact> reference = published_facts(Rules{});
  for (std::size_t n = 0; n < table.size(); ++n) {
    if (table[n].value == reference[n].value || is_published_alternative(table[n], rules)) continue;
    table[n].source = kChanged;
    table[n].standing = Standing::own;
  }
  return table;
}

}  // namespace fieldproof::interbus

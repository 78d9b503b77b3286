#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <utility>

#include "conformance/interbus/other_codings.hpp"
#include "conformance/interbus/slave_acts.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_families.hpp"
#include "conformance/interbus/slave_sequence.hpp"
#include "conformance/sequence_draw.hpp"

// A slave beside references: each value of each word, each level of a cycle flipped, what happens within a
// cycle and within a reset, one thing after another, and everything again with other settings. Each sequence
// begins with the supply, both interfaces on and a data cycle, and ends with what shows the state.
namespace fieldproof::conformance {
namespace {

using slave_families::command;
using slave_families::Commands;
using slave_families::id;
using slave_families::returns;
using slave_families::vocabulary;

// ---- a case ----

using Families = std::vector<SequenceFamily<SlaveBench>>;

// One thing after a start, then what shows the state that it left.
Sequence between(const Commands& middle) {
  Sequence sequence{.commands = {command(SlaveWord::inputs), id(0), command(SlaveWord::data)}};
  sequence.commands.insert(sequence.commands.end(), middle.begin(), middle.end());
  for (const SequenceCommand& one :
       {returns(true), command(SlaveWord::data, {{0, 0xF00F}, {1, 0x00FF}}), returns(false), returns(true),
        id(0), command(SlaveWord::data, {{0, 0x8001}, {1, 0x7FFE}}), id(0), command(SlaveWord::data)})
    sequence.commands.push_back(one);
  return sequence;
}

struct Share {
  std::vector<Commands> (*family)();
  std::size_t quick;
  std::size_t full = kAllOfFamily;
};

Families each_of(const std::vector<Share>& shares) {
  Families families;
  for (const auto& [family, quick, full] : shares) {
    const auto all = [make = family](kernel::Random) {
      std::vector<Sequence> sequences;
      for (const Commands& middle : make()) sequences.push_back(between(middle));
      return sequences;
    };
    families.push_back({all, quick, full, run_slave_sequence});
  }
  return families;
}

void begin_anew(SlaveTwins& twins) {
  twins.each([&](SlaveBench& one) {
    one.set_power(false);
    one.silence(4 * twins.bench().rules().silence_limit);
    one.set_power(true);
    one.bring_up();
  });
}

// With outputs that are 0, because nobody can say when the slave resets itself: by then it may have.
void silence_in_a_reset(SlaveBench& bench, CaseJudge& judge) {
  SlaveTwins twins(bench);
  const interbus::Rules& rules = bench.rules();
  const std::array<std::uint16_t, 3> orders{0, rules.control_remote_off, rules.control_local_off};
  for (const std::uint16_t control : orders) {
    begin_anew(twins);
    SlaveActs acts(twins);
    for (const SequenceCommand& one :
         {command(SlaveWord::inputs), id(0), id(4), command(SlaveWord::silence, {{0, 5}})}) {
      acts.act(one, judge);
      twins.agree(judge, command_lines({.commands = {one}}, vocabulary()).front());
    }
    // The stations in front have reset themselves, too.
    twins.each([&](SlaveBench& one) {
      line::Waveform wave{one.now(), one.rules().bit_rate, one.direct_id_cycle(control)};
      one.drive_at_receiver(wave);
    });
    if (!twins.agree(judge, "an ID cycle in the time of the reset")) continue;
    twins.each([&](SlaveBench& one) {
      const std::vector<std::uint16_t> words(one.words(), 0x1234);
      line::Waveform wave{one.now(), one.rules().bit_rate, one.direct_data_cycle(words, 2)};
      one.drive_at_receiver(wave);
    });
    twins.agree(judge, "a data cycle after that");
  }
}

Families drawn() {
  constexpr std::uint64_t kAll = 300;
  const auto all = [](kernel::Random random) { return drawn_commands(vocabulary(), random.next(), kAll); };
  return {{.all = all, .quick = 15, .full = kAll, .run = run_slave_sequence}};
}

// Everything with other settings, some of it.
Families some_of_all() {
  return each_of({{slave_families::each_value, 20, 200},
                  {slave_families::one_after_another, 6, 200},
                  {slave_families::within_a_reset, 9}});
}

// For a slave whose levels are seen.
Families on_its_line(Families families) {
  for (SequenceFamily<SlaveBench>& family : families) {
    family.run = [](const Sequence& sequence, SlaveBench& bench, CaseJudge& judge) {
      bench.require_line_interface();
      run_slave_sequence(sequence, bench, judge);
    };
  }
  return families;
}

// ---- other settings ----

// Short delays and a short silence.
void change_to_short(interbus::Rules& rules) {
  rules.bit_rate = 2'000'000;
  rules.forward_delay_half_bits = 1;
  rules.return_delay_half_bits = 0;
  rules.silence_limit = 6 * kernel::kMillisecond;
  rules.silence_tolerance = 200 * kernel::kMicrosecond;
  rules.frame_check = "CRC-16/GENIBUS";
  rules.control_remote_off = 0x0010;
  rules.control_local_off = 0x0800;
}

// Delays beyond eight bits, a silence beyond sixteen bits of microseconds.
void change_to_long(interbus::Rules& rules) {
  rules.forward_delay_half_bits = 301;
  rules.return_delay_half_bits = 518;
  rules.silence_limit = 200 * kernel::kMillisecond;
  rules.silence_tolerance = 4 * kernel::kMillisecond;
  rules.frame_check = "CRC-16/KERMIT";
}

// A delay lasts longer than 32 bits of picoseconds.
void change_to_slow(interbus::Rules& rules) {
  rules.bit_rate = 100'000;
  rules.return_delay_half_bits = 999;
  rules.silence_limit = 400 * kernel::kMillisecond;
}

// A bit is no whole number of nanoseconds.
void change_to_odd_rate(interbus::Rules& rules) {
  rules.bit_rate = 1'111'112;
  rules.forward_delay_half_bits = 701;
  rules.return_delay_half_bits = 999;
}

// Minutes: the times of a sequence are longer than 32 bits of microseconds.
void change_to_minutes(interbus::Rules& rules) {
  rules.silence_limit = 700 * kernel::kSecond;
  rules.silence_tolerance = 2 * kernel::kSecond;
}

// No delay at all, and a limit of less than a millisecond.
void change_to_least(interbus::Rules& rules) {
  rules.forward_delay_half_bits = 0;
  rules.return_delay_half_bits = 0;
  rules.silence_limit = 800 * kernel::kMicrosecond;
  rules.silence_tolerance = 100 * kernel::kMicrosecond;
}

// Not whole milliseconds.
void change_to_parts_of_milliseconds(interbus::Rules& rules) {
  rules.silence_limit = 5'500 * kernel::kMicrosecond;
  rules.silence_tolerance = 100 * kernel::kMicrosecond;
}

constexpr std::uint16_t kCodeOfMany = 0x1903;
// As many words as a ring may have.
void change_to_many_words(interbus::Rules& rules) {
  const auto published = interbus::published_length_codes();
  rules.length_codes.assign(published.begin(), published.end());
  rules.length_codes.push_back({0x19, 256});
  rules.max_io_points *= 2;
}

SlaveCase compared(std::string_view id, std::string stimulus, std::vector<MustCatch> catches,
                   Families families, void (*change_rules)(interbus::Rules&) = nullptr,
                   std::optional<std::uint16_t> id_code = std::nullopt) {
  SlaveCase made{slave_sequence_role().test_case, nullptr, slave_sequence_needs()};
  made.families = std::move(families);
  made.test_case.id = fmt::format("interbus/slave/compared/{}", id);
  made.test_case.purpose = "compared";
  made.test_case.stimulus = std::move(stimulus);
  made.test_case.tags = {"must"};
  made.test_case.catches = std::move(catches);
  made.needs.change_rules = change_rules;
  made.needs.id_code = id_code;
  std::vector<Applicability> only_for{for_inputs(), for_outputs()};
  if (change_rules != nullptr) only_for.push_back(for_other_settings());
  made.test_case.not_applicable = for_all(std::move(only_for));
  return made;
}

SlaveCase done_by(void (*procedure)(SlaveBench&, CaseJudge&), SlaveCase one) {
  one.families.reset();
  one.procedure = procedure;
  return one;
}

std::vector<SlaveCase> cases_of_other_codings() {
  std::vector<SlaveCase> all;
  for (const OtherCoding& coding : other_codings()) {
    all.push_back(compared(coding.id, fmt::format("The same with {}.", coding.setting),
                           {{std::string(coding.mutant), std::string(coding.reason)}},
                           each_of({{slave_families::all_codings, 1}, {slave_families::each_value, 2, 60}}),
                           coding.change));
  }
  return all;
}

std::vector<SlaveCase> compared_as_usual() {
  const std::string after = " after a data cycle with both interfaces on; then cycles that show the state.";
  return {
      compared("each_value_of_each_word", "Each word of sequences with each boundary value," + after,
               {{"interface_switches_inside_cycle", "telegram_not_passed"},
                {"takes_half_a_status_word", "octet_wrong"}},
               each_of({{slave_families::each_value, 160}})),
      compared("each_fault_of_a_data_cycle", "A data cycle with a level flipped or a telegram lost," + after,
               {{"clears_outputs_on_rejected_cycle", "outputs_wrong"}},
               each_of({{slave_families::each_fault_of_a_data_cycle, 112}})),
      compared("each_fault_of_an_id_cycle", "An ID cycle with a level flipped or a telegram lost," + after,
               {{"id_octets_swapped", "octet_wrong"}},
               each_of({{slave_families::each_fault_of_an_id_cycle, 96}})),
      compared("one_thing_after_another", "Each two of all that leaves something behind," + after,
               {{"message_without_error", "octet_wrong"}},
               each_of({{slave_families::one_after_another, 40}})),
      compared("around_a_reset",
               "All that leaves something behind, before and after silence or a loss of supply," + after,
               {{"latches_late", "outputs_at_another_time"}},
               each_of({{slave_families::around_a_reset, 120}})),
      compared(
          "within_a_cycle", "Something between a cycle whose end is lost and that end," + after,
          {{"check_not_reset_between_cycles", "octet_wrong"},
           {"forgets_the_missing_stop_of_a_begin", "outputs_wrong"}},
          each_of({{slave_families::within_a_cycle, 90}, {slave_families::stop_missing_after_a_cut, 6}})),
      compared("within_a_reset_of_the_outgoing_bus",
               "ID cycles, silence and supply at both ends of the time of control_reset," + after,
               {{"outgoing_reset_clears_outputs", "outputs_wrong"},
                {"keeps_all_without_supply", "telegram_added"}},
               each_of({{slave_families::within_a_reset, 63}})),
      done_by(silence_in_a_reset,
              compared(
                  "silence_within_a_reset_of_the_outgoing_bus",
                  "Silence that resets the slave while it keeps the outgoing bus in reset, then an ID cycle.",
                  {{"reset_ends_outgoing_reset", "octet_wrong"}}, {})),
      compared("each_cut_of_a_cycle", "A data cycle in two transmissions without a gap," + after,
               {{"loses_the_rest_of_a_cut_telegram", "outputs_wrong"}},
               each_of({{slave_families::each_cut, 24}})),
      compared("two_faults_of_a_data_cycle",
               "A data cycle with two telegrams without a stop level, or one and a wrong level," + after,
               {{"second_missing_stop_takes_the_error_back", "octet_wrong"}},
               each_of({{slave_families::two_faults_of_a_data_cycle, 60}})),
      compared(
          "other_cuts_of_a_cycle",
          "A data cycle whose transmission ends within a telegram, alone or as the supply goes; in three "
          "transmissions; cut where a stop level is missing," +
              after,
          {{"drops_a_cut_telegram", "outputs_wrong"}}, each_of({{slave_families::other_cuts, 60}})),
      compared("other_glitches",
               "A low pulse that is no start level between the telegrams of a cycle, and on the ways back," +
                   after,
               {{"start_bit_not_validated", "outputs_wrong"},
                {"takes_glitches_on_the_way_back", "telegram_added"}},
               each_of({{slave_families::other_glitches, 24}})),
      compared("returned_edges_at_both_limits",
               "Telegrams come back at 1 % beside the bit rate whose edges lie 15 % of a bit beside their "
               "places," +
                   after,
               {{"samples_late_on_the_way_back", "octet_wrong"}},
               on_its_line(each_of({{slave_families::returned_edges_at_both_limits, 8}}))),
      compared("inputs_of_the_start_level", "A clock ticks at all inputs while data cycles come," + after,
               {{"samples_a_telegram_late", "inputs_of_another_instant"}},
               each_of({{slave_families::clock_at_the_inputs, 1}})),
      compared("telegrams_without_stop_are_signs_of_life",
               "Nothing but status telegrams without a stop level beyond the limit of silence," + after,
               {{"without_stop_no_sign_of_life", "outputs_wrong"}},
               each_of({{slave_families::other_signs_of_life, 1}})),
      compared("at_the_end_of_a_reset_of_the_outgoing_bus",
               "ID cycles that end 3/16 of the silence tolerance before and after the time of control_reset,"
               " then data cycles.",
               {{"outgoing_reset_a_quarter_short", "octet_wrong"}},
               each_of({{slave_families::at_the_end_of_a_reset, 6}})),
      compared("edges_at_both_limits",
               "A data cycle at 1 % beside the bit rate whose edges lie 15 % of a bit beside their places," +
                   after,
               {{"samples_late", "outputs_wrong"}},
               on_its_line(each_of({{slave_families::edges_at_both_limits, 8}}))),
      compared(
          "rare_orders",
          "Orders, messages and interfaces with an error, a mark or a silence in the very cycle," + after,
          {{"obeys_a_marked_id_cycle", "octet_wrong"}}, each_of({{slave_families::rare_orders, 40}})),
      compared("each_header_keeps_alive", "Telegrams of one header are the only signs of life," + after,
               {{"silence_counts_data_only", "outputs_wrong"}},
               each_of({{slave_families::each_header_keeps_alive, 8}})),
      compared("many_errors", "18 and 256 cycles in a row with a wrong check," + after,
               {{"counts_errors_in_8_bits", "octet_wrong"}}, each_of({{slave_families::many_errors, 2}})),
      compared(
          "many_cycles",
          "270 data cycles, 270 ID cycles, and a data cycle after 253 to 257 ID cycles," + after,
          {{"loses_every_200th_cycle", "outputs_wrong"}, {"counts_id_cycles_in_8_bits", "outputs_wrong"}},
          each_of({{slave_families::many_cycles, 2}, {slave_families::data_after_many_id_cycles, 5}})),
      compared("drawn_sequences", "Sequences of all words at random.",
               {{"delays_four_bits", "passed_at_another_time"}}, drawn())};
}

std::vector<SlaveCase> compared_elsewhere() {
  return {
      compared("other_codings", "The same with each coding another one.",
               {{"final_xor_hard_coded", "octet_wrong"}}, some_of_all(), change_each_coding),
      compared("short_times", "The same with short delays and a short silence.",
               {{"delays_four_bits", "passed_at_another_time"}}, some_of_all(), change_to_short),
      compared("long_times", "The same with long delays and a long silence.",
               {{"latches_5_ms_late", "outputs_at_another_time"}}, some_of_all(), change_to_long),
      compared("slow_line", "The same at 100 kbit/s with a delay of 5 ms.",
               {{"delay_in_32_bits", "passed_at_another_time"}},
               each_of({{slave_families::around_a_reset, 12}, {slave_families::each_value, 12}}),
               change_to_slow),
      compared("bits_of_odd_length", "The same at 1.111112 Mbit/s with delays of hundreds of bits.",
               {{"bit_time_in_whole_nanoseconds", "passed_at_another_time"}},
               each_of({{slave_families::each_value, 16}, {slave_families::one_after_another, 6}}),
               change_to_odd_rate),
      compared("times_of_minutes", "Silences and resets with a silence limit of 700 s.",
               {{"counts_microseconds_in_32_bits", "outputs_wrong"}},
               each_of({{slave_families::silence_after_a_long_life, 8},
                        {slave_families::around_a_reset, 16},
                        {slave_families::at_the_end_of_a_reset, 2}}),
               change_to_minutes),
      compared("least_times", "The same without delays and with a silence limit of 0.8 ms.",
               {{"a_delay_at_least", "passed_at_another_time"}},
               each_of({{slave_families::each_value, 12}, {slave_families::around_a_reset, 12}}),
               change_to_least),
      compared("parts_of_milliseconds", "Silences and resets with a silence limit of 5.5 ms, to 0.1 ms.",
               {{"silence_limit_in_whole_milliseconds", "outputs_at_another_time"}},
               each_of({{slave_families::around_a_reset, 16}, {slave_families::at_the_end_of_a_reset, 2}}),
               change_to_parts_of_milliseconds),
      compared("many_words", "The same with 256 words.", {{"loses_input_words_above_16", "octet_wrong"}},
               each_of({{slave_families::each_value, 8, 60}}), change_to_many_words, kCodeOfMany)};
}

}  // namespace

std::vector<SlaveCase> slave_compared_cases() {
  return joined({compared_as_usual(), cases_of_other_codings(), compared_elsewhere()});
}

}  // namespace fieldproof::conformance

#include "conformance/interbus/slave_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/slave_acts.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_codings.hpp"
#include "conformance/interbus/slave_reasons.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/field/walk.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

// Drawn as codings, some values of each.
constexpr std::array<std::string_view, 3> kFixedOfSlave{"status_*", "control_*", "message_*"};

// A network within its limits, on which no tester is silent for too long.
void expect_judgeable_slave(const field::Settings& settings) {
  SlaveSetting setting;
  setting.settings = settings;
  const interbus::NetworkDescription network = slave_network(slave_sequence_needs(), setting);
  if (const auto violation = interbus::check(network))
    throw kernel::Error(kernel::ErrorKind::configuration, violation->sentence);
  expect_time_for_silences(network.rules);
  const interbus::SlaveConfiguration usual;
  const field::Settings changed = with_changed_places(settings, usual);
  for (const auto& [name, value] : settings) {
    const auto found = std::ranges::find(changed, name, &field::Settings::value_type::first);
    if (found == changed.end() || found->second != value)
      throw kernel::Error(
          kernel::ErrorKind::configuration,
          fmt::format("\"{}\" has the place of another one; give each a place of its own", name));
  }
}

// Slower, a transmission of a sequence lasts longer than a bench waits for one; and who receives telegrams
// knows of one when it has ended.
constexpr std::array kBoundsOfSlave{SettingBound{"bit_rate", {100'000, 2'000'000}},
                                    SettingBound{"silence_tolerance", {200'000'000, 1'000'000'000'000'000}}};

// Of 24 and of 32 words.
constexpr std::array<std::int64_t, 4> kCodesOfManyWords{0x1303, 0x1403, 0x1303, 0x1403};

// What a slave was identified with, has switched on or has lost.
std::vector<std::vector<NamedCommand>> states_of_a_slave() {
  const NamedCommand identified{"id"};
  const NamedCommand on{"id", {{"orders", 0}}};
  const NamedCommand plugged{"plugs"};
  return {{identified, {"data"}},
          {plugged, on, {"data"}},
          {plugged, on, {"silence"}},
          {identified, {"data"}, {"periphery"}},
          {plugged, on, {"data"}, {"power"}},
          {identified, {"telegrams"}},
          {identified, {"inputs"}, {"good"}},
          {plugged, {"id", {{"orders", 0}, {"reserved", 0x0100}}}, {"good"}},
          {plugged, on, {"good"}, {"id", {{"orders", 4}}}, {"good"}},
          {plugged, on, {"good"}, {"silence", {{"how_long", 0}}}, {"returns"}, {"silence"}},
          // Silence that resets the slave while it keeps the outgoing bus in reset.
          {plugged, {"right_id", {{"orders", 4}}}, {"silence", {{"how_long", 5}}}, {"right_id"}}};
}

// Lengths between the ends, and each coding, too.
std::vector<SequenceSetting> settings_of_a_slave(const interbus::SlaveConfiguration& as_made) {
  std::vector<SequenceSetting> all =
      sequence_settings(interbus::kSlaveTable, &as_made, kFixedOfSlave, kBoundsOfSlave);
  const auto code = std::ranges::find(all, std::string_view("id_code"), &SequenceSetting::name);
  if (code != all.end())
    code->likely.insert(code->likely.end(), kCodesOfManyWords.begin(), kCodesOfManyWords.end());
  // The final XOR of the frame check, at the end: with the other one it is a check of the catalogues, too.
  field::walk(interbus::kSlaveTable, &as_made, [&](const field::Leaf& leaf) {
    if (leaf.name != "frame_check") return;
    all.push_back({.name = "check_final_xor",
                   .row = &leaf.row,
                   .least = 0,
                   .most = 0xFFFF,
                   .simple = 0,
                   .likely = {0xFFFF},
                   .is_likely_only = true});
  });
  const std::vector<SequenceSetting> codings = settings_of_codings(as_made);
  all.insert(all.end(), codings.begin(), codings.end());
  return all;
}

SequenceVocabulary slave_vocabulary() {
  const interbus::SlaveConfiguration as_made =
      SlaveBench(slave_sequence_needs(), SlaveSetting{}).ring().configuration(1);
  return {.words = slave_words(),
          .unit = "telegram",
          .levels_per_unit = line::kDataTelegramLevels,
          .settings = settings_of_a_slave(as_made),
          .objection = objection_of(expect_judgeable_slave)};
}

}  // namespace

const SequenceRole& slave_sequence_role() {
  static const SequenceRole role{
      {.id = "interbus/slave/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever comes at whichever port, whatever happens at the terminals and to the supply, "
           "a slave passes on and shows what a right one does.",
       .reference = sources::from_memory("what a slave does with a cycle, and with a rejected one"),
       .details = details::answer(),
       .rules = slave_reasons(),
       .stimulus =
           "Cycles, telegrams, silences and all else at random, with flipped levels and lost telegrams.",
       .expected =
           "Each telegram on each line and each change of an output is that of two references, one early "
           "and one late.",
       .tags = {},
       .catches = {}},
      with_beginnings(slave_vocabulary(), states_of_a_slave()),
      {{DerivedKind::values, {"sends_check_of_received_bits", "octet_wrong"}},
       {DerivedKind::faults, {"clears_outputs_on_rejected_cycle", "outputs_wrong"}},
       {DerivedKind::words, {"output_octets_swapped", "outputs_wrong"}},
       {DerivedKind::states, {"does_not_resynchronise", "telegram_not_passed"}},
       {DerivedKind::walks, {"locks_up_after_rejected_cycle", "outputs_wrong"}},
       {DerivedKind::repetitions, {"latches_5_ms_late", "outputs_at_another_time"}},
       {DerivedKind::settings, {"input_bit_stuck", "octet_wrong"}},
       {DerivedKind::drawn, {"does_not_resynchronise", "telegram_not_passed"}}}};
  return role;
}

SlaveNeeds slave_sequence_needs() {
  return {.id_code = {}, .remote_neighbour = true, .branch_neighbour = true};
}

void run_slave_sequence(const Sequence& sequence, SlaveBench& bench, CaseJudge& judge) {
  SlaveTwins twins(bench);
  SlaveActs acts(twins);
  twins.each([](SlaveBench& one) { one.bring_up(); });
  const SequenceVocabulary& vocabulary = slave_sequence_role().vocabulary;
  for (const SequenceCommand& command : sequence.commands) {
    acts.act(command, judge);
    if (!twins.agree(judge, command_lines({.commands = {command}}, vocabulary).front())) return;
  }
}

}  // namespace fieldproof::conformance

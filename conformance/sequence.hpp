#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/field/field.hpp"
#include "harness/field/settings.hpp"

// Sequences of commands to an implementation, as values: what `check` draws at random, makes smaller and
// stores, and what `replay` runs again. Which commands there are is the vocabulary of a role; a bench of that
// role knows how to do them, and a model of it what must come of them.
//
// A sequence may begin with settings, by the names and numbers of the Field table of the role: what the
// implementation is given at the beginning of its case besides what the bench has for it, and the references
// that it is compared with, too.
//
// A number of a command lies between the limits of its vocabulary, whoever made the sequence: drawing and
// reading both see to that, so a bench need not.
namespace fieldproof::conformance {

enum class SequenceFaultKind : std::uint8_t {
  flip,  // a level of a unit arrives inverted
  drop,  // a unit does not arrive; what is behind it arrives in time
  gap,   // silence behind a unit
};

// What is wrong with the transmission of one command. A unit is what the line consists of: a character, a
// telegram; one after the last of them, or a level after its end, does nothing.
struct SequenceFault {
  SequenceFaultKind kind = SequenceFaultKind::flip;
  std::uint32_t unit = 0;   // from 0
  std::uint32_t value = 0;  // flip: the level, from 0; gap: bits; drop: 0

  friend auto operator<=>(const SequenceFault&, const SequenceFault&) = default;
};

struct SequenceNumber {
  std::string_view name;
  std::int64_t least = 0;
  std::int64_t most = 0;
  std::int64_t simple = 0;                 // what a person expects when nothing is said
  std::span<const std::int64_t> likely{};  // what is drawn more often than the rest
  bool is_likely_only = false;             // the rest is never drawn: between them nothing is certain
};

struct SequenceWord {
  std::string_view word;
  std::string_view meaning;  // "writes DATA0 and DATA1"
  std::vector<SequenceNumber> numbers{};
  std::size_t most_octets = 0;  // octets of any value behind the numbers
  unsigned units = 0;           // of a transmission without octets; a word with neither takes no faults
  unsigned weight = 1;          // how often it is drawn, beside the others
  bool is_loss = false;         // what went before is lost with it, as with the supply
  bool is_no_frame = false;     // who receives telegrams cannot be told of it
};

// A setting that a sequence may begin with: a number with a name and a list of its own.
struct SequenceSetting {
  std::string name;
  const field::Row* row = nullptr;
  std::int64_t least = 0;
  std::int64_t most = 0;
  std::int64_t simple = 0;             // what the bench gives when nothing is said
  std::vector<std::int64_t> likely{};  // others than that: both ends and their neighbours
  bool is_likely_only = false;         // a choice

  SequenceNumber number() const { return {name, least, most, simple, likely, is_likely_only}; }
};

// Why a role cannot be judged with these, as a sentence; nothing: it can.
using SettingsObjection = std::function<std::optional<std::string>(const field::Settings&)>;

struct SequenceCommand {
  std::size_t word = 0;                // of the vocabulary
  std::vector<std::int64_t> numbers;   // as many as the word has
  std::vector<std::uint8_t> octets{};  // at most as many as the word takes
  std::vector<SequenceFault> faults{};

  friend bool operator==(const SequenceCommand&, const SequenceCommand&) = default;
};

// A setting that commands show, and what else must be set for that.
struct ShownSetting {
  std::string name;
  field::Settings along{};
};
// Commands after which a fault shows that random ones would seldom meet, with the settings that matter there.
struct SequenceSituation {
  std::vector<SequenceCommand> commands;
  std::vector<ShownSetting> shown{};
};

struct SequenceVocabulary {
  std::vector<SequenceWord> words;
  std::string_view unit = "character";
  unsigned levels_per_unit = 11;
  std::span<const std::int64_t> gaps{};  // bits of silence that are drawn
  std::size_t most_commands = 20;        // in a drawn sequence
  std::vector<SequenceSetting> settings{};
  SettingsObjection objection{};  // null: there is none
  // Commands that bring a station into each of its states, for sequences that are derived; that in which it
  // begins need not be among them.
  std::vector<std::vector<SequenceCommand>> beginnings{};
  // What every second drawn sequence begins with, where there are any.
  std::vector<SequenceSituation> situations{};

  const SequenceWord* find(std::string_view word) const;
  const SequenceSetting* find_setting(std::string_view name) const;
  std::optional<std::string> objection_to(const field::Settings& given) const;
};

struct Sequence {
  std::vector<SequenceCommand> commands{};
  // In the order of the vocabulary; those that are not here are as the bench has them.
  field::Settings settings{};

  friend bool operator==(const Sequence&, const Sequence&) = default;
};

// The numbers of a word that are not given, by their place, are the simple ones.
using GivenNumbers = std::initializer_list<std::pair<std::size_t, std::int64_t>>;
SequenceCommand simple_command(const SequenceVocabulary& vocabulary, std::size_t word,
                               GivenNumbers given = {});
SequenceVocabulary without_settings(SequenceVocabulary vocabulary);

// A command in the words of its vocabulary; the numbers that are not named are the simple ones.
struct NamedCommand {
  std::string_view word;
  std::vector<std::pair<std::string_view, std::int64_t>> numbers{};
};
SequenceVocabulary with_beginnings(SequenceVocabulary vocabulary,
                                   const std::vector<std::vector<NamedCommand>>& states);
struct NamedSituation {
  std::vector<NamedCommand> commands;
  std::vector<ShownSetting> shown{};
};
SequenceVocabulary with_situations(SequenceVocabulary vocabulary,
                                   const std::vector<NamedSituation>& situations);

// Units of the transmission of a command, without its faults.
std::size_t units_of(const SequenceWord& word, const SequenceCommand& command);
std::size_t flips_in(const Sequence& sequence);
std::size_t faults_in(const Sequence& sequence);

// "level 3 of character 2 flipped", with the name of a unit.
std::string fault_text(const SequenceFault& fault, std::string_view unit);
// "loss_limit 0 s, boards 1".
std::string settings_text(const field::Settings& settings, const SequenceVocabulary& vocabulary);
// One line for each command: "write data0 165 data1 60 silence 45; bit 3 of character 2 flipped".
std::vector<std::string> command_lines(const Sequence& sequence, const SequenceVocabulary& vocabulary);
// The same after a line for the settings, where it begins with some.
std::vector<std::string> sequence_lines(const Sequence& sequence, const SequenceVocabulary& vocabulary);

// The members "settings" and "commands" of a case file. Reading is strict: an error names line and pointer.
std::string sequence_json(const Sequence& sequence, const SequenceVocabulary& vocabulary);
Sequence read_sequence(config::ObjectReader& reader, const SequenceVocabulary& vocabulary);

}  // namespace fieldproof::conformance

#include "conformance/sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "harness/field/words.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostCommands = 1'000;
constexpr std::size_t kMostFaults = 1'000;
constexpr std::uint32_t kMostUnit = 1'000;
constexpr std::uint32_t kMostValue = 100'000;

constexpr std::array<std::string_view, 3> kFaultNames{"flip", "drop", "gap"};

ordered_json fault_json(const SequenceFault& fault) {
  ordered_json json;
  json["fault"] = kFaultNames.at(static_cast<std::size_t>(fault.kind));
  json["unit"] = fault.unit;
  if (fault.kind == SequenceFaultKind::flip) json["level"] = fault.value;
  if (fault.kind == SequenceFaultKind::gap) json["bits"] = fault.value;
  return json;
}

SequenceFault read_fault(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& reader) {
    SequenceFault fault;
    fault.kind = static_cast<SequenceFaultKind>(reader.required("fault").as_choice(kFaultNames));
    fault.unit = reader.required("unit").as_integer<std::uint32_t>(0, kMostUnit);
    if (fault.kind == SequenceFaultKind::flip) {
      fault.value = reader.required("level").as_integer<std::uint32_t>(0, kMostValue);
    } else if (fault.kind == SequenceFaultKind::gap) {
      fault.value = reader.required("bits").as_integer<std::uint32_t>(0, kMostValue);
    }
    return fault;
  });
}

SequenceCommand read_command(const config::Value& value, const SequenceVocabulary& vocabulary) {
  return config::read_object(value, [&](config::ObjectReader& reader) {
    std::vector<std::string_view> names;
    for (const SequenceWord& word : vocabulary.words) names.push_back(word.word);
    SequenceCommand command;
    command.word = reader.required("do").as_choice(names);
    const SequenceWord& word = vocabulary.words[command.word];
    for (const SequenceNumber& number : word.numbers) {
      command.numbers.push_back(
          reader.required(number.name).as_integer<std::int64_t>(number.least, number.most));
    }
    if (word.most_octets > 0) {
      for (const config::Value& octet : reader.required("octets").as_array(1, word.most_octets)) {
        command.octets.push_back(octet.as_integer<std::uint8_t>());
      }
    }
    if (units_of(word, command) == 0) return command;
    if (const auto faults = reader.optional("faults")) {
      for (const config::Value& fault : faults->as_array(0, kMostFaults)) {
        command.faults.push_back(read_fault(fault));
      }
    }
    return command;
  });
}

field::Settings read_settings(const config::Value& value, const SequenceVocabulary& vocabulary) {
  field::Settings settings = config::read_object(value, [&](config::ObjectReader& reader) {
    field::Settings read;
    for (const SequenceSetting& one : vocabulary.settings) {
      if (const auto number = reader.optional(one.name))
        read.emplace_back(one.name, number->as_integer<std::int64_t>(one.least, one.most));
    }
    return read;
  });
  if (const auto why_not = vocabulary.objection_to(settings)) config::fail(value, *why_not);
  return settings;
}

}  // namespace

const SequenceWord* SequenceVocabulary::find(std::string_view word) const {
  const auto found = std::ranges::find(words, word, &SequenceWord::word);
  return found == words.end() ? nullptr : &*found;
}

const SequenceSetting* SequenceVocabulary::find_setting(std::string_view name) const {
  const auto found = std::ranges::find(settings, name, &SequenceSetting::name);
  return found == settings.end() ? nullptr : &*found;
}

std::optional<std::string> SequenceVocabulary::objection_to(const field::Settings& given) const {
  return given.empty() || !objection ? std::nullopt : objection(given);
}

SequenceCommand simple_command(const SequenceVocabulary& vocabulary, std::size_t word, GivenNumbers given) {
  constexpr std::size_t kOctets = 4;
  const SequenceWord& of = vocabulary.words[word];
  SequenceCommand command{.word = word, .numbers = {}};
  for (const SequenceNumber& number : of.numbers) command.numbers.push_back(number.simple);
  for (const auto& [n, value] : given) command.numbers.at(n) = value;
  if (of.most_octets > 0) command.octets.assign(std::min<std::size_t>(of.most_octets, kOctets), 0x5A);
  return command;
}

SequenceVocabulary without_settings(SequenceVocabulary vocabulary) {
  vocabulary.settings.clear();
  return vocabulary;
}

namespace {

SequenceCommand command_of(const NamedCommand& named, const SequenceVocabulary& vocabulary) {
  const SequenceWord* const word = vocabulary.find(named.word);
  FIELDPROOF_CHECK(word != nullptr, "a state is reached by words of the vocabulary");
  SequenceCommand command =
      simple_command(vocabulary, static_cast<std::size_t>(word - vocabulary.words.data()));
  for (const auto& [name, value] : named.numbers) {
    const auto number = std::ranges::find(word->numbers, name, &SequenceNumber::name);
    FIELDPROOF_CHECK(number != word->numbers.end() && number->least <= value && value <= number->most,
                     "a state is reached by numbers of the vocabulary");
    command.numbers[static_cast<std::size_t>(number - word->numbers.begin())] = value;
  }
  return command;
}

std::vector<SequenceCommand> commands_of(const std::vector<NamedCommand>& named,
                                         const SequenceVocabulary& vocabulary) {
  std::vector<SequenceCommand> commands;
  for (const NamedCommand& one : named) commands.push_back(command_of(one, vocabulary));
  return commands;
}

}  // namespace

SequenceVocabulary with_beginnings(SequenceVocabulary vocabulary,
                                   const std::vector<std::vector<NamedCommand>>& states) {
  for (const std::vector<NamedCommand>& state : states)
    vocabulary.beginnings.push_back(commands_of(state, vocabulary));
  return vocabulary;
}

SequenceVocabulary with_situations(SequenceVocabulary vocabulary,
                                   const std::vector<NamedSituation>& situations) {
  for (const NamedSituation& one : situations) {
    for (const ShownSetting& shown : one.shown)
      FIELDPROOF_CHECK(vocabulary.find_setting(shown.name) != nullptr,
                       "what a situation shows is a setting of the vocabulary");
    vocabulary.situations.push_back({commands_of(one.commands, vocabulary), one.shown});
  }
  return vocabulary;
}

std::size_t units_of(const SequenceWord& word, const SequenceCommand& command) {
  return word.most_octets > 0 ? command.octets.size() : word.units;
}

std::size_t faults_in(const Sequence& sequence) {
  std::size_t count = 0;
  for (const SequenceCommand& command : sequence.commands) count += command.faults.size();
  return count;
}

std::size_t flips_in(const Sequence& sequence) {
  std::size_t count = 0;
  for (const SequenceCommand& command : sequence.commands) {
    count += static_cast<std::size_t>(
        std::ranges::count(command.faults, SequenceFaultKind::flip, &SequenceFault::kind));
  }
  return count;
}

std::string fault_text(const SequenceFault& fault, std::string_view unit) {
  switch (fault.kind) {
    case SequenceFaultKind::flip:
      return fmt::format("level {} of {} {} flipped", fault.value, unit, fault.unit);
    case SequenceFaultKind::drop:
      return fmt::format("{} {} dropped", unit, fault.unit);
    case SequenceFaultKind::gap:
      break;
  }
  return fmt::format("{} bits of silence after {} {}", fault.value, unit, fault.unit);
}

std::string settings_text(const field::Settings& settings, const SequenceVocabulary& vocabulary) {
  std::string text;
  for (const auto& [name, value] : settings) {
    const SequenceSetting* const setting = vocabulary.find_setting(name);
    const std::string number =
        setting == nullptr ? std::to_string(value) : field::text_of(*setting->row, value);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, number);
  }
  return text;
}

std::vector<std::string> sequence_lines(const Sequence& sequence, const SequenceVocabulary& vocabulary) {
  std::vector<std::string> lines = command_lines(sequence, vocabulary);
  if (!sequence.settings.empty())
    lines.insert(lines.begin(), "settings " + settings_text(sequence.settings, vocabulary));
  return lines;
}

std::vector<std::string> command_lines(const Sequence& sequence, const SequenceVocabulary& vocabulary) {
  std::vector<std::string> lines;
  for (const SequenceCommand& command : sequence.commands) {
    const SequenceWord& word = vocabulary.words.at(command.word);
    std::string line(word.word);
    for (std::size_t n = 0; n < word.numbers.size(); ++n) {
      line += fmt::format(" {} {}", word.numbers[n].name, command.numbers.at(n));
    }
    if (!command.octets.empty()) line += fmt::format(" octets {:02X}", fmt::join(command.octets, " "));
    for (const SequenceFault& fault : command.faults) line += "; " + fault_text(fault, vocabulary.unit);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string sequence_json(const Sequence& sequence, const SequenceVocabulary& vocabulary) {
  ordered_json list = ordered_json::array();
  for (const SequenceCommand& command : sequence.commands) {
    const SequenceWord& word = vocabulary.words.at(command.word);
    ordered_json json;
    json["do"] = word.word;
    for (std::size_t n = 0; n < word.numbers.size(); ++n) {
      json[std::string(word.numbers[n].name)] = command.numbers.at(n);
    }
    if (word.most_octets > 0) json["octets"] = command.octets;
    if (!command.faults.empty()) {
      for (const SequenceFault& fault : command.faults) json["faults"].push_back(fault_json(fault));
    }
    list.push_back(std::move(json));
  }
  ordered_json json;
  for (const auto& [name, value] : sequence.settings) json["settings"][name] = value;
  json["commands"] = std::move(list);
  return json.dump();
}

Sequence read_sequence(config::ObjectReader& reader, const SequenceVocabulary& vocabulary) {
  Sequence sequence;
  if (const auto settings = reader.optional("settings"))
    sequence.settings = read_settings(*settings, vocabulary);
  for (const config::Value& command : reader.required("commands").as_array(0, kMostCommands)) {
    sequence.commands.push_back(read_command(command, vocabulary));
  }
  return sequence;
}

}  // namespace fieldproof::conformance

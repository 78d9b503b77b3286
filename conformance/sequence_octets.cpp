#include "conformance/sequence_octets.hpp"

#include <algorithm>

#include "conformance/sequence_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr unsigned kOctet = 256;
constexpr unsigned kOwnValue = 0x80;     // of a selector: the value follows
constexpr unsigned kFirstFaulty = 0xA0;  // of the count of faults: below it there are none
constexpr unsigned kMostFaultsOfAStep = 3;
constexpr unsigned kFaultKinds = 3;
constexpr unsigned kSettings = 0xF0;  // no word is written so
constexpr unsigned kMostSettings = 0x10;
constexpr unsigned kSituation = 0xEF;  // nor so

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> octets) : left_(octets) {}

  bool is_empty() const { return left_.empty(); }
  bool begins_with(unsigned least) const { return !left_.empty() && left_.front() >= least; }
  bool takes(unsigned octet) {
    if (left_.empty() || left_.front() != octet) return false;
    left_ = left_.subspan(1);
    return true;
  }
  unsigned octet() {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }
  // As many octets as the limit needs.
  std::uint64_t number_below(std::uint64_t limit) {
    std::uint64_t value = 0;
    for (std::uint64_t reach = 1; reach < limit; reach *= kOctet) value = value * kOctet + octet();
    return value % limit;
  }

 private:
  std::span<const std::uint8_t> left_;
};

class Writer {
 public:
  void octet(std::size_t value) { octets.push_back(static_cast<std::uint8_t>(value)); }
  void number_below(std::uint64_t value, std::uint64_t limit) {
    std::vector<std::uint8_t> digits;
    for (std::uint64_t reach = 1; reach < limit; reach *= kOctet) {
      digits.push_back(static_cast<std::uint8_t>(value % kOctet));
      value /= kOctet;
    }
    octets.insert(octets.end(), digits.rbegin(), digits.rend());
  }

  std::vector<std::uint8_t> octets;
};

std::uint64_t values_of(const SequenceNumber& number) {
  return static_cast<std::uint64_t>(number.most - number.least) + 1;
}

std::int64_t read_number(Reader& reader, const SequenceNumber& number) {
  const unsigned selector = reader.octet();
  const bool is_likely = number.is_likely_only || selector < kOwnValue;
  // Words share lists of likely values: one beyond the range of this number would be no sequence that can be
  // stored.
  if (is_likely && !number.likely.empty())
    return std::clamp(number.likely[selector % number.likely.size()], number.least, number.most);
  return number.least + static_cast<std::int64_t>(reader.number_below(values_of(number)));
}

void write_number(Writer& writer, const SequenceNumber& number, std::int64_t value) {
  const auto likely = std::ranges::find(number.likely, value);
  if (likely != number.likely.end())
    return writer.octet(static_cast<std::size_t>(likely - number.likely.begin()));
  writer.octet(kOwnValue);
  writer.number_below(static_cast<std::uint64_t>(value - number.least), values_of(number));
}

field::Settings read_settings(Reader& reader, const SequenceVocabulary& vocabulary) {
  if (vocabulary.settings.empty() || !reader.begins_with(kSettings)) return {};
  std::vector<SettingChoice> chosen;
  for (unsigned left = 1 + reader.octet() % kMostSettings; left > 0; --left) {
    const std::size_t which = reader.octet() % vocabulary.settings.size();
    chosen.push_back({which, read_number(reader, vocabulary.settings[which].number())});
  }
  return settings_of(chosen, vocabulary);
}

void write_settings(Writer& writer, const field::Settings& settings, const SequenceVocabulary& vocabulary) {
  if (settings.empty()) return;
  const std::size_t count = std::min<std::size_t>(settings.size(), kMostSettings);
  writer.octet(kSettings + count - 1);
  for (std::size_t n = 0; n < count; ++n) {
    const SequenceSetting* setting = vocabulary.find_setting(settings[n].first);
    writer.octet(static_cast<std::size_t>(setting - vocabulary.settings.data()));
    write_number(writer, setting->number(), settings[n].second);
  }
}

std::vector<SequenceCommand> read_situation(Reader& reader, const SequenceVocabulary& vocabulary) {
  const auto& all = vocabulary.situations;
  if (all.empty() || !reader.takes(kSituation)) return {};
  return all[reader.number_below(all.size())].commands;
}

// That which covers the most of its commands, as many as are returned.
std::size_t write_situation(Writer& writer, const std::vector<SequenceCommand>& commands,
                            const SequenceVocabulary& vocabulary) {
  const auto& all = vocabulary.situations;
  const auto covered = [&](const SequenceSituation& one) {
    return std::ranges::mismatch(one.commands, commands).in1 == one.commands.end() ? one.commands.size() : 0;
  };
  const auto longest = std::ranges::max_element(all, {}, covered);
  const std::size_t count = longest == all.end() ? 0 : covered(*longest);
  if (count == 0) return 0;
  writer.octet(kSituation);
  writer.number_below(static_cast<std::uint64_t>(longest - all.begin()), all.size());
  return count;
}

SequenceFault read_fault(Reader& reader, const SequenceVocabulary& vocabulary, std::size_t units) {
  SequenceFault fault;
  fault.kind = static_cast<SequenceFaultKind>(reader.octet() % kFaultKinds);
  if (fault.kind == SequenceFaultKind::gap && vocabulary.gaps.empty()) fault.kind = SequenceFaultKind::drop;
  fault.unit = static_cast<std::uint32_t>(reader.number_below(units));
  if (fault.kind == SequenceFaultKind::flip)
    fault.value = static_cast<std::uint32_t>(reader.number_below(vocabulary.levels_per_unit));
  if (fault.kind == SequenceFaultKind::gap)
    fault.value = static_cast<std::uint32_t>(vocabulary.gaps[reader.octet() % vocabulary.gaps.size()]);
  return fault;
}

void write_fault(Writer& writer, const SequenceFault& fault, const SequenceVocabulary& vocabulary,
                 std::size_t units) {
  writer.octet(static_cast<std::size_t>(fault.kind));
  writer.number_below(fault.unit, units);
  if (fault.kind == SequenceFaultKind::flip) writer.number_below(fault.value, vocabulary.levels_per_unit);
  if (fault.kind != SequenceFaultKind::gap) return;
  const auto gap = std::ranges::find(vocabulary.gaps, std::int64_t{fault.value});
  writer.octet(static_cast<std::size_t>(gap - vocabulary.gaps.begin()) % vocabulary.gaps.size());
}

}  // namespace

Sequence sequence_of_octets(std::span<const std::uint8_t> octets, const SequenceVocabulary& vocabulary) {
  Reader reader(octets);
  Sequence sequence;
  sequence.settings = read_settings(reader, vocabulary);
  sequence.commands = read_situation(reader, vocabulary);
  while (!reader.is_empty() && sequence.commands.size() < kMostFuzzedCommands) {
    SequenceCommand command;
    command.word = reader.octet() % vocabulary.words.size();
    const SequenceWord& word = vocabulary.words[command.word];
    for (const SequenceNumber& number : word.numbers) command.numbers.push_back(read_number(reader, number));
    if (word.most_octets > 0) {
      const std::size_t count = 1 + reader.octet() % word.most_octets;
      for (std::size_t n = 0; n < count; ++n)
        command.octets.push_back(static_cast<std::uint8_t>(reader.octet()));
    }
    const std::size_t units = units_of(word, command);
    const unsigned faults = units > 0 ? reader.octet() : 0;
    for (unsigned n = 0; faults >= kFirstFaulty && n <= faults % kMostFaultsOfAStep; ++n)
      command.faults.push_back(read_fault(reader, vocabulary, units));
    std::ranges::sort(command.faults);
    const auto doubled = std::ranges::unique(command.faults);
    command.faults.erase(doubled.begin(), doubled.end());
    sequence.commands.push_back(std::move(command));
  }
  return sequence;
}

std::vector<std::uint8_t> octets_of_sequence(const Sequence& sequence, const SequenceVocabulary& vocabulary) {
  Writer writer;
  write_settings(writer, sequence.settings, vocabulary);
  const std::size_t written = write_situation(writer, sequence.commands, vocabulary);
  for (const SequenceCommand& command : std::span(sequence.commands).subspan(written)) {
    const SequenceWord& word = vocabulary.words[command.word];
    writer.octet(command.word);
    for (std::size_t n = 0; n < word.numbers.size(); ++n)
      write_number(writer, word.numbers[n], command.numbers[n]);
    if (word.most_octets > 0) {
      writer.octet(command.octets.size() - 1);
      for (const std::uint8_t octet : command.octets) writer.octet(octet);
    }
    const std::size_t units = units_of(word, command);
    if (units == 0) continue;
    const std::size_t faults = std::min<std::size_t>(command.faults.size(), kMostFaultsOfAStep);
    constexpr unsigned kNoRemainder = kFirstFaulty + kMostFaultsOfAStep - kFirstFaulty % kMostFaultsOfAStep;
    writer.octet(faults == 0 ? 0 : kNoRemainder + faults - 1);
    for (std::size_t n = 0; n < faults; ++n) write_fault(writer, command.faults[n], vocabulary, units);
  }
  return writer.octets;
}

}  // namespace fieldproof::conformance

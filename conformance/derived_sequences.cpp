#include "conformance/derived_sequences.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "conformance/covering_array.hpp"
#include "conformance/sequence_draw.hpp"
#include "conformance/sequence_settings.hpp"

namespace fieldproof::conformance {

const std::array<DerivedRow, 8> kDerivedRows{{
    {DerivedKind::values, "each_number_at_its_boundaries",
     "Each number of each command at both ends, beside them, at each power of two and at what the rules "
     "name, "
     "between other commands; and two numbers at once."},
    {DerivedKind::faults, "each_unit_spoilt",
     "Each unit of each transmission lost, each of its levels inverted, each gap after it, between the same "
     "transmission unspoilt; and two faults at once.",
     400, 7'000},
    {DerivedKind::words, "each_three_commands_in_each_order",
     "Each three commands, usual and unusual, one after the other."},
    {DerivedKind::states, "each_command_in_each_state",
     "Each command, with each of its choices, in each state into which commands bring a station.", 1'500},
    {DerivedKind::walks, "each_transition_of_its_states",
     "Each command in each state of the reference that single commands tell apart, then what tells where "
     "that "
     "leads from all others; at full volume after one command more.",
     1'900, 30'000},
    {DerivedKind::repetitions, "the_same_many_times",
     "Each command again and again, two commands in turn, and others after them.", 30, 350},
    {DerivedKind::settings, "each_setting_at_its_ends",
     "Each setting at both ends of its range and beside them, and one of each command; and two settings at "
     "once.",
     1'000},
    {DerivedKind::drawn, "any_commands_as_they_come",
     "Sequences at random, as `check` draws them: any commands with any numbers, spoilt or not, from any "
     "state.",
     300},
}};

namespace {

constexpr std::array<std::size_t, 3> kRepetitions{2, 20, 130};
constexpr std::size_t kOrder = 3;          // words of which all orders occur
constexpr std::size_t kNewOfWalk = 4;      // words that a walk has beyond those it shares with the one before
constexpr std::size_t kTourLength = 5;     // commands with a setting
constexpr std::int64_t kMostChoices = 20;  // of a number: more are a quantity

void add_once(std::vector<std::int64_t>& values, std::int64_t value) {
  if (std::ranges::find(values, value) == values.end()) values.push_back(value);
}

// What makes sequences of one vocabulary.
class Derivation {
 public:
  Derivation(const SequenceVocabulary& vocabulary, kernel::Random random, std::size_t repetitions)
      : vocabulary_(vocabulary),
        random_(random),
        source_(vocabulary, random.split("drawn").seed()),
        most_repetitions_(repetitions) {
    for (std::size_t word = 0; word < vocabulary.words.size(); ++word) {
      if (vocabulary.words[word].weight == 0) continue;
      words_.push_back(word);
      letters_.push_back(simple(word));
      SequenceCommand unusual = drawn(word);
      if (unusual != letters_.back()) letters_.push_back(std::move(unusual));
    }
  }

  // About one thing, by its number.
  std::vector<std::function<Sequence()>> singles(DerivedKind kind) const {
    switch (kind) {
      case DerivedKind::values:
        return values();
      case DerivedKind::faults:
        return faults();
      case DerivedKind::words:
        return walks();
      case DerivedKind::states:
        return states();
      case DerivedKind::repetitions:
        return repetitions();
      case DerivedKind::settings:
        return settings();
      case DerivedKind::walks:  // of the reference, not of the vocabulary alone
      case DerivedKind::drawn:  // nothing of it is about one thing
        return {};
    }
    return {};
  }

  // Each two values of two numbers of a word, together.
  std::vector<std::function<Sequence()>> pairs() {
    Makers all;
    for (const std::size_t word : words_) {
      const std::vector<SequenceNumber>& numbers = vocabulary_.words[word].numbers;
      if (numbers.size() < 2) continue;
      std::vector<std::vector<std::int64_t>> values;
      std::vector<std::size_t> counts;
      for (const SequenceNumber& number : numbers)
        counts.push_back(values.emplace_back(derived_values(number)).size());
      for (const ValueRow& row :
           covering_array(counts, [](const ValueRow&) { return true; }, random_.split(word)).rows) {
        SequenceCommand command = simple(word);
        for (std::size_t n = 0; n < row.size(); ++n) command.numbers[n] = values[n][row[n]];
        all.push_back([this, n = all.size(), command = std::move(command)] { return within(n, {command}); });
      }
    }
    return all;
  }

  // About two things, drawn; with no commands where there is nothing to draw.
  Sequence of_two(DerivedKind kind) {
    switch (kind) {
      case DerivedKind::states:
      case DerivedKind::values:
        return between_others({drawn(any_word())});
      case DerivedKind::faults:
        return two_faults();
      case DerivedKind::words:
        return walk_with(drawn(any_word()));
      case DerivedKind::repetitions:
        return in_turn();
      case DerivedKind::settings:
        return two_settings();
      case DerivedKind::walks:
        return {};
      case DerivedKind::drawn:
        return next_drawn();
    }
    return {};
  }

 private:
  using Makers = std::vector<std::function<Sequence()>>;

  SequenceCommand simple(std::size_t word) const { return simple_command(vocabulary_, word); }

  // Each number at any of its values.
  SequenceCommand drawn(std::size_t word) {
    const SequenceWord& of = vocabulary_.words[word];
    SequenceCommand command{.word = word, .numbers = {}};
    for (const SequenceNumber& number : of.numbers) {
      const std::vector<std::int64_t> values = derived_values(number);
      command.numbers.push_back(values[random_.below(values.size())]);
    }
    const std::size_t octets = of.most_octets == 0 ? 0 : 1 + random_.below(of.most_octets);
    for (std::size_t n = 0; n < octets; ++n)
      command.octets.push_back(static_cast<std::uint8_t>(random_.below(256)));
    return command;
  }

  const SequenceCommand& letter(std::size_t n) const { return letters_[n % letters_.size()]; }
  std::size_t any_word() { return words_[random_.below(words_.size())]; }
  SequenceCommand any_letter() { return letters_[random_.below(letters_.size())]; }

  // Each state in turn, the first as the station is made.
  std::vector<SequenceCommand> beginning(std::size_t n) const {
    const std::size_t which = n % (vocabulary_.beginnings.size() + 1);
    return which == 0 ? std::vector<SequenceCommand>{} : vocabulary_.beginnings[which - 1];
  }

  // The n-th has something else around it than the one before.
  Sequence within(std::size_t n, std::vector<SequenceCommand> about) const {
    Sequence sequence{beginning(n)};
    if (n % 2 == 1) sequence.commands.push_back(letter(n / 2));
    for (SequenceCommand& one : about) sequence.commands.push_back(std::move(one));
    append_each(sequence, n / 2);
    return sequence;
  }
  // One of each command, in their order or the other; after what is lost nothing would be seen.
  void append_each(Sequence& sequence, std::size_t n) const {
    std::vector<std::size_t> order = words_;
    std::erase_if(order, [&](std::size_t word) { return vocabulary_.words[word].is_no_frame; });
    if (n % 2 == 1) std::ranges::reverse(order);
    std::ranges::stable_partition(order, [&](std::size_t word) { return !vocabulary_.words[word].is_loss; });
    for (const std::size_t word : order) sequence.commands.push_back(simple(word));
  }
  Sequence between_others(std::vector<SequenceCommand> about) {
    return within(random_.below(letters_.size() * words_.size() * 2), std::move(about));
  }

  Makers values() const {
    Makers all;
    const auto add = [&](SequenceCommand command) {
      all.push_back([this, n = all.size(), command = std::move(command)] { return within(n, {command}); });
    };
    for (const std::size_t word : words_) {
      const SequenceCommand usual = simple(word);
      const SequenceWord& of = vocabulary_.words[word];
      add(usual);
      for (std::size_t n = 0; n < of.numbers.size(); ++n) {
        for (const std::int64_t value : derived_values(of.numbers[n])) {
          SequenceCommand other = usual;
          other.numbers[n] = value;
          if (other != usual) add(std::move(other));
        }
      }
      for (std::size_t count = 1; count <= of.most_octets; ++count) {
        SequenceCommand other = usual;
        other.octets.assign(count, static_cast<std::uint8_t>(count * 0x11));
        add(std::move(other));
      }
    }
    return all;
  }

  // Of one transmission.
  std::vector<SequenceFault> faults_of(const SequenceCommand& command) const {
    std::vector<SequenceFault> all;
    const std::size_t units = units_of(vocabulary_.words[command.word], command);
    for (std::uint32_t unit = 0; unit < units; ++unit) {
      all.push_back({SequenceFaultKind::drop, unit, 0});
      for (std::uint32_t level = 0; level < vocabulary_.levels_per_unit; ++level)
        all.push_back({SequenceFaultKind::flip, unit, level});
      for (const std::int64_t gap : vocabulary_.gaps)
        all.push_back({SequenceFaultKind::gap, unit, static_cast<std::uint32_t>(gap)});
    }
    return all;
  }

  static SequenceCommand spoilt(SequenceCommand command, std::vector<SequenceFault> faults) {
    std::ranges::sort(faults);
    const auto doubled = std::ranges::unique(faults);
    faults.erase(doubled.begin(), doubled.end());
    command.faults = std::move(faults);
    return command;
  }

  // The same unspoilt on both sides: a receiver that takes it at all, and takes the next one.
  Makers faults() const {
    Makers all;
    for (const SequenceCommand& command : letters_) {
      for (const SequenceFault& fault : faults_of(command)) {
        all.push_back([this, n = all.size(), command, fault] {
          std::vector<SequenceCommand> about{spoilt(command, {fault}), command};
          if (n % 3 == 0) about.insert(about.begin(), command);
          return within(n, std::move(about));
        });
      }
    }
    return all;
  }

  Sequence two_faults() {
    std::vector<std::size_t> sent = words_;
    std::erase_if(sent, [&](std::size_t word) { return faults_of(simple(word)).empty(); });
    if (sent.empty()) return {};
    const std::size_t word = sent[random_.below(sent.size())];
    const SequenceCommand command = drawn(word);
    const std::vector<SequenceFault> of = faults_of(command);
    const SequenceFault& one = of[random_.below(of.size())];
    // As often close together as anywhere: what a check finds depends on that.
    SequenceFault other = of[random_.below(of.size())];
    if (random_.chance(0.5)) {
      other = one;
      (one.kind == SequenceFaultKind::flip && random_.chance(0.5) ? other.value : other.unit) += 1;
    }
    return between_others({spoilt(command, {one, other}), simple(word)});
  }

  // All orders of three letters, each once: a de Bruijn sequence (of Lyndon words), cut into pieces that
  // share two letters with the next.
  Makers walks() const {
    std::vector<std::size_t> round;
    std::vector<std::size_t> word(kOrder + 1, 0);
    const std::function<void(std::size_t, std::size_t)> append = [&](std::size_t at, std::size_t period) {
      if (at > kOrder) {
        if (kOrder % period == 0)
          round.insert(round.end(), word.begin() + 1, word.begin() + 1 + static_cast<std::ptrdiff_t>(period));
        return;
      }
      word[at] = word[at - period];
      append(at + 1, period);
      for (std::size_t next = word[at - period] + 1; next < letters_.size(); ++next) {
        word[at] = next;
        append(at + 1, at);
      }
    };
    append(1, 1);
    Makers all;
    for (std::size_t from = 0; from < round.size(); from += kNewOfWalk) {
      std::vector<std::size_t> piece;
      for (std::size_t n = 0; n < kNewOfWalk + kOrder - 1; ++n)
        piece.push_back(round[(from + n) % round.size()]);
      all.push_back([this, n = all.size(), piece = std::move(piece)] {
        Sequence sequence{beginning(n)};
        for (const std::size_t one : piece) sequence.commands.push_back(letters_[one]);
        return sequence;
      });
    }
    return all;
  }

  // A number of few values chooses: which station, which kind. Each of these is a command of its own, and of
  // other numbers the ends.
  std::vector<SequenceCommand> choices() const {
    std::vector<SequenceCommand> all;
    for (const std::size_t word : words_) {
      const SequenceCommand usual = all.emplace_back(simple(word));
      const std::vector<SequenceNumber>& numbers = vocabulary_.words[word].numbers;
      for (std::size_t n = 0; n < numbers.size(); ++n) {
        const bool is_choice = numbers[n].most - numbers[n].least < kMostChoices;
        for (const std::int64_t value : derived_values(numbers[n])) {
          if (value == usual.numbers[n]) continue;
          if (!is_choice && value != numbers[n].least && value != numbers[n].most) continue;
          all.push_back(usual);
          all.back().numbers[n] = value;
        }
      }
    }
    return all;
  }

  Makers states() const {
    Makers all;
    const std::vector<SequenceCommand> commands = choices();
    for (std::size_t state = 0; state <= vocabulary_.beginnings.size(); ++state) {
      for (std::size_t n = 0; n < commands.size(); ++n) {
        all.push_back([this, state, n, command = commands[n]] {
          Sequence sequence{beginning(state)};
          sequence.commands.push_back(command);
          append_each(sequence, state + n);
          return sequence;
        });
      }
    }
    return all;
  }

  Sequence walk_with(SequenceCommand command) {
    Sequence sequence{beginning(random_.below(vocabulary_.beginnings.size() + 1))};
    for (std::size_t n = 0; n < kOrder; ++n) sequence.commands.push_back(any_letter());
    sequence.commands.push_back(std::move(command));
    for (std::size_t n = 1; n < kOrder; ++n) sequence.commands.push_back(any_letter());
    return sequence;
  }

  Makers repetitions() const {
    Makers all;
    for (const SequenceCommand& command : letters_) {
      std::vector<std::size_t> counts(kRepetitions.begin(), kRepetitions.end());
      // A thousand times an hour in which nothing is sent is more time than a bench has.
      const bool is_sent = units_of(vocabulary_.words[command.word], command) > 0;
      const bool is_usual = command == simple(command.word);
      if (is_sent && is_usual && most_repetitions_ > kManyRepetitions) counts.push_back(most_repetitions_);
      for (const std::size_t count : counts) {
        all.push_back([this, n = all.size(), command, count] {
          return within(2 * n, std::vector<SequenceCommand>(count, command));
        });
      }
    }
    return all;
  }

  Sequence in_turn() {
    const std::vector<SequenceCommand> both{any_letter(), any_letter()};
    std::vector<SequenceCommand> about;
    for (std::size_t n = 0; n < kManyRepetitions; ++n) about.push_back(both[n % 2]);
    return between_others(std::move(about));
  }

  // Commands for whatever settings: the n-th some, the next the next.
  std::vector<SequenceCommand> tour(std::size_t n) const {
    std::vector<SequenceCommand> commands = beginning(n);
    for (std::size_t m = 0; m < kTourLength; ++m) commands.push_back(letter(n * kTourLength + m));
    return commands;
  }

  Makers settings() const {
    Makers all;
    const std::size_t tours = (letters_.size() + kTourLength - 1) / kTourLength;
    for (std::size_t which = 0; which < vocabulary_.settings.size(); ++which) {
      const SequenceSetting& setting = vocabulary_.settings[which];
      for (const std::int64_t value : setting.likely) {
        for (std::size_t n = 0; n < tours; ++n) {
          all.push_back([this, which, value, n] {
            const std::array<SettingChoice, 1> chosen{{{which, value}}};
            return Sequence{tour(n), settings_of(chosen, vocabulary_)};
          });
        }
        if (setting.is_likely_only || setting.likely.size() == 1) add_choices_with(which, value, all);
        for (std::size_t state = 0; state <= vocabulary_.beginnings.size(); ++state) {
          all.push_back([this, which, value, state, n = all.size()] {
            const std::array<SettingChoice, 1> chosen{{{which, value}}};
            Sequence sequence{beginning(state), settings_of(chosen, vocabulary_)};
            append_each(sequence, n);
            return sequence;
          });
        }
      }
    }
    return all;
  }

  // What can be or not, or is one of a few, may matter to any choice of any command.
  void add_choices_with(std::size_t which, std::int64_t value, Makers& all) const {
    const std::vector<SequenceCommand> commands = choices();
    for (std::size_t first = 0; first < commands.size(); first += kTourLength) {
      const std::size_t end = std::min(commands.size(), first + kTourLength);
      all.push_back([this, which, value, n = all.size(),
                     tour = std::vector(commands.begin() + static_cast<std::ptrdiff_t>(first),
                                        commands.begin() + static_cast<std::ptrdiff_t>(end))] {
        const std::array<SettingChoice, 1> chosen{{{which, value}}};
        Sequence sequence{beginning(n), settings_of(chosen, vocabulary_)};
        sequence.commands.insert(sequence.commands.end(), tour.begin(), tour.end());
        return sequence;
      });
    }
  }

  SettingChoice any_setting() {
    const std::size_t which = random_.below(vocabulary_.settings.size());
    const SequenceSetting& setting = vocabulary_.settings[which];
    if (setting.likely.empty()) return {which, setting.simple};
    return {which, setting.likely[random_.below(setting.likely.size())]};
  }
  Sequence two_settings() {
    if (vocabulary_.settings.empty()) return {};
    const std::array<SettingChoice, 2> chosen{any_setting(), any_setting()};
    std::vector<SequenceCommand> commands = tour(random_.below(letters_.size()));
    commands.push_back(drawn(any_word()));
    return {std::move(commands), settings_of(chosen, vocabulary_)};
  }

  Sequence next_drawn() {
    Sequence next;
    while (next.commands.empty()) next = source_.draw(next_++);
    return next;
  }

  const SequenceVocabulary& vocabulary_;
  kernel::Random random_;
  SequenceSource source_;
  std::size_t most_repetitions_;
  std::uint64_t next_ = 100;  // of the source: the first ones have few commands
  std::vector<std::size_t> words_;
  std::vector<SequenceCommand> letters_;  // of each word a usual command and another
};

}  // namespace

std::vector<std::int64_t> derived_values(const SequenceNumber& number) {
  std::vector<std::int64_t> values{number.simple};
  for (const std::int64_t likely : number.likely)
    add_once(values, std::clamp(likely, number.least, number.most));
  if (number.is_likely_only) return values;
  for (const std::int64_t end : {number.least, number.least + 1, number.most - 1, number.most})
    if (number.least <= end && end <= number.most) add_once(values, end);
  for (std::int64_t power = 1; power <= number.most / 2; power *= 2) {
    for (const std::int64_t value : {power * 2 - 1, power * 2})
      if (number.least <= value && value <= number.most) add_once(values, value);
  }
  return values;
}

Sequence one_of_each(const SequenceVocabulary& vocabulary) {
  Sequence sequence;
  for (std::size_t word = 0; word < vocabulary.words.size(); ++word)
    if (vocabulary.words[word].weight > 0) sequence.commands.push_back(simple_command(vocabulary, word));
  return sequence;
}

bool has_derived(DerivedKind kind, const SequenceVocabulary& vocabulary) {
  if (kind == DerivedKind::settings) return !vocabulary.settings.empty();
  return std::ranges::any_of(vocabulary.words, [&](const SequenceWord& word) {
    return word.weight > 0 && (kind != DerivedKind::faults || word.most_octets > 0 || word.units > 0);
  });
}

DerivedSequences taken_of(std::vector<std::function<Sequence()>> makers, std::size_t most,
                          kernel::Random random) {
  DerivedSequences derived{.sequences = {}, .singles = makers.size()};
  if (makers.size() > most) {
    random.split("singles").shuffle(makers);
    makers.resize(most);
  }
  derived.taken = makers.size();
  for (const auto& make : makers) derived.sequences.push_back(make());
  return derived;
}

DerivedSequences evenly_taken(const std::vector<Sequence>& all, std::size_t most, kernel::Random random) {
  const std::size_t count = std::min(most, all.size());
  DerivedSequences derived;
  const std::size_t first = count == all.size() ? 0 : static_cast<std::size_t>(random.below(all.size()));
  for (std::size_t n = 0; n < count; ++n)
    derived.sequences.push_back(all[(first + n * all.size() / count) % all.size()]);
  return derived;
}

DerivedSequences derived_sequences(DerivedKind kind, const SequenceVocabulary& vocabulary, std::size_t most,
                                   kernel::Random random, std::size_t repetitions) {
  Derivation derivation(vocabulary, random.split("of_two"), repetitions);
  DerivedSequences derived = taken_of(derivation.singles(kind), most, random);
  if (kind == DerivedKind::values && derived.taken < most) {
    auto pairs = derivation.pairs();
    random.split("pairs").shuffle(pairs);
    pairs.resize(std::min(pairs.size(), most - derived.taken));
    for (const auto& make : pairs) derived.sequences.push_back(make());
  }
  // Two settings at once find little that one does not, and slow rates among them cost the most.
  const std::size_t filled = kind == DerivedKind::settings ? most * 2 / 5 : most;
  while (derived.sequences.size() < filled) {
    Sequence another = derivation.of_two(kind);
    if (another.commands.empty()) break;
    derived.sequences.push_back(std::move(another));
  }
  return derived;
}

}  // namespace fieldproof::conformance

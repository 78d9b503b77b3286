#include "conformance/sequence_draw.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "conformance/sequence_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::uint64_t kGrowth = 10;  // sequences of each length before they get longer
constexpr unsigned kPerCent = 100;
constexpr unsigned kFaultyPerCent = 30;      // of the commands
constexpr std::size_t kMostDrawnFaults = 3;  // of one command
constexpr unsigned kRepeatedPerCent = 15;
constexpr unsigned kLikelyPerCent = 60;
constexpr unsigned kSetOfThree = 1;  // sequences that begin with settings
constexpr unsigned kSecondSettingPerCent = 25;
constexpr unsigned kMostDrawnSettings = 3;
constexpr unsigned kLikelySettingPerCent = 80;
constexpr unsigned kMostSteps = 200;  // that fail to fail, before RapidCheck's part is over

template <typename T>
T chosen(std::span<const T> from) {
  return from[*rc::gen::inRange<std::size_t>(0, from.size())];
}

bool chance(unsigned per_cent) {
  return *rc::gen::inRange(0U, kPerCent) < per_cent;
}

std::int64_t draw_number(const SequenceNumber& number, unsigned likely_per_cent = kLikelyPerCent) {
  if (!number.likely.empty() && (number.is_likely_only || chance(likely_per_cent))) {
    return std::clamp(chosen(number.likely), number.least, number.most);
  }
  return *rc::gen::inRange(number.least, number.most + 1);
}

SequenceFault draw_fault(const SequenceVocabulary& vocabulary, std::size_t units) {
  SequenceFault fault;
  fault.unit = *rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(units));
  fault.kind = *rc::gen::weightedElement<SequenceFaultKind>(
      {{6, SequenceFaultKind::flip}, {2, SequenceFaultKind::drop}, {2, SequenceFaultKind::gap}});
  if (fault.kind == SequenceFaultKind::gap && vocabulary.gaps.empty()) fault.kind = SequenceFaultKind::drop;
  if (fault.kind == SequenceFaultKind::flip) {
    fault.value = *rc::gen::inRange<std::uint32_t>(0, vocabulary.levels_per_unit);
  } else if (fault.kind == SequenceFaultKind::gap) {
    fault.value = static_cast<std::uint32_t>(chosen(vocabulary.gaps));
  }
  return fault;
}

rc::Gen<SequenceCommand> command_of(const SequenceVocabulary& vocabulary) {
  // A word stands in the urn as often as it weighs.
  std::vector<std::size_t> urn;
  for (std::size_t n = 0; n < vocabulary.words.size(); ++n) {
    urn.insert(urn.end(), vocabulary.words[n].weight, n);
  }
  return rc::gen::exec([&vocabulary, urn] {
    SequenceCommand command;
    command.word = chosen(std::span<const std::size_t>(urn));
    const SequenceWord& word = vocabulary.words[command.word];
    for (const SequenceNumber& number : word.numbers) command.numbers.push_back(draw_number(number));
    if (word.most_octets > 0) {
      const auto count = *rc::gen::inRange<std::size_t>(1, word.most_octets + 1);
      for (std::size_t n = 0; n < count; ++n) {
        command.octets.push_back(static_cast<std::uint8_t>(*rc::gen::inRange(0, 256)));
      }
    }
    const std::size_t units = units_of(word, command);
    if (units == 0 || !chance(kFaultyPerCent)) return command;
    const auto faults = *rc::gen::inRange<std::size_t>(1, kMostDrawnFaults + 1);
    for (std::size_t n = 0; n < faults; ++n) command.faults.push_back(draw_fault(vocabulary, units));
    std::ranges::sort(command.faults);
    const auto doubled = std::ranges::unique(command.faults);
    command.faults.erase(doubled.begin(), doubled.end());
    return command;
  });
}

// What comes twice is what implementations take a short cut for.
std::vector<SequenceCommand> with_repetitions(
    const std::vector<std::pair<SequenceCommand, unsigned>>& drawn) {
  std::vector<SequenceCommand> commands;
  for (const auto& [command, die] : drawn) {
    const bool is_repeated = !commands.empty() && die >= kPerCent - kRepeatedPerCent;
    commands.push_back(is_repeated ? SequenceCommand(commands.back()) : command);
  }
  return commands;
}

field::Settings draw_settings(const SequenceVocabulary& vocabulary) {
  std::vector<SettingChoice> drawn;
  if (vocabulary.settings.empty() || *rc::gen::inRange(0U, 3U) >= kSetOfThree) return {};
  do {
    const auto which = *rc::gen::inRange<std::size_t>(0, vocabulary.settings.size());
    drawn.push_back({which, draw_number(vocabulary.settings[which].number(), kLikelySettingPerCent)});
  } while (drawn.size() < kMostDrawnSettings && chance(kSecondSettingPerCent));
  return settings_of(drawn, vocabulary);
}

// Random commands alone seldom lead into a state that takes several in their order: each second sequence
// begins with what leads into one.
std::vector<SequenceCommand> draw_beginning(const SequenceVocabulary& vocabulary) {
  if (vocabulary.beginnings.empty() || chance(kPerCent / 2)) return {};
  return chosen(std::span<const std::vector<SequenceCommand>>(vocabulary.beginnings));
}

struct DrawnSituation {
  std::vector<SequenceCommand> commands;
  field::Settings settings;
};

// With one of the settings that it shows, or with none: each of these is as likely.
std::optional<DrawnSituation> draw_situation(const SequenceVocabulary& vocabulary) {
  if (vocabulary.situations.empty() || chance(kPerCent / 2)) return std::nullopt;
  std::vector<std::pair<const SequenceSituation*, const ShownSetting*>> all;
  for (const SequenceSituation& one : vocabulary.situations) {
    if (one.shown.empty()) all.emplace_back(&one, nullptr);
    for (const ShownSetting& shown : one.shown) all.emplace_back(&one, &shown);
  }
  const auto [situation, shown] =
      chosen(std::span<const std::pair<const SequenceSituation*, const ShownSetting*>>(all));
  std::vector<SettingChoice> choices;
  const auto choose = [&](const std::string& name, std::optional<std::int64_t> value) {
    const SequenceSetting* const setting = vocabulary.find_setting(name);
    if (setting == nullptr) return;  // this implementation has it fixed
    const auto which = static_cast<std::size_t>(setting - vocabulary.settings.data());
    choices.push_back({which, value ? *value : draw_number(setting->number(), kLikelySettingPerCent)});
  };
  if (shown != nullptr) {
    for (const auto& [name, value] : shown->along) choose(name, value);
    choose(shown->name, std::nullopt);
  }
  return DrawnSituation{situation->commands, settings_of(choices, vocabulary)};
}

rc::Shrinkable<Sequence> drawn(const SequenceVocabulary& vocabulary, std::uint64_t seed, std::uint64_t n) {
  const auto most = static_cast<int>(std::min<std::uint64_t>(1 + n / kGrowth, vocabulary.most_commands));
  // The size of a container is its length; that of what is in it stays whole.
  const auto one = rc::gen::pair(command_of(vocabulary), rc::gen::inRange(0U, kPerCent));
  const auto commands = rc::gen::container<std::vector<std::pair<SequenceCommand, unsigned>>>(
      rc::gen::resize(rc::kNominalSize, one));
  // Drawn apart from the commands, which are those of the seed with any settings, after any beginning.
  const auto apart = [&](std::uint64_t what, auto draw) {
    return rc::gen::exec(draw)(rc::Random(rc::Random::Key{seed, n, what, 0})).value();
  };
  field::Settings settings = apart(1, [&] { return draw_settings(vocabulary); });
  std::vector<SequenceCommand> beginning = apart(2, [&] { return draw_beginning(vocabulary); });
  if (auto situation = apart(3, [&] { return draw_situation(vocabulary); })) {
    beginning = std::move(situation->commands);
    if (!situation->settings.empty()) settings = std::move(situation->settings);
  }
  const std::size_t room = vocabulary.most_commands;
  const auto together = [=](const std::vector<std::pair<SequenceCommand, unsigned>>& of) {
    std::vector<SequenceCommand> all = beginning;
    const std::vector<SequenceCommand> others = with_repetitions(of);
    all.insert(all.end(), others.begin(), others.end());
    all.resize(std::min(all.size(), room));
    return Sequence{std::move(all), settings};
  };
  return rc::gen::map(rc::gen::resize(most, commands), together)(rc::Random(rc::Random::Key{seed, n, 0, 0}));
}

// RapidCheck keeps what it is at in one place for all threads, and cases run in several.
template <typename Call>
auto alone(Call call) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  return call();
}

}  // namespace

Sequence SequenceSource::draw(std::uint64_t n) const {
  return alone([&] { return drawn(vocabulary_, seed_, n).value(); });
}

Sequence SequenceSource::smaller(std::uint64_t n, const SequenceFails& still_fails) const {
  rc::Shrinkable<Sequence> best = alone([&] { return drawn(vocabulary_, seed_, n); });
  for (bool is_smaller = true; is_smaller;) {
    is_smaller = false;
    auto steps = alone([&] { return best.shrinks(); });
    for (unsigned tried = 0; tried < kMostSteps && !is_smaller; ++tried) {
      const auto step = alone([&] { return steps.next(); });
      if (!step) break;
      is_smaller = still_fails(alone([&] { return step->value(); }));
      if (is_smaller) best = *step;
    }
  }
  return alone([&] { return best.value(); });
}

std::vector<Sequence> drawn_commands(const SequenceVocabulary& vocabulary, std::uint64_t seed,
                                     std::uint64_t count) {
  constexpr std::uint64_t kFirst = 40;  // those before are short
  const SequenceSource source(vocabulary, seed);
  std::vector<Sequence> sequences;
  for (std::uint64_t n = 0; n < count; ++n)
    sequences.push_back({.commands = source.draw(kFirst + n).commands});
  return sequences;
}

}  // namespace fieldproof::conformance

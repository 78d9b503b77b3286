#include "conformance/sequence_contrast.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {
namespace {

// The values next to this one: towards what is simple, then away from it.
std::vector<std::int64_t> neighbours(const SequenceNumber& number, std::int64_t value) {
  std::vector<std::int64_t> near;
  if (number.is_likely_only) {
    std::vector<std::int64_t> all(number.likely.begin(), number.likely.end());
    all.push_back(number.simple);
    std::ranges::sort(all);
    const auto above = std::ranges::upper_bound(all, value);
    const auto from = std::ranges::lower_bound(all, value);
    if (from != all.begin()) near.push_back(*(from - 1));
    if (above != all.end()) near.push_back(*above);
  } else {
    if (value > number.least) near.push_back(value - 1);
    if (value < number.most) near.push_back(value + 1);
  }
  const bool is_simple_above = number.simple > value;
  std::ranges::stable_sort(near, {}, [&](std::int64_t one) { return (one > value) != is_simple_above; });
  return near;
}

class SequenceContrast {
 public:
  SequenceContrast(const Sequence& smallest, const SequenceVocabulary& vocabulary, const SequenceShows& shows)
      : smallest_(smallest), vocabulary_(vocabulary), shows_(shows) {}

  std::vector<std::string> run() {
    for (std::size_t n = 0; n < smallest_.settings.size(); ++n) look_at_setting(n);
    for (std::size_t n = 0; n < smallest_.commands.size(); ++n) {
      const std::size_t before = lines_.size();
      for (std::size_t k = 0; k < smallest_.commands[n].numbers.size(); ++k) look_at_number(n, k);
      for (std::size_t k = 0; k < smallest_.commands[n].faults.size(); ++k) look_at_fault(n, k);
      if (lines_.size() == before) look_at_command(n);
    }
    return std::move(lines_);
  }

 private:
  // Notes what comes of one that is changed.
  void try_with(std::string how, const Sequence& changed) {
    if (vocabulary_.objection_to(changed.settings)) return;
    const std::optional<bool> fails = shows_(changed);
    if (!fails) return;
    decides_ = decides_ || !*fails;
    tried_.push_back(how + (*fails ? " it fails, too" : " it passes"));
  }

  // A line about what was tried, where it decides.
  void say(const std::string& what) {
    if (decides_) lines_.push_back(fmt::format("{}: {}", what, fmt::join(tried_, ", ")));
    decides_ = false;
    tried_.clear();
  }

  bool is_full() const { return lines_.size() == kMostContrasts; }

  void look_at_setting(std::size_t n) {
    if (is_full()) return;
    const auto& [name, value] = smallest_.settings[n];
    Sequence without = smallest_;
    without.settings.erase(without.settings.begin() + static_cast<std::ptrdiff_t>(n));
    try_with("as usual", without);
    const SequenceSetting* const setting = vocabulary_.find_setting(name);
    if (setting != nullptr) {
      for (const std::int64_t near : neighbours(setting->number(), value)) {
        Sequence changed = smallest_;
        changed.settings[n].second = near;
        if (near != setting->simple)
          try_with("with " + settings_text({{name, near}}, vocabulary_).substr(name.size() + 1), changed);
      }
    }
    say("setting " + settings_text({smallest_.settings[n]}, vocabulary_));
  }

  // Without the only one nothing happens.
  void look_at_command(std::size_t n) {
    if (is_full() || smallest_.commands.size() == 1) return;
    Sequence without = smallest_;
    without.commands.erase(without.commands.begin() + static_cast<std::ptrdiff_t>(n));
    try_with("without it", without);
    say(name_of(n));
  }

  void look_at_number(std::size_t n, std::size_t k) {
    const SequenceNumber& number = word_of(n).numbers[k];
    const std::int64_t value = smallest_.commands[n].numbers[k];
    if (is_full()) return;
    std::vector<std::int64_t> others = neighbours(number, value);
    if (value != number.simple && std::ranges::find(others, number.simple) == others.end())
      others.push_back(number.simple);
    for (const std::int64_t other : others) {
      Sequence changed = smallest_;
      changed.commands[n].numbers[k] = other;
      try_with(fmt::format("with {}", other), changed);
    }
    say(fmt::format("{} {} in {}", number.name, value, name_of(n)));
  }

  void look_at_fault(std::size_t n, std::size_t k) {
    if (is_full()) return;
    Sequence without = smallest_;
    auto& faults = without.commands[n].faults;
    const SequenceFault fault = faults[k];
    faults.erase(faults.begin() + static_cast<std::ptrdiff_t>(k));
    try_with("without it", without);
    say(fmt::format("{} in {}", fault_text(fault, vocabulary_.unit), name_of(n)));
  }

  const SequenceWord& word_of(std::size_t n) const { return vocabulary_.words[smallest_.commands[n].word]; }
  std::string name_of(std::size_t n) const { return fmt::format("command {}, {}", n + 1, word_of(n).word); }

  const Sequence& smallest_;
  const SequenceVocabulary& vocabulary_;
  const SequenceShows& shows_;
  std::vector<std::string> lines_;
  std::vector<std::string> tried_;
  bool decides_ = false;
};

}  // namespace

std::vector<std::string> contrasts(const Sequence& smallest, const SequenceVocabulary& vocabulary,
                                   const SequenceShows& shows) {
  return SequenceContrast(smallest, vocabulary, shows).run();
}

}  // namespace fieldproof::conformance

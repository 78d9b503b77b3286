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
      : smallest_(smallest), vocabulary_(vocabulary), shows_(shows), has_line_(smallest.commands.size()) {}

  std::vector<std::string> run() {
    for (std::size_t n = 0; n < smallest_.settings.size(); ++n) look_at_setting(n);
    for (const bool is_simple : {false, true}) {
      for_each_command([&](std::size_t n) {
        for (std::size_t k = 0; k < smallest_.commands[n].numbers.size(); ++k)
          if (is_simple == (smallest_.commands[n].numbers[k] == word_of(n).numbers[k].simple))
            look_at_number(n, k);
        if (is_simple) return;
        for (std::size_t k = 0; k < smallest_.commands[n].faults.size(); ++k) look_at_fault(n, k);
        if (!has_line_[n]) look_at_command(n);
      });
    }
    if (has_left_some_) lines_.emplace_back("more was not tried");
    return std::move(lines_);
  }

 private:
  // Of equal ones in a row the last.
  template <typename LookAt>
  void for_each_command(const LookAt& look_at) {
    for (std::size_t n = 0; n < smallest_.commands.size(); ++n)
      if (!is_repeated(n)) look_at(n);
  }
  bool is_repeated(std::size_t n) const {
    return n + 1 < smallest_.commands.size() && smallest_.commands[n] == smallest_.commands[n + 1];
  }

  // Notes what comes of one that is changed.
  void try_with(const std::string& how, const Sequence& changed) {
    if (vocabulary_.objection_to(changed.settings)) return;
    if (lines_.size() == kMostContrasts || runs_ == kMostContrastRuns) {
      has_left_some_ = true;
      return;
    }
    ++runs_;
    switch (shows_(changed)) {
      case Shown::alike:
        return tried_.push_back(how + " it fails, too");
      case Shown::otherwise:
        decides_ = true;
        return tried_.push_back(how + " it fails otherwise");
      case Shown::passes:
        decides_ = true;
        return tried_.push_back(how + " it passes");
      case Shown::not_judged:
        return tried_.push_back(how + " it is not judged");
      case Shown::not_tried:
        has_left_some_ = true;
    }
  }

  // A line about what was tried, where it decides.
  bool say(const std::string& what) {
    const bool has_said = std::exchange(decides_, false);
    if (has_said) lines_.push_back(fmt::format("{}: {}", what, fmt::join(tried_, ", ")));
    tried_.clear();
    return has_said;
  }

  void look_at_setting(std::size_t n) {
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
    if (smallest_.commands.size() == 1) return;
    Sequence without = smallest_;
    without.commands.erase(without.commands.begin() + static_cast<std::ptrdiff_t>(n));
    try_with(n > 0 && is_repeated(n - 1) ? "once less" : "without it", without);
    has_line_[n] = say(name_of(n));
  }

  void look_at_number(std::size_t n, std::size_t k) {
    const SequenceNumber& number = word_of(n).numbers[k];
    const std::int64_t value = smallest_.commands[n].numbers[k];
    std::vector<std::int64_t> others = neighbours(number, value);
    if (value != number.simple && std::ranges::find(others, number.simple) == others.end())
      others.push_back(number.simple);
    for (const std::int64_t other : others) {
      Sequence changed = smallest_;
      changed.commands[n].numbers[k] = other;
      try_with(fmt::format("with {}", other), changed);
    }
    if (say(fmt::format("{} {} in {}", number.name, value, name_of(n)))) has_line_[n] = true;
  }

  void look_at_fault(std::size_t n, std::size_t k) {
    Sequence without = smallest_;
    auto& faults = without.commands[n].faults;
    const SequenceFault fault = faults[k];
    faults.erase(faults.begin() + static_cast<std::ptrdiff_t>(k));
    try_with("without it", without);
    if (say(fmt::format("{} in {}", fault_text(fault, vocabulary_.unit), name_of(n)))) has_line_[n] = true;
  }

  const SequenceWord& word_of(std::size_t n) const { return vocabulary_.words[smallest_.commands[n].word]; }
  // Counted as a finding lists them.
  std::string name_of(std::size_t n) const {
    std::size_t place = 1;
    for (std::size_t before = 0; before < n; ++before) place += is_repeated(before) ? 0U : 1U;
    return fmt::format("command {}, {}", place, word_of(n).word);
  }

  const Sequence& smallest_;
  const SequenceVocabulary& vocabulary_;
  const SequenceShows& shows_;
  std::vector<std::string> lines_;
  std::vector<bool> has_line_;  // of each command
  std::vector<std::string> tried_;
  bool decides_ = false;
  bool has_left_some_ = false;
  std::size_t runs_ = 0;
};

}  // namespace

Shown shown_by(const judge::CaseResult& result, std::string_view reason) {
  if (result.verdict == judge::Verdict::pass || result.verdict == judge::Verdict::warn) return Shown::passes;
  if (result.verdict < judge::Verdict::fail) return Shown::not_judged;
  return result.reason == reason ? Shown::alike : Shown::otherwise;
}

std::vector<std::string> contrasts(const Sequence& smallest, const SequenceVocabulary& vocabulary,
                                   const SequenceShows& shows) {
  return SequenceContrast(smallest, vocabulary, shows).run();
}

}  // namespace fieldproof::conformance

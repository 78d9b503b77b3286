#include "cli/burst_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <string>
#include <utility>

#include "harness/measure/frequency.hpp"

namespace fieldproof::cli {
namespace {

using emc::Level;

class LevelReader {
 public:
  LevelReader(const Settings& settings, std::string_view option) : settings_(settings), option_(option) {}

  std::vector<Level> read(const std::vector<std::string>& words) {
    for (const std::string& word : words) add(word);
    return std::move(levels_);
  }

 private:
  void add(const std::string& word) {
    const bool is_free = word.starts_with("x:") || word.starts_with("X:");
    const std::string range = is_free ? word.substr(2) : word;
    const std::size_t dots = range.find("..");
    const std::string from = range.substr(0, dots);
    std::string to = dots == std::string::npos ? from : range.substr(dots + 2);
    std::string step = is_free ? "500" : "1";
    if (const std::size_t colon = to.find(':'); dots != std::string::npos && colon != std::string::npos) {
      step = to.substr(colon + 1);
      to.resize(colon);
    }
    const auto low = real_of(from);
    const auto high = real_of(to);
    const auto pitch = real_of(step);
    const double most = is_free ? Level::kMostVolts : 4;
    const bool is_range = low && high && pitch && *low >= 1 && *low <= *high && *high <= most &&
                          *pitch >= 1 && *pitch <= Level::kMostVolts;
    if (!is_range || (!is_free && (*low != static_cast<unsigned>(*low) || *pitch != 1))) refuse(word);
    const auto count = static_cast<unsigned>((*high - *low) / *pitch + 1e-9) + 1;
    for (unsigned n = 0; n < count; ++n) {
      const double value = *low + n * *pitch;
      levels_.push_back(is_free ? Level::free(value)
                                : Level::standard(emc::PortKind::signal, static_cast<unsigned>(value)));
    }
  }

  [[noreturn]] void refuse(const std::string& word) const {
    settings_.refuse(
        option_,
        fmt::format("'{}' is no level; write 1..4, 3, x:1000 or x:1000..4500:500 (1 to 10000 volts)", word));
  }

  const Settings& settings_;
  std::string_view option_;
  std::vector<Level> levels_;
};

constexpr std::array kRepetitions = {emc::Repetition::khz_5, emc::Repetition::khz_100,
                                     emc::Repetition::khz_2_5_edition_1};
constexpr std::array kPolarities = {emc::Polarity::positive, emc::Polarity::negative};

// As written, or the same frequency: "100 kHz" and "0.1MHz" are "100kHz".
bool is_named(const std::string& written, std::string_view name) {
  const auto frequency = measure::Frequency::read(name);
  return written == name || (frequency && measure::Frequency::read(written) == frequency);
}

template <typename Value, std::size_t N>
Value choice(const Settings& settings, std::string_view option, const std::string& word,
             const std::array<Value, N>& known) {
  std::string all;
  for (const Value value : known) {
    if (is_named(word, word_of(value))) return value;
    all += (all.empty() ? "" : ", ") + std::string(word_of(value));
  }
  settings.refuse(option, fmt::format("'{}' is none of {}", word, all));
}

template <typename Value, std::size_t N>
std::vector<Value> choices(const Settings& settings, std::string_view option,
                           const std::array<Value, N>& known) {
  std::vector<Value> chosen;
  for (const std::string& word : settings.words(option)) {
    chosen.push_back(choice(settings, option, word, known));
  }
  return chosen;
}

}  // namespace

std::vector<Level> levels_from(const Settings& settings) {
  return LevelReader(settings, "test-levels").read(settings.words("test-levels"));
}

std::vector<emc::Repetition> repetitions_from(const Settings& settings) {
  return choices(settings, "repetition", kRepetitions);
}

std::vector<emc::Polarity> polarities_from(const Settings& settings) {
  return choices(settings, "polarity", kPolarities);
}

emc::BurstSettings bursts_from(const Settings& settings) {
  const std::vector<std::string> words = settings.words("bursts");
  const auto levels = LevelReader(settings, "bursts").read({words.front()});
  if (levels.size() != 1 || words.size() > 3) {
    settings.refuse("bursts", "a measurement takes one level, one rate, one polarity; write 3,5kHz,+");
  }
  emc::BurstSettings bursts;
  bursts.level = levels.front();
  if (words.size() > 1) bursts.repetition = choice(settings, "bursts", words[1], kRepetitions);
  if (words.size() > 2) bursts.polarity = choice(settings, "bursts", words[2], kPolarities);
  return bursts;
}

emc::Profile profile_from(const Settings& settings) {
  const std::string written = settings.text("profile");
  return std::filesystem::is_regular_file(written) ? emc::Profile::load(written)
                                                   : emc::Profile::named(written);
}

std::optional<double> real_of(std::string_view text) {
  double value = 0;
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace fieldproof::cli

#include "harness/measure/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

constexpr std::size_t kMostDigits = 12;  // of the whole part; more cannot be below the limit

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Digits with at most one point, as thousandths; nothing when the text goes further or a fourth decimal
// counts.
std::optional<std::int64_t> thousandths(std::string_view text) {
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point);
  std::string decimals(text.substr(std::min(point + 1, text.size())));
  while (decimals.size() > 3 && decimals.back() == '0') decimals.pop_back();
  if (whole.empty() || whole.size() > kMostDigits || decimals.size() > 3) return std::nullopt;
  if (point < text.size() && decimals.empty()) return std::nullopt;
  decimals.resize(3, '0');
  std::int64_t value = 0;
  for (const std::string_view part : {whole, std::string_view(decimals)}) {
    for (const char digit : part) {
      if (!is_digit(digit)) return std::nullopt;
      value = 10 * value + (digit - '0');
    }
  }
  return value;
}

}  // namespace

Frequency Frequency::from_millihertz(std::int64_t millihertz) {
  FIELDPROOF_CHECK(millihertz > 0 && millihertz <= kMostMillihertz,
                   "a frequency lies between 1 mHz and 1 MHz");
  return Frequency(millihertz);
}

std::optional<Frequency> Frequency::read(std::string_view text) {
  // The prefix of the unit, and its part of a millihertz in a thousandth of it.
  constexpr std::array<std::pair<std::string_view, std::int64_t>, 3> kUnits = {
      {{"kHz", 1'000}, {"MHz", 1'000'000}, {"Hz", 1}}};
  const bool is_millihertz = text.ends_with("mHz");
  std::int64_t factor = 0;
  std::size_t unit = 3;
  for (const auto& [name, thousandth] : kUnits) {
    if (is_millihertz || !text.ends_with(name)) continue;
    factor = thousandth;
    unit = name.size();
    break;
  }
  if (!is_millihertz && factor == 0) return std::nullopt;
  text.remove_suffix(unit);
  if (text.ends_with(' ')) text.remove_suffix(1);
  const auto read = thousandths(text);
  if (!read || *read == 0) return std::nullopt;
  if (is_millihertz) {
    if (*read % 1'000 != 0 || *read / 1'000 > kMostMillihertz) return std::nullopt;
    return Frequency(*read / 1'000);
  }
  if (*read > kMostMillihertz / factor) return std::nullopt;
  return Frequency(*read * factor);
}

std::string describe(Frequency frequency) {
  return fmt::format("{} Hz", frequency.hertz());
}

}  // namespace fieldproof::measure

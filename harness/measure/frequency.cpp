#include "harness/measure/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>

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
  if (!text.ends_with("Hz")) return std::nullopt;
  text.remove_suffix(2);
  std::int64_t factor = 1;
  if (text.ends_with('k')) {
    text.remove_suffix(1);
    factor = 1'000;
  }
  if (text.ends_with(' ')) text.remove_suffix(1);
  const auto read = thousandths(text);
  if (!read || *read == 0 || *read > kMostMillihertz / factor) return std::nullopt;
  return Frequency(*read * factor);
}

std::string describe(Frequency frequency) {
  return fmt::format("{} Hz", frequency.hertz());
}

}  // namespace fieldproof::measure

// Physical quantities: a decimal number and a unit, kept as decimal digits so that conversion is exact.

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "harness/config/nearest.hpp"
#include "harness/config/source.hpp"

namespace fieldproof::config {

namespace {

struct Unit {
  std::string_view name;
  int power;  // of ten, of the unit that the reader answers in
};

// What one kind of quantity is called in errors, and what may be written.
struct Scale {
  std::string_view quantity;
  std::string_view example;
  std::string_view smallest;  // what an exact answer is a whole number of
  std::span<const Unit> units;
};

constexpr std::array kTimeUnits{Unit{"ps", 0}, Unit{"ns", 3}, Unit{"us", 6}, Unit{"ms", 9}, Unit{"s", 12}};
constexpr std::array kRateUnits{Unit{"bit/s", 0}, Unit{"kbit/s", 3}, Unit{"Mbit/s", 6}, Unit{"Gbit/s", 9}};
constexpr std::array kLengthUnits{Unit{"mm", -3}, Unit{"cm", -2}, Unit{"m", 0}, Unit{"km", 3}};

constexpr Scale kTime{"duration", "25 ms", "picoseconds", kTimeUnits};
constexpr Scale kRate{"bit rate", "500 kbit/s", "bits per second", kRateUnits};
constexpr Scale kLength{"length", "12 m", "", kLengthUnits};

// digits * 10^power, negated if is_negative. No leading zeros, and no trailing ones after the point.
struct Decimal {
  bool is_negative = false;
  std::string digits;
  int power = 0;
};

std::string list_of(std::span<const Unit> units) {
  std::string list;
  for (const Unit& unit : units) list += fmt::format("{}{}", list.empty() ? "" : ", ", unit.name);
  return list;
}

// More digits than any range holds are refused, so that powers stay small numbers.
constexpr std::size_t kMostDigits = 60;

// "-12.50" without its unit; nothing when it is no decimal number.
std::optional<Decimal> decimal(std::string_view text) {
  Decimal number;
  if (text.starts_with('-')) {
    number.is_negative = true;
    text.remove_prefix(1);
  }
  const std::size_t point = text.find('.');
  std::string_view whole = text.substr(0, point);
  std::string_view fraction = point == std::string_view::npos ? "" : text.substr(point + 1);
  const auto is_digits = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (!is_digits(whole) || (point != std::string_view::npos && !is_digits(fraction))) return std::nullopt;
  while (whole.starts_with('0')) whole.remove_prefix(1);
  while (fraction.ends_with('0')) fraction.remove_suffix(1);
  if (whole.size() + fraction.size() > kMostDigits) return std::nullopt;
  number.power = -static_cast<int>(fraction.size());
  number.digits = std::string(whole) + std::string(fraction);
  return number;
}

// The number and the power of its unit together, or a refusal.
Decimal quantity(const Value& value, const Scale& scale) {
  const std::string rule = fmt::format("write a number and a unit, for example \"{}\" (units: {})",
                                       scale.example, list_of(scale.units));
  if (value.kind() == ValueKind::integer || value.kind() == ValueKind::number) {
    fail(value, fmt::format("a {} needs its unit; {}", scale.quantity, rule));
  }
  if (!value.is_string()) fail(value, fmt::format("this is not a {}; {}", scale.quantity, rule));
  const std::string_view text = value.as_string();
  const std::size_t end = std::min(text.find_first_not_of("-.0123456789"), text.size());
  auto number = decimal(text.substr(0, end));
  if (!number) fail(value, fmt::format("{} is not a {}; {}", in_quotes(text), scale.quantity, rule));
  std::string_view name = text.substr(end);
  if (name.starts_with(' ')) name.remove_prefix(1);
  if (name.empty()) fail(value, fmt::format("{} has no unit; {}", in_quotes(text), rule));
  for (const Unit& unit : scale.units) {
    if (unit.name != name) continue;
    number->power += unit.power;
    return *number;
  }
  fail(value, fmt::format("{} is not a unit of a {}; {}", in_quotes(name), scale.quantity, rule));
}

// Exactly this quantity in the smallest unit; what 64 bit do not hold saturates and is told.
struct Whole {
  std::int64_t number = 0;
  bool is_saturated = false;
};

Whole whole(const Value& value, const Scale& scale) {
  const Decimal number = quantity(value, scale);
  if (number.power < 0 && !number.digits.empty()) {
    fail(value, fmt::format("{} is not a whole number of {}; write fewer decimals",
                            in_quotes(value.as_string()), scale.smallest));
  }
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  Whole total;
  const auto append = [&](std::int64_t digit) {
    total.is_saturated = total.is_saturated || total.number > (kLargest - digit) / 10;
    total.number = total.is_saturated ? kLargest : total.number * 10 + digit;
  };
  for (const char digit : number.digits) append(digit - '0');
  for (int zeros = 0; zeros < number.power && total.number != 0; ++zeros) append(0);
  if (number.is_negative) total.number = -total.number;
  return total;
}

// Also "-0 m": a sign has no place where nothing negative is meant.
bool has_stray_sign(const Value& value, bool takes_negative) {
  return !takes_negative && value.as_string().starts_with('-');
}

template <typename T, typename Describe>
void check_range(const Value& value, T read, T min, T max, Describe describe, bool is_saturated = false) {
  if (read < min || has_stray_sign(value, min < T{})) {
    fail(value,
         fmt::format("{} is too small; write at least {}", in_quotes(value.as_string()), describe(min)));
  }
  if (read > max || is_saturated) {
    fail(value,
         fmt::format("{} is too large; write at most {}", in_quotes(value.as_string()), describe(max)));
  }
}

}  // namespace

kernel::Duration Value::as_duration(kernel::Duration min, kernel::Duration max) const {
  const Whole read = whole(*this, kTime);
  const kernel::Duration duration{read.number};
  const auto describe = [](kernel::Duration limit) { return kernel::describe(limit); };
  check_range(*this, duration, min, max, describe, read.is_saturated);
  return duration;
}

std::int64_t Value::as_bit_rate(std::int64_t min, std::int64_t max) const {
  const Whole read = whole(*this, kRate);
  const auto describe = [](std::int64_t limit) { return fmt::format("{} bit/s", limit); };
  check_range(*this, read.number, min, max, describe, read.is_saturated);
  return read.number;
}

double Value::as_length_m(double min, double max) const {
  const Decimal number = quantity(*this, kLength);
  // Written once more with its power, so that the nearest double is found in one rounding.
  const std::string text = fmt::format("{}{}e{}", number.is_negative ? "-" : "",
                                       number.digits.empty() ? "0" : number.digits, number.power);
  double read = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  check_range(*this, read, min, max, [](double limit) { return fmt::format("{} m", limit); });
  return read;
}

}  // namespace fieldproof::config

#include "harness/kernel/time.hpp"

#include <array>
#include <string_view>

namespace fieldproof::kernel {
namespace {

struct Unit {
  std::uint64_t picoseconds;
  std::string_view name;
};

constexpr std::array kUnits = {Unit{1'000'000'000'000, "s"}, Unit{1'000'000'000, "ms"}, Unit{1'000'000, "us"},
                               Unit{1'000, "ns"}, Unit{1, "ps"}};

std::string in_unit(std::uint64_t size, const Unit& unit) {
  std::string text = std::to_string(size / unit.picoseconds);
  std::uint64_t rest = size % unit.picoseconds;
  std::uint64_t place = unit.picoseconds;
  char separator = '.';
  // At least one group of decimals where the unit has any, then as many as are needed to be exact.
  while (place > 1 && (rest != 0 || separator == '.')) {
    place /= 1'000;
    const std::string group = std::to_string(rest / place);
    if (separator == '.') text += separator;
    separator = 0;
    text.append(3 - group.size(), '0').append(group);
    rest %= place;
  }
  return text.append(" ").append(unit.name);
}

}  // namespace

std::string describe(Duration duration) {
  const std::int64_t count = duration.count();
  if (count == 0) return "0 s";
  const std::uint64_t size =
      count < 0 ? ~static_cast<std::uint64_t>(count) + 1 : static_cast<std::uint64_t>(count);
  const Unit* unit = kUnits.begin();
  while (size < unit->picoseconds) ++unit;
  return (count < 0 ? "-" : "") + in_unit(size, *unit);
}

std::string describe(Time time) {
  return time == kNever ? "never" : describe(time.time_since_epoch());
}

}  // namespace fieldproof::kernel

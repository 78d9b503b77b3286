#include "harness/field/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace fieldproof::field {
namespace {

std::string bit_rate_text(std::int64_t rate) {
  if (rate != 0 && rate % 1'000'000 == 0) return fmt::format("{} Mbit/s", rate / 1'000'000);
  if (rate != 0 && rate % 1'000 == 0) return fmt::format("{} kbit/s", rate / 1'000);
  return fmt::format("{} bit/s", rate);
}

// 3/2 is 1.5, 1950/1000 is 1.95: exact where `per` divides a power of ten, as units do.
std::string fraction_text(std::int64_t number, std::int64_t per) {
  if (per == 1) return fmt::format("{}", number);
  return fmt::format("{}", static_cast<double>(number) / static_cast<double>(per));
}

std::string with_unit(std::string number, std::string_view unit) {
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

std::string number_text(const About& about, std::int64_t number) {
  const Unit& unit = about.unit;
  switch (unit.notation) {
    case Notation::bit_rate:
      return bit_rate_text(number);
    case Notation::hexadecimal:
      return hexadecimal_text(about.range, number);
    case Notation::decimal:
      break;
  }
  return with_unit(fraction_text(number, unit.per), unit.name);
}

// "A", "A or B", "A, B or C".
std::string listed(const std::vector<std::string>& all, std::string_view last_comma) {
  std::string text;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (n > 0) text += n + 1 == all.size() ? last_comma : ", ";
    text += all[n];
  }
  return text;
}

}  // namespace

std::string hexadecimal_text(const Range& range, std::int64_t number) {
  const bool is_word = range.most > 0xFF && range.most <= 0xFFFF;
  return fmt::format("{:0{}X}h", number, is_word ? 4 : 2);
}

std::string text_of(const Row& row, std::int64_t number) {
  const auto word = std::ranges::find(row.about.choices, number, &Choice::value);
  if (word != row.about.choices.end()) return std::string(word->name);
  if (row.kind == Kind::truth) return number != 0 ? "yes" : "no";
  if (row.kind == Kind::duration) return kernel::describe(kernel::Duration{number});
  return number_text(row.about, number);
}

std::string text_of_list(const Row& row, const void* items) {
  std::vector<std::string> all;
  for (std::size_t n = 0; n < row.list.size(items); ++n) {
    std::vector<std::string> columns;
    for (const Row& column : row.list.element->rows) {
      columns.push_back(text_of(column, column.get(row.list.at(items, n))));
    }
    all.push_back(listed(columns, " "));
  }
  return all.empty() ? "none" : listed(all, ", ");
}

std::string range_text(const Row& row) {
  const About& about = row.about;
  if (row.kind == Kind::truth) return "yes or no";
  if (row.kind == Kind::choice) {
    std::vector<std::string> names;
    for (const Choice& choice : about.choices) names.emplace_back(choice.name);
    return listed(names, " or ");
  }
  if (row.kind == Kind::duration) {
    return fmt::format("{} to {}", kernel::describe(kernel::Duration{about.range.least}),
                       kernel::describe(kernel::Duration{about.range.most}));
  }
  return fmt::format("{} to {}", number_text(about, about.range.least), number_text(about, about.range.most));
}

std::string setting_range_text(const Row& row) {
  const About& about = row.about;
  if (row.kind == Kind::truth) return "0 or 1";
  if (row.kind == Kind::duration) return range_text(row);
  if (row.kind == Kind::choice) {
    std::vector<std::string> names;
    for (const Choice& choice : about.choices)
      names.push_back(fmt::format("{}: {}", choice.value, choice.name));
    return listed(names, ", ");
  }
  if (about.unit.notation == Notation::hexadecimal) {
    return fmt::format("{} to {}", hexadecimal_text(about.range, about.range.least),
                       hexadecimal_text(about.range, about.range.most));
  }
  return fmt::format("{} to {}", about.range.least, about.range.most);
}

std::string setting_unit_text(const Row& row) {
  if (row.kind == Kind::duration) return "ps";
  const Unit& unit = row.about.unit;
  return unit.per == 1 ? std::string(unit.name) : fmt::format("1/{} {}", unit.per, unit.name);
}

}  // namespace fieldproof::field

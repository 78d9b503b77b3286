#include "harness/field/written_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/field/custom.hpp"
#include "harness/field/walk.hpp"
#include "harness/field/words.hpp"

namespace fieldproof::field {
namespace {

WrittenRow written(std::string name, const Row& row, std::string reference, const About& about) {
  return {.name = std::move(name),
          .unit = setting_unit_text(row),
          .range = setting_range_text(row),
          .reference = std::move(reference),
          .meaning = std::string(row.about.meaning),
          .source = std::string(about.source),
          .standing = about.standing};
}

std::string in_a_cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string reference_text(const Row& row, std::int64_t number) {
  if (row.about.unit.notation == Notation::hexadecimal) return hexadecimal_text(row.about.range, number);
  if (row.kind == Kind::duration) return kernel::describe(kernel::Duration{number});
  return fmt::format("{}", number);
}

void add_list(const Leaf& leaf, std::vector<WrittenRow>& rows) {
  const List& list = leaf.row.list;
  const About& about = leaf.row.about;
  const void* items = leaf.row.member(leaf.reference);
  const std::size_t size = list.size(items);
  if (!list.is_of_fixed_size) {
    rows.push_back({.name = leaf.name,
                    .range = fmt::format("0 to {}", list.most),
                    .reference = fmt::format("{}", size),
                    .meaning = fmt::format("how many: {}", about.meaning),
                    .source = std::string(about.source),
                    .standing = about.standing});
    for (const Row& column : list.element->rows) {
      const std::string tail = column.name.empty() ? "" : fmt::format("_{}", column.name);
      rows.push_back(written(fmt::format("{}_N{}", leaf.name, tail), column, "", about));
    }
    return;
  }
  for (std::size_t n = 0; n < size; ++n) {
    const Row& column = list.element->rows.front();
    WrittenRow row = written(element_name(leaf, n, column.name), column,
                             reference_text(column, column.get(list.at(items, n))), about);
    row.meaning = fmt::format("{}, {}", about.meaning, n + list.first_number);
    rows.push_back(std::move(row));
  }
}

void add_custom(const Leaf& leaf, std::vector<WrittenRow>& rows) {
  const Custom& custom = *leaf.row.custom;
  Settings reference;
  if (custom.put != nullptr) custom.put(leaf.row.member(leaf.reference), reference);
  for (const SettingWords& words : custom.words) {
    const auto found = std::ranges::find(reference, words.name, &Settings::value_type::first);
    rows.push_back({.name = std::string(words.name),
                    .range = std::string(words.range),
                    .reference = found == reference.end() ? "" : fmt::format("{}", found->second),
                    .meaning = std::string(words.meaning),
                    .source = std::string(leaf.row.about.source),
                    .standing = leaf.row.about.standing});
  }
}

}  // namespace

std::vector<WrittenRow> written_rows(const AnyTable& table) {
  std::vector<WrittenRow> rows;
  walk(table, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::list) {
      add_list(leaf, rows);
    } else if (leaf.row.kind == Kind::custom) {
      add_custom(leaf, rows);
    } else {
      rows.push_back(
          written(leaf.name, leaf.row, reference_text(leaf.row, leaf.reference_number()), leaf.row.about));
    }
  });
  return rows;
}

std::string markdown_of(const AnyTable& table) {
  std::string text =
      "| setting | unit | range | reference | meaning | standing |\n|---|---|---|--:|---|---|\n";
  for (const WrittenRow& row : written_rows(table)) {
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name, row.unit, row.range, row.reference,
                        in_a_cell(row.meaning), judge::name(row.standing));
  }
  return text;
}

std::string columns_of(const AnyTable& table) {
  const std::vector<WrittenRow> rows = written_rows(table);
  std::size_t name = 0;
  std::size_t range = 0;
  std::size_t reference = 0;
  // Ends of times are written with units of their own.
  const auto range_of = [](const WrittenRow& row) {
    const bool has_unit = row.unit.empty() || row.unit == "ps";
    return has_unit ? row.range : fmt::format("{} {}", row.range, row.unit);
  };
  for (const WrittenRow& row : rows) {
    name = std::max(name, row.name.size());
    range = std::max(range, range_of(row).size());
    reference = std::max(reference, row.reference.size());
  }
  std::string text;
  for (const WrittenRow& row : rows) {
    text += fmt::format("  {:{}}  {:{}}  {:>{}}  [{}] {}\n", row.name, name, range_of(row), range,
                        row.reference, reference, judge::name(row.standing), row.meaning);
  }
  return text;
}

std::optional<std::string> explained(const AnyTable& table, std::string_view name) {
  for (const WrittenRow& row : written_rows(table)) {
    if (row.name != name) continue;
    const char* trust = judge::is_verified(row.standing) ? "" : ", unverified";
    std::string text = fmt::format("{}\n", row.name);
    const auto field = [&text](const char* label, const std::string& value) {
      if (!value.empty()) text += fmt::format("\n{}\n  {}\n", label, value);
    };
    field("meaning", row.meaning);
    field("unit", row.unit);
    field("range", row.range);
    field("reference", row.reference);
    field("source", fmt::format("{} [{}{}]", row.source, judge::name(row.standing), trust));
    return text;
  }
  return std::nullopt;
}

}  // namespace fieldproof::field

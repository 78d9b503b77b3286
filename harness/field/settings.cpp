#include "harness/field/settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/field/custom.hpp"
#include "harness/field/walk.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::field {
namespace {

// Another number than the one that was given is another case: it is refused, never brought into its range.
std::int64_t in_range(std::string_view name, std::int64_t number, const Range& range) {
  if (number >= range.least && number <= range.most) return number;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("the setting '{}' is {}; it is from {} to {}", name, number, range.least, range.most));
}

void put_list(const Leaf& leaf, Settings& settings) {
  const List& list = leaf.row.list;
  const void* items = leaf.row.member(leaf.object);
  const std::size_t size = list.size(items);
  if (!list.is_of_fixed_size) settings.emplace_back(leaf.name, static_cast<std::int64_t>(size));
  for (std::size_t n = 0; n < size; ++n) {
    for (const Row& column : list.element->rows) {
      settings.emplace_back(element_name(leaf, n, column.name), column.get(list.at(items, n)));
    }
  }
}

void take_number(const GivenSettings& given, std::string_view name, const Row& row, void* object) {
  if (const auto number = given.find(name)) row.set(object, in_range(name, *number, row.about.range));
}

void take_list(const GivenSettings& given, const Leaf& leaf, void* items) {
  const List& list = leaf.row.list;
  if (!list.is_of_fixed_size) {
    const auto most = static_cast<std::int64_t>(list.most);
    const auto size = given.find(leaf.name);
    if (size) list.resize(items, static_cast<std::size_t>(in_range(leaf.name, *size, {0, most})));
  }
  for (std::size_t n = 0; n < list.size(items); ++n) {
    for (const Row& column : list.element->rows) {
      // An element that is not given is brought into its range, too: a new one is zero.
      void* const element = const_cast<void*>(list.at(items, n));
      column.set(element, std::clamp(column.get(element), column.about.range.least, column.about.range.most));
      take_number(given, element_name(leaf, n, column.name), column, element);
    }
  }
}

}  // namespace

GivenSettings::GivenSettings(const Settings& settings) {
  for (const auto& [name, number] : settings) by_name_.emplace(name, number);
}

std::optional<std::int64_t> GivenSettings::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? std::nullopt : std::optional(found->second);
}

std::int64_t GivenSettings::within(std::string_view name, Range range, std::int64_t absent) const {
  return in_range(name, find(name).value_or(absent), range);
}

Settings settings_of_any(const AnyTable& table, const void* object) {
  Settings settings;
  walk(table, object, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::list) {
      put_list(leaf, settings);
    } else if (leaf.row.kind == Kind::custom) {
      if (leaf.row.custom->put != nullptr) leaf.row.custom->put(leaf.row.member(leaf.object), settings);
    } else {
      settings.emplace_back(leaf.name, leaf.number());
    }
  });
  return settings;
}

void take_settings_of_any(const AnyTable& table, const Settings& settings, void* object) {
  const GivenSettings given(settings);
  // The walk is over an object that may be changed.
  walk(table, object, [&](const Leaf& leaf) {
    void* const target = const_cast<void*>(leaf.object);
    if (leaf.row.kind == Kind::list) {
      take_list(given, leaf, const_cast<void*>(leaf.row.member(target)));
    } else if (leaf.row.kind == Kind::custom) {
      if (leaf.row.custom->take == nullptr) return;
      leaf.row.custom->take(given, const_cast<void*>(leaf.row.member(target)));
    } else {
      take_number(given, leaf.name, leaf.row, target);
    }
  });
}

}  // namespace fieldproof::field

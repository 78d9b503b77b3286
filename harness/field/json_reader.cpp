#include "harness/field/json_reader.hpp"

#include <fmt/format.h>

#include "harness/config/document.hpp"
#include "harness/field/custom.hpp"
#include "harness/field/walk.hpp"

namespace fieldproof::field {
namespace {

std::int64_t read_number(const config::Value& value, const About& about) {
  const auto [least, most] = about.range;
  switch (about.unit.notation) {
    case Notation::bit_rate:
      return value.as_bit_rate(least, most);
    case Notation::hexadecimal: {
      const auto number =
          static_cast<std::int64_t>(value.as_hex_or_integer(static_cast<std::uint64_t>(most)));
      if (number < least)
        config::fail(value, fmt::format("{} is too small; write {} to {}", number, least, most));
      return number;
    }
    case Notation::decimal:
      break;
  }
  return value.as_integer<std::int64_t>(least, most);
}

std::int64_t read_one(const config::Value& value, const Row& row) {
  const About& about = row.about;
  if (row.kind == Kind::truth) return value.as_bool() ? 1 : 0;
  if (row.kind == Kind::duration) {
    return value.as_duration(kernel::Duration{about.range.least}, kernel::Duration{about.range.most}).count();
  }
  if (row.kind == Kind::number) return read_number(value, about);
  std::vector<std::string_view> names;
  for (const Choice& choice : about.choices) names.push_back(choice.name);
  return about.choices[value.as_choice(names)].value;
}

void read_list(const config::Value& value, const List& list, void* items) {
  const std::size_t least = list.is_of_fixed_size ? list.size(items) : 0;
  const auto elements = value.as_array(least, list.is_of_fixed_size ? least : list.most);
  if (!list.is_of_fixed_size) list.resize(items, elements.size());
  for (std::size_t n = 0; n < elements.size(); ++n) {
    void* const element = const_cast<void*>(list.at(items, n));
    if (is_plain(*list.element)) {
      const Row& row = list.element->rows.front();
      row.set(element, read_one(elements[n], row));
    } else {
      config::read_object(elements[n], [&](config::ObjectReader& reader) {
        read_members_of_any(reader, *list.element, element);
      });
    }
  }
}

}  // namespace

void read_members_of_any(config::ObjectReader& reader, const AnyTable& table, void* object) {
  walk(table, object, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::custom && leaf.row.custom->read == nullptr) return;
    const auto value = reader.optional(leaf.name);
    if (!value) return;
    void* const target = const_cast<void*>(leaf.object);
    if (leaf.row.kind == Kind::list) {
      read_list(*value, leaf.row.list, const_cast<void*>(leaf.row.member(target)));
    } else if (leaf.row.kind == Kind::custom) {
      leaf.row.custom->read(*value, const_cast<void*>(leaf.row.member(target)));
    } else {
      leaf.row.set(target, read_one(*value, leaf.row));
    }
  });
}

}  // namespace fieldproof::field

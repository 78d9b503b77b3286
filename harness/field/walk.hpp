// One after the other all rows of a table, parts included, each with its full name and with the object whose
// member it describes.
#pragma once

#include <functional>
#include <string>

#include "harness/field/field.hpp"

namespace fieldproof::field {

struct Leaf {
  std::string name;       // with the prefixes of the parts around it
  const Row& row;         // of any kind but part and internal
  const void* object;     // for row.get, row.set, row.member
  const void* reference;  // the same of an object as it is made

  std::int64_t number() const { return row.get(object); }
  std::int64_t reference_number() const { return row.get(reference); }
};

using Visit = std::function<void(const Leaf&)>;
void walk(const AnyTable& table, const void* object, const Visit& visit);
// Over an object as it is made.
void walk(const AnyTable& table, const Visit& visit);

// "schedule_items_2_at": of the column of an element; without a column, where an element is one number.
std::string element_name(const Leaf& list, std::size_t n, std::string_view column);
// Elements that are one number have a table of one row without a name.
bool is_plain(const AnyTable& element);

}  // namespace fieldproof::field

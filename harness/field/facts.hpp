// Where each number comes from and how far it can be trusted: the table of sources of reports.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

struct Fact {
  std::string name;   // of the member; a part of it in brackets where parts differ in standing
  std::string value;  // as a person reads it, with unit
  std::string_view source;
  judge::Standing standing;

  bool is_about(std::string_view member) const {
    return std::string_view(name).substr(0, name.find('[')) == member;
  }
};

// In the order of the members. What differs from the reference's value and is no other value that a source
// names was set for this run: it has the standing `own`.
std::vector<Fact> facts_of_any(const AnyTable& table, const void* object);

template <typename T>
std::vector<Fact> facts_of(const Table<T>& table, const T& object) {
  return facts_of_any(table, &object);
}

}  // namespace fieldproof::field

// Members of an object in a configuration file, each as its row says: strict, in ranges, quantities with
// their unit. What is not written stays as it is. Keys that no row names are refused by config::read_object.
#pragma once

#include "harness/field/field.hpp"

namespace fieldproof::config {
class ObjectReader;
}

namespace fieldproof::field {

void read_members_of_any(config::ObjectReader& reader, const AnyTable& table, void* object);

template <typename T>
void read_members(config::ObjectReader& reader, const Table<T>& table, T& object) {
  read_members_of_any(reader, table, &object);
}

}  // namespace fieldproof::field

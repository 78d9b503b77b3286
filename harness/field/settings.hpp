// Settings of a case: what an implementation is given by name and number, as messages and plug-ins carry it.
//
// One rule for all: the name is the member's, a duration is picoseconds, a truth 0 or 1, a choice its number.
// A list "live" gives its size as "live" and its elements as "live_0", "live_1", of a structure
// "items_0_at". Read back, a value outside of its range is refused (kernel::Error(configuration), with its
// name and range) and what is not given stays as it was.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

using Settings = std::vector<std::pair<std::string, std::int64_t>>;

class GivenSettings {
 public:
  explicit GivenSettings(const Settings& settings);  // which must stay
  std::optional<std::int64_t> find(std::string_view name) const;
  std::int64_t within(std::string_view name, Range range, std::int64_t absent) const;

 private:
  std::map<std::string_view, std::int64_t> by_name_;
};

Settings settings_of_any(const AnyTable& table, const void* object);
void take_settings_of_any(const AnyTable& table, const Settings& settings, void* object);

template <typename T>
Settings settings_of(const Table<T>& table, const T& object) {
  return settings_of_any(table, &object);
}
template <typename T>
void take_settings(const Table<T>& table, const Settings& settings, T& object) {
  take_settings_of_any(table, settings, &object);
}
// A new object with what was given.
template <typename T>
T taken_from(const Table<T>& table, const Settings& settings) {
  T object;
  take_settings(table, settings, object);
  return object;
}

}  // namespace fieldproof::field

// Rows as questions of a PICS: what a person answers about an implementation, in the same words as settings.
#pragma once

#include <vector>

#include "harness/field/field.hpp"
#include "harness/field/settings.hpp"
#include "harness/judge/pics.hpp"

namespace fieldproof::field {

// One item for each number, truth, choice and duration; lists and custom members are nobody's to declare.
std::vector<judge::PicsItem> pics_items_of(const AnyTable& table);

judge::Pics declared_by_any(const AnyTable& table, const void* object);
void take_pics_of_any(const AnyTable& table, const judge::Pics& pics, void* object);
// What these settings are, as answers; of numbers, truths, choices and durations, as above.
void declare_settings(const AnyTable& table, const Settings& settings, judge::Pics& pics);

// All items as the object has them.
template <typename T>
judge::Pics declared_by(const Table<T>& table, const T& object) {
  return declared_by_any(table, &object);
}
// A new object with what was declared.
template <typename T>
T declared_in(const Table<T>& table, const judge::Pics& pics) {
  T object;
  take_pics_of_any(table, pics, &object);
  return object;
}

}  // namespace fieldproof::field

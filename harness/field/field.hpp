// The rows of which everything is made that speaks of a number or an option: of a `Rules`, of a
// configuration.
//
// One row for each member, its name taken from the member itself:
//
//   constexpr auto kRows = field::rows<Rules>(
//       row<&Rules::bit_rate>({kBitRate, {1'200, 1'000'000}, "on the line", kPaper, Standing::seed}),
//       row<&Rules::loss_limit>({kTime, {0, kHour}, "valves off without a command for so long", ...}));
//   const field::Table<Rules> kRulesTable{field::table<Rules>(kRows)};
//
// A member without a row does not compile. Rows hold no type: a number, a truth, a choice and a duration
// are read and set as 64 bits, a duration in picoseconds; what is inside of a member is a part (a structure
// with a table of its own) or a list; what is none of these is custom. What is made of tables: settings.hpp,
// facts.hpp, pics.hpp, json_reader.hpp, json_schema.hpp, written_table.hpp, boundaries.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/field/members.hpp"
#include "harness/judge/verdict.hpp"
#include "harness/kernel/time.hpp"

namespace fieldproof::field {

struct Custom;  // custom.hpp
struct Row;

enum class Kind : std::uint8_t { number, truth, choice, duration, part, list, custom, internal };

// How a number is written.
enum class Notation : std::uint8_t { decimal, hexadecimal, bit_rate };

struct Unit {
  std::string_view name{};
  std::int64_t per = 1;  // the number counts this part of the unit: 2 for half bits
  Notation notation = Notation::decimal;
};
inline constexpr Unit kNoUnit{};
inline constexpr Unit kBitRate{"bit/s", 1, Notation::bit_rate};
inline constexpr Unit kBits{"bit"};
inline constexpr Unit kHalfBits{"bit", 2};
inline constexpr Unit kOctets{"octets"};
inline constexpr Unit kMetres{"m"};
inline constexpr Unit kHexadecimal{"", 1, Notation::hexadecimal};
inline constexpr Unit kTime{};  // of durations, which bring their own

struct Range {
  std::int64_t least = 0;
  std::int64_t most = 0;
};
inline constexpr Range kTruthRange{0, 1};
constexpr Range between(kernel::Duration least, kernel::Duration most) {
  return {least.count(), most.count()};
}

// A word for a value: all that a choice can be, or what stands for one value of a number (0: "none").
struct Choice {
  std::string_view name;
  std::int64_t value;
  std::string_view meaning{};
};

// Another value that a source names.
struct Alternative {
  std::int64_t value;
  std::string_view source;
  judge::Standing standing;
};

// What a row says of its member.
struct About {
  Unit unit{};
  Range range{};
  std::string_view meaning{};
  std::string_view source{};
  judge::Standing standing = judge::Standing::own;
  std::span<const Choice> choices{};
  std::span<const Alternative> alternatives{};
};

// Of any type; views take this one.
struct AnyTable {
  std::span<const Row> rows;
  const void* (*reference)();  // an object as it is made
};
template <typename T>
struct Table : AnyTable {};

// Of a structure inside: `only` its rows of these names, all when there are none; their names begin with
// `prefix`.
struct Part {
  const AnyTable* table = nullptr;
  std::span<const std::string_view> only{};
  std::string_view prefix{};
  bool has(std::string_view name) const {
    if (only.empty()) return true;
    for (const std::string_view one : only) {
      if (one == name) return true;
    }
    return false;
  }
};

// Of what stands in a list. An element is an object with a table, or one number that `get` and `set` of the
// element's row give. A vector grows and shrinks; an array always has its size.
struct List {
  const AnyTable* element = nullptr;
  std::size_t (*size)(const void*) = nullptr;
  void (*resize)(void*, std::size_t) = nullptr;
  const void* (*at)(const void*, std::size_t) = nullptr;
  std::size_t most = 0;
  bool is_of_fixed_size = false;
  std::size_t first_number = 0;  // of the first element in names
};

struct Row {
  std::string_view name;
  Kind kind = Kind::number;
  About about{};
  std::int64_t (*get)(const void*) = nullptr;
  void (*set)(void*, std::int64_t) = nullptr;
  // The member itself, of parts, lists and custom rows.
  const void* (*member)(const void*) = nullptr;
  Part part{};
  List list{};
  const Custom* custom = nullptr;
};

template <auto Member>
struct MemberOf;
template <typename Class, typename Value, Value Class::* Member>
struct MemberOf<Member> {
  using Object = Class;
  using Type = Value;
};

template <typename T>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<T, kernel::Duration>) return Kind::duration;
  if constexpr (std::is_same_v<T, bool>) return Kind::truth;
  if constexpr (std::is_enum_v<T>) return Kind::choice;
  return Kind::number;
}

template <typename T>
constexpr std::int64_t number_of(const T& value) {
  if constexpr (std::is_same_v<T, kernel::Duration>) {
    return value.count();
  } else {
    return static_cast<std::int64_t>(value);
  }
}

template <typename T>
constexpr T value_of(std::int64_t number) {
  if constexpr (std::is_same_v<T, bool>) {
    return number != 0;
  } else {
    return static_cast<T>(number);
  }
}

// A number that its type cannot hold is not in its range: caught where the table is made.
template <typename T>
consteval void expect_to_fit(const Range& range) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    if (!std::in_range<T>(range.least) || !std::in_range<T>(range.most)) throw "the range does not fit";
  }
  if (range.least > range.most) throw "the range is empty";
}

// ---- rows of one number ----

template <auto Member>
consteval Row row(About about) {
  using Type = typename MemberOf<Member>::Type;
  using Object = typename MemberOf<Member>::Object;
  if (kind_of<Type>() == Kind::truth) about.range = kTruthRange;
  if (kind_of<Type>() == Kind::choice) {
    if (about.choices.empty()) throw "a choice without its words";
    about.range = {about.choices.front().value, about.choices.back().value};
  }
  expect_to_fit<Type>(about.range);
  return {.name = name_of<Member>(),
          .kind = kind_of<Type>(),
          .about = about,
          .get = [](const void* object) { return number_of(static_cast<const Object*>(object)->*Member); },
          .set = [](void* object,
                    std::int64_t number) { static_cast<Object*>(object)->*Member = value_of<Type>(number); }};
}

template <auto Member>
constexpr const void* member_of(const void* object) {
  return &(static_cast<const typename MemberOf<Member>::Object*>(object)->*Member);
}

// ---- rows of what is inside ----

template <auto Member>
consteval Row part(const Table<typename MemberOf<Member>::Type>& table,
                   std::span<const std::string_view> only = {}, std::string_view prefix = {}) {
  return {.name = name_of<Member>(),
          .kind = Kind::part,
          .member = member_of<Member>,
          .part = {&table, only, prefix}};
}

// The table of the elements says what each of them is.
template <auto Member>
consteval Row list(const Table<typename MemberOf<Member>::Type::value_type>& element, std::size_t most,
                   About about, std::size_t first_number = 0) {
  using Items = typename MemberOf<Member>::Type;
  List list{.element = &element,
            .size = [](const void* items) { return static_cast<const Items*>(items)->size(); },
            .at = [](const void* items, std::size_t n) -> const void* {
              return &(*static_cast<const Items*>(items))[n];
            },
            .most = most,
            .first_number = first_number};
  if constexpr (requires(Items items) { items.resize(1); }) {
    list.resize = [](void* items, std::size_t size) { static_cast<Items*>(items)->resize(size); };
  } else {
    list.is_of_fixed_size = true;
  }
  return {.name = name_of<Member>(),
          .kind = Kind::list,
          .about = about,
          .member = member_of<Member>,
          .list = list};
}

template <auto Member>
consteval Row custom(const Custom& custom, About about) {
  return {.name = name_of<Member>(),
          .kind = Kind::custom,
          .about = about,
          .member = member_of<Member>,
          .custom = &custom};
}

// A member that is of this process alone: nobody sets it, nobody is given it.
template <auto Member>
consteval Row internal() {
  return {.name = name_of<Member>(), .kind = Kind::internal};
}

// The element of a list that is one number: a row without a name.
template <typename T>
consteval Row item(About about) {
  return {.name = {},
          .kind = kind_of<T>(),
          .about = about,
          .get = [](const void* object) { return number_of(*static_cast<const T*>(object)); },
          .set = [](void* object, std::int64_t number) { *static_cast<T*>(object) = value_of<T>(number); }};
}

// The same of a structure that is told as one number.
template <typename T, auto Pack, auto Unpack>
consteval Row packed_item(About about) {
  return {
      .name = {},
      .kind = Kind::number,
      .about = about,
      .get =
          [](const void* object) { return static_cast<std::int64_t>(Pack(*static_cast<const T*>(object))); },
      .set =
          [](void* object, std::int64_t number) {
            *static_cast<T*>(object) = Unpack(static_cast<std::uint64_t>(number));
          }};
}

// ---- tables ----

// The names of members, for `Part::only`.
template <auto... Members>
inline constexpr std::array<std::string_view, sizeof...(Members)> kNames{name_of<Members>()...};

// Each member of T exactly once.
template <typename T, typename... Rows>
consteval std::array<Row, sizeof...(Rows)> rows(Rows... all) {
  static_assert(sizeof...(Rows) == kMembers<T>, "each member has its row");
  const std::array<Row, sizeof...(Rows)> table{all...};
  for (std::size_t a = 0; a < table.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (table[a].name == table[b].name) throw "a member has two rows";
    }
  }
  return table;
}

template <typename T>
const void* reference_of() {
  static const T reference{};
  return &reference;
}

template <typename T>
constexpr Table<T> table(std::span<const Row> rows) {
  return {{rows, reference_of<T>}};
}

}  // namespace fieldproof::field

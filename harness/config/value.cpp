#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "harness/config/nearest.hpp"
#include "harness/config/source.hpp"

namespace fieldproof::config {

namespace {

const char* name_of(ValueKind kind) {
  switch (kind) {
    case ValueKind::null:
      return "null";
    case ValueKind::boolean:
      return "a truth value";
    case ValueKind::integer:
      return "a whole number";
    case ValueKind::number:
      return "a number with a fraction or an exponent";
    case ValueKind::string:
      return "a string";
    case ValueKind::array:
      return "an array";
    case ValueKind::object:
      return "an object";
  }
  return "a value";
}

// "abc" is a string; write ...
[[noreturn]] void refuse_kind(const Value& value, const Source& source, const Node& node,
                              std::string_view expected) {
  const bool is_scalar =
      node.kind != ValueKind::array && node.kind != ValueKind::object && node.kind != ValueKind::null;
  const std::string subject = is_scalar ? printable(source.raw(node), 60) + " is " : "this is ";
  fail(value, fmt::format("{}{}; write {}", subject, name_of(node.kind), expected));
}

// The value of a whole number as it is written, which may be too long for 64 bit.
[[noreturn]] void refuse_range(const Value& value, const Source& source, const Node& node,
                               std::string_view expected) {
  fail(value, fmt::format("{} is out of range; write {}", printable(source.raw(node), 60), expected));
}

// Digits only, so a whole number that 64 bit do not hold: the parser has made a floating-point number of it.
bool is_oversized_integer(const Source& source, const Node& node) {
  return node.kind == ValueKind::number && source.raw(node).find_first_of(".eE") == std::string_view::npos;
}

template <typename T>
std::string whole_number(T min, T max) {
  if (max == std::numeric_limits<T>::max()) {
    return min == std::numeric_limits<T>::min() && min < 0 ? "a whole number"
                                                           : fmt::format("a whole number from {}", min);
  }
  return fmt::format("a whole number from {} to {}", min, max);
}

std::string some(std::size_t count) {
  return fmt::format("{} element{}", count, count == 1 ? "" : "s");
}

}  // namespace

void fail(const Value& value, std::string_view sentence) {
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("{}:{}: {}: {}", value.source_->name, value.line(), shown(value.pointer()), sentence));
}

namespace {

std::optional<Value> part_of(const Value& whole, std::string_view key) {
  if (whole.is_object()) {
    for (const Member& member : whole.as_members())
      if (member.key == key) return member.value;
  }
  if (whole.is_array()) {
    const std::vector<Value> elements = whole.as_array();
    std::size_t place = elements.size();
    std::from_chars(key.data(), key.data() + key.size(), place);
    if (place < elements.size()) return elements[place];
  }
  return std::nullopt;
}

}  // namespace

void fail(const Value& root, const Violation& violation) {
  Value nearest = root;
  std::string_view rest = violation.at;
  while (rest.starts_with('/')) {
    rest.remove_prefix(1);
    const std::string_view key = rest.substr(0, rest.find('/'));
    const auto part = part_of(nearest, key);
    if (!part) break;
    nearest = *part;
    rest.remove_prefix(key.size());
  }
  fail(nearest, violation.sentence);
}

std::string Value::pointer() const {
  return source_->pointer(node_);
}
std::size_t Value::line() const {
  return source_->place(source_->nodes[node_].offset).first;
}
std::size_t Value::column() const {
  return source_->place(source_->nodes[node_].offset).second;
}
ValueKind Value::kind() const {
  return source_->nodes[node_].kind;
}

std::string_view Value::as_string() const {
  const Node& node = source_->nodes[node_];
  if (node.kind != ValueKind::string) refuse_kind(*this, *source_, node, "a string");
  return source_->strings[node.bits];
}

bool Value::as_bool() const {
  const Node& node = source_->nodes[node_];
  if (node.kind != ValueKind::boolean) refuse_kind(*this, *source_, node, "true or false");
  return node.bits != 0;
}

std::int64_t Value::signed_between(std::int64_t min, std::int64_t max) const {
  const Node& node = source_->nodes[node_];
  const std::string expected = whole_number(min, max);
  if (is_oversized_integer(*source_, node)) refuse_range(*this, *source_, node, expected);
  if (node.kind != ValueKind::integer) refuse_kind(*this, *source_, node, expected);
  const auto number = static_cast<std::int64_t>(node.bits);
  const bool is_held = node.is_negative == (number < 0);
  if (!is_held || number < min || number > max) refuse_range(*this, *source_, node, expected);
  return number;
}

std::uint64_t Value::unsigned_between(std::uint64_t min, std::uint64_t max) const {
  const Node& node = source_->nodes[node_];
  const std::string expected = whole_number(min, max);
  if (is_oversized_integer(*source_, node)) refuse_range(*this, *source_, node, expected);
  if (node.kind != ValueKind::integer) refuse_kind(*this, *source_, node, expected);
  if (node.is_negative || node.bits < min || node.bits > max) {
    refuse_range(*this, *source_, node, expected);
  }
  return node.bits;
}

double Value::as_number(double min, double max) const {
  const Node& node = source_->nodes[node_];
  const bool is_bounded =
      min != std::numeric_limits<double>::lowest() || max != std::numeric_limits<double>::max();
  const std::string expected = is_bounded ? fmt::format("a number from {} to {}", min, max) : "a number";
  double number = 0.0;
  if (node.kind == ValueKind::number) {
    number = std::bit_cast<double>(node.bits);
  } else if (node.kind == ValueKind::integer) {
    number = node.is_negative ? static_cast<double>(static_cast<std::int64_t>(node.bits))
                              : static_cast<double>(node.bits);
  } else {
    refuse_kind(*this, *source_, node, expected);
  }
  if (number < min || number > max) refuse_range(*this, *source_, node, expected);
  return number;
}

std::uint64_t Value::hex_or_unsigned(std::uint64_t max) const {
  const Node& node = source_->nodes[node_];
  if (node.kind != ValueKind::string) return unsigned_between(0, max);
  const std::string_view word = source_->strings[node.bits];
  std::uint64_t number = 0;
  auto result = std::from_chars_result{word.data(), std::errc::invalid_argument};
  if (word.starts_with("0x") || word.starts_with("0X")) {
    result = std::from_chars(word.data() + 2, word.data() + word.size(), number, 16);
  }
  if (result.ec == std::errc::invalid_argument || result.ptr != word.data() + word.size()) {
    fail(*this, fmt::format("{} is not a hexadecimal number; write for example \"0xBE\"", in_quotes(word)));
  }
  if (result.ec != std::errc{} || number > max) {
    fail(*this, fmt::format("{} is out of range; write at most \"0x{:X}\"", in_quotes(word), max));
  }
  return number;
}

std::size_t Value::as_choice(std::span<const std::string_view> names) const {
  const Node& node = source_->nodes[node_];
  std::string list;
  for (const std::string_view name : names) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
  if (node.kind != ValueKind::string) refuse_kind(*this, *source_, node, "one of " + list);
  const std::string_view word = source_->strings[node.bits];
  const auto found = std::find(names.begin(), names.end(), word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (const auto meant = misspelled(word, names)) {
    fail(*this,
         fmt::format("{} is not known; did you mean \"{}\"? (known: {})", in_quotes(word), *meant, list));
  }
  fail(*this, fmt::format("{} is not known; write one of {}", in_quotes(word), list));
}

std::vector<Value> Value::as_array(std::size_t min, std::size_t max) const {
  const Node& node = source_->nodes[node_];
  if (node.kind != ValueKind::array) {
    const bool has_most = max < std::numeric_limits<std::size_t>::max();
    const std::string number = min == max ? fmt::format("{}", min)
                               : has_most ? fmt::format("{} to {}", min, max)
                                          : fmt::format("{} or more", min);
    refuse_kind(*this, *source_, node,
                min > 0 || has_most ? fmt::format("an array of {} elements", number) : "an array");
  }
  if (node.children < min) {
    fail(*this, fmt::format("the array has {}; write at least {}", some(node.children), min));
  }
  if (node.children > max) {
    fail(*this, fmt::format("the array has {}; write at most {}", some(node.children), max));
  }
  std::vector<Value> elements;
  elements.reserve(node.children);
  std::uint32_t child = node.children == 0 ? kNoNode : node_ + 1;
  for (; child != kNoNode; child = source_->nodes[child].next) elements.emplace_back(*source_, child);
  return elements;
}

std::vector<Member> Value::as_members() const {
  const Node& node = source_->nodes[node_];
  if (node.kind != ValueKind::object) refuse_kind(*this, *source_, node, "an object");
  std::vector<Member> members;
  members.reserve(node.children);
  std::uint32_t child = node.children == 0 ? kNoNode : node_ + 1;
  for (; child != kNoNode; child = source_->nodes[child].next) {
    members.push_back({source_->strings[source_->nodes[child].key], Value(*source_, child)});
  }
  return members;
}

}  // namespace fieldproof::config

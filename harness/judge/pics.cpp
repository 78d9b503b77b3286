#include "harness/judge/pics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::judge {
namespace {

template <typename T>
const T* answer(const std::map<std::string, Pics::Answer, std::less<>>& items, std::string_view item) {
  const auto found = items.find(item);
  return found == items.end() ? nullptr : std::get_if<T>(&found->second);
}

}  // namespace

bool Pics::supports(std::string_view item) const {
  const bool* declared = answer<bool>(items_, item);
  return declared != nullptr ? *declared : duration(item, {}) > kernel::Duration{};
}

std::int64_t Pics::number(std::string_view item, std::int64_t absent) const {
  const std::int64_t* declared = answer<std::int64_t>(items_, item);
  return declared == nullptr ? absent : *declared;
}

std::string Pics::text(std::string_view item, std::string_view absent) const {
  const std::string* declared = answer<std::string>(items_, item);
  return declared == nullptr ? std::string(absent) : *declared;
}

kernel::Duration Pics::duration(std::string_view item, kernel::Duration absent) const {
  const kernel::Duration* declared = answer<kernel::Duration>(items_, item);
  return declared == nullptr ? absent : *declared;
}

Pics Pics::completed_by(Pics defaults) const {
  for (const auto& [item, answer] : items_) defaults.declare(item, answer);
  return defaults;
}

PicsKind kind_of(const Pics::Answer& answer) {
  return static_cast<PicsKind>(answer.index());
}

std::string answer_text(const Pics::Answer& answer) {
  const auto text = [](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, kernel::Duration>) return kernel::describe(value);
    if constexpr (std::is_same_v<Value, std::string>) return fmt::format("\"{}\"", value);
    if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, std::int64_t>)
      return fmt::format("{}", value);
  };
  return std::visit(text, answer);
}

std::string answers_text(const PicsItem& item) {
  switch (item.kind) {
    case PicsKind::truth:
      return "true or false";
    case PicsKind::number:
      return fmt::format("a whole number from {} to {}", item.least, item.most);
    case PicsKind::duration:
      return fmt::format("a time from {} to {}", kernel::describe(kernel::Duration{item.least}),
                         kernel::describe(kernel::Duration{item.most}));
    case PicsKind::text:
      break;
  }
  return fmt::format("\"{}\"", fmt::join(item.words, "\" or \""));
}

}  // namespace fieldproof::judge

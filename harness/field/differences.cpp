#include "harness/field/differences.hpp"

#include <fmt/format.h>

#include "harness/field/custom.hpp"
#include "harness/field/settings.hpp"
#include "harness/field/walk.hpp"
#include "harness/field/words.hpp"

namespace fieldproof::field {
namespace {

void add_difference(const std::string& name, const std::string& here, const std::string& usual,
                    std::vector<std::string>& lines) {
  if (here != usual) lines.push_back(fmt::format("{} {} in place of {}", name, here, usual));
}

// A list of hundreds of items would bury the lines around it.
std::string begin_of_list(const std::string& text, std::size_t items) {
  constexpr std::size_t kMostText = 400;
  if (text.size() <= kMostText) return text;
  return fmt::format("{}, ... ({} in all)", text.substr(0, text.rfind(", ", kMostText)), items);
}

void add_list(const Leaf& leaf, std::vector<std::string>& lines) {
  const Row& row = leaf.row;
  const void* here = row.member(leaf.object);
  const void* usual = row.member(leaf.reference);
  const std::string text = text_of_list(row, here);
  const std::string usual_text = text_of_list(row, usual);
  if (text == usual_text) return;
  lines.push_back(fmt::format("{} {} in place of {}", leaf.name, begin_of_list(text, row.list.size(here)),
                              begin_of_list(usual_text, row.list.size(usual))));
}

void add_custom(const Leaf& leaf, std::vector<std::string>& lines) {
  const Custom& custom = *leaf.row.custom;
  if (custom.put == nullptr) return;
  Settings here;
  Settings usual;
  custom.put(leaf.row.member(leaf.object), here);
  custom.put(leaf.row.member(leaf.reference), usual);
  const GivenSettings usually(usual);
  const auto text = [](std::optional<std::int64_t> number) {
    return number ? fmt::format("{}", *number) : std::string("none");
  };
  for (const auto& [name, number] : here) add_difference(name, text(number), text(usually.find(name)), lines);
}

}  // namespace

std::vector<std::string> differences_of_any(const AnyTable& table, const void* object) {
  std::vector<std::string> lines;
  walk(table, object, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::custom) {
      add_custom(leaf, lines);
    } else if (leaf.row.kind == Kind::list) {
      add_list(leaf, lines);
    } else if (leaf.number() != leaf.reference_number()) {
      add_difference(leaf.name, text_of(leaf.row, leaf.number()), text_of(leaf.row, leaf.reference_number()),
                     lines);
    }
  });
  return lines;
}

}  // namespace fieldproof::field

#include <fmt/format.h>

#include <algorithm>

#include "harness/field/walk.hpp"
#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

std::optional<std::string> outside(std::string_view name, std::int64_t value, const field::Range& range) {
  if (value >= range.least && value <= range.most) return std::nullopt;
  return fmt::format("{} is {}, and may be {} to {}", name, value, range.least, range.most);
}

template <typename Rules>
std::optional<std::string> first_impossible(const field::Table<Rules>& table, const Rules& rules) {
  const LinkRules& link = rules.link;
  const std::int64_t answer =
      std::int64_t{link.response_delay_slots} * link.slot_time_octets - link.slot_time_octets;
  std::optional<std::string> sentence;
  field::walk(table, &rules, [&](const field::Leaf& leaf) {
    if (sentence || leaf.row.kind == field::Kind::list) return;
    field::Range range = leaf.row.about.range;
    if (leaf.name == field::name_of<&LinkRules::inter_pdu_delay_octets>())
      range.most = std::min(range.most, answer);
    sentence = outside(leaf.name, leaf.number(), range);
  });
  return sentence;
}

}  // namespace

std::optional<std::string> impossible(const FfRules& rules) {
  return first_impossible(kFfRulesTable, rules);
}

std::optional<std::string> impossible(const IsaRules& rules) {
  return first_impossible(kIsaRulesTable, rules);
}

}  // namespace fieldproof::fieldbus_dll

#include "protocols/token_bus/rules.hpp"

#include <fmt/format.h>

#include "harness/field/walk.hpp"
#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr unsigned kLongestClaimSlots = 6;

}  // namespace

std::optional<std::string> impossible(const Rules& rules) {
  std::optional<std::string> sentence;
  field::walk(kRulesTable, &rules, [&](const field::Leaf& leaf) {
    const field::Range range = leaf.row.about.range;
    if (sentence || leaf.row.kind == field::Kind::list) return;
    if (leaf.number() < range.least || leaf.number() > range.most) {
      sentence =
          fmt::format("{} is {}, and may be {} to {}", leaf.name, leaf.number(), range.least, range.most);
    }
  });
  if (sentence) return sentence;
  if (kLongestClaimSlots * std::size_t{rules.slot_time_octets} > most_data(rules)) {
    return fmt::format("a claim of {} slot times of {} octets is longer than a frame of {} octets",
                       kLongestClaimSlots, rules.slot_time_octets, rules.most_octets);
  }
  if (rules.response_gap_octets + 2 > rules.slot_time_octets) {
    return fmt::format("a response begins after {} octets, which a slot time of {} does not hold",
                       rules.response_gap_octets, rules.slot_time_octets);
  }
  return std::nullopt;
}

}  // namespace fieldproof::token_bus

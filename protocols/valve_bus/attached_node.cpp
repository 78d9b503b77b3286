#include "protocols/valve_bus/attached_node.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::valve_bus {

std::vector<std::pair<std::string, std::int64_t>> node_settings(const NodeConfiguration& configuration) {
  const Rules& rules = configuration.rules;
  return {{"bit_rate", rules.bit_rate},
          {"characters", static_cast<std::int64_t>(rules.characters)},
          {"address_tens", configuration.tens},
          {"address_units", configuration.units},
          {"boards", configuration.boards},
          {"answers_writes", rules.answers_writes ? 1 : 0},
          {"loss_limit_ms", rules.loss_limit / kernel::kMillisecond}};
}

NodeConfiguration node_configuration_of(const iut::CaseBegin& begin) {
  NodeConfiguration configuration;
  Rules& rules = configuration.rules;
  const auto number = [&](std::string_view name, unsigned absent) {
    return static_cast<unsigned>(iut::setting(begin, name, absent));
  };
  rules.bit_rate = std::clamp<std::int64_t>(iut::setting(begin, "bit_rate", rules.bit_rate), 1, 100'000'000);
  rules.characters = character_profile_of(begin);
  configuration.tens = number("address_tens", configuration.tens);
  configuration.units = number("address_units", configuration.units);
  configuration.boards = number("boards", configuration.boards);
  rules.answers_writes = iut::setting(begin, "answers_writes", 0) != 0;
  rules.loss_limit =
      std::clamp<std::int64_t>(iut::setting(begin, "loss_limit_ms", 0), 0, 3'600'000) * kernel::kMillisecond;
  return configuration;
}

AttachedNode::AttachedNode(iut::Attachment attachment, const NodeConfiguration& configuration,
                           const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules), attached_(std::move(attachment)), line_(attached_, rules_) {
  attached_.begin({case_id, seed, node_settings(configuration)}, *this);
}

void AttachedNode::wire(segment::Port& line, NodeBoards& boards) {
  line_.wire(line);
  boards_ = &boards;
}

void AttachedNode::set_power(bool is_on, kernel::Time now) {
  line_.begin(rules_, now);
  attached_.set_power(is_on, now);
}

void AttachedNode::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item != kValves || value > 0xFFFF) {
    iut::refuse_impossible(
        fmt::format("writes {} to item {}; a node has 16 valves, item {}", value, item, kValves));
  }
  attached_.expect_in_order(when, "moves its valves");
  boards_->drive_valves(static_cast<std::uint16_t>(value), when);
}

std::uint64_t AttachedNode::read(iut::Item item, kernel::Time when) {
  if (item != kLimitSwitches) {
    iut::refuse_impossible(
        fmt::format("reads item {}; a node has its limit switches, item {}", item, kLimitSwitches));
  }
  attached_.expect_ahead(when, "reads its limit switches");
  return boards_->limit_switches(when);
}

// ---- a node of ours ----

bool ServedNode::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  play(make_(node_configuration_of(begin)), bench);
  station().wire(port(0), *this);
  return true;
}

}  // namespace fieldproof::valve_bus

#include "protocols/valve_bus/attached_node.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::valve_bus {

AttachedNode::AttachedNode(iut::Attachment attachment, const NodeConfiguration& configuration,
                           const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules), attached_(std::move(attachment)), line_(attached_, uart(rules_)) {
  attached_.begin({case_id, seed, node_settings(configuration)}, *this);
}

void AttachedNode::wire(segment::Port& line, NodeBoards& boards) {
  line_.wire(line);
  boards_ = &boards;
}

void AttachedNode::set_power(bool is_on, kernel::Time now) {
  line_.begin(uart(rules_), now);
  attached_.set_power(is_on, now);
  line_.after_call(now);
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

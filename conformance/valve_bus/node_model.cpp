#include "conformance/valve_bus/node_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

// Instants on the line are rounded to picoseconds, each for itself.
constexpr kernel::Duration kRounded = kernel::kNanosecond;
// In front of the declared time without a host, within which nobody can say what is right.
constexpr kernel::Duration kLossDoubt = 50 * kernel::kMillisecond;

}  // namespace

NodeModel::NodeModel(const valve_bus::NodeConfiguration& configuration)
    : configuration_(configuration), address_(10 * configuration.tens + configuration.units) {
  power_up(kernel::kStart);
}

void NodeModel::power_up(kernel::Time now) {
  writes_.assign(1, {0, now, now});
  valves_ = 0;
  last_command_ = now;
}

bool NodeModel::is_own(const ArrivedFrame& frame, unsigned command) const {
  const valve_bus::Rules& rules = configuration_.rules;
  return frame.is_command() && frame.octets[0] == address_ && address_ >= rules.first_address &&
         address_ <= rules.last_address && frame.octets[1] == command;
}

bool NodeModel::is_answered(const ArrivedFrame& frame) const {
  const valve_bus::Rules& rules = configuration_.rules;
  return is_own(frame, rules.read_command) || (rules.answers_writes && is_own(frame, rules.write_command));
}

std::optional<NodeModel::Answer> NodeModel::hear(const ArrivedFrame& frame, std::uint16_t switches) {
  const valve_bus::Rules& rules = configuration_.rules;
  const bool has_second_board = configuration_.boards > 1;
  if (is_own(frame, rules.read_command)) {
    last_command_ = frame.end;
    const unsigned second = has_second_board ? switches >> 8U : 0U;
    return Answer{static_cast<std::uint8_t>(switches), static_cast<std::uint8_t>(second)};
  }
  if (!is_own(frame, rules.write_command)) return std::nullopt;
  last_command_ = frame.end;
  const std::uint8_t data0 = frame.octets[2];
  const std::uint8_t data1 = frame.octets[3];
  const unsigned second = has_second_board ? data1 : 0U;
  writes_.push_back({static_cast<std::uint16_t>(data0 | second << 8U), frame.end - kRounded,
                     frame.end + valve_bus::delimiter(rules) + actuation_limit(rules) + kRounded});
  if (rules.answers_writes) return Answer{data0, data1};
  return std::nullopt;
}

std::size_t NodeModel::overdue(kernel::Time now) const {
  std::size_t last = 0;
  for (std::size_t n = 0; n < writes_.size(); ++n) {
    if (writes_[n].latest < now) last = n;
  }
  return last;
}

std::optional<std::size_t> NodeModel::next_with(std::uint16_t valves, std::size_t least,
                                                kernel::Time now) const {
  for (std::size_t n = least; n < writes_.size(); ++n) {
    if (writes_[n].valves == valves && writes_[n].earliest <= now) return n;
  }
  return std::nullopt;
}

std::string NodeModel::admissible(kernel::Time now) const {
  std::string text = "valves by what arrived:";
  for (std::size_t n = overdue(now); n < writes_.size(); ++n) {
    if (writes_[n].earliest > now) continue;
    text += fmt::format(" {:02X} {:02X},", writes_[n].valves & 0xFFU, writes_[n].valves >> 8U);
  }
  text.pop_back();
  return text;
}

std::optional<NodeModel::Objection> NodeModel::move(std::uint16_t valves, kernel::Time when) {
  if (auto objection = pass(when)) return objection;
  // pass() has taken away what is over: the first is what stands, or is overdue only by now.
  const auto meant = next_with(valves, 1, when);
  if (!meant) {
    const bool is_due = writes_.size() > 1;
    return Objection{is_due ? "valves_wrong" : "moves_without_command", admissible(when), when};
  }
  writes_.erase(writes_.begin(), writes_.begin() + static_cast<std::ptrdiff_t>(*meant));
  valves_ = valves;
  return std::nullopt;
}

std::optional<NodeModel::Objection> NodeModel::pass(kernel::Time now) {
  const std::size_t least = overdue(now);
  if (least == 0) return std::nullopt;
  // The write that is overdue stands at the valves, or a later one does.
  const auto standing = next_with(valves_, least, now);
  if (!standing) return Objection{"write_not_taken", admissible(now), now};
  writes_.erase(writes_.begin(), writes_.begin() + static_cast<std::ptrdiff_t>(*standing));
  return std::nullopt;
}

kernel::Time NodeModel::holds_until() const {
  const kernel::Duration limit = configuration_.rules.loss_limit;
  return limit > kernel::Duration{} ? last_command_ + limit - kLossDoubt : kernel::kNever;
}

}  // namespace fieldproof::conformance

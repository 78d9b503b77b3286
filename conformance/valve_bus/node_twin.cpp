#include "conformance/valve_bus/node_twin.hpp"

namespace fieldproof::conformance {

NodeTwin::NodeTwin(const valve_bus::NodeConfiguration& configuration, kernel::Time now)
    : node_(configuration),
      driven_(character_format(configuration.rules), configuration.rules.bit_rate),
      line_(node_, driven_) {
  boards_.on_change(
      [this](const segment::ProcessWords::Change& change) { valves_.set(change.after, change.when); });
  node_.wire(line_, boards_);
  line_.run_until(now);
  set_power(true, now);
}

void NodeTwin::set_power(bool is_on, kernel::Time now) {
  line_.run_until(now);
  node_.set_power(is_on, now);
  // Without supply no solenoid is held.
  if (!is_on) boards_.drive_valves(0, now);
  line_.refresh();
  valves_.begin(0, now);
}

Observations NodeTwin::take_answers() {
  Observations answers;
  for (const Transmission& one : driven_.transmissions()) {
    const std::vector<std::uint8_t> octets = one.octets();
    answers.push_back({{octets.begin(), octets.end()}, one.driver_on});
  }
  driven_.clear();
  return answers;
}

std::vector<valve_bus::NodeConfiguration> node_extremes(const valve_bus::NodeConfiguration& configuration) {
  std::vector<valve_bus::NodeConfiguration> all{configuration};
  const kernel::Duration limit = configuration.rules.loss_limit;
  if (limit == kernel::Duration{}) return all;
  for (const kernel::Duration other : {limit - limit / 10, limit + limit / 10}) {
    all.push_back(configuration);
    all.back().rules.loss_limit = other;
  }
  return all;
}

}  // namespace fieldproof::conformance

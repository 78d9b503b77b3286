#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// The words of charts for a local node: what the tester sends, what the node has to do. The reason codes are
// those of the expectations in node_expect.hpp.
namespace fieldproof::conformance {

// What the steps of one round share.
struct NodeScene : Scene<NodeBench> {
  // With random limit switches.
  NodeScene(NodeBench& bench_, CaseJudge& judge_, unsigned round_);

  std::uint16_t switches = 0;         // of the boards
  std::vector<std::uint8_t> frame{};  // that was sent last
  kernel::Time end{};                 // of its last stop bit
  Transmission answer{};              // that was seen last

  // The octets, a silence in which the node can act, and nothing that was seen before.
  void send(std::vector<std::uint8_t> octets);
  // The same after something that the case is about, too.
  void send_next(std::vector<std::uint8_t> octets);
  void set_switches(std::uint16_t made);
  std::vector<std::uint8_t> command(unsigned id, unsigned number, unsigned data0, unsigned data1) const;
  // For the node, with random data.
  std::vector<std::uint8_t> command(unsigned number);
  std::vector<std::uint8_t> write(unsigned data0, unsigned data1) const {
    return command(bench.address(), bench.rules().write_command, data0, data1);
  }
  // Of all valves.
  std::vector<std::uint8_t> moving_write() const;
  // A write of all valves, with this level of one character inverted, of another one in each round.
  void write_with_wrong_level(std::size_t level);
  std::size_t stop_level() const { return character_format(bench.rules()).bits_before_stop(); }
  // The valves that the frame drives, which is a write.
  std::uint16_t valves() const { return bench.valves_of(frame.at(2), frame.at(3)); }
};

using NodeStep = ChartStep<NodeScene>;
using NodeChart = Chart<NodeScene>;

inline NodeCase on_chart(TestCase test_case, NodeChart chart, NodeNeeds needs = {}) {
  return charted<NodeCase>(std::move(test_case), std::move(chart), std::move(needs));
}

// What one chart alone does, or requires.
inline NodeStep stimulus(std::string text, std::function<void(NodeScene&)> run) {
  return {std::move(text), {}, std::move(run)};
}
inline NodeStep expected(std::string text, std::function<void(NodeScene&)> run) {
  return {{}, std::move(text), std::move(run)};
}

namespace node_chart {

using MakeFrame = std::function<std::vector<std::uint8_t>(NodeScene&)>;
NodeStep sent(std::string text, MakeFrame frame);
NodeStep write();
NodeStep moving_write();
// Valves that are on show what switches them off, too.
NodeStep valves_on();
NodeStep read();

// What was sent is a write, and the node takes it.
NodeStep taken();
NodeStep valves_stand(std::string reason);
// The last command is answered with the limit switches.
NodeStep answered();
NodeStep no_valve_moved(std::string reason, std::string why_not);
NodeStep silent(std::string reason, std::string why_not);
// Both.
NodeStep ignored(std::string reason, std::string why_not);
// A write and a read are.
NodeStep serves();

}  // namespace node_chart
}  // namespace fieldproof::conformance

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// The words of charts for a host module: what the PC orders, what the nodes answer, what the host has to
// make of it. The reason codes are those of the expectations in host_expect.hpp.
namespace fieldproof::conformance {

// What the steps of one round share.
struct HostScene {
  HostScene(HostBench& bench_, CaseJudge& judge_, unsigned round_);

  HostBench& bench;
  CaseJudge& judge;
  unsigned round;                      // from 0
  std::uint8_t id;                     // of the node that is read
  std::uint8_t other;                  // of the next one
  HostFrame request{};                 // the first attempt of the read
  std::vector<std::uint8_t> octets{};  // of the response that was given last
  valve_bus::Response known{};         // that the node was known to give before
  valve_bus::HostCounters counters{};  // of the node, when the read was ordered
  valve_bus::HostCounters others{};    // of the other one

  valve_bus::Response random_response();
  // The data in the octets that were given.
  valve_bus::Response response() const { return {octets.at(0), octets.at(1)}; }
};

using HostStep = ChartStep<HostScene>;
using HostChart = Chart<HostScene>;

inline HostCase on_chart(TestCase test_case, HostChart chart, HostNeeds needs = {}) {
  return charted<HostCase>(std::move(test_case), std::move(chart), std::move(needs));
}

namespace host_chart {

// The PC orders a read of the node, and the host sends it.
HostStep read();
// The same, answered with random data, which the PC gets: what is known of the node from then on.
HostStep served_read();
// The node gives a right response, with random data; by default at an ordinary time.
HostStep response();
// The node gives these octets, at an ordinary time or so long after the request.
using MakeOctets = std::function<std::vector<std::uint8_t>(HostScene&)>;
using MakeTime = std::function<kernel::Duration(HostScene&)>;
HostStep answer(std::string text, MakeOctets octets, MakeTime after = {});
std::vector<std::uint8_t> right_octets(HostScene& scene);

// The PC gets the data of the response as the next thing.
HostStep reported();
// The PC gets what the response holds within the time that a response takes: this reason when nothing comes.
HostStep taken(std::string reason);
// Nothing is reported, the node is polled again, and its right response is reported.
HostStep refused(std::string reason, std::string why_not);
// The host polls the node again.
HostStep polled_again();
HostStep not_polled_again();
HostStep error(valve_bus::HostErrorKind kind, std::string reason_for_data = "error_not_told");
// What was known of the node, marked as old.
HostStep old_data();
HostStep nothing_reported(kernel::Duration within, std::string reason, std::string why_not);
// Since the read was ordered; the counters of the other node stand.
HostStep counted(std::uint64_t valve_bus::HostCounters::* counter, unsigned count, std::string what);

}  // namespace host_chart
}  // namespace fieldproof::conformance

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// The words of charts for a host module: what the PC orders, what the nodes answer, what the host has to
// make of it. The reason codes are those of the expectations in host_expect.hpp.
namespace fieldproof::conformance {

// What the steps of one round share.
struct HostScene : Scene<HostBench> {
  HostScene(HostBench& bench_, CaseJudge& judge_, unsigned round_);

  std::uint8_t id;                     // of the node that is read
  std::uint8_t other;                  // of the next one
  unsigned writes = 0;                 // that were ordered
  valve_bus::Command command{};        // that was ordered last
  HostFrame request{};                 // the first attempt of it
  HostFrame poll{};                    // the last one
  std::vector<std::uint8_t> octets{};  // of the response that was given last
  valve_bus::Response known{};         // that the node was known to give before
  valve_bus::HostCounters counters{};  // of the node, when the read was ordered
  valve_bus::HostCounters others{};    // of the other one

  void order(const valve_bus::Command& ordered);
  // What was ordered is sent.
  void expect_sent();
  // Gives octets as the response, at an ordinary time or so long after the request.
  void answer(std::vector<std::uint8_t> given, kernel::Duration after);
  void answer(std::vector<std::uint8_t> given) { answer(std::move(given), bench.turnaround_time()); }
  // The octets that were given, in characters of this format.
  line::Levels levels(valve_bus::CharacterProfile profile) const;
  // In which a response that began at an ordinary time has been reported, if it is.
  kernel::Duration reporting_time() const;
  void expect_nothing_reported(std::string_view reason, const std::string& why_not);
};

using HostStep = ChartStep<HostScene>;
using HostChart = Chart<HostScene>;

inline HostCase on_chart(TestCase test_case, HostChart chart, HostNeeds needs = {}) {
  return charted<HostCase>(std::move(test_case), std::move(chart), std::move(needs));
}

// What one chart alone does, or requires.
inline HostStep stimulus(std::string text, std::function<void(HostScene&)> run) {
  return {std::move(text), {}, std::move(run)};
}
inline HostStep expected(std::string text, std::function<void(HostScene&)> run) {
  return {{}, std::move(text), std::move(run)};
}

// As the PC writes it; the block check is the host's.
inline std::vector<std::uint8_t> octets_for(const valve_bus::Command& command) {
  return {command.id, command.command, command.data0, command.data1};
}

namespace host_chart {

// The PC orders a read of the node, and the host sends it.
HostStep read();
// The PC orders a write to the next one of five nodes, and the host sends it: writes to many would fill the
// line with refreshes.
HostStep write();
// A read, answered with random data, which the PC gets: what is known of the node from then on.
HostStep served_read();
// Power goes off and comes: nothing is refreshed any more.
HostStep power_cycled();
// Power goes off and comes with the next position of the DIP switches, another one in each round.
HostStep powered_up_at_each_position();
unsigned dip_positions();
unsigned dip_of(const HostScene& scene);
// The node gives a right response, with random data; by default at an ordinary time.
HostStep response();
// The node gives these octets, at an ordinary time or so long after the request.
using MakeOctets = std::function<std::vector<std::uint8_t>(HostScene&)>;
using MakeTime = std::function<kernel::Duration(HostScene&)>;
HostStep answer(std::string text, MakeOctets octets, MakeTime after = {});
std::vector<std::uint8_t> right_octets(HostScene& scene);
// What was written, as the node would give it: but for one bit of DATA1 or of DATA0 when it is wrong.
MakeOctets written_data(bool is_right);
// The node gives these levels for the octets of a right response, which stand in the scene.
HostStep answer_levels(std::string text, std::function<line::Levels(HostScene&)> levels);

// The PC gets the data of the response as the next thing.
HostStep reported();
// The PC gets what the response holds within the time that a response takes: this reason when nothing comes.
HostStep taken(std::string reason);
// Nothing is reported, the node is polled again, and its right response is reported.
HostStep refused(std::string reason, std::string why_not);
// The one or the other: "up to 1.4 characters".
HostStep taken_if(std::string text, std::function<bool(const HostScene&)> is_taken,
                  std::string refused_reason, std::string taken_reason, std::string why_not);
// The host polls the node again.
HostStep polled_again();
HostStep not_polled_again();
HostStep error(valve_bus::HostErrorKind kind, std::string reason_for_data = "error_not_told");
// What was known of the node, marked as old.
HostStep old_data();
// Within this time, or within that in which a response is reported.
HostStep nothing_reported(MakeTime within, std::string reason, std::string why_not);
HostStep nothing_reported(kernel::Duration within, std::string reason, std::string why_not);
HostStep nothing_reported(std::string reason, std::string why_not);
// A read is served, whatever came before.
HostStep recovers();
// Since the read was ordered; the counters of the other node stand.
HostStep counted(std::uint64_t valve_bus::HostCounters::* counter, unsigned count, std::string what,
                 std::string reason = "counters_wrong");

}  // namespace host_chart
}  // namespace fieldproof::conformance

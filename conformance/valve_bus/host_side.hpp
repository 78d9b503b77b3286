#pragma once

#include <set>

#include "conformance/comparison/observation.hpp"
#include "conformance/valve_bus/host_bench.hpp"

// One of the two benches of a sequence for a host module: what the tester does there as PC and as nodes, and
// what the host sends and reports.
//
// Writes that repeat what a node was last told are left out of the requests: a host refreshes when it likes.
namespace fieldproof::conformance {

class HostSide {
 public:
  // `judge`: of the form of its frames; null: it is not judged.
  HostSide(HostBench& bench, CaseJudge* judge) : bench_(bench), judge_(judge) {}

  const Observations& requests() const { return requests_; }
  const Observations& indications() const { return indications_; }
  // Nodes for which something was ordered since power-up.
  const std::set<std::uint8_t>& ids() const { return ids_; }
  HostBench& bench() { return bench_; }

  void order(const valve_bus::Command& command);
  // The first octets of a command of which the rest does not come; nothing is open before.
  void order_part(std::span<const std::uint8_t> octets);
  // To the end of the next request that awaits a response; false when none comes.
  bool await_request();
  // Answers the request that was awaited, and runs to the end of the answer.
  // `is_whole`: without faults, so everybody knows when it has ended.
  void answer(const line::Levels& levels, kernel::Duration turnaround_time, bool is_whole);
  // Until every order has ended; nothing is answered.
  void drain();
  // With nothing open: what the nodes say is a surprise.
  void say(std::span<const std::uint8_t> octets);
  void wait(kernel::Duration duration);
  void restart();
  // What receivers may differ about has arrived at the host.
  bool is_doubtful() const;

 private:
  bool awaits_response(const valve_bus::Command& command) const;
  bool is_flooded() const;
  void take_indications();
  // The host has sent this; nothing when it is a refresh.
  std::optional<valve_bus::Command> note(const HostFrame& frame);

  HostBench& bench_;
  CaseJudge* judge_;
  Observations requests_;
  Observations indications_;
  std::set<std::uint8_t> ids_;
  std::size_t orders_ = 0;
  bool is_end_sure_ = true;        // of what was last said on the line
  kernel::Time unnoticed_from_{};  // of the last surprise on the line
  kernel::Time unnoticed_until_{};
  kernel::Time before_on_{};  // of the driver, at the last frame
  kernel::Time before_off_{};
};

}  // namespace fieldproof::conformance

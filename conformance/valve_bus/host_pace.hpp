#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "conformance/valve_bus/host_bench.hpp"
#include "conformance/valve_bus/host_expect.hpp"

// When a host module sends in a sequence, held against the earliest and the latest instants of its page: the
// rest after a write, the time-out of a read, the refreshes and their turns.
//
// It is told of what happens in the order in which it happens. Where nobody can say how the host has
// understood what came from its nodes there is no latest instant.
namespace fieldproof::conformance {

class HostPace {
 public:
  // `judge`: null for a host that is not judged.
  HostPace(const HostBench& bench, CaseJudge* judge) : bench_(bench), judge_(judge) {}

  void on_frame(const HostFrame& frame, bool is_refresh);
  void on_error(const valve_bus::HostError& error, kernel::Time when);
  // The nodes answer the last frame.
  void on_answer() { was_answered_ = true; }
  // The line is not silent though nobody asked.
  void on_noise();
  void on_power();
  // So many writes stand in the FIFO at least.
  void on_writes_ordered(std::size_t count) { writes_waiting_ = count; }

  bool has_written() const { return !written_at_.empty(); }
  kernel::Time last_start() const { return last_ ? last_->start : kernel::Time{}; }
  kernel::Time last_end() const { return last_ ? last_->end : kernel::Time{}; }
  // Until each node that was written to has been written to again, whatever the PC has ordered meanwhile.
  kernel::Duration longest_refresh() const;
  std::size_t written_nodes() const { return written_at_.size(); }
  // Each node that was written to has been written to again by now: `no_refresh`.
  void expect_refreshed();

 private:
  struct Frame {
    valve_bus::Command command;
    kernel::Time start;
    kernel::Time end;
  };

  void expect_rest_after_write(const HostFrame& frame);
  void expect_time_out(const HostFrame& frame, bool is_attempt);
  void expect_turns(bool is_refresh, bool is_write);
  bool awaits_response(const valve_bus::Command& command) const;

  const HostBench& bench_;
  CaseJudge* judge_;
  std::optional<Frame> last_;
  bool was_answered_ = false;                        // the last frame
  unsigned attempt_ = 0;                             // that it was; 0: nobody knows
  std::map<std::uint8_t, kernel::Time> written_at_;  // the begin of the last write to each node
  std::size_t writes_waiting_ = 0;
  unsigned refreshes_ = 0;  // one after the other
};

}  // namespace fieldproof::conformance

#pragma once

#include <set>

#include "conformance/comparison/observation.hpp"
#include "conformance/valve_bus/host_bench.hpp"
#include "conformance/valve_bus/host_pace.hpp"

// One of the two benches of a sequence for a host module: what the tester does there as PC and as nodes, and
// what the host sends and reports.
//
// Writes that repeat what a node was last told are left out of the requests: a host refreshes when it likes.
namespace fieldproof::conformance {

// What a node says to a write of a host that waits for acknowledges.
enum class Acknowledge : std::uint8_t { none, other_data, wrong_check, one_octet, right };

class HostSide {
 public:
  // `judge`: of the form of its frames; null: it is not judged.
  HostSide(HostBench& bench, CaseJudge* judge)
      : bench_(bench),
        judge_(judge),
        pace_(bench, judge),
        dip_(static_cast<unsigned>(bench.pics().number("dip", 0))) {}

  const Observations& requests() const { return requests_; }
  // Of what the host has done on the line, or refused to.
  const Observations& indications() const { return indications_; }
  // Of commands that did not come whole or were lost: when, in between, depends on how fast it sends.
  const Observations& fifo_errors() const { return fifo_errors_; }
  // Of the FIFO, where there is no doubt about them: overflow, octets that there is room for.
  const Observations& fifo_states() const { return fifo_states_; }
  // Frames that it has counted as late, each time that some were said.
  const Observations& late_counts() const { return late_counts_; }
  // Nodes for which something was ordered since power-up.
  const std::set<std::uint8_t>& ids() const { return ids_; }
  HostBench& bench() { return bench_; }
  // For data that no command before has had.
  unsigned next_number() { return number_++; }
  void note_id(std::uint8_t id) { ids_.insert(id); }
  const HostPace& pace() const { return pace_; }
  // Something may have been lost that another host has room for.
  bool is_overflow_doubtful() const { return is_overflow_doubtful_; }

  void order(const valve_bus::Command& command);
  // The first octets of a command of which the rest does not come; nothing is open before.
  void order_part(std::span<const std::uint8_t> octets);
  // As many octets as they are, of so many commands, at once.
  void order_octets(std::span<const std::uint8_t> octets, std::size_t commands);
  // The writes that were ordered last stand in the FIFO.
  void expect_turns(std::size_t writes) { pace_.on_writes_ordered(writes); }
  // To the end of the next request that awaits a response; false when none comes.
  bool await_request();
  // To the end of the next frame that is no refresh.
  bool await_command();
  // Answers the request that was awaited, and runs to the end of the answer.
  // `is_whole`: without faults, so everybody knows when it has ended.
  void answer(const line::Levels& levels, kernel::Duration turnaround_time, bool is_whole);
  // Character by character, as a node does.
  void answer(const valve_bus::Response& response, kernel::Duration turnaround_time) {
    answer_octets(octets_of(response), turnaround_time);
  }
  void answer_octets(std::span<const std::uint8_t> octets, kernel::Duration turnaround_time);
  // Until every order has ended; nothing is answered.
  void drain();
  // With nothing open: what the nodes say is a surprise.
  void say(std::span<const std::uint8_t> octets);
  // With nothing open: the line is not silent for so long, and the PC orders this soon.
  void talk(kernel::Duration duration, const valve_bus::Command& command);
  void wait(kernel::Duration duration);
  // The first attempts of this write are acknowledged so; all other writes are acknowledged rightly, where
  // the host waits for that.
  void acknowledge_wrongly(const valve_bus::Command& command, unsigned attempts, Acknowledge how);
  // To the end of this write; false when it does not come so soon.
  bool await_write(const valve_bus::Command& command, kernel::Duration within);
  // With nothing open: the line is not silent for so long, and nothing is ordered; then refreshes come.
  void keep_line_busy(kernel::Duration duration);
  void expect_refreshed() { pace_.expect_refreshed(); }
  void note_late(std::uint8_t id, std::int64_t count) { late_counts_.push_back({{id, count}, bench_.now()}); }
  void turn_dip(unsigned position) { bench_.set_dip(dip_ = position); }
  void restart();
  void note_fifo();
  // What receivers may differ about has arrived at the host.
  bool is_doubtful() const;

 private:
  bool awaits_response(const valve_bus::Command& command) const;
  bool is_flooded() const;
  void take_indications();
  // The host has sent this; nothing when it is a refresh.
  std::optional<valve_bus::Command> note(const HostFrame& frame);
  void acknowledge(const valve_bus::Command& command);

  HostBench& bench_;
  CaseJudge* judge_;
  Observations requests_;
  Observations indications_;
  Observations fifo_errors_;
  Observations fifo_states_;
  Observations late_counts_;
  valve_bus::Command wrongly_acknowledged_;
  unsigned wrong_acknowledges_ = 0;  // that are left
  Acknowledge wrong_acknowledge_ = Acknowledge::right;
  HostPace pace_;
  unsigned dip_;
  unsigned number_ = 1;
  bool is_overflow_doubtful_ = false;
  std::set<std::uint8_t> ids_;
  std::size_t orders_ = 0;
  bool is_end_sure_ = true;        // of what was last said on the line
  kernel::Time unnoticed_from_{};  // of the last surprise on the line
  kernel::Time unnoticed_until_{};
  kernel::Time before_on_{};  // of the driver, at the last frame
  kernel::Time before_off_{};
};

}  // namespace fieldproof::conformance

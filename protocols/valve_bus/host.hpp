#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>

#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/command_fifo.hpp"
#include "protocols/valve_bus/device.hpp"

// The reference host module: it takes commands from the FIFO that its PC fills, sends them one at a time with
// their block check, waits for the responses to reads, and sends the last write of each node again and again.
//
//   off ──power──▶ idle ──a read, the line silent──▶ awaiting ──response──▶ idle
//                   ▲ │                                 │ time-out: again, or an error
//                   │ └──a write──▶ resting ◀───────────┘
//                   └───────────────────┘ distance over
//
// A response has no address: only its time says to which read it belongs. So nothing is sent while one may
// still come: after a wrong response the host waits until the time-out, and after the last attempt a little
// longer, for one that is late. What comes when nothing is awaited is drained.
//
// While it drives the line it does not listen, however it is wired.
//
// Limits: a response that comes later than that, into the window of the next read, is taken for an answer to
// it; no host can tell. Due refreshes and commands of the PC take turns, so with more than some 40 nodes to
// refresh the bus is full and refreshes come later than they should.
//
// Every decision that a wrong implementation takes otherwise has a name and can be overridden one by one.
namespace fieldproof::valve_bus {

enum class HostState : std::uint8_t { off, idle, awaiting, resting };

class Host : public HostDevice {
 public:
  explicit Host(const HostConfiguration& configuration);

  void wire(segment::Port& line, HostApplication& application) override;
  void set_power(bool is_on, kernel::Time now) override;
  void set_dip(unsigned position) override { dip_ = position; }
  void write(std::span<const std::uint8_t> octets, kernel::Time now) override;
  std::size_t fifo_room() const override { return fifo_->room(); }
  bool has_overflowed() const override { return fifo_->has_overflowed(); }
  HostCounters counters(std::uint8_t id) const override { return counters_.at(counters_place(id)); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  HostState state() const { return state_; }

 protected:
  enum class Purpose : std::uint8_t { command, refresh, verification };

  // What the host is at: a command that has been or will be sent.
  struct Exchange {
    Command command;
    Purpose purpose = Purpose::command;
    unsigned attempt = 1;
  };

  Host(const HostConfiguration& configuration, std::unique_ptr<CommandFifo> fifo);

  const HostConfiguration& configuration() const { return configuration_; }
  // With the bit rate of the DIP switches.
  const Rules& rules() const { return rules_; }
  CharacterCodec& codec() { return codec_; }
  FrameCollector& collector() { return collector_; }
  const FrameCollector& collector() const { return collector_; }
  const CommandFifo& fifo() const { return *fifo_; }
  segment::Port& line() { return *line_; }
  const std::optional<Exchange>& exchange() const { return exchange_; }
  std::optional<Response> known(std::uint8_t id) const { return known_.at(id); }
  std::uint8_t last_id() const { return last_id_; }
  HostCounters& counted(std::uint8_t id) { return counters_.at(counters_place(id)); }
  unsigned dip() const { return dip_; }
  // The nodes that are refreshed, the one that was written to longest ago first.
  const std::deque<std::uint8_t>& refresh_order() const { return refresh_order_; }
  kernel::Time refresh_due(std::uint8_t id) const { return writes_.at(id).due; }

  // ---- decisions: what the PC wants ----
  virtual std::optional<Command> next_command() { return fifo_->take(); }
  virtual bool is_address(std::uint8_t id) const;
  virtual bool is_command(std::uint8_t command) const;
  virtual void refuse(const HostError& error, kernel::Time now) { tell(error, now); }
  virtual void on_lost_command(std::uint8_t id, kernel::Time now);
  virtual void on_part(std::span<const std::uint8_t> part, kernel::Time now);
  virtual void keep_write(const Command& command);

  // ---- decisions: what is sent again ----
  // When a write that was sent at `start`, or could not be sent then, is sent again.
  virtual kernel::Time refreshed_at(kernel::Time start) const { return start + rules_.refresh; }
  virtual bool is_refreshed(std::uint8_t) const { return true; }
  // The place in the order of the nodes of which a refresh is due.
  virtual std::size_t next_refresh(kernel::Time) const { return 0; }
  // Whether a read of the node follows this write.
  virtual bool is_read_back(const Exchange& write) const {
    return configuration_.verifies_writes && write.purpose == Purpose::command;
  }

  // ---- decisions: requests ----
  virtual std::int64_t bit_rate_of(unsigned dip) const;
  virtual Command sent(const Command& command) const { return command; }
  virtual std::uint8_t request_check(const Command& command) const;
  // Between whatever was on the line and the next start bit.
  virtual kernel::Duration silence() const { return delimiter(rules_); }
  virtual bool awaits_response(const Exchange& exchange) const;
  virtual kernel::Duration time_out() const { return response_time_out(rules_); }
  // One that is due, where the last exchange was one or was none.
  virtual bool may_refresh(bool was_refresh) const;
  virtual bool may_repeat(const Exchange& exchange) const;
  // A line that is not silent for so long is not waited for.
  virtual kernel::Duration longest_talk() const { return time_out(); }
  // What is left for a late response after the last attempt.
  virtual kernel::Duration late_span() const;
  // Nothing begins while others are on the line.
  virtual bool waits_for_silence() const { return true; }

  // ---- decisions: what is heard ----
  virtual line::UartCharacter judged(const line::UartCharacter& character) const { return character; }
  virtual bool is_own(const line::UartCharacter& character) const { return character.start < driving_until_; }
  virtual void on_character(const line::UartCharacter& character) { collector_.add(character); }
  virtual kernel::Duration shortest_turnaround_time() const { return longest_gap(rules_); }
  virtual std::optional<Response> response_in(const CollectedFrame& frame) const;
  virtual bool fits(std::span<const std::uint8_t> octets) const;
  virtual void on_stray(const CollectedFrame& frame, kernel::Time now);
  // The time-out of an attempt that was answered wrongly goes on.
  virtual bool waits_out_a_wrong_response() const { return true; }
  virtual bool is_verified(const Command& written, const Response& read) const;

  // ---- decisions: what the PC is told ----
  virtual void tell(const HostResponse& response, kernel::Time now);
  virtual void tell(const HostError& error, kernel::Time now);
  virtual void tell_old(std::uint8_t id, kernel::Time now);
  virtual std::size_t counters_place(std::uint8_t id) const { return id; }

  // ---- actions ----
  void read_dip();
  // What has been collected is over.
  void end_frame(kernel::Time now);
  virtual void send(kernel::Time now);
  // The octets, the first start bit at `start`, with the driver on around them.
  virtual void transmit(std::span<const std::uint8_t> octets, kernel::Time start);
  // What came is no response to what was sent.
  void reject();
  // What is awaited has come.
  void accept(const Response& response, kernel::Time now);
  virtual void fail(HostErrorKind kind, kernel::Time now);
  // Nothing is sent before this instant.
  void leave_silent_until(kernel::Time time) { free_at_ = std::max(free_at_, time); }

 private:
  std::optional<Exchange> next_exchange(kernel::Time now);
  std::optional<Command> next_valid_command(kernel::Time now);
  void note_write(const Command& command, kernel::Time start);
  kernel::Time refresh_due_at() const;
  kernel::Time work_since() const;
  kernel::Time sends_at() const;
  kernel::Time window_closes_at() const;
  kernel::Time busy_limit_at() const;

  void on_window_frame(const CollectedFrame& frame, kernel::Time now);
  void close_window(kernel::Time now);
  void repeat_or_fail(HostErrorKind kind, kernel::Time now);
  void on_line_busy(kernel::Time now);
  void end_write();
  void enter_resting(kernel::Time until);

  static constexpr std::size_t kIds = 256;

  HostConfiguration configuration_;
  Rules rules_;
  unsigned dip_;
  CharacterCodec codec_;
  FrameCollector collector_;
  std::unique_ptr<CommandFifo> fifo_;
  segment::Port* line_ = nullptr;
  HostApplication* application_ = nullptr;

  HostState state_ = HostState::off;
  std::optional<Exchange> exchange_;
  kernel::Time free_at_{};  // for the next start of the driver
  kernel::Time driving_until_{kernel::Duration::min()};
  kernel::Time request_end_{};  // of the last stop bit
  kernel::Time window_end_{};   // for the start bit of a response
  bool is_rejected_ = false;    // what came in the window
  bool is_late_ = false;        // what would come now, of last_id_
  std::uint8_t last_id_ = 0;
  kernel::Time waits_since_{kernel::Duration::min()};  // for the line, with its present attempt
  bool was_refresh_ = false;                           // the last exchange

  std::array<std::optional<Response>, kIds> known_{};
  std::array<HostCounters, kIds> counters_{};
  struct Write {
    Command command;
    kernel::Time due;
  };
  std::array<Write, kIds> writes_{};        // the last one of each node
  std::deque<std::uint8_t> refresh_order_;  // the nodes that have one, the next to be refreshed first
};

}  // namespace fieldproof::valve_bus

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"

// The reference local node: it listens, takes a command for its address when the silence after it is sure,
// drives its valves or answers with its limit switches.
//
//   off ──power──▶ waiting ──character──▶ collecting ──silence of 3.5 characters──▶ waiting    (valves, or
//   nothing)
//                     ▲                                    │ a read of its own
//                     └──────── driver off ── answering ◀──┘ turn-round
//
// While it drives the line its receiver is off: characters that begin before its driver is off are not heard.
// A command that comes before it has answered cancels the answer: the host has given it up.
//
// Every decision that a wrong implementation takes otherwise has a name and can be overridden one by one.
namespace fieldproof::valve_bus {

// What it takes the reference node to work out an answer, after the delimiter.
inline constexpr kernel::Duration kNodeProcessing = 100 * kernel::kMicrosecond;

enum class NodeState : std::uint8_t { off, waiting, collecting, answering };

class Node : public NodeDevice {
 public:
  explicit Node(const NodeConfiguration& configuration);

  void wire(segment::Port& line, NodeBoards& boards) override;
  void set_power(bool is_on, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  NodeState state() const { return state_; }
  unsigned address() const { return address_; }

 protected:
  const NodeConfiguration& configuration() const { return configuration_; }
  const Rules& rules() const { return configuration_.rules; }
  std::uint16_t valves() const { return valves_; }
  std::uint16_t limit_switches(kernel::Time when) { return boards_->limit_switches(when); }
  FrameCollector& collector() { return collector_; }

  // ---- decisions ----
  virtual unsigned address_of(unsigned tens, unsigned units) const;
  virtual line::UartCharacter judged(const line::UartCharacter& character) const { return character; }
  virtual void on_character(const line::UartCharacter& character);
  virtual void on_frame(const CollectedFrame& frame, kernel::Time now);
  virtual bool is_meant(std::uint8_t id) const;
  virtual bool fits(std::span<const std::uint8_t> octets) const;
  virtual void on_command(const Command& command, kernel::Time now);
  virtual std::uint16_t valves_of(const Command& command) const;
  virtual Response response(kernel::Time now);
  virtual kernel::Duration turnaround_time() const;
  virtual std::uint8_t response_check(const Response& response) const;
  virtual void on_power_up(kernel::Time) {}

  // ---- actions ----
  // What has been collected is over.
  void end_frame(kernel::Time now);
  segment::Port& line() { return *line_; }
  CharacterCodec& codec() { return codec_; }
  virtual void actuate(std::uint16_t valves, kernel::Time now);
  // The first start bit at `start`, or now where that has passed.
  void answer_at(const Response& response, kernel::Time start);
  // The octets, the first start bit at `start`, with the driver on around them.
  virtual void transmit(std::span<const std::uint8_t> octets, kernel::Time start);

 private:
  struct Answer {
    Response response;
    kernel::Time start;  // of its first start bit
  };

  kernel::Time driver_on_at(const Answer& answer) const;
  kernel::Time loss_at() const;

  NodeConfiguration configuration_;
  unsigned address_;
  CharacterCodec codec_;
  FrameCollector collector_;
  segment::Port* line_ = nullptr;
  NodeBoards* boards_ = nullptr;
  NodeState state_ = NodeState::off;
  std::uint16_t valves_ = 0;
  std::optional<Answer> answer_;
  kernel::Time driving_until_{kernel::Duration::min()};
  kernel::Time last_command_{};
};

}  // namespace fieldproof::valve_bus

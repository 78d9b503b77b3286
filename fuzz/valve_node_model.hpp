#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/device.hpp"

// What a local node of the valve bus may do, from the characters that arrive at it and from nothing else. A
// frame is what lies between two silences of 3.5 characters; it is a command when it has five good characters
// without a gap above 1.5, and their exclusive or is 0. A write of its own moves the valves when the frame is
// known to be over; a read of its own is answered within the turn-round, unless another character comes
// first. Nothing else moves a valve or switches the driver on.
//
// The model hears the line as a tap and is told what the node does. The characters come from the receiver of
// the house.
namespace fieldproof::fuzz {

struct ValveWrite {
  kernel::Time when;
  std::uint16_t valves = 0;
  friend bool operator==(const ValveWrite&, const ValveWrite&) = default;
};

class ValveNodeModel final : public segment::Tap {
 public:
  explicit ValveNodeModel(const valve_bus::NodeConfiguration& configuration);

  void set_power(bool is_on, kernel::Time now);
  void set_switches(std::uint16_t switches) { switches_ = switches; }

  // What arrived.
  void on_wave(const line::Waveform& wave) override;
  // Nothing else has arrived until now.
  void run_until(kernel::Time now);
  // The node drives this: a broken invariant unless it is the next character of an answer that is due.
  void on_driven(const line::Waveform& wave, kernel::Time now);

  // That the node must have done.
  const std::vector<ValveWrite>& writes() const { return writes_; }
  // An answer is due that has not begun.
  bool owes_answer() const { return due_.has_value(); }

 private:
  struct Heard {
    std::uint8_t octet;
    bool is_good;
  };
  struct Due {
    std::array<std::uint8_t, 3> octets;
    kernel::Time earliest;  // of the first start bit
    kernel::Time latest;
  };

  void on_character(const line::CharacterReceiver::Received& one, kernel::Time now);
  void end_frame(kernel::Time now);
  void on_command(kernel::Time now);
  void let_go(kernel::Time when);
  kernel::Time known_at() const;
  kernel::Time loss_at() const;

  valve_bus::NodeConfiguration configuration_;
  line::CharacterReceiver receiver_;
  line::CharacterReceiver answer_receiver_;
  bool is_on_ = false;
  std::vector<Heard> frame_;
  bool has_gap_ = false;
  kernel::Time busy_until_{};
  kernel::Time last_command_{};
  kernel::Time driving_until_{kernel::Duration::min()};
  std::uint16_t valves_ = 0;
  std::uint16_t switches_ = 0;
  std::optional<Due> due_;
  std::deque<std::uint8_t> saying_;  // what is left of an answer that has begun
  std::vector<ValveWrite> writes_;
};

}  // namespace fieldproof::fuzz

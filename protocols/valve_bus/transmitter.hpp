#pragma once

#include "harness/iut/device.hpp"
#include "protocols/valve_bus/codec.hpp"

// Puts what an implementation says it has sent onto the line of the bench: its driver that comes on, the
// characters without a gap, its driver that goes off.
namespace fieldproof::valve_bus {

class Transmitter {
 public:
  explicit Transmitter(const Rules& rules) : rules_(rules), codec_(rules) {}

  // Instants in order: driver on, start, end of the characters, driver off.
  void drive(segment::Port& line, const iut::Transmission& transmission);
  // Levels as they are.
  void drive(segment::Port& line, line::Waveform& wave);
  // Nothing has been driven before this instant.
  void begin_at(kernel::Time now) { driven_until_ = now; }
  kernel::Time driven_until() const { return driven_until_; }

 private:
  // The driver on and nothing said. Gives the end: `to`, or what rounding makes of it.
  kernel::Time drive_idle(segment::Port& line, kernel::Time from, kernel::Time to);
  kernel::Time behind_the_last(kernel::Time start) const;

  Rules rules_;
  CharacterCodec codec_;
  kernel::Time driven_until_{};
};

}  // namespace fieldproof::valve_bus

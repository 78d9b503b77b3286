#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/line_driver.hpp"

// The line of the valve bus as an implementation outside hears and drives it, whatever its role: port 0, in
// characters that are over, or in levels.
namespace fieldproof::valve_bus {

class AttachedLine {
 public:
  // Throws kernel::Error for an implementation that announces what the valve bus does not have.
  AttachedLine(iut::AttachedCase& attached, const Rules& rules);

  void wire(segment::Port& line) { line_ = &line; }
  // Nothing has been driven before `now`, and characters come as these rules say.
  void begin(const Rules& rules, kernel::Time now);

  void receive(segment::PortIndex port, const line::Waveform& reception);
  void on_time(kernel::Time now);
  kernel::Time next_time() const {
    return attached_.is_well() ? std::min(attached_.next_time(), driver_.next_time()) : kernel::kNever;
  }
  // The implementation has been called: what it has said goes onto the line.
  void after_call(kernel::Time now) {
    if (driver_.has_work()) put(now);
  }
  // Throws iut::Misbehaviour where its driver is on for no reason.
  void end();

  // What the implementation drives.
  void set_driver(unsigned port, bool is_on, kernel::Time at);
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters);
  void transmit(unsigned port, line::Waveform& wave);

  // Of all that it does from now on; kept with what it drives.
  void set_uncertainty(iut::TimingUncertainty uncertainty) { uncertainty_ = uncertainty; }
  iut::TimingUncertainty uncertainty() const { return uncertainty_; }
  iut::TimingUncertainty uncertainty_of(kernel::Time driver_on) const;

 private:
  struct Known {
    kernel::Time driver_on;
    iut::TimingUncertainty uncertainty;
  };

  void put(kernel::Time now);
  void expect_exact(const line::Waveform& reception) const;
  void expect_port(unsigned port) const;

  iut::AttachedCase& attached_;
  Rules rules_;
  CharacterCodec codec_;
  LineDriver driver_;
  segment::Port* line_ = nullptr;
  std::vector<iut::Character> characters_;
  iut::TimingUncertainty uncertainty_;
  std::deque<Known> known_;  // the last ones
};

}  // namespace fieldproof::valve_bus

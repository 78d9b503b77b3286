#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/enabled_driver.hpp"
#include "harness/line/uart.hpp"
#include "harness/line/uart_codec.hpp"
#include "harness/segment/station.hpp"

// A line of UART characters as an implementation outside receives and drives it, whatever its role: port 0,
// in characters that are over, or in levels.
namespace fieldproof::iut {

class AttachedUart {
 public:
  // Throws kernel::Error for an implementation that announces telegrams, which such a line does not have.
  AttachedUart(AttachedCase& attached, const line::Uart& uart);

  void wire(segment::Port& line) { line_ = &line; }
  // Nothing has been driven before `now`, and characters are these.
  void begin(const line::Uart& uart, kernel::Time now);

  void receive(segment::PortIndex port, const line::Waveform& reception);
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now);
  void on_time(kernel::Time now);
  kernel::Time next_time() const {
    return attached_.is_well() ? std::min(attached_.next_time(), driver_.next_time()) : kernel::kNever;
  }
  // The implementation has been called: what it has said goes onto the line.
  void after_call(kernel::Time now) {
    if (driver_.has_work()) put(now);
  }
  // Throws Misbehaviour where its driver is on for no reason.
  void end();

  // What the implementation drives.
  void set_driver(unsigned port, bool is_on, kernel::Time at);
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters);
  void transmit(unsigned port, line::Waveform& wave);

  // Of all that it does from now on; kept with what it drives.
  void set_uncertainty(TimingUncertainty uncertainty) { uncertainty_ = uncertainty; }
  TimingUncertainty uncertainty() const { return uncertainty_; }
  TimingUncertainty uncertainty_of(kernel::Time driver_on) const;

 private:
  struct Known {
    kernel::Time driver_on;
    TimingUncertainty uncertainty;
  };

  void put(kernel::Time now);
  void expect_exact(const line::Waveform& reception) const;
  void expect_port(unsigned port) const;

  AttachedCase& attached_;
  line::Uart uart_;
  line::UartCodec codec_;
  EnabledDriver driver_;
  segment::Port* line_ = nullptr;
  std::vector<Character> characters_;
  TimingUncertainty uncertainty_;
  std::deque<Known> known_;  // the last ones
};

}  // namespace fieldproof::iut

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocols/fieldbus_dll/line_end.hpp"

// Function blocks of a control loop: analog input, PID and analog output, and a process to control.
//
// What blocks exchange is a value with its status. That values are single precision, the high octet first,
// with one octet of status in front, is from memory; that the number of the sample stands after them is this
// project's choice, so that whoever gets a value can tell where it comes from.
namespace fieldproof::fieldbus_dll {

enum class SignalStatus : std::uint8_t { bad = 0x00, good = 0x80 };

struct Signal {
  float value = 0;
  SignalStatus status = SignalStatus::bad;
  std::uint32_t sample = 0;  // of the analog input, from 1 on; what a PID computes has that of its input

  friend bool operator==(const Signal&, const Signal&) = default;
};

Octets octets_of(const Signal& signal);
// Nothing when the octets are no signal: another length, an unknown status, a value that is no number.
std::optional<Signal> signal_of(std::span<const std::uint8_t> octets);

// Turns what it measures into a signal; outside of its range the nearest end, which is bad.
class AnalogInput {
 public:
  AnalogInput(float low, float high) : low_(low), high_(high) {}
  Signal execute(double measured);

 private:
  float low_, high_;
  std::uint32_t sample_ = 0;
};

struct PidSettings {
  double gain = 1;
  double reset_s = 0;   // integral time; 0: none
  double rate_s = 0;    // derivative time, of the measured value
  double period_s = 1;  // from execution to execution
  double low = 0;       // of the output
  double high = 100;
};

// In increments: u += gain * (de + e * period / reset - d2y * rate / period), and within its limits, so that
// the integral does not wind up there. With a bad input the output stays as it is.
class Pid {
 public:
  // A period or a reset that is negative, or limits without room between, are a configuration error.
  explicit Pid(const PidSettings& settings);
  // The latest that has come; the same again where nothing has.
  Signal execute(const Signal& measured, double setpoint);

 private:
  PidSettings settings_;
  bool has_begun_ = false;
  double output_;
  double error_ = 0;  // of the execution before
  double measured_ = 0, measured_before_ = 0;
};

// Puts out what is good; else it stays where it is.
class AnalogOutput {
 public:
  double execute(const Signal& wanted);
  double output() const { return output_; }

 private:
  double output_ = 0;
};

// Two lags in a row, y / u = gain / ((1 + lag_1 s)(1 + lag_2 s)), solved exactly while its input stands.
class Process {
 public:
  // Lags are positive, and not equal.
  Process(double gain, double lag_1_s, double lag_2_s);
  void advance(double seconds, double input);
  double output() const { return second_; }

 private:
  double gain_, lag_1_, lag_2_;
  double first_ = 0, second_ = 0;
};

}  // namespace fieldproof::fieldbus_dll

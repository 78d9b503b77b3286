#include "protocols/fieldbus_dll/function_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::size_t kSignalOctets = 9;

void put_word(Octets& octets, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) octets.push_back(static_cast<std::uint8_t>(word >> shift));
}

std::uint32_t word_at(std::span<const std::uint8_t> octets, std::size_t at) {
  std::uint32_t word = 0;
  for (const std::uint8_t octet : octets.subspan(at, 4)) word = word << 8 | octet;
  return word;
}

}  // namespace

Octets octets_of(const Signal& signal) {
  Octets octets{static_cast<std::uint8_t>(signal.status)};
  put_word(octets, std::bit_cast<std::uint32_t>(signal.value));
  put_word(octets, signal.sample);
  return octets;
}

std::optional<Signal> signal_of(std::span<const std::uint8_t> octets) {
  if (octets.size() != kSignalOctets) return std::nullopt;
  const auto status = static_cast<SignalStatus>(octets[0]);
  if (status != SignalStatus::good && status != SignalStatus::bad) return std::nullopt;
  const auto value = std::bit_cast<float>(word_at(octets, 1));
  if (!std::isfinite(value)) return std::nullopt;
  return Signal{value, status, word_at(octets, 5)};
}

Signal AnalogInput::execute(double measured) {
  ++sample_;
  if (!std::isfinite(measured)) return {low_, SignalStatus::bad, sample_};
  const bool is_inside = measured >= double{low_} && measured <= double{high_};
  const double value = std::clamp(measured, double{low_}, double{high_});
  return {static_cast<float>(value), is_inside ? SignalStatus::good : SignalStatus::bad, sample_};
}

Pid::Pid(const PidSettings& settings) : settings_(settings), output_(settings.low) {
  if (!(settings.period_s > 0) || !(settings.reset_s >= 0) || !(settings.low < settings.high)) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "a PID block has a period above 0, a reset of 0 or more, and a low limit of its "
                        "output below the high one");
  }
}

Signal Pid::execute(const Signal& measured, double setpoint) {
  if (measured.status == SignalStatus::bad) {
    return {static_cast<float>(output_), SignalStatus::bad, measured.sample};
  }
  const double value = measured.value;
  const double error = setpoint - value;
  if (!has_begun_) {
    has_begun_ = true;
    measured_ = measured_before_ = value;
  }
  double step = error - error_;
  if (settings_.reset_s > 0) step += error * settings_.period_s / settings_.reset_s;
  step -= (value - 2 * measured_ + measured_before_) * settings_.rate_s / settings_.period_s;
  output_ = std::clamp(output_ + settings_.gain * step, settings_.low, settings_.high);
  error_ = error;
  measured_before_ = measured_;
  measured_ = value;
  return {static_cast<float>(output_), SignalStatus::good, measured.sample};
}

double AnalogOutput::execute(const Signal& wanted) {
  if (wanted.status == SignalStatus::good) output_ = wanted.value;
  return output_;
}

Process::Process(double gain, double lag_1_s, double lag_2_s)
    : gain_(gain), lag_1_(lag_1_s), lag_2_(lag_2_s) {
  FIELDPROOF_CHECK(lag_1_s > 0 && lag_2_s > 0 && lag_1_s != lag_2_s, "a process has two lags, which differ");
}

void Process::advance(double seconds, double input) {
  const double rest = gain_ * input;
  const double decay_1 = std::exp(-seconds / lag_1_);
  const double decay_2 = std::exp(-seconds / lag_2_);
  const double off = first_ - rest;
  second_ = rest + (second_ - rest) * decay_2 + off * lag_1_ / (lag_1_ - lag_2_) * (decay_1 - decay_2);
  first_ = rest + off * decay_1;
}

}  // namespace fieldproof::fieldbus_dll

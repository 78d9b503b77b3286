#include "emc/pulse.hpp"

#include "emc/exponential.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kPeak = 0.92;  // v1
constexpr double kRise = 3.5e-9;
constexpr double kDecay = 51e-9;
constexpr double kOrder = 1.8;

constexpr double kTwoExponentialsScale = 1.27;
constexpr double kTwoExponentialsDecay = 55.6e-9;

constexpr double kNanosecond = 1e-9;
constexpr double kStep = 0.01e-9;
constexpr double kEnd = 2e-6;  // what follows is below 10^-15 of the peak

// The first instant from `from` on at which the pulse has passed `level`, in the direction in which it goes.
double crossing(const Pulse& pulse, double from, double level) {
  const bool is_rising = pulse.at(from) < level;
  double before = from;
  while ((pulse.at(before + kStep) < level) == is_rising) before += kStep;
  double behind = before + kStep;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = (before + behind) / 2;
    ((pulse.at(middle) < level) == is_rising ? before : behind) = middle;
  }
  return behind;
}

}  // namespace

Pulse::Pulse(PulseShape shape) : shape_(shape), scale_(kTwoExponentialsScale) {
  if (shape == PulseShape::standard_formula) {
    scale_ = kPeak / portable_exp(-(kRise / kDecay) * portable_power(kOrder * kDecay / kRise, 1 / kOrder));
  }
}

double Pulse::at(double seconds) const {
  if (seconds <= 0) return 0;
  if (shape_ == PulseShape::double_exponential) {
    return scale_ * (1 - portable_exp(-seconds / kRise)) * portable_exp(-seconds / kTwoExponentialsDecay);
  }
  const double x = portable_power(seconds / kRise, kOrder);
  return scale_ * x / (1 + x) * portable_exp(-seconds / kDecay);
}

PulseFigures measure(const Pulse& pulse) {
  PulseFigures figures{};
  double peak_time = 0;
  for (double t = 0; t < kEnd; t += kStep) {
    const double v = pulse.at(t + kStep / 2);
    figures.area_ns += v * kStep / kNanosecond;
    figures.square_area_ns += v * v * kStep / kNanosecond;
    if (v <= figures.peak) continue;
    figures.peak = v;
    peak_time = t + kStep / 2;
  }
  const double half = crossing(pulse, 0, 0.5 * figures.peak);
  const double ninety = crossing(pulse, 0, 0.9 * figures.peak);
  figures.peak_ns = peak_time / kNanosecond;
  figures.rise_ns = (ninety - crossing(pulse, 0, 0.1 * figures.peak)) / kNanosecond;
  figures.width_ns = (crossing(pulse, peak_time, 0.5 * figures.peak) - half) / kNanosecond;
  figures.tail_ns = crossing(pulse, peak_time, 0.1 * figures.peak) / kNanosecond;
  return figures;
}

}  // namespace fieldproof::emc

#pragma once

#include <cstdint>

// The voltage of one fast transient of IEC 61000-4-4, of nominal peak 1, seconds after its begin.
//
// The standard's formula (annex of edition 3; constants from memory, confirmed by calculation) is
//   v(t) = (v1 / k) * x / (1 + x) * exp(-t / tau2),  x = (t / tau1)^n,
//   k = exp(-(tau1 / tau2) * (n * tau2 / tau1)^(1 / n));
// the double exponential is A * (1 - exp(-t / tau1)) * exp(-t / tau2). Both are the wave into a matched load;
// nothing else of the generator is here.
namespace fieldproof::emc {

enum class PulseShape : std::uint8_t { standard_formula, double_exponential };

class Pulse {
 public:
  explicit Pulse(PulseShape shape = PulseShape::standard_formula);

  double at(double seconds) const;

 private:
  PulseShape shape_;
  double scale_;
};

// What is measured on a pulse with an oscilloscope.
struct PulseFigures {
  double peak;            // of a nominal peak of 1
  double peak_ns;         // when
  double rise_ns;         // 10 % to 90 % of the peak
  double width_ns;        // at 50 % of the peak
  double tail_ns;         // from the begin until 10 % of the peak are left
  double area_ns;         // integral, per volt of nominal peak
  double square_area_ns;  // integral of the square
};

PulseFigures measure(const Pulse& pulse);

}  // namespace fieldproof::emc

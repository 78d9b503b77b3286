#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "emc/generator.hpp"
#include "emc/pulse.hpp"
#include "harness/kernel/time.hpp"

// From the generator's pulse to the time in which a receiver's output is wrong.
//
// The pulse comes through the generator's source and the coupling capacitance into the common-mode impedance
// of the line; a part of it goes straight on, a part makes cable and clamp ring. Shield and imbalance turn
// this common-mode voltage into a differential one, the receiver's filter smooths it, and the receiver
// decides with hysteresis about bit voltage plus disturbance. Where the common-mode voltage is beyond what
// the receiver stands, its output is forced, and stays so for the recovery time. Nothing here is a
// probability: a bit is wrong where the receiver samples during this time.
//
// The model is this project's own and its absolute thresholds are uncalibrated: no published error rate
// against kilovolts was found to hold it to. Shapes and ratios are what it is for.
//
// Limits: linear up to the receiver; two pulses do not add (the time in between is longer than any
// disturbance that the ranges allow at 5 kHz); the edges of the line's own levels are ideal.
namespace fieldproof::emc {

enum class CouplingMethod : std::uint8_t {
  capacitive_clamp,
  coupling_network,  // 33 nF per line in place of the clamp's capacitance
};

// All parameters of the model. The unit is the last word of a name; ranges and standing are in
// `coupling_parameters`.
struct Coupling {
  CouplingMethod method = CouplingMethod::capacitive_clamp;
  PulseShape pulse = PulseShape::standard_formula;
  double source_ohm = 50;
  double clamp_pf = 200;
  double common_mode_ohm = 75;
  double direct_part = 0.5;   // of the coupled voltage that reaches the receiver as it is
  double ringing_part = 0.5;  // that excites the resonance
  double ring_mhz = 10;
  double ring_q = 4;
  double shield_db = 0;      // 0: none; 30: on a pigtail; 58: bonded all around
  double imbalance_db = 30;  // common mode to differential
  double filter_mhz = 5;     // the receiver's low-pass
  double bit_v = 2;          // differential, +bit_v for level 1 and -bit_v for level 0
  double threshold_v = 0;
  double hysteresis_mv = 50;  // between the two thresholds
  // Infinite: isolated, the common mode does nothing by itself.
  double common_mode_limit_v = std::numeric_limits<double>::infinity();
  double recovery_ns = 100;
  bool forced_level = false;  // the output beyond the common-mode limit: a property of the device

  friend bool operator==(const Coupling&, const Coupling&) = default;
};

// Where a number comes from. Only the standard's own are no choice of this project.
enum class Standing : std::uint8_t { standard, searched, from_memory, own_choice };

struct CouplingParameter {
  std::string_view name;  // as in the struct and in profile files
  std::string_view unit;
  double Coupling::* member;
  double smallest;
  double largest;
  Standing standing;
  std::string_view meaning;
};

std::span<const CouplingParameter> coupling_parameters();
// A parameter out of its range, or a receiver that would not see the quiet line, is a configuration error.
void check_coupling(const Coupling& coupling);
std::string_view text_of(Standing standing);

// Times relative to the begin of a pulse, [from, to).
struct Interval {
  kernel::Duration from;
  kernel::Duration to;

  friend bool operator==(const Interval&, const Interval&) = default;
};

// When the receiver's output is wrong, for each level that is driven; ordered, apart.
struct WrongOutput {
  std::array<std::vector<Interval>, 2> of_level;

  bool empty() const { return of_level[0].empty() && of_level[1].empty(); }
  kernel::Duration duration(bool level) const;
  // From the first to the last wrong instant of either level; zero length when there is none.
  Interval hull() const;
};

// What a pulse of 1 V does to the line and to the filtered input of the receiver. Takes some milliseconds to
// compute; all levels and polarities of a campaign share it.
class LineResponse {
 public:
  // Checks the coupling.
  explicit LineResponse(const Coupling& coupling);

  const Coupling& coupling() const { return coupling_; }

  // Both per volt of open-circuit setting.
  double coupled_peak() const { return coupled_peak_; }  // behind the clamp, before the resonance
  double common_mode_peak() const;                       // at the cable, before the shield
  double differential_peak() const;                      // filtered, before shield and imbalance

  // What is added at the receiver's input, filtered, at multiples of kStep from the begin of the pulse on.
  std::vector<double> receiver_volts(double open_circuit_volts, Polarity polarity) const;
  static constexpr kernel::Duration kStep{100};

  WrongOutput wrong_output(double open_circuit_volts, Polarity polarity) const;

  // The lowest setting at which an output can be wrong at all (either way), without hysteresis.
  double threshold_volts() const;

 private:
  void compute();

  Coupling coupling_;
  double coupled_peak_ = 0;
  std::vector<double> common_mode_;   // at multiples of the step
  std::vector<double> differential_;  // filtered
};

}  // namespace fieldproof::emc

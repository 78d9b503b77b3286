#include "emc/coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emc/exponential.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kStepNs = 0.1;
constexpr double kNetworkPf = 33'000;
// So many of the longest time constant, after which 0.02 per mille of a disturbance is left.
constexpr double kTimeConstants = 11;
constexpr double kPulseNs = 1'200;  // of the pulse less than 10^-10 is left then

constexpr std::array kParameters{
    CouplingParameter{"source_ohm", "ohm", &Coupling::source_ohm, 50, 50, Standing::standard,
                      "source impedance of the generator"},
    CouplingParameter{"clamp_pf", "pF", &Coupling::clamp_pf, 50, 1000, Standing::from_memory,
                      "coupling capacitance of the clamp; 100 pF is nominal"},
    CouplingParameter{"common_mode_ohm", "ohm", &Coupling::common_mode_ohm, 50, 150, Standing::own_choice,
                      "common-mode impedance that the clamp sees"},
    CouplingParameter{"direct_part", "", &Coupling::direct_part, 0, 1, Standing::own_choice,
                      "part of the coupled voltage that reaches the receiver as it is"},
    CouplingParameter{"ringing_part", "", &Coupling::ringing_part, 0, 1, Standing::own_choice,
                      "part of the coupled voltage that excites the resonance"},
    CouplingParameter{"ring_mhz", "MHz", &Coupling::ring_mhz, 3, 40, Standing::own_choice,
                      "resonance of cable and clamp, about a quarter wave of the cable"},
    CouplingParameter{"ring_q", "", &Coupling::ring_q, 1, 8, Standing::own_choice,
                      "quality of the resonance"},
    CouplingParameter{"shield_db", "dB", &Coupling::shield_db, 0, 120, Standing::own_choice,
                      "attenuation by the shield and its bonding: 0 none, 30 pigtail, 58 all around"},
    CouplingParameter{"imbalance_db", "dB", &Coupling::imbalance_db, 20, 45, Standing::own_choice,
                      "attenuation from common mode to differential"},
    CouplingParameter{"filter_mhz", "MHz", &Coupling::filter_mhz, 0.05, 100, Standing::own_choice,
                      "corner of the receiver's low-pass"},
    CouplingParameter{"bit_v", "V", &Coupling::bit_v, 0.05, 3, Standing::own_choice,
                      "differential voltage of a level at the receiver"},
    CouplingParameter{"threshold_v", "V", &Coupling::threshold_v, -0.2, 0.2, Standing::standard,
                      "threshold of the receiver, within the limits of TIA-485-A"},
    CouplingParameter{"hysteresis_mv", "mV", &Coupling::hysteresis_mv, 0, 200, Standing::own_choice,
                      "distance of the two thresholds"},
    CouplingParameter{"common_mode_limit_v", "V", &Coupling::common_mode_limit_v, 1,
                      std::numeric_limits<double>::infinity(), Standing::own_choice,
                      "beyond it the output is forced: 12 not isolated (TIA-485-A), 50 opto-coupler, "
                      "200 digital isolator"},
    CouplingParameter{"recovery_ns", "ns", &Coupling::recovery_ns, 0, 10'000, Standing::own_choice,
                      "for which the output stays forced"},
};

// The line as a system of first-order equations: the coupling capacitor, the resonance (value and slope) and
// the filter.
struct LineState {
  double capacitor = 0;
  double ring = 0;
  double ring_slope = 0;
  double filtered = 0;
};

class Line {
 public:
  explicit Line(const Coupling& c)
      : coupling_(c),
        gain_(c.common_mode_ohm / (c.common_mode_ohm + c.source_ohm)),
        angular_(2 * kPi * c.ring_mhz * 1e-3),
        ring_decay_ns_(c.ring_q / (kPi * c.ring_mhz) * 1e3),
        filter_(2 * kPi * c.filter_mhz * 1e-3) {
    const double pf = c.method == CouplingMethod::coupling_network ? kNetworkPf : c.clamp_pf;
    capacitor_ns_ = (c.common_mode_ohm + c.source_ohm) * pf * 1e-3;
  }

  double coupled(double pulse, const LineState& s) const { return gain_ * (pulse - s.capacitor); }
  double common_mode(double pulse, const LineState& s) const {
    return coupling_.direct_part * coupled(pulse, s) + coupling_.ringing_part * s.ring;
  }

  // One step of Runge and Kutta; the pulse at its begin, middle and end.
  LineState advanced(const LineState& s, double begin, double middle, double end) const {
    const LineState a = slope(begin, s);
    const LineState b = slope(middle, moved(s, a, kStepNs / 2));
    const LineState c = slope(middle, moved(s, b, kStepNs / 2));
    const LineState d = slope(end, moved(s, c, kStepNs));
    LineState next = moved(s, a, kStepNs / 6);
    next = moved(next, b, kStepNs / 3);
    next = moved(next, c, kStepNs / 3);
    return moved(next, d, kStepNs / 6);
  }

  double longest_time_constant_ns() const { return std::max({ring_decay_ns_, 1 / filter_, capacitor_ns_}); }

 private:
  LineState slope(double pulse, const LineState& s) const {
    const double ring_rate = 1 / ring_decay_ns_;
    const double spring = angular_ * angular_ + ring_rate * ring_rate;
    return {(pulse - s.capacitor) / capacitor_ns_, s.ring_slope,
            angular_ * angular_ * coupled(pulse, s) - 2 * ring_rate * s.ring_slope - spring * s.ring,
            filter_ * (common_mode(pulse, s) - s.filtered)};
  }

  static LineState moved(const LineState& s, const LineState& by, double ns) {
    return {s.capacitor + ns * by.capacitor, s.ring + ns * by.ring, s.ring_slope + ns * by.ring_slope,
            s.filtered + ns * by.filtered};
  }

  const Coupling& coupling_;
  double gain_;
  double angular_;  // per ns, as the other rates
  double ring_decay_ns_;
  double filter_;
  double capacitor_ns_;
};

// The pulse at multiples of half a step.
std::vector<double> pulse_table(const Pulse& pulse) {
  std::vector<double> table;
  const auto count = static_cast<std::size_t>(2 * kPulseNs / kStepNs);
  table.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    table.push_back(pulse.at(static_cast<double>(n) * kStepNs / 2 * 1e-9));
  }
  return table;
}

double peak_of(const std::vector<double>& samples) {
  double peak = 0;
  for (const double sample : samples) peak = std::max(peak, std::abs(sample));
  return peak;
}

// The receiver: output for one driven level under a disturbance.
class Receiver {
 public:
  Receiver(const Coupling& coupling, bool level)
      : rise_(coupling.threshold_v + coupling.hysteresis_mv / 2000),
        fall_(coupling.threshold_v - coupling.hysteresis_mv / 2000),
        bit_(level ? coupling.bit_v : -coupling.bit_v),
        limit_(coupling.common_mode_limit_v),
        recovery_(static_cast<std::int64_t>(coupling.recovery_ns / kStepNs)),
        forced_(coupling.forced_level),
        output_(level) {}

  // The output for the next step of time.
  bool decide(double differential, double common_mode) {
    const double input = bit_ + differential;
    if (output_ ? input < fall_ : input > rise_) output_ = !output_;
    if (std::abs(common_mode) > limit_) {
      forced_steps_ = recovery_ + 1;
    } else if (forced_steps_ > 0) {
      --forced_steps_;
    }
    return forced_steps_ > 0 ? forced_ : output_;
  }

 private:
  double rise_;
  double fall_;
  double bit_;
  double limit_;
  std::int64_t recovery_;
  bool forced_;
  bool output_;
  std::int64_t forced_steps_ = 0;
};

}  // namespace

std::span<const CouplingParameter> coupling_parameters() {
  return kParameters;
}

void check_coupling(const Coupling& coupling) {
  for (const CouplingParameter& parameter : coupling_parameters()) {
    const double value = coupling.*parameter.member;
    if (value >= parameter.smallest && value <= parameter.largest) continue;
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{} = {} {} is out of its range; it takes {} to {}.", parameter.name,
                                    value, parameter.unit, parameter.smallest, parameter.largest));
  }
  const double highest = std::abs(coupling.threshold_v) + coupling.hysteresis_mv / 2000;
  if (coupling.bit_v <= highest) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("bit_v = {} V does not reach the threshold of {} V with its hysteresis; "
                                    "the receiver would not see the quiet line.",
                                    coupling.bit_v, highest));
  }
}

std::string_view text_of(Standing standing) {
  constexpr std::array<std::string_view, 4> kTexts{"standard", "searched", "from memory", "own choice"};
  return kTexts.at(static_cast<std::size_t>(standing));
}

kernel::Duration WrongOutput::duration(bool level) const {
  kernel::Duration sum{};
  for (const Interval& interval : of_level.at(level ? 1 : 0)) sum += interval.to - interval.from;
  return sum;
}

Interval WrongOutput::hull() const {
  if (empty()) return {};
  Interval hull{kernel::Duration::max(), kernel::Duration::zero()};
  for (const auto& intervals : of_level) {
    if (intervals.empty()) continue;
    hull.from = std::min(hull.from, intervals.front().from);
    hull.to = std::max(hull.to, intervals.back().to);
  }
  return hull;
}

LineResponse::LineResponse(const Coupling& coupling) : coupling_(coupling) {
  check_coupling(coupling);
  compute();
}

void LineResponse::compute() {
  const std::vector<double> pulse = pulse_table(Pulse(coupling_.pulse));
  const auto pulse_at = [&](std::size_t half_step) {
    return half_step < pulse.size() ? pulse[half_step] : 0;
  };
  const Line line(coupling_);
  const double length_ns = kPulseNs + kTimeConstants * line.longest_time_constant_ns();
  const auto steps = static_cast<std::size_t>(length_ns / kStepNs);
  common_mode_.reserve(steps);
  differential_.reserve(steps);
  LineState state;
  for (std::size_t n = 0; n < steps; ++n) {
    const double now = pulse_at(2 * n);
    coupled_peak_ = std::max(coupled_peak_, line.coupled(now, state));
    common_mode_.push_back(line.common_mode(now, state));
    differential_.push_back(state.filtered);
    state = line.advanced(state, now, pulse_at(2 * n + 1), pulse_at(2 * n + 2));
  }
}

double LineResponse::common_mode_peak() const {
  return peak_of(common_mode_);
}

double LineResponse::differential_peak() const {
  return peak_of(differential_);
}

std::vector<double> LineResponse::receiver_volts(double open_circuit_volts, Polarity polarity) const {
  const double factor = static_cast<double>(polarity) * open_circuit_volts *
                        voltage_factor(coupling_.shield_db) * voltage_factor(coupling_.imbalance_db);
  std::vector<double> volts;
  volts.reserve(differential_.size());
  for (const double one : differential_) volts.push_back(factor * one);
  return volts;
}

WrongOutput LineResponse::wrong_output(double open_circuit_volts, Polarity polarity) const {
  const double sign = static_cast<double>(polarity);
  const double shielded = sign * open_circuit_volts * voltage_factor(coupling_.shield_db);
  const double differential = shielded * voltage_factor(coupling_.imbalance_db);
  WrongOutput wrong;
  for (const bool level : {false, true}) {
    std::vector<Interval>& intervals = wrong.of_level.at(level ? 1 : 0);
    Receiver receiver(coupling_, level);
    bool was_wrong = false;
    kernel::Duration now{};
    const auto follow = [&](double differential_now, double common_mode_now) {
      const bool is_wrong = receiver.decide(differential_now, common_mode_now) != level;
      if (is_wrong && !was_wrong) intervals.push_back({now, now});
      if (is_wrong) intervals.back().to = now + kStep;
      was_wrong = is_wrong;
      now += kStep;
    };
    for (std::size_t n = 0; n < common_mode_.size(); ++n) {
      follow(differential * differential_[n], shielded * common_mode_[n]);
    }
    const auto recovery = static_cast<std::size_t>(coupling_.recovery_ns / kStepNs);
    for (std::size_t n = 0; n <= recovery && was_wrong; ++n) follow(0, 0);
    FIELDPROOF_CHECK(!was_wrong, "a receiver is right again when the disturbance is over");
  }
  return wrong;
}

double LineResponse::threshold_volts() const {
  const double shield = voltage_factor(coupling_.shield_db);
  const double by_common_mode = coupling_.common_mode_limit_v / (shield * common_mode_peak());
  double by_difference = std::numeric_limits<double>::infinity();
  // Either polarity may meet either level.
  const double margin = coupling_.bit_v - std::abs(coupling_.threshold_v);
  if (margin > 0)
    by_difference = margin / (shield * voltage_factor(coupling_.imbalance_db) * differential_peak());
  return std::min(by_common_mode, by_difference);
}

}  // namespace fieldproof::emc

#include "protocols/interbus/network_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "protocols/interbus/station_timing.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using measure::Comparison;
using measure::Distribution;
using measure::Phase;

constexpr double kPerMicrosecond = 1e6;  // picoseconds
constexpr std::string_view kMicrosecond = "us";
constexpr std::string_view kOfCycle = "of the cycle time";
constexpr std::string_view kOfTheory = "of the theory";
// A kind of sample of which the theory expects fewer may be missing altogether.
constexpr double kFewSamples = 10;

double us(double picoseconds) {
  return picoseconds / kPerMicrosecond;
}
double us(Duration duration) {
  return us(static_cast<double>(duration.count()));
}
double us(std::int64_t picoseconds) {
  return us(static_cast<double>(picoseconds));
}

// Delays of the edges in front of an interval in which the input must be sampled for the edge to be seen: an
// edge waits evenly up to a cycle, or up to the end of that interval.
class DelayRows {
 public:
  DelayRows(std::string_view edges, Duration least, Duration cycle, Duration interval)
      : edges_(edges), least_(least), cycle_(cycle), span_(std::min(cycle, interval)) {}

  void append(std::vector<Comparison>& rows, const Distribution& delays) const {
    if (delays.is_empty()) return;
    const double span = us(span_);
    const double count = static_cast<double>(delays.count());
    const double deviation = span / std::sqrt(12.0);
    rows.push_back(row("least delay", us(least_), us(delays.min()), span / count));
    rows.push_back(row("mean delay", us(least_) + span / 2, us(delays.mean()), deviation / std::sqrt(count)));
    rows.push_back(row("largest delay", us(least_) + span, us(delays.max()), span / count));
    rows.push_back(row("standard deviation of the delay", deviation, us(delays.standard_deviation()),
                       deviation / std::sqrt(2 * count)));
  }

 private:
  Comparison row(std::string_view what, double theory, double measured, double standard_error) const {
    return {fmt::format("{}, {}", what, edges_),
            std::string(kMicrosecond),
            theory,
            measured,
            us(cycle_),
            std::string(kOfCycle),
            standard_error};
  }

  std::string_view edges_;
  Duration least_;
  Duration cycle_;
  Duration span_;
};

// Everything that a comparison of one path needs at hand.
struct PathTheory {
  PathTheory(const NetworkDescription& network, const SignalRecord& record, const PathRecord& path)
      : wave(record.settings.wave),
        cycle(cycle_time_in_force(network)),
        delay(path_delay(network, path.path, record.settings.latch)),
        high(wave.high()),
        low(wave.period() - high),
        width(pulse_width(high, cycle)) {}

  measure::SquareWave wave;
  Duration cycle;
  EdgeDelay delay;
  Duration high;
  Duration low;
  PulseWidth width;
};

Comparison of_cycle(const PathTheory& theory, std::string quantity, double expected, double measured,
                    double standard_error) {
  return {std::move(quantity), std::string(kMicrosecond), expected,      measured,
          us(theory.cycle),    std::string(kOfCycle),     standard_error};
}

// Lost pulses have no phase: where a run was disturbed nobody knows which of them the disturbance took.
void append_widths(std::vector<Comparison>& rows, const PathTheory& theory, const measure::EdgeSkew& skew,
                   bool is_disturbed) {
  const Distribution& widths = skew.widths.in(Phase::quiet);
  if (widths.is_empty()) return;
  const PulseWidth& width = theory.width;
  const auto count = static_cast<double>(widths.count());
  const double more = width.probability_of_one_more;
  const double cycle = us(theory.cycle);
  const bool is_lossy = width.cycles == 0;
  if (is_lossy || (1 - more) * count >= kFewSamples) {
    const Duration shortest = is_lossy ? width.longer : width.shorter;
    rows.push_back(of_cycle(theory, "shortest pulse", us(shortest), us(widths.min()), 0));
  }
  if (more * count >= kFewSamples) {
    rows.push_back(of_cycle(theory, "longest pulse", us(width.longer), us(widths.max()), 0));
  }
  if (!is_disturbed) {
    const double came = count / (count + static_cast<double>(skew.lost_pulses));
    rows.push_back(of_cycle(theory, "mean width of a pulse, lost ones as 0", us(width.mean),
                            us(widths.mean()) * came, cycle * std::sqrt(more * (1 - more) / count)));
  } else if (!is_lossy) {
    rows.push_back(of_cycle(theory, "mean width of a pulse", us(width.mean), us(widths.mean()),
                            cycle * std::sqrt(more * (1 - more) / count)));
  }
  rows.push_back(of_cycle(theory, "standard deviation of the width",
                          is_lossy ? 0 : us(width.standard_deviation), us(widths.standard_deviation()),
                          is_lossy ? 0 : cycle * std::abs(1 - 2 * more) / (2 * std::sqrt(count))));
}

void append_duty(std::vector<Comparison>& rows, const PathTheory& theory, const measure::EdgeSkew& skew) {
  const Distribution& errors = skew.duty_errors_ppm.in(Phase::quiet);
  if (errors.is_empty()) return;
  const auto largest = static_cast<double>(std::max(errors.max(), -errors.min()));
  rows.push_back({"largest error of the duty cycle of a period, at most", "%",
                  100 * max_duty_error(theory.wave.frequency.hertz(), theory.cycle), largest * 1e-4, 100,
                  "of a period", 0, true});
}

Comparison share(std::string quantity, double expected, std::uint64_t lost, std::uint64_t all) {
  const auto count = static_cast<double>(all);
  return {std::move(quantity),
          "",
          expected,
          static_cast<double>(lost) / count,
          1,
          "of all",
          std::sqrt(expected * (1 - expected) / count)};
}

void append_losses(std::vector<Comparison>& rows, const PathTheory& theory, const measure::EdgeSkew& skew) {
  rows.push_back(share("share of lost pulses", theory.width.lost_probability, skew.lost_pulses, skew.pulses));
  if (skew.pauses == 0) return;
  rows.push_back(share("share of lost pauses", pulse_width(theory.low, theory.cycle).lost_probability,
                       skew.lost_pauses, skew.pauses));
}

void append_phase_lag(std::vector<Comparison>& rows, const PathTheory& theory,
                      const measure::EdgeSkew& skew) {
  const Distribution& delays = skew.rise_delays.in(Phase::quiet);
  if (delays.is_empty() || theory.width.cycles == 0) return;
  const double degrees_per_us = 360 * theory.wave.frequency.hertz() * 1e-6;
  const double lag = degrees_per_us * us(theory.delay.mean);
  const double error = us(theory.delay.standard_deviation) / std::sqrt(static_cast<double>(delays.count()));
  rows.push_back({"mean lag of the rising edges", "deg", lag, degrees_per_us * us(delays.mean()), lag,
                  std::string(kOfTheory), degrees_per_us * error});
}

Comparison none_of(std::string quantity, std::uint64_t count) {
  return {std::move(quantity), "", 0, static_cast<double>(count), 1, "of one", 0, true};
}

std::vector<measure::Curve> curves_of(const measure::EdgeSkew& skew) {
  const std::string unit(kMicrosecond);
  return {{"delay, rising edges", unit, kPerMicrosecond, skew.rise_delays},
          {"delay, falling edges", unit, kPerMicrosecond, skew.fall_delays},
          {"width of a pulse", unit, kPerMicrosecond, skew.widths},
          {"error of the width", unit, kPerMicrosecond, skew.width_errors},
          {"error of the duty cycle of a period", "%", 1e4, skew.duty_errors_ppm}};
}

measure::Series series_of(const NetworkDescription& network, const SignalRecord& record,
                          const PathRecord& path) {
  measure::Series series;
  series.name = fmt::format("{} from {}", measure::describe(record.settings.wave.frequency), path.path.name);
  if (!record.has_stopped) series.comparisons = compare_path(network, record, path);
  series.curves = curves_of(path.skew);
  series.counts = {{"lost pulses", path.skew.lost_pulses, path.skew.pulses},
                   {"lost pauses", path.skew.lost_pauses, path.skew.pauses},
                   {"words that the input never had", path.skew.foreign_words, 0},
                   {"torn process images", record.torn_images, record.images},
                   {"trains", static_cast<std::uint64_t>(record.trains), 0}};
  if (record.has_stopped) series.counts.push_back({"the bus stopped for good", 1, 0});
  series.trace = path.trace;
  return series;
}

std::vector<measure::Condition> conditions_of(const NetworkDescription& network,
                                              const MeasurementSettings& settings) {
  const auto time = [](Duration duration) { return kernel::describe(duration); };
  return {{"latch model", fmt::format("{}: {}", name(settings.latch), describe(settings.latch))},
          {"each signal", time(settings.duration)},
          {fmt::format("cycle time by {}", name(network.formula)),
           time(cycle_time(network.formula, timing_input(network)))},
          {"cycle time by the structure of the frame", time(structural_cycle_time(network))},
          {"cycle time requested", network.cycle_time ? time(*network.cycle_time) : "the shortest"}};
}

// The cycles of all signals together.
class CycleSeries {
 public:
  void add(const SignalRecord& record) {
    times_.add(record.cycle_times);
    data_cycles_ += record.data_cycles;
    id_cycles_ += record.id_cycles;
    rejected_ += record.rejected_cycles;
  }

  measure::Series finish(const NetworkDescription& network) const {
    measure::Series series;
    series.name = "cycle";
    series.comparisons = compare_cycles(network, times_.in(Phase::quiet));
    series.curves = {{"cycle time", std::string(kMicrosecond), kPerMicrosecond, times_}};
    series.counts = {{"data cycles", data_cycles_, 0},
                     {"ID cycles", id_cycles_, 0},
                     {"rejected cycles", rejected_, data_cycles_ + id_cycles_}};
    return series;
  }

 private:
  measure::PhasedDistribution times_;
  std::uint64_t data_cycles_ = 0;
  std::uint64_t id_cycles_ = 0;
  std::uint64_t rejected_ = 0;
};

}  // namespace

std::string_view name(LatchModel model) {
  constexpr std::array<std::string_view, 3> kNames = {"M1", "M2", "M3"};
  return kNames.at(static_cast<std::size_t>(model));
}

std::string_view describe(LatchModel model) {
  constexpr std::array<std::string_view, 3> kTexts = {
      "inputs and outputs at one instant (a bound that no station reaches)",
      "inputs at the start of the frame, outputs at its end",
      "inputs at the end of the frame before, outputs at the end of the frame"};
  return kTexts.at(static_cast<std::size_t>(model));
}

Duration cycle_time_in_force(const NetworkDescription& network) {
  return std::max(structural_cycle_time(network), network.cycle_time.value_or(Duration::zero()));
}

Duration frame_between(const NetworkDescription& network, const CopiedPath& path) {
  const std::vector<Duration> arrivals = arrival_delays(network);
  const auto arrival = [&](int position) { return arrivals.at(static_cast<std::size_t>(position - 1)); };
  return sample_to_latch(network) + arrival(path.to) - arrival(path.from);
}

EdgeDelay path_delay(const NetworkDescription& network, const CopiedPath& path, LatchModel model) {
  const Duration frame = sample_to_latch(network);
  const Duration way = frame_between(network, path) - frame;
  EdgeDelay delay = edge_delay(model, cycle_time_in_force(network), frame);
  for (Duration* part : {&delay.min, &delay.mean, &delay.max}) *part += way;
  return delay;
}

std::vector<Comparison> compare_cycles(const NetworkDescription& network, const Distribution& cycle_times) {
  if (cycle_times.is_empty()) return {};
  const std::string unit(kMicrosecond);
  const double cycle = us(cycle_time_in_force(network));
  const double highest = highest_frequency_hz(cycle_time_in_force(network));
  const double reached = highest_frequency_hz(Duration{cycle_times.max()});
  return {{"cycle time", unit, cycle, us(cycle_times.mean()), cycle, std::string(kOfTheory)},
          {"jitter of the cycle, peak to peak", unit, 0, us(cycle_times.max() - cycle_times.min()), cycle,
           std::string(kOfCycle)},
          {"highest frequency without loss, by the longest cycle", "Hz", highest, reached, highest,
           std::string(kOfTheory)}};
}

std::vector<Comparison> compare_path(const NetworkDescription& network, const SignalRecord& record,
                                     const PathRecord& path) {
  const PathTheory theory(network, record, path);
  const measure::EdgeSkew& skew = path.skew;
  std::vector<Comparison> rows;
  DelayRows("rising edges", theory.delay.min, theory.cycle, theory.high)
      .append(rows, skew.rise_delays.in(Phase::quiet));
  DelayRows("falling edges", theory.delay.min, theory.cycle, theory.low)
      .append(rows, skew.fall_delays.in(Phase::quiet));
  append_phase_lag(rows, theory, skew);
  const bool is_disturbed = record.settings.disturb != nullptr;
  append_widths(rows, theory, skew, is_disturbed);
  append_duty(rows, theory, skew);
  if (is_disturbed) return rows;
  append_losses(rows, theory, skew);
  rows.push_back(none_of("words that the input never had", skew.foreign_words));
  rows.push_back(none_of("torn process images", record.torn_images));
  return rows;
}

measure::Measurement measure_network(const NetworkDescription& network, const MeasurementSettings& settings) {
  measure::Measurement measurement;
  measurement.protocol = "interbus";
  measurement.network = network.name;
  measurement.seed = settings.seed;
  measurement.tolerance_percent = settings.tolerance_percent;
  measurement.conditions = conditions_of(network, settings);
  measurement.conditions.insert(measurement.conditions.end(), settings.conditions.begin(),
                                settings.conditions.end());
  measurement.series.emplace_back();  // the cycles come first
  CycleSeries cycles;
  for (std::size_t n = 0; n < settings.signals.size(); ++n) {
    const SignalRecord record = record_signal(network, {.wave = settings.signals[n],
                                                        .duration = settings.duration,
                                                        .latch = settings.latch,
                                                        .seed = settings.seed,
                                                        .disturb = settings.disturb,
                                                        .phase_during = settings.phase_during});
    cycles.add(record);
    if (record.has_stopped) {
      measurement.is_complete = false;
      measurement.conditions.push_back(
          {"not compared", fmt::format("{}: the bus stopped for good meanwhile",
                                       measure::describe(settings.signals[n].frequency))});
    }
    for (const PathRecord& path : record.paths)
      measurement.series.push_back(series_of(network, record, path));
    if (settings.on_progress) settings.on_progress(n + 1);
  }
  measurement.series.front() = cycles.finish(network);
  return measurement;
}

}  // namespace fieldproof::interbus

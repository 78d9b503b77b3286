#include "harness/network/network_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "harness/kernel/random.hpp"
#include "harness/measure/cyclic_copy.hpp"
#include "harness/segment/stop.hpp"

namespace fieldproof::network {
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
// Of the time courses of all signals together.
constexpr std::size_t kMostWindows = 400;

double us(double picoseconds) {
  return picoseconds / kPerMicrosecond;
}
double us(Duration duration) {
  return us(static_cast<double>(duration.count()));
}
double us(std::int64_t picoseconds) {
  return us(static_cast<double>(picoseconds));
}

// How many different phases the edges of a signal have against the cycle. The trains divide a cycle evenly;
// within a train each period shifts the phase by the same amount. Edges that fall together, or nearer to each
// other than that many edges would lie if they were spread evenly, say nothing new.
double different_phases(const SignalRecord& record, Duration cycle) {
  const std::int64_t parts = record.settings.periods_per_train * record.trains;
  std::set<std::int64_t> taken;
  for (std::int64_t n = 0; n < record.settings.periods_per_train; ++n) {
    const Duration phase = n * record.settings.wave.period() % cycle;
    const double share = static_cast<double>(phase.count()) / static_cast<double>(cycle.count());
    taken.insert(std::llround(static_cast<double>(parts) * share) % parts);
  }
  return static_cast<double>(record.trains) * static_cast<double>(taken.size());
}

// A third of how far the greatest of so many values may stay below the end of a span over which they are
// drawn evenly, in one of 370 cases at most: what three standard errors mean for a mean.
double error_of_extreme(double span, double count) {
  constexpr double kBeyondThreeErrors = 0.0027;
  return span * (1 - std::pow(kBeyondThreeErrors, 1 / count)) / 3;
}

// The usual error of a standard deviation holds for many samples; of few nothing is known.
double error_of_deviation(double deviation, double count) {
  return count < kFewSamples ? deviation : deviation / std::sqrt(2 * count);
}

// Delays of the edges in front of an interval in which the input must be sampled for the edge to be seen: an
// edge waits evenly up to a cycle, or up to the end of that interval.
class DelayRows {
 public:
  DelayRows(std::string_view edges, Duration least, Duration cycle, Duration interval, double phases)
      : edges_(edges), least_(least), cycle_(cycle), span_(std::min(cycle, interval)), phases_(phases) {}

  void append(std::vector<Comparison>& rows, const Distribution& delays) const {
    if (delays.is_empty()) return;
    const double span = us(span_);
    const double count = std::min(phases_, static_cast<double>(delays.count()));
    const double deviation = span / std::sqrt(12.0);
    rows.push_back(row("least delay", us(least_), us(delays.min()), error_of_extreme(span, count)));
    rows.push_back(row("mean delay", us(least_) + span / 2, us(delays.mean()), deviation / std::sqrt(count)));
    rows.push_back(row("largest delay", us(least_) + span, us(delays.max()), error_of_extreme(span, count)));
    rows.push_back(row("standard deviation of the delay", deviation, us(delays.standard_deviation()),
                       error_of_deviation(deviation, count)));
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
  double phases_;
};

// Of the standard deviation of a choice between two values, in parts of their distance. Where both are
// equally probable it is largest: what remains there is a third of the square of three errors of the share.
double error_of_choice(double share, double count) {
  return std::abs(1 - 2 * share) / (2 * std::sqrt(count)) + 0.75 / count;
}

// Everything that a comparison of one path needs at hand. An edge waits for the sample, evenly up to a cycle.
struct PathForms {
  PathForms(const SignalRecord& record, const PathTheory& theory)
      : wave(record.settings.wave),
        cycle(theory.cycle),
        least_delay(theory.least_delay),
        mean_delay(least_delay + Duration{std::llround(static_cast<double>(cycle.count()) / 2)}),
        delay_deviation(std::llround(static_cast<double>(cycle.count()) / std::sqrt(12.0))),
        high(wave.high()),
        low(wave.period() - high),
        width(measure::pulse_width(high, cycle)),
        phases(different_phases(record, cycle)) {}

  // Of so many edges those that tell something new.
  double telling(std::uint64_t edges) const { return std::min(phases, static_cast<double>(edges)); }

  measure::SquareWave wave;
  Duration cycle;
  Duration least_delay;
  Duration mean_delay;
  Duration delay_deviation;
  Duration high;
  Duration low;
  measure::PulseWidth width;
  double phases;
};

Comparison of_cycle(const PathForms& theory, std::string quantity, double expected, double measured,
                    double standard_error) {
  return {std::move(quantity), std::string(kMicrosecond), expected,      measured,
          us(theory.cycle),    std::string(kOfCycle),     standard_error};
}

// Lost pulses have no phase: where a run was disturbed nobody knows which of them the disturbance took.
void append_widths(std::vector<Comparison>& rows, const PathForms& theory, const measure::EdgeSkew& skew,
                   bool is_disturbed) {
  const Distribution& widths = skew.widths.in(Phase::quiet);
  if (widths.is_empty()) return;
  const measure::PulseWidth& width = theory.width;
  const double count = theory.telling(widths.count());
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
    const auto widths_count = static_cast<double>(widths.count());
    const double came = widths_count / (widths_count + static_cast<double>(skew.lost_pulses));
    rows.push_back(of_cycle(theory, "mean width of a pulse, lost ones as 0", us(width.mean),
                            us(widths.mean()) * came, cycle * std::sqrt(more * (1 - more) / count)));
  } else if (!is_lossy) {
    rows.push_back(of_cycle(theory, "mean width of a pulse", us(width.mean), us(widths.mean()),
                            cycle * std::sqrt(more * (1 - more) / count)));
  }
  rows.push_back(of_cycle(theory, "standard deviation of the width",
                          is_lossy ? 0 : us(width.standard_deviation), us(widths.standard_deviation()),
                          is_lossy              ? 0
                          : count < kFewSamples ? cycle
                                                : cycle * error_of_choice(more, count)));
}

void append_duty(std::vector<Comparison>& rows, const PathForms& theory, const measure::EdgeSkew& skew) {
  const Distribution& errors = skew.duty_errors_ppm.in(Phase::quiet);
  if (errors.is_empty()) return;
  const auto largest = static_cast<double>(std::max(errors.max(), -errors.min()));
  rows.push_back({"largest error of the duty cycle of a period, at most", "%",
                  100 * measure::max_duty_error(theory.wave.frequency.hertz(), theory.cycle), largest * 1e-4,
                  100, "of a period", 0, true});
}

Comparison share(std::string quantity, double expected, std::uint64_t lost, std::uint64_t all,
                 double telling) {
  return {std::move(quantity),
          "",
          expected,
          static_cast<double>(lost) / static_cast<double>(all),
          1,
          "of all",
          std::sqrt(expected * (1 - expected) / telling)};
}

void append_losses(std::vector<Comparison>& rows, const PathForms& theory, const measure::EdgeSkew& skew) {
  rows.push_back(share("share of lost pulses", theory.width.lost_probability, skew.lost_pulses, skew.pulses,
                       theory.telling(skew.pulses)));
  if (skew.pauses == 0) return;
  rows.push_back(share("share of lost pauses",
                       measure::pulse_width(theory.low, theory.cycle).lost_probability, skew.lost_pauses,
                       skew.pauses, theory.telling(skew.pauses)));
}

void append_phase_lag(std::vector<Comparison>& rows, const PathForms& theory, const measure::EdgeSkew& skew) {
  const Distribution& delays = skew.rise_delays.in(Phase::quiet);
  if (delays.is_empty() || theory.width.cycles == 0) return;
  const double degrees_per_us = 360 * theory.wave.frequency.hertz() * 1e-6;
  const double lag = degrees_per_us * us(theory.mean_delay);
  const double error = us(theory.delay_deviation) / std::sqrt(theory.telling(delays.count()));
  rows.push_back({"mean lag of the rising edges", "deg", lag, degrees_per_us * us(delays.mean()), lag,
                  std::string(kOfTheory), degrees_per_us * error});
}

Comparison none_of(std::string quantity, std::uint64_t count) {
  return {std::move(quantity), "", 0, static_cast<double>(count), 1, "of one", 0, true};
}

std::vector<Comparison> compare_edges(const SignalRecord& record, const PathForms& theory,
                                      const measure::EdgeSkew& skew) {
  std::vector<Comparison> rows;
  DelayRows("rising edges", theory.least_delay, theory.cycle, theory.high, theory.phases)
      .append(rows, skew.rise_delays.in(Phase::quiet));
  DelayRows("falling edges", theory.least_delay, theory.cycle, theory.low, theory.phases)
      .append(rows, skew.fall_delays.in(Phase::quiet));
  append_phase_lag(rows, theory, skew);
  const bool is_disturbed = record.settings.disturb != nullptr;
  append_widths(rows, theory, skew, is_disturbed);
  append_duty(rows, theory, skew);
  if (!is_disturbed) append_losses(rows, theory, skew);
  return rows;
}

std::vector<measure::Curve> curves_of(const measure::EdgeSkew& skew) {
  const std::string unit(kMicrosecond);
  return {{"delay, rising edges", unit, kPerMicrosecond, skew.rise_delays},
          {"delay, falling edges", unit, kPerMicrosecond, skew.fall_delays},
          {"width of a pulse", unit, kPerMicrosecond, skew.widths},
          {"error of the width", unit, kPerMicrosecond, skew.width_errors},
          {"error of the duty cycle of a period", "%", 1e4, skew.duty_errors_ppm}};
}

measure::Series series_of(const SignalRecord& record, const PathRecord& path) {
  measure::Series series;
  series.name = fmt::format("{} from {}", measure::describe(record.settings.wave.frequency), path.path.name);
  if (!record.has_stopped) series.comparisons = compare_path(record, path);
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

// Paths without a closed form; said once.
void leave_open(measure::Measurement& measurement, std::string_view why) {
  measurement.is_complete = false;
  const std::string value = fmt::format("delays and widths on copied paths: {}", why);
  if (std::ranges::find(measurement.conditions, value, &measure::Condition::value) ==
      measurement.conditions.end()) {
    measurement.conditions.push_back({"not compared", value});
  }
}

// The same ones of each signal.
void add_counts(std::vector<measure::Count>& sums, const std::vector<measure::Count>& counts) {
  for (const measure::Count& one : counts) {
    const auto sum = std::ranges::find(sums, one.what, &measure::Count::what);
    if (sum == sums.end()) {
      sums.push_back(one);
    } else {
      sum->count += one.count;
      sum->of += one.of;
    }
  }
}

// The cycles of all signals together, a series for each kind.
class CycleSeries {
 public:
  void add(const SignalRecord& record) {
    if (cycles_.empty()) {
      cycles_ = record.cycles;
    } else {
      for (std::size_t n = 0; n < cycles_.size(); ++n) cycles_[n].times.add(record.cycles[n].times);
    }
    runs_.resize(cycles_.size());
    for (std::size_t n = 0; n < cycles_.size(); ++n) runs_[n].push_back(course_run(record, n));
    add_counts(faults_, record.delivery_faults);
    add_counts(remarks_, record.remarks);
    data_ += record.data_exchanges;
    service_ += record.service_exchanges;
    unserved_ += record.unserved_exchanges;
    retries_ += record.retries;
  }

  std::vector<measure::Series> finish(const ExchangeWords& words) const {
    std::vector<measure::Series> all;
    for (const CycleRecord& cycle : cycles_) {
      measure::Series& series = all.emplace_back();
      series.name = cycle.kind.name;
      for (const Phase phase : measure::kPhases) {
        for (Comparison& row : compare_cycles(cycle.kind, cycle.times.in(phase), all.size() == 1)) {
          row.phase = phase;
          series.comparisons.push_back(std::move(row));
        }
      }
      series.curves = {{cycle.kind.name + (cycle.kind.is_delay ? "" : " time"), std::string(kMicrosecond),
                        kPerMicrosecond, cycle.times}};
      series.course = course_of(series.curves.front(), cycle.kind, runs_[all.size() - 1]);
    }
    if (all.empty()) return all;
    for (const measure::Count& fault : faults_)
      all.front().comparisons.push_back(none_of(fault.what, fault.count));
    auto& counts = all.front().counts;
    counts.push_back({std::string(words.data), data_, 0});
    if (!words.service.empty()) counts.push_back({std::string(words.service), service_, 0});
    counts.push_back({std::string(words.unserved), unserved_, data_ + service_});
    if (retries_ > 0) counts.push_back({"retries", retries_, 0});
    counts.insert(counts.end(), remarks_.begin(), remarks_.end());
    return all;
  }

 private:
  static measure::CourseRun course_run(const SignalRecord& record, std::size_t kind) {
    measure::CourseRun run{measure::describe(record.settings.wave.frequency), record.cycles[kind].course,
                           record.bands};
    if (record.has_stopped) run.stopped_after = record.stopped_after;
    return run;
  }

  static measure::Course course_of(const measure::Curve& curve, const CycleKind& kind,
                                   const std::vector<measure::CourseRun>& runs) {
    measure::Course course{curve.quantity, curve.unit, curve.per_unit};
    if (kind.theory > Duration::zero()) course.theory = us(kind.theory);
    course.is_bound = kind.is_bound;
    course.runs = runs;
    return course;
  }

  std::vector<CycleRecord> cycles_;
  std::vector<std::vector<measure::CourseRun>> runs_;  // by kind, then by signal
  std::vector<measure::Count> faults_;
  std::vector<measure::Count> remarks_;
  std::uint64_t data_ = 0;
  std::uint64_t service_ = 0;
  std::uint64_t unserved_ = 0;
  std::uint64_t retries_ = 0;
};

}  // namespace

std::vector<Comparison> compare_cycles(const CycleKind& kind, const Distribution& times, bool is_sampling) {
  if (times.is_empty() || kind.theory == Duration::zero()) return {};
  const std::string unit(kMicrosecond);
  const double cycle = us(kind.theory);
  std::vector<Comparison> rows;
  if (kind.is_bound) {
    rows.push_back({fmt::format("longest {}, at most", kind.name), unit, cycle, us(times.max()), cycle,
                    std::string(kOfTheory), 0, true});
    return rows;
  }
  rows.push_back(
      {fmt::format("{} time", kind.name), unit, cycle, us(times.mean()), cycle, std::string(kOfTheory),
       times.standard_deviation() / kPerMicrosecond / std::sqrt(static_cast<double>(times.count()))});
  const bool has_jitter = kind.jitter > Duration::zero();
  rows.push_back({fmt::format("jitter of the {}, peak to peak{}", kind.name, has_jitter ? ", at most" : ""),
                  unit, us(kind.jitter), us(times.max() - times.min()), has_jitter ? us(kind.jitter) : cycle,
                  std::string(has_jitter ? kOfTheory : kOfCycle), 0, has_jitter});
  if (!is_sampling) return rows;
  const double highest = measure::highest_frequency_hz(kind.theory + kind.jitter);
  rows.push_back({"highest frequency without loss, by the longest cycle", "Hz", highest,
                  measure::highest_frequency_hz(Duration{times.max()}), highest, std::string(kOfTheory)});
  return rows;
}

std::vector<Comparison> compare_path(const SignalRecord& record, const PathRecord& path) {
  std::vector<Comparison> rows;
  if (path.path.theory) rows = compare_edges(record, PathForms(record, *path.path.theory), path.skew);
  if (record.settings.disturb != nullptr) return rows;
  rows.push_back(none_of("words that the input never had", path.skew.foreign_words));
  rows.push_back(none_of("torn process images", record.torn_images));
  return rows;
}

namespace {

// Of a cycle that is too long for each pulse to be sampled, as the closed forms have it.
void add_what_is_too_fast(measure::Measurement& measurement, const SignalRecord& record) {
  const measure::Frequency frequency = record.settings.wave.frequency;
  double highest = frequency.hertz();
  for (const PathRecord& path : record.paths)
    if (path.path.theory) highest = std::min(highest, measure::highest_frequency_hz(path.path.theory->cycle));
  if (highest >= frequency.hertz()) return;
  measurement.conditions.push_back(
      {"faster than the cycle",
       fmt::format("{}: above {:.4g} Hz a pulse may fall between two samples and be lost",
                   measure::describe(frequency), highest)});
}

// A signal that took longer than was asked for, and a bus that did not last as long.
void add_remarks(measure::Measurement& measurement, const SignalRecord& record,
                 const MeasurementSettings& settings) {
  const std::string signal = measure::describe(record.settings.wave.frequency);
  if (record.lasted > settings.duration) {
    measurement.conditions.push_back(
        {"longer than asked for",
         fmt::format("{}: one train of {} periods and its rest take {}", signal,
                     record.settings.periods_per_train, kernel::describe(record.lasted))});
  }
  if (!record.has_stopped) return;
  measurement.failures.push_back(fmt::format(
      "{}: the bus stopped for good meanwhile, its last data {} after the begin{}{}", signal,
      kernel::describe(record.stopped_after), record.complaint.empty() ? "" : ": ", record.complaint));
}

// What no station may do, however fast or slow it is, on a quiet line: words that nobody gave, images of
// several instants, and pulses that last for many cycles and never arrive.
void add_what_is_wrong(measure::Measurement& measurement, const SignalRecord& record) {
  constexpr double kManyCycles = 4;
  if (record.settings.disturb != nullptr || record.has_stopped) return;
  Duration longest{};
  for (const CycleRecord& cycle : record.cycles) {
    const Distribution& times = cycle.times.in(Phase::quiet);
    if (!times.is_empty()) longest = std::max(longest, Duration{times.max()});
  }
  const measure::Frequency frequency = record.settings.wave.frequency;
  // Where no closed form says how often a word is sampled, nobody knows what may be lost.
  const auto lasts_for_many = [&](const CopiedPath& path) {
    if (!path.theory || longest == Duration::zero()) return false;
    const Duration cycle = std::max(longest, path.theory->cycle);
    return kManyCycles * frequency.hertz() < measure::highest_frequency_hz(cycle);
  };
  const auto fail = [&](const std::string& where, const std::string& what) {
    measurement.failures.push_back(fmt::format("{}{}: {}", measure::describe(frequency), where, what));
  };
  for (const PathRecord& path : record.paths) {
    const measure::EdgeSkew& skew = path.skew;
    const std::string from = " from " + path.path.name;
    if (skew.foreign_words > 0)
      fail(from, fmt::format("{} words that the input never had", skew.foreign_words));
    if (lasts_for_many(path.path) && skew.pulses > 0 && skew.lost_pulses == skew.pulses)
      fail(from, fmt::format("none of {} pulses arrived, though each lasted for many cycles", skew.pulses));
  }
  if (record.torn_images > 0)
    fail("", fmt::format("{} of {} process images are torn", record.torn_images, record.images));
}

std::optional<SignalRecord> record_until_stopped(Network& network, const measure::SquareWave& wave,
                                                 const MeasurementSettings& settings) {
  if (settings.stop.stop_requested()) return std::nullopt;
  const segment::StopScope scope(settings.stop);
  try {
    return record_signal(network,
                         {.wave = wave,
                          .duration = settings.duration,
                          .seed = settings.seed,
                          .disturb = settings.disturb,
                          .phase_during = settings.phase_during,
                          .next_disturbance = settings.next_disturbance,
                          .most_windows = std::max<std::size_t>(1, kMostWindows / settings.signals.size())});
  } catch (const segment::Interrupted&) {
    return std::nullopt;
  }
}

}  // namespace

measure::Measurement measure_network(const MakeNetwork& make, const MeasurementSettings& settings) {
  measure::Measurement measurement;
  measurement.protocol = settings.protocol;
  measurement.seed = settings.seed;
  measurement.tolerance_percent = settings.tolerance_percent;
  CycleSeries cycles;
  ExchangeWords words;
  for (std::size_t n = 0; n < settings.signals.size(); ++n) {
    const std::unique_ptr<Network> network = make(kernel::Random(settings.seed).split(n).seed());
    if (n == 0) {
      measurement.network = network->name();
      measurement.conditions = network->conditions();
      measurement.conditions.push_back({"each signal", kernel::describe(settings.duration)});
      measurement.conditions.insert(measurement.conditions.end(), settings.conditions.begin(),
                                    settings.conditions.end());
      words = network->exchange_words();
    }
    const std::optional<SignalRecord> recorded =
        record_until_stopped(*network, settings.signals[n], settings);
    if (!recorded) {
      measurement.is_complete = false;
      measurement.conditions.push_back(
          {"not measured", fmt::format("{} and what follows it: the measurement was ended before",
                                       measure::describe(settings.signals[n].frequency))});
      break;
    }
    const SignalRecord& record = *recorded;
    cycles.add(record);
    add_remarks(measurement, record, settings);
    add_what_is_too_fast(measurement, record);
    add_what_is_wrong(measurement, record);
    for (const PathRecord& path : record.paths) {
      measurement.series.push_back(series_of(record, path));
      if (!path.path.theory) leave_open(measurement, path.path.why_open);
    }
    if (settings.on_progress) settings.on_progress(n + 1);
  }
  // The cycles come first.
  std::vector<measure::Series> first = cycles.finish(words);
  measurement.series.insert(measurement.series.begin(), std::make_move_iterator(first.begin()),
                            std::make_move_iterator(first.end()));
  return measurement;
}

}  // namespace fieldproof::network

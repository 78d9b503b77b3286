// For tests: a small measurement with values in two phases.
#pragma once

#include "harness/measure/measurement.hpp"
#include "reports/measurement_writer.hpp"

namespace fieldproof::reports {

// A second in which three bursts come, the cycles of which are longer; then the bus stops.
inline measure::Course sample_course() {
  using measure::Phase;
  measure::TimeCourse values(kernel::kSecond, 50);
  measure::CourseRun run{"50 Hz", values};
  for (std::int64_t n = 1; n <= 90; ++n) {
    const kernel::Duration when = 10 * n * kernel::kMillisecond;
    const std::int64_t place = n % 30;
    const Phase phase = place >= 10 && place < 13 ? Phase::burst
                        : place == 13             ? Phase::recovery
                                                  : Phase::quiet;
    const std::int64_t more = phase == Phase::quiet ? n % 7 : phase == Phase::burst ? 814 + 40 * n : 200;
    run.values.add(when, phase, (814 + more) * 1'000'000);
    if (place == 10) run.bands.push_back({when, when + 25 * kernel::kMillisecond, 2});
  }
  run.stopped_after = 900 * kernel::kMillisecond;
  measure::Course course{"cycle time", "us", 1e6, 814.0};
  course.runs = {run};
  return course;
}

inline measure::Measurement sample_measurement() {
  using measure::Phase;
  measure::Measurement measurement;
  measurement.protocol = "interbus";
  measurement.network = "one coupler";
  measurement.seed = 7;
  measurement.tolerance_percent = 2;
  measurement.conditions = {{"latch model", "M2"}};
  measure::Series series;
  series.name = "50 Hz from di to do";
  series.comparisons = {{"cycle time", "us", 814, 814.2, 814, "of the theory"},
                        {"largest error, at most", "%", 4.07, 3.5, 100, "of a period", 0, true}};
  measure::Curve delays{"delay", "us", 1e6, {}};
  for (const std::int64_t value : {1'000'000, 2'000'000, 3'000'000, 4'000'000})
    delays.values.add(Phase::quiet, value);
  delays.values.add(Phase::burst, std::int64_t{9'500'000});
  series.curves = {delays};
  series.counts = {{"lost pulses", 1, 20}, {"trains", 3, 0}};
  series.trace.length = kernel::kMillisecond;
  series.trace.input = {{kernel::kMicrosecond, true}};
  series.trace.output = {{3 * kernel::kMicrosecond, true}};
  series.course = sample_course();
  measurement.series = {series};
  return measurement;
}

// The same with bursts on the line, and what must be said of them.
inline measure::Measurement sample_burst_measurement() {
  measure::Measurement measurement = sample_measurement();
  measurement.conditions.push_back({"cycle time by f4", "1.252000001 ms, of that 574.766668 us of waiting"});
  measurement.series[0].comparisons[0].measured = measurement.series[0].comparisons[0].theory * (1 - 1.1e-9);
  measure::Curve lags{"lag", "us", 1e6, {}};
  for (std::int64_t n = 0; n < 40; ++n) lags.values.add(measure::Phase::quiet, (n % 7 + 1) * 1'000'000);
  measurement.series[0].curves.push_back(lags);
  measurement.conditions.push_back({"bursts", "5 kHz, +, level 3 (1000 V), profile A"});
  measurement.conditions.push_back({std::string(kCaveat), "The coupling is not calibrated."});
  return measurement;
}

}  // namespace fieldproof::reports

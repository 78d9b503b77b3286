#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/measure/comparison.hpp"
#include "harness/measure/phase.hpp"
#include "harness/measure/time_course.hpp"

// All of a measurement as whoever writes it down needs it: comparisons with the theory, distributions and
// counts, in words and numbers without any protocol.
namespace fieldproof::measure {

// Values of one quantity. They are kept as whole numbers; `per_unit` of them are one `unit`.
struct Curve {
  std::string quantity;
  std::string unit;
  double per_unit = 1;
  PhasedDistribution values;
};

// One run in it: the network with one signal.
struct CourseRun {
  std::string name;  // "50 Hz"
  TimeCourse values;
  std::vector<Band> bands{};  // in which bursts were on the line
  // The network stopped for good: its last data exchange.
  std::optional<kernel::Duration> stopped_after{};
};

// When the values of a quantity came, in runs one after another. Units as those of a curve.
struct Course {
  std::string quantity;
  std::string unit;
  double per_unit = 1;
  std::optional<double> theory{};  // in the unit; nothing where no closed form holds
  bool is_bound = false;           // the theory is the most that may be
  std::vector<CourseRun> runs{};
};

struct Count {
  std::string what;  // "lost pulses"
  std::uint64_t count = 0;
  std::uint64_t of = 0;  // 0: not a part of anything
};

// A signal and what followed it, as an oscilloscope shows both.
struct Trace {
  struct Edge {
    kernel::Duration when;  // since the begin of the trace
    bool level = false;     // from then on
  };
  std::vector<Edge> input;
  std::vector<Edge> output;
  kernel::Duration length{};
};

struct Series {
  std::string name;  // "50 Hz from di16 word 0 to do16 word 0"
  std::vector<Comparison> comparisons;
  std::vector<Curve> curves;
  std::vector<Count> counts;
  Trace trace;
  std::optional<Course> course{};
};

struct Condition {
  std::string name;  // "latch model"
  std::string value;
};

struct Measurement {
  std::string protocol;
  std::string network;
  // Others than references in it, as they were named; a difference is no failure of theirs. Empty: none.
  std::string implementations{};
  std::uint64_t seed = 0;
  double tolerance_percent = 0;
  std::vector<Condition> conditions;
  std::vector<Series> series;
  bool is_complete = true;  // false: something could not be compared; a condition says what, and why
  std::vector<std::string> failures;  // "50 Hz: the bus stopped for good ..."
};

// Over everything that was compared while the network was quiet; open where something could not be, or where
// nothing was: bursts that follow each other faster than the network recovers leave no quiet phase. The
// theory is that of a quiet network: what bursts and recovery make of it stands beside it, and refutes
// nothing.
Agreement agreement(const Measurement& measurement);
// Of one phase alone; nothing where nothing of it was compared.
std::optional<Agreement> agreement(const Measurement& measurement, Phase phase);

}  // namespace fieldproof::measure

#include "reports/measurement_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/course_json.hpp"
#include "reports/text_summary.hpp"
#include "reports/trace_json.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;
using measure::Comparison;
using measure::Curve;
using measure::Distribution;

constexpr std::string_view kMeasurementSchema = "fieldproof/measurement/1";
constexpr std::size_t kBins = 64;

struct Quantile {
  const char* key;
  double part;
};
constexpr std::array kQuantiles = {Quantile{"p50", 0.5}, Quantile{"p99", 0.99}, Quantile{"p99_99", 0.9999}};

// ---- JSON ----

Json comparison_json(const Comparison& one, double tolerance_percent) {
  return {{"quantity", as_utf8(one.quantity)},
          {"unit", as_utf8(one.unit)},
          {"theory", one.theory},
          {"measured", one.measured},
          {"is_bound", one.is_bound},
          {"deviation_percent", one.deviation_percent()},
          {"whole", as_utf8(one.whole_name)},
          {"standard_error", one.standard_error},
          {"phase", name(one.phase)},
          {"agreement", name(agreement(one, tolerance_percent))}};
}

Json distribution_json(const Distribution& values, double per_unit) {
  const auto in_unit = [per_unit](auto value) { return static_cast<double>(value) / per_unit; };
  Json json = {{"count", values.count()}, {"min", in_unit(values.min())}, {"mean", in_unit(values.mean())}};
  for (const auto& [key, part] : kQuantiles) json[key] = in_unit(values.quantile(part));
  json["max"] = in_unit(values.max());
  json["standard_deviation"] = in_unit(values.standard_deviation());
  json["exact_quantiles"] = values.has_exact_quantiles();
  json["histogram"] = Json::array();
  for (const auto& bin : values.histogram(kBins)) {
    json["histogram"].push_back(
        {{"low", in_unit(bin.low)}, {"high", in_unit(bin.high)}, {"count", bin.count}});
  }
  return json;
}

Json curve_json(const Curve& curve) {
  Json json = {
      {"quantity", as_utf8(curve.quantity)}, {"unit", as_utf8(curve.unit)}, {"phases", Json::object()}};
  for (const measure::Phase phase : measure::kPhases) {
    const Distribution& values = curve.values.in(phase);
    if (!values.is_empty())
      json["phases"][std::string(name(phase))] = distribution_json(values, curve.per_unit);
  }
  return json;
}

Json series_json(const measure::Series& series, double tolerance_percent) {
  Json json = {{"name", as_utf8(series.name)},
               {"comparisons", Json::array()},
               {"distributions", Json::array()},
               {"counts", Json::array()},
               {"trace", trace_json(series.trace)}};
  for (const Comparison& one : series.comparisons) {
    json["comparisons"].push_back(comparison_json(one, tolerance_percent));
  }
  for (const Curve& curve : series.curves) json["distributions"].push_back(curve_json(curve));
  for (const measure::Count& one : series.counts) {
    json["counts"].push_back({{"what", as_utf8(one.what)}, {"count", one.count}, {"of", one.of}});
  }
  if (series.course) json["course"] = course_json(*series.course);
  return json;
}

// ---- text ----

constexpr std::size_t kNameWidth = 52;

std::string value_text(double value, std::string_view unit) {
  return fmt::format("{:.{}f}{}{}", value, unit.empty() ? 4 : 3, unit.empty() ? "" : " ", escaped_line(unit));
}

std::string comparison_line(const Comparison& one, double tolerance_percent) {
  const auto agrees = agreement(one, tolerance_percent);
  const std::string mark = agrees == measure::Agreement::holds ? "" : fmt::format("  {}", name(agrees));
  const std::string what = escaped_line(one.quantity) +
                           (one.phase == measure::Phase::quiet ? "" : fmt::format(", {}", name(one.phase)));
  return fmt::format("  {:<{}} {:>14} {:>14} {:>+9.3f} % {}{}\n", what, kNameWidth,
                     value_text(one.theory, one.unit), value_text(one.measured, one.unit),
                     one.deviation_percent(), escaped_line(one.whole_name), mark);
}

std::string distribution_line(const Curve& curve, measure::Phase phase) {
  const Distribution& values = curve.values.in(phase);
  std::string line = fmt::format(
      "  {:<{}} {:<8} {:>9}", fmt::format("{}, {}", escaped_line(curve.quantity), escaped_line(curve.unit)),
      kNameWidth - 12, name(phase), values.count());
  const auto put = [&](double value, std::string_view sign = "") {
    line += fmt::format(" {:>11}", fmt::format("{}{:.3f}", sign, value / curve.per_unit));
  };
  put(static_cast<double>(values.min()));
  put(values.mean());
  for (const auto& [key, part] : kQuantiles) {
    put(static_cast<double>(values.quantile(part)), values.has_exact_quantiles() ? "" : "~");
  }
  put(static_cast<double>(values.max()));
  put(values.standard_deviation());
  return line + "\n";
}

std::string distributions_text(const std::vector<Curve>& curves) {
  std::string text;
  for (const Curve& curve : curves) {
    for (const measure::Phase phase : measure::kPhases) {
      if (!curve.values.in(phase).is_empty()) text += distribution_line(curve, phase);
    }
  }
  if (text.empty()) return text;
  return fmt::format("  {:<{}} {:<8} {:>9} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}\n",
                     "distribution", kNameWidth - 12, "phase", "count", "min", "mean", "p50", "p99", "p99.99",
                     "max", "sd") +
         text;
}

std::string counts_text(const std::vector<measure::Count>& counts) {
  std::string text;
  for (const measure::Count& one : counts) {
    text += fmt::format("  {:<{}} {}", escaped_line(one.what), kNameWidth, one.count);
    text += one.of == 0 ? "\n" : fmt::format(" of {}\n", one.of);
  }
  return text;
}

std::string series_text(const measure::Series& series, double tolerance_percent) {
  std::string text = fmt::format("\n{}\n", escaped_line(series.name));
  if (!series.comparisons.empty()) {
    text += fmt::format("  {:<{}} {:>14} {:>14} {:>11}\n", "quantity", kNameWidth, "theory", "measured",
                        "deviation");
  }
  for (const Comparison& one : series.comparisons) text += comparison_line(one, tolerance_percent);
  text += distributions_text(series.curves);
  if (series.course) text += course_text(*series.course);
  return text + counts_text(series.counts);
}

std::string channel_text(const std::vector<measure::Trace::Edge>& edges, kernel::Duration length,
                         std::size_t columns) {
  std::string line(columns, '_');
  bool level = false;
  std::size_t next = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    // What holds in the middle of the column.
    const double middle = (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
    const auto when = kernel::Duration{std::llround(middle * static_cast<double>(length.count()))};
    while (next < edges.size() && edges[next].when <= when) level = edges[next++].level;
    if (level) line[column] = '#';
  }
  return line;
}

}  // namespace

std::string measurement_json(const measure::Measurement& measurement) {
  Json json = {{"schema", kMeasurementSchema},
               {"protocol", as_utf8(measurement.protocol)},
               {"network", as_utf8(measurement.network)},
               {"seed", fmt::format("{}", measurement.seed)},
               {"tolerance_percent", measurement.tolerance_percent},
               {"agreement", name(agreement(measurement))},
               {"phases", Json::object()},
               {"failures", Json::array()},
               {"conditions", Json::array()},
               {"series", Json::array()}};
  if (!measurement.implementations.empty()) json["implementations"] = as_utf8(measurement.implementations);
  for (const measure::Phase phase : measure::kPhases) {
    if (const auto of_phase = agreement(measurement, phase)) json["phases"][name(phase)] = name(*of_phase);
  }
  for (const std::string& failure : measurement.failures) json["failures"].push_back(as_utf8(failure));
  for (const measure::Condition& one : measurement.conditions) {
    if (one.name == kCaveat) {
      json["unverified"].push_back(as_utf8(one.value));
      continue;
    }
    json["conditions"].push_back({{"name", as_utf8(one.name)}, {"value", as_utf8(one.value)}});
  }
  for (const measure::Series& series : measurement.series) {
    json["series"].push_back(series_json(series, measurement.tolerance_percent));
  }
  return json.dump(1) + "\n";
}

std::string measurement_text(const measure::Measurement& measurement) {
  std::string text = fmt::format("network {}\n", escaped_line(measurement.network));
  for (const measure::Condition& one : measurement.conditions) {
    text += fmt::format("  {:<{}} {}\n", escaped_line(one.name), kNameWidth, escaped_line(one.value));
  }
  for (const measure::Series& series : measurement.series) {
    text += series_text(series, measurement.tolerance_percent);
  }
  for (const std::string& failure : measurement.failures)
    text += fmt::format("\nfail: {}\n", escaped_line(failure));
  const bool is_disturbed = agreement(measurement, measure::Phase::burst).has_value() ||
                            agreement(measurement, measure::Phase::recovery).has_value();
  text += fmt::format("\ntheory and measurement{}: {} (tolerance {} %)\n", is_disturbed ? " while quiet" : "",
                      name(agreement(measurement)), measurement.tolerance_percent);
  if (!agreement(measurement, measure::Phase::quiet))
    text += "  nothing was compared while quiet: the network was never quiet, or nothing was measured\n";
  for (const measure::Phase phase : {measure::Phase::burst, measure::Phase::recovery}) {
    if (const auto of_phase = agreement(measurement, phase)) {
      text += fmt::format("  the same, {}: {}; the closed forms are those of a quiet network\n", name(phase),
                          name(*of_phase));
    }
  }
  return text;
}

std::string trace_text(const measure::Trace& trace, std::size_t columns) {
  return fmt::format("input  {}\noutput {}\n", channel_text(trace.input, trace.length, columns),
                     channel_text(trace.output, trace.length, columns));
}

}  // namespace fieldproof::reports

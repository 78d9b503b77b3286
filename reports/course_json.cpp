#include "reports/course_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

double seconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / static_cast<double>(kernel::kSecond.count());
}

Json points_json(const measure::TimeCourse& values, double per_unit) {
  Json json = Json::array();
  for (const auto& point : values.points()) {
    json.push_back({{"from_s", seconds(point.from)},
                    {"phase", name(point.phase)},
                    {"count", point.count},
                    {"min", static_cast<double>(point.min) / per_unit},
                    {"mean", point.mean / per_unit},
                    {"max", static_cast<double>(point.max) / per_unit}});
  }
  return json;
}

Json run_json(const measure::CourseRun& run, double per_unit) {
  Json json = {{"name", as_utf8(run.name)},
               {"length_s", seconds(run.values.length())},
               {"window_s", seconds(run.values.window())},
               {"points", points_json(run.values, per_unit)},
               {"bursts", Json::array()},
               {"longest", Json::array()}};
  if (run.stopped_after) json["stopped_s"] = seconds(*run.stopped_after);
  for (const measure::Band& band : run.bands) {
    json["bursts"].push_back(
        {{"from_s", seconds(band.from)}, {"to_s", seconds(band.to)}, {"count", band.disturbances}});
  }
  for (const auto& one : run.values.longest()) {
    json["longest"].push_back({{"at_s", seconds(one.when)},
                               {"phase", name(one.phase)},
                               {"value", static_cast<double>(one.value) / per_unit}});
  }
  return json;
}

bool is_constant(const measure::TimeCourse& values) {
  const auto points = values.points();
  return std::ranges::all_of(points, [&](const auto& point) {
    return point.min == points.front().min && point.max == points.front().min;
  });
}

}  // namespace

Json course_json(const measure::Course& course) {
  Json json = {{"quantity", as_utf8(course.quantity)},
               {"unit", as_utf8(course.unit)},
               {"is_bound", course.is_bound},
               {"runs", Json::array()}};
  if (course.theory) json["theory"] = *course.theory;
  for (const measure::CourseRun& run : course.runs) json["runs"].push_back(run_json(run, course.per_unit));
  return json;
}

std::string course_text(const measure::Course& course) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (const measure::CourseRun& run : course.runs) {
    if (is_constant(run.values)) continue;
    text += fmt::format("  longest {}, {}:", escaped_line(course.quantity), escaped_line(run.name));
    std::size_t told = 0;
    for (const auto& one : run.values.longest()) {
      if (told++ == kMost) break;
      text += fmt::format("{} {:.3f} {} at {:.6f} s ({})", told == 1 ? "" : ",",
                          static_cast<double>(one.value) / course.per_unit, escaped_line(course.unit),
                          seconds(one.when), name(one.phase));
    }
    text += "\n";
  }
  return text;
}

}  // namespace fieldproof::reports

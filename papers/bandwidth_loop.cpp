// Figures 3 and 4 of Hong and others, a control loop with and without their scheme; and the scheme as
// stations that send frames.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "papers/bandwidth_lines.hpp"
#include "papers/window_loop.hpp"
#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::papers {
namespace {

using bandwidth::Demand;
using bandwidth::Load;
using bandwidth::Sent;
using bandwidth::WindowFigures;
using bandwidth::WindowRun;
using bandwidth::WindowTraffic;
using kernel::Duration;
using reports::PublishedCurves;
using reports::PublishedRow;
using reports::PublishedSection;

constexpr unsigned kFewestPeriods = 100;

PublishedRow row_of_course(std::string what, const LoopCourse& course) {
  return {std::move(what), "",
          fmt::format("error {:.2f} %s, actuator travel {:.0f} %", course.absolute_error, course.travel),
          fmt::format("{} samplings of the controller, {} vacant, {} samples lost", course.samplings,
                      course.vacant, course.lost),
          std::nullopt};
}

PublishedRow sentence(std::string what, std::string published, double with, double without) {
  return {std::move(what), std::move(published), fmt::format("{:+.0f} %", 100 * (with / without - 1)),
          "the same process, controller, packets and line", reports::more_than(without, with)};
}

PublishedCurves::Curve curve_of(std::string name, const LoopCourse& course, double LoopCourse::Point::* value,
                                std::size_t points) {
  PublishedCurves::Curve curve{std::move(name), {}};
  for (const LoopCourse::Point& point : course.points) {
    if (curve.points.size() < points) curve.points.push_back({point.time_s, point.*value});
  }
  return curve;
}

}  // namespace

PublishedSection bandwidth_loop(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 3 and 4: a control loop with and without the scheme, T 20 ms";
  section.note =
      "The paper shows a picture and names no process. Here: two lags of 80 and 32 ms, a PID, three other "
      "loops, "
      "files of all nodes. Without the scheme the same server visits the same nodes and loops sample at the "
      "same "
      "instants, but it has no periodic byte, and packets of files are three times as long.";
  const WindowTraffic with = safe_traffic(bandwidth::fractional_density());
  WindowTraffic without = with;
  without.has_periodic_byte = false;
  without.non_real_time_packet *= 3;
  const auto periods =
      static_cast<unsigned>(std::clamp<std::int64_t>(settings.duration / with.slot, 120, 20'000));
  const LoopCourse alone = run_window_loop(with, Load::none, periods, settings.seed);
  const LoopCourse planned = run_window_loop(with, Load::saturated, periods, settings.seed);
  const LoopCourse cyclic = run_window_loop(without, Load::random, periods, settings.seed);
  section.rows.push_back(row_of_course("without other data", alone));
  section.rows.push_back(row_of_course("with the scheme, other queues always full", planned));
  section.rows.push_back(row_of_course("without it", cyclic));
  section.rows.push_back(
      {"figure 3, delays over T: several samples come in a period, none in another", "both",
       fmt::format("{} lost, {} vacant", cyclic.lost, cyclic.vacant), "without the scheme",
       reports::of_samples(reports::more_than(0, static_cast<double>(std::min(cyclic.lost, cyclic.vacant))),
                           periods, kFewestPeriods)});
  section.rows.push_back({"with the scheme: samples lost and vacant sampling", "none",
                          fmt::format("{} and {}", planned.lost, planned.vacant), "",
                          reports::at_most(0, static_cast<double>(planned.lost + planned.vacant))});
  section.rows.push_back(sentence("loss and vacant sampling: error of the loop",
                                  "they lower performance much", cyclic.absolute_error,
                                  planned.absolute_error));
  section.rows.push_back(sentence("loss and vacant sampling: travel of the actuator", "jitter wears it",
                                  cyclic.travel, planned.travel));
  const std::size_t points = std::min<std::size_t>(1'200, cyclic.points.size());
  PublishedCurves process{"Figure 4: the process", "time, s", "per cent", {}};
  PublishedCurves actuator{"Figure 4: the actuator", "time, s", "per cent", {}};
  for (const auto& [name, course] :
       {std::pair{"without the scheme", &cyclic}, {"with the scheme", &planned}}) {
    process.curves.push_back(curve_of(name, *course, &LoopCourse::Point::process, points));
    actuator.curves.push_back(curve_of(name, *course, &LoopCourse::Point::actuator, points));
  }
  process.curves.push_back(curve_of("setpoint", planned, &LoopCourse::Point::setpoint, points));
  section.figures = {std::move(process), std::move(actuator)};
  return section;
}

PublishedSection bandwidth_stations(const Settings& settings) {
  PublishedSection section;
  section.heading = "The same as stations that send frames, at 1 Mbit/s";
  section.note =
      "The paper: the scheme fits every cyclic service, polling and token alike. Each station sends real "
      "frames "
      "with the periodic byte; somebody on the line reads them.";
  for (const bool is_polled : {false, true}) {
    bandwidth::WindowLineRules rules = line_rules();
    rules.is_polled = is_polled;
    const Demand demand = with_real_time();
    const WindowTraffic traffic = on_line(bandwidth::traffic_of(demand, 1), rules);
    for (const Load load : {Load::saturated, Load::just_late}) {
      WindowRun run{.seed = settings.seed, .slots = 100, .real_time = load, .non_real_time = load};
      const bandwidth::LinkRun link = run_window_link(traffic, rules, run);
      std::vector<Sent> sent;
      run.on_sent = [&](const Sent& one) { sent.push_back(one); };
      const WindowFigures figures = run_windows(traffic, run);
      const std::size_t both = std::min(sent.size(), link.sent.size());
      const Duration before = link.origin - kernel::kStart;
      std::size_t equal = 0;
      while (equal < both && sent[equal].node == link.sent[equal].node &&
             sent[equal].packet == link.sent[equal].packet &&
             sent[equal].end + before == link.sent[equal].end)
        ++equal;
      section.rows.push_back(
          {fmt::format("{}, other queues send {}", is_polled ? "polling" : "token", name_of(load)),
           "no datum over T_1", told_longest(figures),
           fmt::format("{} of {} packets end at the picosecond of the simulation without frames", equal,
                       both),
           reports::at_most(0, static_cast<double>(both - equal + figures.over_slot()), "late or unlike")});
    }
  }
  return section;
}

}  // namespace fieldproof::papers

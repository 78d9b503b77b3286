// The section of Hong and others about control loops over a fieldbus: what data loss and vacant sampling
// cost, quiet and under bursts. The paper shows a picture and two sentences; process, tuning and traffic are
// chosen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "harness/traffic/milliseconds.hpp"
#include "papers/link_bursts.hpp"
#include "papers/sections.hpp"
#include "protocols/fieldbus_dll/control_loop.hpp"

namespace fieldproof::papers {
namespace {

using fieldbus_dll::ControlLoop;
using fieldbus_dll::ControlLoopSetting;
using fieldbus_dll::DataWay;
using reports::PublishedCurves;
using reports::PublishedRow;
using reports::PublishedSection;

constexpr double kMessages = 1.5;  // of each other node in a second, where the bus is loaded
constexpr unsigned kMostPeriods = 20'000;
constexpr double kShownSeconds = 60;
constexpr std::uint64_t kFewestSamples = 30;

ControlLoopSetting loop_setting(const Settings& settings, DataWay way, double messages_per_s) {
  ControlLoopSetting loop;
  loop.seed = settings.seed;
  loop.way = way;
  loop.messages_per_s = messages_per_s;
  loop.periods = static_cast<unsigned>(
      std::clamp<std::int64_t>(settings.duration / loop.sampling_period, 1, kMostPeriods));
  return loop;
}

std::string told_loop(const ControlLoop& loop) {
  return fmt::format("error {:.1f} %s, overshoot {:.1f} %, valve travel {:.0f} %", loop.absolute_error,
                     loop.overshoot, loop.valve_travel);
}

double delay_ms(std::int64_t picoseconds) {
  return traffic::ms(kernel::Duration{picoseconds});
}

std::string told_hops(const ControlLoop& loop) {
  const auto hop = [](const fieldbus_dll::HopFigures& figures) {
    return fmt::format("{} of {} lost, {} missing, {} vacant", figures.lost, figures.sent, figures.missing,
                       figures.vacant);
  };
  return fmt::format("to the controller {}; to the valve {}; loop delay {:.1f} to {:.1f} ms, mean {:.1f} ms",
                     hop(loop.to_controller), hop(loop.to_valve), delay_ms(loop.loop_delay.min()),
                     delay_ms(loop.loop_delay.max()), loop.loop_delay.mean() / traffic::kPicosecondsPerMs);
}

PublishedRow loop_row(std::string what, const ControlLoop& loop) {
  return {std::move(what), "", told_loop(loop), told_hops(loop), std::nullopt};
}

// What the paper says in words, and whether it is so here.
PublishedRow sentence(std::string what, std::string published, const ControlLoop& with,
                      const ControlLoop& without, double ControlLoop::* quantity) {
  return {std::move(what), std::move(published),
          fmt::format("{:+.0f} %", 100 * (with.*quantity / (without.*quantity) - 1)),
          "the same bus, blocks and messages; only the way of the data differs",
          reports::of_samples(reports::more_than(without.*quantity, with.*quantity), with.to_controller.sent,
                              kFewestSamples)};
}

PublishedCurves::Curve course(std::string name, const ControlLoop& loop,
                              double fieldbus_dll::LoopPoint::* quantity) {
  PublishedCurves::Curve curve{std::move(name), {}};
  for (const fieldbus_dll::LoopPoint& point : loop.course) {
    if (point.time_s <= kShownSeconds) curve.points.push_back({point.time_s, point.*quantity});
  }
  return curve;
}

PublishedCurves figure_of(std::string name, double fieldbus_dll::LoopPoint::* quantity,
                          std::vector<std::pair<std::string, const ControlLoop*>> loops, bool has_setpoint) {
  PublishedCurves figure{std::move(name), "time, s", "per cent", {}};
  for (const auto& [title, loop] : loops) figure.curves.push_back(course(title, *loop, quantity));
  if (has_setpoint) {
    figure.curves.push_back(course("setpoint", *loops.front().second, &fieldbus_dll::LoopPoint::setpoint));
  }
  return figure;
}

// An installation at the strongest level of a signal port.
ControlLoop loop_under_bursts(ControlLoopSetting setting, const char* profile, std::int64_t bit_rate,
                              emc::Repetition repetition) {
  emc::BurstSettings bursts;
  bursts.level = emc::Level::standard(emc::PortKind::signal, 4);
  bursts.repetition = repetition;
  setting.bit_rate = bit_rate;
  setting.disturb = bursts_on_link(emc::Profile::named(profile), bursts, bit_rate,
                                   kernel::kStart + fieldbus_dll::loop_begin(bit_rate), setting.seed);
  return run_control_loop(setting);
}

struct DisturbedLine {
  const char* profile;
  std::int64_t bit_rate;
};

std::string told_relationship(std::string_view what, const fieldbus_dll::RelationshipFigures& figures) {
  if (figures.delay.is_empty()) return fmt::format("{}: {} sent, none arrived", what, figures.sent);
  return fmt::format("{} {:.0f} to {:.0f} ms, mean {:.0f} ms ({} of {} missing)", what,
                     delay_ms(figures.delay.min()), delay_ms(figures.delay.max()),
                     figures.delay.mean() / traffic::kPicosecondsPerMs, figures.missing, figures.sent);
}

PublishedRow operator_row(std::string what, const ControlLoop& loop) {
  return {std::move(what), "",
          fmt::format("{}; {}; {}", told_relationship("responses", loop.requests),
                      told_relationship("alarms", loop.alarms), told_relationship("trends", loop.trends)),
          fmt::format("{}; the transmitter is without the token for {:.0f} ms at most",
                      loop.requests.arrived > 0 ? told_loop(loop) : "no setpoint has ever come",
                      traffic::ms(loop.longest_without_token)),
          std::nullopt};
}

}  // namespace

PublishedSection control_loop_with_operator(const Settings& settings) {
  PublishedSection section;
  section.heading = "What else applications say: requests and their responses, alarms, trends";
  section.note =
      "Neither paper has them. Beside the published loop an operator writes each new setpoint and reads once "
      "a second, as a client; the transmitter reports alarms as urgent and trends as time-available data to "
      "everybody. V(TTRT) decides who waits: a short one holds back trends and messages, a long one lets "
      "alarms wait after them; below the rotation without any data nothing but urgent data goes, and no "
      "setpoint ever comes. Nothing is sent again but a setpoint without a response, after 5 s.";
  const auto loop_of = [&](double messages, kernel::Duration target, double loss) {
    ControlLoopSetting setting = loop_setting(settings, DataWay::published, messages);
    setting.has_operator = true;
    setting.target_rotation = target;
    if (loss > 0)
      setting.disturb = fieldbus_dll::losing_frames(loss, kernel::Random(settings.seed).split("losses"));
    return run_control_loop(setting);
  };
  for (const double messages : {0.0, kMessages}) {
    for (const std::int64_t target_ms : {100, 300, 60'000}) {
      section.rows.push_back(
          operator_row(fmt::format("{} messages per node and second, TTRT {} ms", messages, target_ms),
                       loop_of(messages, target_ms * kernel::kMillisecond, 0)));
    }
  }
  section.rows.push_back(operator_row("0 messages, TTRT 300 ms, 5 % of frames lost",
                                      loop_of(0, 300 * kernel::kMillisecond, 0.05)));
  return section;
}

PublishedSection control_loop_quiet(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 3 and 4: data loss and vacant sampling in a control loop, 250 ms, 31.25 kbit/s";
  section.note =
      "The paper shows one picture with and one without, and names no process, bus or load. Here: two lags "
      "of "
      "1 s and 0.4 s, a PID, eight other nodes that send messages. Data that the scheduler compels arrive in "
      "time whatever else is sent; data that wait for the token are late when the rotation is long. Sums "
      "over "
      "the whole run.";
  const ControlLoop alone = run_loop_without_bus(loop_setting(settings, DataWay::published, 0));
  const ControlLoop published = run_control_loop(loop_setting(settings, DataWay::published, kMessages));
  section.rows.push_back(loop_row("without a bus", alone));
  section.rows.push_back(
      loop_row(fmt::format("published, {} messages per node and second", kMessages), published));
  ControlLoop late;
  for (const double messages : {0.0, 0.5, 1.0, kMessages, 2.0}) {
    ControlLoop loop = run_control_loop(loop_setting(settings, DataWay::by_token, messages));
    section.rows.push_back(
        loop_row(fmt::format("by token, {} messages per node and second", messages), loop));
    if (messages == kMessages) late = std::move(loop);
  }
  ControlLoopSetting bounded = loop_setting(settings, DataWay::by_token, kMessages);
  bounded.target_rotation = 100 * kernel::kMillisecond;
  section.rows.push_back(loop_row("the same load by token, TTRT 100 ms", run_control_loop(bounded)));
  section.rows.push_back(sentence("integral of the error, with the phenomena over without",
                                  "performance falls greatly", late, published,
                                  &ControlLoop::absolute_error));
  section.rows.push_back(sentence("travel of the valve, with the phenomena over without",
                                  "jitter wears the actuator", late, published, &ControlLoop::valve_travel));
  section.figures.push_back(
      figure_of("Figure 4: the process", &fieldbus_dll::LoopPoint::process,
                {{"by token: loss and vacant sampling", &late}, {"published: neither", &published}}, true));
  section.figures.push_back(
      figure_of("Figure 4: the valve", &fieldbus_dll::LoopPoint::valve,
                {{"by token: loss and vacant sampling", &late}, {"published: neither", &published}}, false));
  return section;
}

PublishedSection control_loop_under_bursts(const Settings& settings) {
  PublishedSection section;
  section.heading = "The same loop under bursts of IEC 61000-4-4, 2000 V, and with frames lost";
  section.note =
      "The paper has no bursts. The levels of the model are uncalibrated. Receivers of 31.25 kbit/s do not "
      "see "
      "pulses that are shorter than a quarter of a bit; what they miss comes from pulses that follow each "
      "other closely. Frames that are lost by chance at each receiver show what a worse line would cost.";
  const ControlLoop quiet = run_control_loop(loop_setting(settings, DataWay::published, 0));
  section.rows.push_back(loop_row("published, quiet", quiet));
  for (const DisturbedLine& line : {DisturbedLine{"E", 31'250}, {"E2", 31'250}, {"F", 1'000'000}}) {
    for (const emc::Repetition repetition : {emc::Repetition::khz_5, emc::Repetition::khz_100}) {
      section.rows.push_back(loop_row(fmt::format("published, {} bit/s, profile {}, {}", line.bit_rate,
                                                  line.profile, emc::text_of(repetition)),
                                      loop_under_bursts(loop_setting(settings, DataWay::published, 0),
                                                        line.profile, line.bit_rate, repetition)));
    }
  }
  const ControlLoop hit = loop_under_bursts(loop_setting(settings, DataWay::by_token, kMessages), "E2",
                                            31'250, emc::Repetition::khz_100);
  section.rows.push_back(
      loop_row(fmt::format("by token, {} messages, 31250 bit/s, profile E2, 100 kHz", kMessages), hit));
  ControlLoop lossy;
  for (const double loss : {0.05, 0.2}) {
    ControlLoopSetting setting = loop_setting(settings, DataWay::published, 0);
    setting.disturb = fieldbus_dll::losing_frames(loss, kernel::Random(settings.seed).split("losses"));
    lossy = run_control_loop(setting);
    section.rows.push_back(loop_row(fmt::format("published, {:.0f} % of frames lost", 100 * loss), lossy));
  }
  section.figures.push_back(figure_of("The process", &fieldbus_dll::LoopPoint::process,
                                      {{"published, 20 % of frames lost", &lossy},
                                       {"published, quiet", &quiet},
                                       {"by token under bursts", &hit}},
                                      true));
  return section;
}

}  // namespace fieldproof::papers

#include "papers/window_loop.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "protocols/fieldbus_dll/function_blocks.hpp"

namespace fieldproof::papers {
namespace {

using bandwidth::LoopTraffic;
using bandwidth::Packet;
using bandwidth::Sent;
using bandwidth::WindowTraffic;
using kernel::Duration;
using kernel::Time;

constexpr unsigned kPeriodsPerSetpoint = 60;
constexpr double kLag1 = 4;  // of this and below: sampling periods
constexpr double kLag2 = 1.6;
constexpr double kReset = 5.6;
constexpr double kRate = 0.4;
constexpr double kControllerGain = 1.5;
constexpr double kLowSetpoint = 40;
constexpr double kHighSetpoint = 60;
constexpr unsigned kPointsPerPeriod = 5;

// In this order at one instant: what arrives counts for the sampling.
enum class Event : std::uint8_t { order_arrives, sample_arrives, sensor, controller, point };

struct Happening {
  Time when;
  Event event;
  Time of{};  // when what arrives was generated
  friend auto operator<=>(const Happening&, const Happening&) = default;
};

double in_seconds(Duration duration) {
  return static_cast<double>(duration.count()) / 1e12;
}

// What the line does for the loop, in order.
std::vector<Happening> happenings_of(const WindowTraffic& traffic, bandwidth::Load others, unsigned periods,
                                     std::uint64_t seed) {
  const LoopTraffic& loop = traffic.loops.front();
  const Duration period = loop.every * traffic.slot;
  const Time end = kernel::kStart + std::int64_t{periods} * period;
  std::vector<Happening> all;
  for (Time at = kernel::kStart + loop.sensor_offset * traffic.slot; at < end; at += period)
    all.push_back({at, Event::sensor});
  for (Time at = kernel::kStart + loop.controller_offset * traffic.slot + loop.skew; at < end; at += period)
    all.push_back({at, Event::controller});
  for (std::int64_t n = 0; n < std::int64_t{periods} * kPointsPerPeriod; ++n)
    all.push_back({kernel::kStart + n * period / std::int64_t{kPointsPerPeriod}, Event::point});
  bandwidth::WindowRun run{.seed = seed,
                           .slots = std::uint64_t{periods} * loop.every,
                           .real_time = others,
                           .non_real_time = others};
  run.on_sent = [&](const Sent& sent) {
    if (sent.packet != Packet::periodic || sent.end >= end) return;
    if (sent.node == loop.sensor) all.push_back({sent.end, Event::sample_arrives, sent.generated});
    if (sent.node == loop.controller) all.push_back({sent.end, Event::order_arrives, sent.generated});
  };
  bandwidth::run_windows(traffic, run);
  std::ranges::sort(all);
  return all;
}

class LoopRun {
 public:
  explicit LoopRun(Duration period)
      : period_s_(in_seconds(period)),
        pid_({.gain = kControllerGain,
              .reset_s = kReset * period_s_,
              .rate_s = kRate * period_s_,
              .period_s = period_s_}),
        process_(1, kLag1 * period_s_, kLag2 * period_s_) {}

  void happen(const Happening& one) {
    advance(one.when);
    switch (one.event) {
      case Event::sensor:
        samples_.push_back({one.when, input_.execute(process_.output())});
        break;
      case Event::sample_arrives:
        arrive(signal_at(samples_, one.of));
        break;
      case Event::controller:
        control(one.when);
        break;
      case Event::order_arrives:
        move(signal_at(orders_, one.of));
        break;
      case Event::point:
        course_.points.push_back({now_s_, setpoint(), process_.output(), output_.output()});
        break;
    }
  }
  LoopCourse course() { return std::move(course_); }

 private:
  struct Kept {
    Time when;
    fieldbus_dll::Signal signal;
  };

  static fieldbus_dll::Signal signal_at(const std::vector<Kept>& kept, Time when) {
    return std::ranges::lower_bound(kept, when, {}, &Kept::when)->signal;
  }
  double setpoint() const {
    const auto steps = static_cast<std::uint64_t>(now_s_ / (kPeriodsPerSetpoint * period_s_) + 1e-9);
    return steps % 2 == 0 ? kHighSetpoint : kLowSetpoint;
  }
  void advance(Time when) {
    const double until = in_seconds(when - kernel::kStart);
    const double step = until - now_s_;
    if (step <= 0) return;
    course_.absolute_error += std::abs(setpoint() - process_.output()) * step;
    process_.advance(step, output_.output());
    now_s_ = until;
  }
  // What its successor has replaced before it was sent is lost as well.
  void arrive(const fieldbus_dll::Signal& signal) {
    course_.lost += signal.sample - newest_.sample - 1;
    newest_ = signal;
    ++arrived_;
  }
  void control(Time when) {
    if (newest_.sample == 0) return;  // nothing has ever come
    ++course_.samplings;
    if (arrived_ == 0) ++course_.vacant;
    if (arrived_ > 1) course_.lost += arrived_ - 1;
    arrived_ = 0;
    orders_.push_back({when, pid_.execute(newest_, setpoint())});
  }
  void move(const fieldbus_dll::Signal& order) {
    const double before = output_.output();
    course_.travel += std::abs(output_.execute(order) - before);
  }

  double period_s_;
  fieldbus_dll::AnalogInput input_{0, 100};
  fieldbus_dll::Pid pid_;
  fieldbus_dll::AnalogOutput output_;
  fieldbus_dll::Process process_;
  std::vector<Kept> samples_, orders_;
  fieldbus_dll::Signal newest_{};
  unsigned arrived_ = 0;
  double now_s_ = 0;
  LoopCourse course_;
};

}  // namespace

LoopCourse run_window_loop(const WindowTraffic& traffic, bandwidth::Load others, unsigned periods,
                           std::uint64_t seed) {
  LoopRun run(traffic.loops.front().every * traffic.slot);
  for (const Happening& one : happenings_of(traffic, others, periods, seed)) run.happen(one);
  return run.course();
}

}  // namespace fieldproof::papers

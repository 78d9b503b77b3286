#include "protocols/fieldbus_dll/control_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "protocols/fieldbus_dll/function_blocks.hpp"
#include "protocols/fieldbus_dll/relationships.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::uint8_t kScheduler = 0x10;
constexpr std::uint8_t kFirstTalker = 0x11;
constexpr std::uint8_t kTalkers = 8;
constexpr std::uint8_t kTransmitter = 0x20;
constexpr std::uint8_t kController = 0x21;
constexpr std::uint8_t kValve = 0x22;
constexpr std::uint8_t kOperator = 0x23;
constexpr std::uint8_t kSelector = 0x20;

constexpr std::size_t kMessageOctets = 128;
constexpr std::uint64_t kMostMessages = 64;

// Where in a period, in twentieths, which block runs.
constexpr unsigned kSteps = 20;
constexpr unsigned kInputStep = 0;
constexpr unsigned kPidStep = 10;
constexpr unsigned kOutputStep = 19;
constexpr unsigned kStepsPerPoint = 2;

// The process, its controller and what is asked of it.
constexpr double kGain = 1;
constexpr double kLag1 = 1;  // s
constexpr double kLag2 = 0.4;
constexpr double kControllerGain = 1.5;
constexpr double kReset = 1.4;  // s
constexpr double kRate = 0.1;
constexpr double kLowSetpoint = 40;
constexpr double kHighSetpoint = 60;
constexpr unsigned kPeriodsPerSetpoint = 60;

// The operator: what it asks and is told, and how often.
constexpr kernel::Duration kReadEvery = kernel::kSecond;
constexpr kernel::Duration kLongestWait = 5 * kernel::kSecond;  // for a response
constexpr double kAlarmAt = (kLowSetpoint + kHighSetpoint) / 2;
constexpr std::size_t kTrendOctets = 60;

double in_seconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / 1e12;
}

void check_loop(const ControlLoopSetting& setting) {
  const auto refuse = [](const char* sentence) {
    throw kernel::Error(kernel::ErrorKind::configuration, sentence);
  };
  if (setting.bit_rate != 31'250 && setting.bit_rate != 1'000'000 && setting.bit_rate != 2'500'000)
    refuse("a line has 31250, 1000000 or 2500000 bit/s");
  const kernel::Duration period = setting.sampling_period;
  if (period < 80 * kernel::kMillisecond || period > 10 * kernel::kSecond ||
      period % (8 * kTick) != 0 * kTick)
    refuse("a sampling period is a multiple of 250 us between 80 ms and 10 s");
  if (setting.periods == 0 || setting.periods > 20'000) refuse("a control loop runs for 1 to 20000 periods");
  if (!(setting.messages_per_s >= 0 && setting.messages_per_s <= 20))
    refuse("a node sends 0 to 20 messages in a second");
}

// What one block sends another, and what of it is used.
class Hop {
 public:
  void send() { ++figures_.sent; }
  void arrive(const Signal& signal) { arrived_.push_back(signal); }

  // The newest that has come since the last call.
  std::optional<Signal> take() {
    if (arrived_.empty()) {
      if (figures_.used > 0) ++figures_.vacant;
      return std::nullopt;
    }
    const Signal newest = arrived_.back();
    ++figures_.used;
    figures_.lost += arrived_.size() - 1;
    arrived_.clear();
    return newest;
  }

  HopFigures figures() const {
    HopFigures figures = figures_;
    figures.missing = figures.sent - figures.used - figures.lost;
    return figures;
  }

 private:
  HopFigures figures_;
  std::vector<Signal> arrived_;
};

// How long what is numbered takes, by its numbers.
class Delays {
 public:
  void send(std::uint8_t number, kernel::Time now) {
    ++figures_.sent;
    sent_.at(number) = now;
  }
  void arrive(std::uint8_t number, kernel::Time now) { arrive_since(sent_.at(number), now); }
  void send() { ++figures_.sent; }
  void arrive_since(kernel::Time sent, kernel::Time now) {
    ++figures_.arrived;
    figures_.delay.add(now - sent);
  }
  RelationshipFigures figures() const {
    RelationshipFigures figures = figures_;
    figures.missing = figures.sent - figures.arrived;
    return figures;
  }

 private:
  RelationshipFigures figures_;
  std::array<kernel::Time, 256> sent_{};
};

using Send = std::function<void(const Signal&)>;

double wanted_setpoint(std::uint64_t period) {
  return period / kPeriodsPerSetpoint % 2 == 0 ? kHighSetpoint : kLowSetpoint;
}

// The blocks and the process, from twentieth to twentieth of a period.
class Loop {
 public:
  Loop(const ControlLoopSetting& setting, Send send_sample, Send send_order)
      : step_time_(setting.sampling_period / kSteps),
        pid_({.gain = kControllerGain,
              .reset_s = kReset,
              .rate_s = kRate,
              .period_s = in_seconds(setting.sampling_period)}),
        send_sample_(std::move(send_sample)),
        send_order_(std::move(send_order)) {}

  Hop& to_controller() { return to_controller_; }
  Hop& to_valve() { return to_valve_; }
  // From now on the controller knows a setpoint when it is told, not when it is wanted.
  void wait_for_setpoints() { is_told_setpoints_ = true; }
  void tell_setpoint(double setpoint) { known_setpoint_ = setpoint; }
  const Signal& measured() const { return measured_; }
  double process() const { return process_.output(); }

  // All that happens at the instant of this step, then the process until the next.
  void run(std::uint64_t step) {
    const auto place = static_cast<unsigned>(step % kSteps);
    begin_setpoint(step / kSteps);
    if (place == kInputStep) measure(step);
    if (place == kPidStep) control(step);
    if (place == kOutputStep) move_valve(step);
    if (step % kStepsPerPoint == 0) {
      const double time = in_seconds(static_cast<std::int64_t>(step) * step_time_);
      found_.course.push_back({time, setpoint_, process_.output(), output_.output()});
    }
    process_.advance(in_seconds(step_time_), output_.output());
    judge();
  }

  ControlLoop found() {
    found_.to_controller = to_controller_.figures();
    found_.to_valve = to_valve_.figures();
    return std::move(found_);
  }

 private:
  void begin_setpoint(std::uint64_t period) {
    const double wanted = wanted_setpoint(period);
    if (wanted == setpoint_) return;
    step_ = wanted - setpoint_;
    setpoint_ = wanted;
    if (!is_told_setpoints_) known_setpoint_ = wanted;
  }

  void measure(std::uint64_t step) {
    const Signal sample = input_.execute(process_.output());
    sampled_.push_back(step);
    to_controller_.send();
    send_sample_(sample);
  }

  void control(std::uint64_t step) {
    if (const auto newest = to_controller_.take()) {
      measured_ = *newest;
      found_.delay_to_controller.add(since_sample(measured_, step));
    }
    if (measured_.sample == 0) return;  // nothing has ever come
    to_valve_.send();
    send_order_(pid_.execute(measured_, known_setpoint_));
  }

  void move_valve(std::uint64_t step) {
    const auto newest = to_valve_.take();
    if (!newest) return;
    found_.loop_delay.add(since_sample(*newest, step));
    const double before = output_.output();
    found_.valve_travel += std::abs(output_.execute(*newest) - before);
  }

  void judge() {
    const double error = setpoint_ - process_.output();
    found_.absolute_error += std::abs(error) * in_seconds(step_time_);
    found_.overshoot = std::max(found_.overshoot, -100 * error / step_);
  }

  kernel::Duration since_sample(const Signal& signal, std::uint64_t step) const {
    return static_cast<std::int64_t>(step - sampled_.at(signal.sample - 1)) * step_time_;
  }

  kernel::Duration step_time_;
  AnalogInput input_{0, 100};
  Pid pid_;
  AnalogOutput output_;
  Process process_{kGain, kLag1, kLag2};
  Send send_sample_, send_order_;
  Hop to_controller_, to_valve_;
  Signal measured_;
  double setpoint_ = 0;
  double known_setpoint_ = 0;  // to the controller
  bool is_told_setpoints_ = false;
  double step_ = 0;                     // of the setpoint, the last
  std::vector<std::uint64_t> sampled_;  // in which step, by sample
  ControlLoop found_;
};

// The application of controller and valve: what arrives is new once.
class Inbox final : public FfSilentUser {
 public:
  explicit Inbox(Hop& hop) : hop_(hop) {}
  void on_data(const FfDlpdu& dlpdu, kernel::Time) override { put(dlpdu); }
  void on_published(const FfDlpdu& dlpdu, kernel::Time) override {
    if (std::exchange(writes_, dlpdu.writes) != dlpdu.writes) put(dlpdu);
  }

 private:
  void put(const FfDlpdu& dlpdu) {
    if (const auto signal = signal_of(dlpdu.data)) hop_.arrive(*signal);
  }

  Hop& hop_;
  std::optional<std::uint8_t> writes_;
};

// What the operator asks and is told, beside the loop.
class Operation {
 public:
  using SubmitAt = std::function<bool(std::uint8_t node, const FfRequest& request)>;

  Operation(Loop& loop, FfUser& rest_of_controller, FfUser& nobody, const SubmitAt& submit)
      : loop_(loop),
        transmitter_(submitting(submit, kTransmitter), nobody),
        controller_(submitting(submit, kController), rest_of_controller),
        operator_(submitting(submit, kOperator), nobody) {
    controller_.serve([this](std::uint8_t, const Octets& request, kernel::Time) { return serve(request); });
    operator_.on_response([this](const Relationships::Response& one) {
      requests_.arrive_since(one.asked, one.came);
      if (written_) setpoint_ = *std::exchange(written_, std::nullopt);
    });
    operator_.on_report([this](const Relationships::Report& one) {
      (one.priority == Priority::urgent ? alarms_ : trends_).arrive(one.number, one.came);
    });
  }

  Relationships& transmitter() { return transmitter_; }
  Relationships& controller() { return controller_; }
  Relationships& at_operator() { return operator_; }

  // Before the blocks of this instant, `since` the loop began.
  void run(std::uint64_t period, kernel::Duration since, kernel::Time now) {
    if (operator_.give_up(kLongestWait, now) > 0) written_.reset();
    // Written again until the controller has confirmed it.
    if (const double wanted = wanted_setpoint(period);
        wanted != setpoint_ && ask({.value = static_cast<float>(wanted), .status = SignalStatus::good}, now))
      written_ = wanted;
    if (since >= next_read_) {
      // Where the last one still waits, it is not asked again.
      ask({}, now);
      report(trends_, Priority::time_available, Octets(kTrendOctets, 0), now);
      next_read_ += kReadEvery;
    }
    const bool is_high = loop_.process() >= kAlarmAt;
    if (is_high != was_high_) report(alarms_, Priority::urgent, octets_of(Signal{}), now);
    was_high_ = is_high;
  }

  void tell(ControlLoop& found) const {
    found.requests = requests_.figures();
    found.alarms = alarms_.figures();
    found.trends = trends_.figures();
  }

 private:
  static Relationships::Submit submitting(const SubmitAt& submit, std::uint8_t node) {
    return [submit, node](const FfRequest& request) { return submit(node, request); };
  }

  // A good value is a setpoint, another signal asks for the value that is known.
  Octets serve(const Octets& request) {
    const auto signal = signal_of(request);
    if (signal && signal->status == SignalStatus::good) loop_.tell_setpoint(signal->value);
    return octets_of(loop_.measured());
  }

  bool ask(const Signal& signal, kernel::Time now) {
    if (!operator_.request(kController, octets_of(signal), now)) return false;
    requests_.send();
    return true;
  }

  void report(Delays& delays, Priority priority, const Octets& data, kernel::Time now) {
    if (const auto number = transmitter_.report(priority, data)) delays.send(*number, now);
  }

  Loop& loop_;
  Relationships transmitter_, controller_, operator_;
  Delays requests_, alarms_, trends_;
  double setpoint_ = 0;            // that the controller has confirmed
  std::optional<double> written_;  // for which no response has come yet
  kernel::Duration next_read_{};
  bool was_high_ = false;
};

// A node that sends messages to its neighbour.
struct Talker {
  std::uint8_t node;
  traffic::PoissonArrivals arrivals;
  std::uint64_t submitted = 0;
};

class LoopOnLink {
 public:
  explicit LoopOnLink(const ControlLoopSetting& setting)
      : setting_(setting),
        random_(setting.seed),
        link_(rules(), random_.split("link"), setting.disturb),
        loop_(setting, sender(kTransmitter, kController), sender(kController, kValve)) {
    link_.on_driven([this](const FfDriven& one) {
      if (one.dlpdu.type == FfType::pt) note_token(one.dlpdu.node, one.begin);
      if (one.dlpdu.type == FfType::dt1) ++driven_[one.node];
    });
    link_.add_master(configuration(kScheduler), nobody_);
    for (std::uint8_t n = 0; n < kTalkers; ++n) {
      const auto node = static_cast<std::uint8_t>(kFirstTalker + n);
      link_.add_device(configuration(node), nobody_);
      talkers_.push_back({node, {setting.messages_per_s / 1'000, random_.split("messages").split(n)}});
    }
    const bool is_operated = setting_.has_operator;
    link_.add_device(configuration(kTransmitter), is_operated ? operation_.transmitter() : nobody_as_user());
    link_.add_device(configuration(kController),
                     is_operated ? operation_.controller() : controller_as_user());
    link_.add_device(configuration(kValve), valve_);
    if (!is_operated) return;
    link_.add_device(configuration(kOperator), operation_.at_operator());
    loop_.wait_for_setpoints();
  }

  ControlLoop run() {
    // A macrocycle begins whenever link time is a multiple of it.
    const std::int64_t cycles =
        (loop_begin(setting_.bit_rate) + setting_.sampling_period - kernel::Duration{1}) /
        setting_.sampling_period;
    const kernel::Time begin = kernel::kStart + cycles * setting_.sampling_period;
    run_to(begin);
    check_all_live();
    longest_without_token_ = {};
    for (std::uint64_t step = 0; step < std::uint64_t{setting_.periods} * kSteps; ++step) {
      const kernel::Duration since = static_cast<std::int64_t>(step) * (setting_.sampling_period / kSteps);
      run_to(begin + since);
      if (setting_.has_operator) operation_.run(step / kSteps, since, begin + since);
      loop_.run(step);
    }
    ControlLoop found = loop_.found();
    operation_.tell(found);
    found.longest_without_token = longest_without_token_;
    return found;
  }

 private:
  FfRules rules() const {
    FfRules rules;
    rules.link.bit_rate = setting_.bit_rate;
    rules.target_rotation = setting_.target_rotation;
    return rules;
  }

  FfConfiguration configuration(std::uint8_t node) const {
    FfConfiguration configuration;
    configuration.rules = rules();
    configuration.node = node;
    if (node == kTransmitter || node == kController) configuration.published = {address_of(node, kSelector)};
    if (node == kController) configuration.subscribed = {address_of(kTransmitter, kSelector)};
    if (node == kValve) configuration.subscribed = {address_of(kController, kSelector)};
    if (node != kScheduler) return configuration;
    configuration.begins_as_scheduler = true;
    const auto ticks = static_cast<std::uint32_t>(setting_.sampling_period / kTick);
    configuration.schedule = {.version = 1, .macrocycle = ticks, .items = {}};
    if (setting_.way == DataWay::published) {
      configuration.schedule.items = {{ticks / 8, address_of(kTransmitter, kSelector), Priority::normal},
                                      {ticks / 8 * 5, address_of(kController, kSelector), Priority::normal}};
    }
    return configuration;
  }

  Send sender(std::uint8_t from, std::uint8_t to) {
    return [this, from, to](const Signal& signal) {
      if (setting_.way == DataWay::published) {
        link_.write(from, address_of(from, kSelector), octets_of(signal));
      } else {
        link_.submit(from, {Priority::urgent, address_of(to, kSelector), octets_of(signal)});
      }
    };
  }

  FfUser& nobody_as_user() { return nobody_; }
  FfUser& controller_as_user() { return controller_; }

  void note_token(std::uint8_t node, kernel::Time when) {
    const bool is_new = live_.insert(node).second;
    if (node != kTransmitter) return;
    if (!is_new) longest_without_token_ = std::max(longest_without_token_, when - last_token_);
    last_token_ = when;
  }

  // With what talkers want to say meanwhile.
  void run_to(kernel::Time time) {
    while (true) {
      const auto next =
          std::ranges::min_element(talkers_, {}, [](const Talker& talker) { return talker.arrivals.next(); });
      if (next->arrivals.next() > time) break;
      link_.run_to(next->arrivals.next());
      talk(*next);
    }
    link_.run_to(time);
  }

  void talk(Talker& talker) {
    talker.arrivals.draw();
    if (talker.submitted - driven_[talker.node] >= kMostMessages) return;
    ++talker.submitted;
    const auto neighbour =
        static_cast<std::uint8_t>(kFirstTalker + (talker.node - kFirstTalker + 1) % kTalkers);
    link_.submit(talker.node, {Priority::time_available, address_of(neighbour, kSelector),
                               Octets(kMessageOctets, talker.node)});
  }

  void check_all_live() const {
    const std::uint8_t last = setting_.has_operator ? kOperator : kValve;
    for (std::uint8_t node = kFirstTalker; node <= last; ++node) {
      const bool is_used = node < kFirstTalker + kTalkers || node >= kTransmitter;
      if (is_used && !live_.contains(node)) {
        throw kernel::Error(
            kernel::ErrorKind::configuration,
            "not every node is live when the loop begins: the line is disturbed, or has too little time "
            "beside the schedule and the messages");
      }
    }
  }

  ControlLoopSetting setting_;
  kernel::Random random_;
  FfSilentUser nobody_;
  FfLink link_;
  Loop loop_;
  Inbox controller_{loop_.to_controller()};
  Inbox valve_{loop_.to_valve()};
  Operation operation_{loop_, controller_, nobody_, [this](std::uint8_t node, const FfRequest& request) {
                         return link_.submit(node, request);
                       }};
  std::vector<Talker> talkers_;
  std::map<std::uint8_t, std::uint64_t> driven_;  // DT1, by node
  std::set<std::uint8_t> live_;                   // had the token once
  kernel::Time last_token_{};                     // of the transmitter
  kernel::Duration longest_without_token_{};
};

}  // namespace

std::string_view text_of(DataWay way) {
  return way == DataWay::published ? "published" : "by token";
}

ControlLoop run_control_loop(const ControlLoopSetting& setting) {
  check_loop(setting);
  return LoopOnLink(setting).run();
}

ControlLoop run_loop_without_bus(const ControlLoopSetting& setting) {
  check_loop(setting);
  Loop* self = nullptr;
  Loop loop(
      setting, [&self](const Signal& sample) { self->to_controller().arrive(sample); },
      [&self](const Signal& order) { self->to_valve().arrive(order); });
  self = &loop;
  for (std::uint64_t step = 0; step < std::uint64_t{setting.periods} * kSteps; ++step) loop.run(step);
  return loop.found();
}

}  // namespace fieldproof::fieldbus_dll

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/line_watch.hpp"
#include "conformance/stressed_receiver.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/plan.hpp"
#include "harness/judge/pics.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "harness/trace/recording.hpp"

// The bench of one station on a shared line: the implementation under test (IUT), and the lower tester in the
// place of all others. A protocol's bench adds the upper side and what the tester can send and expect.
//
// A `Configuration` has `rules`, these a `bit_rate`.
namespace fieldproof::conformance {

// Who plays, and how.
template <typename Device, typename Configuration>
struct BusSetting {
  using Rules = decltype(Configuration::rules);

  std::function<std::unique_ptr<Device>(const Configuration&)> make_device{};
  std::uint64_t seed = 1;
  Volume volume = Volume::full;
  std::optional<judge::Pics> pics{};
  fault::Plan plan{};
  std::span<const fault::Stress> stresses{};
  // Makes the recorder of the bench's trace; null: nothing is recorded. It must outlive the bench.
  std::function<trace::Recorder*(const trace::Trace&, const Rules&)> make_recorder{};
};

template <typename Device, typename Configuration>
class BusBench : private segment::Station, private segment::Tap {
 public:
  using Setting = BusSetting<Device, Configuration>;

  // `role` names the place of the IUT: "node".
  BusBench(const std::string& role, const Configuration& configuration, const Setting& setting,
           segment::ContentionRule rule = segment::ContentionRule::noise)
      : configuration_(configuration),
        volume_(setting.volume),
        random_(setting.seed),
        line_(segment_, "line", rule, random_),
        device_(setting.make_device(configuration)),
        line_watch_(kernel::levels_duration(1, configuration.rules.bit_rate)),
        stressed_(setting.stresses) {
    tester_ = &line_.attach("tester/in", segment_.attach(*this, "tester"), 0, {});
    device_seat_ = segment_.attach(*device_, role);
    place_ = &line_.attach(role + "/in", device_seat_, 0, {});
    if (setting.make_recorder)
      segment_.trace().set_recorder(setting.make_recorder(segment_.trace(), configuration.rules));
    place_->tap_driven(*this);
    line_watch_.watch(*place_, segment_.trace());
    if (setting.plan.empty()) return;
    plan_ = std::make_unique<fault::InstalledPlan>(setting.plan, segment_.trace(), random_.split("plan"));
    place_->set_channel(
        plan_->channel_for({role + "/in", place_->trace_channel(), configuration.rules.bit_rate}));
  }

  segment::Segment& segment() { return segment_; }
  kernel::Time now() const { return segment_.now(); }
  kernel::Random& random() { return random_; }
  std::uint8_t random_octet() { return static_cast<std::uint8_t>(random_.below(256)); }
  template <typename Count>
  Count volume(Count quick, Count full) const {
    return volume_ == Volume::quick ? quick : full;
  }
  const Configuration& configuration() const { return configuration_; }

  // ---- stress ----
  std::span<const fault::Stress> stresses() const { return stressed_.stresses(); }
  // The n-th of a case has the n-th disturbances.
  void begin_stress(const fault::Stress& stress) {
    stressed_.begin(stress, *place_,
                    {configuration_.rules.bit_rate, now(), random_.split("stress").split(stress_number_++),
                     segment_.trace(), place_->trace_channel()});
  }
  void end_stress() { stressed_.end(); }

  // ---- the end of a case ----
  const LineWatch& line_watch() const { return line_watch_; }
  void finish() { device_->end(); }
  std::vector<std::uint64_t> planned_hits() const {
    return plan_ ? plan_->hits_of_parts() : std::vector<std::uint64_t>{};
  }

 protected:
  // The tester drives it, and runs until it is over. Gives that instant.
  kernel::Time send(line::Waveform wave) {
    const kernel::Time end = wave.end();
    tester_->drive(wave);
    segment_.run_until(end);
    return end;
  }
  Device& device() { return *device_; }
  segment::MediumPort& place() { return *place_; }
  segment::MediumPort& tester() { return *tester_; }
  // The IUT was told something from outside of the line.
  void refresh_device() { segment_.refresh(device_seat_); }
  // What the IUT has driven since then.
  const std::vector<line::Waveform>& driven() const { return driven_; }
  void clear_driven() { driven_.clear(); }

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
  void on_wave(const line::Waveform& wave) override { driven_.push_back(wave); }

  Configuration configuration_;
  Volume volume_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  std::unique_ptr<Device> device_;
  LineWatch line_watch_;
  std::unique_ptr<fault::InstalledPlan> plan_;
  StressedReceiver stressed_;
  std::uint64_t stress_number_ = 0;
  std::size_t device_seat_ = 0;
  segment::MediumPort* tester_ = nullptr;
  segment::MediumPort* place_ = nullptr;
  std::vector<line::Waveform> driven_;
};

}  // namespace fieldproof::conformance

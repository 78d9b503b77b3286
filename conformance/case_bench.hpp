#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/line_watch.hpp"
#include "conformance/stressed_receiver.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/known_names.hpp"
#include "harness/fault/plan.hpp"
#include "harness/field/settings.hpp"
#include "harness/judge/pics.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/segment.hpp"

// What the bench of every case has, whatever the protocol: the segment, its draws, the declared faults, the
// stresses of the case, and the watch over what is driven. Benches of a shared line add `LineBench`.
namespace fieldproof::conformance {

// Who plays, and how; a bench adds what only its role has. What stands here is the same for all.
template <typename Device, typename Configuration>
struct BenchSetting {
  using Make = std::function<std::unique_ptr<Device>(const Configuration&)>;
  using Rules = decltype(Configuration::rules);

  Make make_device{};
  std::uint64_t seed = 1;
  Volume volume = Volume::full;
  std::optional<judge::Pics> pics{};
  field::Settings settings{};  // what the configuration has otherwise than PICS and case have it
  std::span<const fault::Stress> stresses{};
  // Makes the recorder of the bench's trace; null: nothing is recorded. It must outlive the bench.
  std::function<trace::Recorder*(const trace::Trace&, const Rules&)> make_recorder{};
};

// Of a bench that puts declared faults on the line.
template <typename Device, typename Configuration>
struct PlannedSetting : BenchSetting<Device, Configuration> {
  fault::Plan plan{};
};

class CaseBench {
 public:
  CaseBench(const CaseBench&) = delete;
  CaseBench& operator=(const CaseBench&) = delete;

  segment::Segment& segment() { return segment_; }
  kernel::Time now() const { return segment_.now(); }
  void wait(kernel::Duration duration) { segment_.run_for(duration); }
  kernel::Random& random() { return random_; }
  std::uint8_t random_octet() { return static_cast<std::uint8_t>(random_.below(256)); }
  // `quick` or `full` repetitions.
  template <typename Count>
  Count volume(Count quick, Count full) const {
    return volume_ == Volume::quick ? quick : full;
  }

  // ---- stress ----
  std::span<const fault::Stress> stresses() const { return stressed_.stresses(); }
  void end_stress() { stressed_.end(); }
  std::uint64_t stressed_transmissions() const { return stressed_.changed(); }

  // ---- the end of a case ----
  std::vector<std::uint64_t> planned_hits() const {
    return plan_ ? plan_->hits_of_parts() : std::vector<std::uint64_t>{};
  }
  // What the IUT drives.
  const LineWatch& line_watch() const { return line_watch_; }

 protected:
  CaseBench(std::uint64_t seed, Volume volume, std::span<const fault::Stress> stresses, LineWatch line_watch)
      : volume_(volume), random_(seed), line_watch_(std::move(line_watch)), stressed_(stresses) {}
  ~CaseBench() = default;

  template <typename Setting, typename Rules>
  void start_recording(const Setting& setting, const Rules& rules) {
    if (setting.make_recorder) segment_.trace().set_recorder(setting.make_recorder(segment_.trace(), rules));
  }
  template <typename Line>
  void watch(Line& line) {
    line_watch_.watch(line, segment_.trace());
  }
  // Null: nothing is declared. What the plan names that is not of these is refused.
  fault::InstalledPlan* make_plan(const fault::Plan& plan, const fault::KnownNames& known) {
    fault::expect_known_names(plan, known);
    return make_plan(plan);
  }
  // The same where whoever installs it looks at its names.
  fault::InstalledPlan* make_plan(const fault::Plan& plan) {
    if (!plan.empty())
      plan_ = std::make_unique<fault::InstalledPlan>(plan, segment_.trace(), random_.split("plan"));
    return plan_.get();
  }
  // At a receiver of this rate of levels, from then on; the n-th of a case has the n-th disturbances.
  template <typename Receiver>
  void begin_stress_at(const fault::Stress& stress, Receiver& receiver, std::int64_t rate,
                       kernel::Time from) {
    stressed_.begin(stress, receiver,
                    {rate, from, random_.split("stress").split(stress_number_++), segment_.trace(),
                     receiver.trace_channel()});
  }
  bool has_been_stressed() const { return stress_number_ > 0; }

 private:
  Volume volume_;
  kernel::Random random_;
  // Lines tell the watch what is driven in their last run.
  LineWatch line_watch_;
  segment::Segment segment_;
  std::unique_ptr<fault::InstalledPlan> plan_;
  StressedReceiver stressed_;
  std::uint64_t stress_number_ = 0;
};

}  // namespace fieldproof::conformance

#pragma once

#include <array>
#include <memory>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "harness/traffic/timed_token.hpp"

// What stations of a timed token have to send: adversaries that make a rotation as long as they can, and
// queues.
namespace fieldproof::traffic {

// Always a longest frame, in each class.
std::unique_ptr<FrameSource> saturated_frames(const TimedToken& token);
// Anything from nothing to holding times that are used to the last instant.
std::unique_ptr<FrameSource> random_frames(const TimedToken& token, const kernel::Random& random);
// Class 6 uses its holding time to the last instant, and a longest frame begins then; no other class has any.
std::unique_ptr<FrameSource> class_6_to_the_last(const TimedToken& token);
// Two quiet rotations, so that the rotation timers are full. Then a station sends in `lower` until the last
// instant, and after it everybody in class 6.
std::unique_ptr<FrameSource> just_in_time(const TimedToken& token, AccessClass lower);

// The longest rotation that any of them reaches.
kernel::Duration longest_under_attack(const TimedToken& token, const kernel::Random& random,
                                      std::uint64_t rotations);

// Frames of one length that arrive at each station as a Poisson stream for each class, the oldest first.
class QueuedFrames final : public FrameSource {
 public:
  struct Settings {
    kernel::Duration frame{};
    std::array<double, kAccessClasses> per_ms{};  // at each station; 0: none of this class
    kernel::Duration bound{};                     // of which `beyond` tells
  };
  QueuedFrames(const TimedToken& token, const Settings& settings, const kernel::Random& random);

  std::optional<kernel::Duration> take(unsigned station, AccessClass access_class, kernel::Time now,
                                       kernel::Duration left) override;

  // From the arrival to the end of the transmission, ps.
  const measure::Distribution& delays(AccessClass access_class) const {
    return delays_[static_cast<std::size_t>(access_class)];
  }
  // Frames of any class that took longer than the bound.
  std::uint64_t beyond() const { return beyond_; }

 private:
  Settings settings_;
  std::array<std::vector<PoissonArrivals>, kAccessClasses> arrivals_;
  std::array<measure::Distribution, kAccessClasses> delays_;
  std::uint64_t beyond_ = 0;
};

}  // namespace fieldproof::traffic

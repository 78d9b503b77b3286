#include "harness/traffic/timed_token.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "harness/kernel/error.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::Duration;
using kernel::Time;

[[noreturn]] void refuse_token(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, sentence);
}

void check_token(const TimedToken& token) {
  if (token.stations < 2 || token.stations > kMostTimedStations) {
    refuse_token(fmt::format("a ring of {} stations cannot be simulated; one of 2 to {} can", token.stations,
                             kMostTimedStations));
  }
  if (token.pass <= Duration::zero() || token.longest_frame <= Duration::zero() ||
      token.hold < Duration::zero() ||
      std::ranges::any_of(token.targets, [](Duration target) { return target < Duration::zero(); })) {
    refuse_token(
        "the pass of a token and its longest frame take time, and no holding or target time is negative");
  }
}

// The timers of one station.
struct StationTimers {
  std::optional<Time> arrived;
  std::array<std::optional<Time>, 3> run_out{};  // of classes 4, 2 and 0; nothing: they have
};

class TimedRing {
 public:
  TimedRing(const TimedToken& token, FrameSource& source)
      : token_(token), source_(source), stations_(token.stations) {}

  TimedTokenFigures rotate(std::uint64_t visits) {
    for (std::uint64_t n = 0; n < visits; ++n) visit(static_cast<unsigned>(n % token_.stations));
    return std::move(figures_);
  }

 private:
  void visit(unsigned station) {
    StationTimers& timers = stations_[station];
    if (timers.arrived) {
      const Duration rotation = now_ - *timers.arrived;
      figures_.rotations.add(rotation);
      figures_.longest_rotation = std::max(figures_.longest_rotation, rotation);
    }
    timers.arrived = now_;
    source_.on_token(station, now_);
    serve(station, AccessClass::six, token_.hold);
    for (std::size_t n = 0; n < timers.run_out.size(); ++n) {
      if (token_.targets[n] == Duration::zero()) continue;
      const Duration left = timers.run_out[n] ? *timers.run_out[n] - now_ : Duration::zero();
      timers.run_out[n] = now_ + token_.targets[n];
      serve(station, static_cast<AccessClass>(n + 1), left);
    }
    now_ += token_.pass;
  }

  void serve(unsigned station, AccessClass access_class, Duration hold) {
    const Time end = now_ + hold;
    while (now_ < end) {
      const std::optional<Duration> frame = source_.take(station, access_class, now_, end - now_);
      if (!frame) return;
      if (*frame <= Duration::zero() || *frame > token_.longest_frame) {
        refuse_token(fmt::format("a frame of {} is none of up to {}", kernel::describe(*frame),
                                 kernel::describe(token_.longest_frame)));
      }
      now_ += *frame;
      ++figures_.frames[static_cast<std::size_t>(access_class)];
    }
  }

  const TimedToken token_;
  FrameSource& source_;
  std::vector<StationTimers> stations_;
  TimedTokenFigures figures_;
  Time now_ = kernel::kStart;
};

}  // namespace

std::string_view name_of(AccessClass access_class) {
  constexpr std::array<std::string_view, kAccessClasses> kNames{"class 6", "class 4", "class 2", "class 0"};
  return kNames.at(static_cast<std::size_t>(access_class));
}

Duration rotation_bound(const TimedToken& token) {
  check_token(token);
  const Duration held = token.hold > Duration::zero() ? token.hold + token.longest_frame : Duration::zero();
  const Duration longest_target = *std::ranges::max_element(token.targets);
  const Duration of_class_6 = token.stations * (held + token.pass);
  if (longest_target == Duration::zero()) return of_class_6;
  return std::max(of_class_6, longest_target + token.longest_frame + (token.stations - 1) * held);
}

TimedTokenFigures rotate_timed_token(const TimedToken& token, FrameSource& source, std::uint64_t visits) {
  check_token(token);
  return TimedRing(token, source).rotate(visits);
}

}  // namespace fieldproof::traffic

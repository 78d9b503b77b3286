#include "harness/traffic/token_loads.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::traffic {
namespace {

using kernel::Duration;
using kernel::Time;

using Taken = std::optional<Duration>;

// Uses a holding time so that the last frame begins when it is all but over.
Duration to_the_last(Duration left, Duration longest) {
  constexpr Duration kAllButOver = kernel::kNanosecond;
  return left <= kAllButOver ? longest : std::min(left - kAllButOver, longest);
}

template <typename Take>
class LambdaSource final : public FrameSource {
 public:
  explicit LambdaSource(Take take) : take_(std::move(take)) {}
  Taken take(unsigned station, AccessClass access_class, Time /*now*/, Duration left) override {
    return take_(station, access_class, left);
  }

 private:
  Take take_;
};

template <typename Take>
std::unique_ptr<FrameSource> source_of(Take take) {
  return std::make_unique<LambdaSource<Take>>(std::move(take));
}

class JustInTime final : public FrameSource {
 public:
  JustInTime(const TimedToken& token, AccessClass lower) : token_(token), lower_(lower) {}

  void on_token(unsigned station, Time /*now*/) override {
    if (station == 0) ++rotation_;
  }
  Taken take(unsigned station, AccessClass access_class, Time /*now*/, Duration left) override {
    constexpr unsigned kRound = 4;
    constexpr unsigned kQuiet = 2;
    const unsigned phase = rotation_ % kRound;
    if (phase < kQuiet) return std::nullopt;
    const bool is_attack = phase == kQuiet && station == 0;
    if (access_class != (is_attack ? lower_ : AccessClass::six)) return std::nullopt;
    return to_the_last(left, token_.longest_frame);
  }

 private:
  TimedToken token_;
  AccessClass lower_;
  unsigned rotation_ = ~0U;  // the first token makes it 0
};

}  // namespace

std::unique_ptr<FrameSource> saturated_frames(const TimedToken& token) {
  return source_of(
      [longest = token.longest_frame](unsigned, AccessClass, Duration) { return Taken(longest); });
}

std::unique_ptr<FrameSource> random_frames(const TimedToken& token, const kernel::Random& random) {
  return source_of([longest = token.longest_frame, random = kernel::Random(random)](
                       unsigned, AccessClass, Duration left) mutable -> Taken {
    constexpr std::uint64_t kChoices = 4;
    constexpr std::int64_t kShortest = 1'000;  // ps
    switch (random.below(kChoices)) {
      case 0:
        return std::nullopt;
      case 1:
        return to_the_last(left, longest);
      default:
        return Duration{random.between(std::min(kShortest, longest.count()), longest.count())};
    }
  });
}

std::unique_ptr<FrameSource> class_6_to_the_last(const TimedToken& token) {
  return source_of(
      [longest = token.longest_frame](unsigned, AccessClass access_class, Duration left) -> Taken {
        if (access_class != AccessClass::six) return std::nullopt;
        return to_the_last(left, longest);
      });
}

std::unique_ptr<FrameSource> just_in_time(const TimedToken& token, AccessClass lower) {
  return std::make_unique<JustInTime>(token, lower);
}

Duration longest_under_attack(const TimedToken& token, const kernel::Random& random,
                              std::uint64_t rotations) {
  std::vector<std::unique_ptr<FrameSource>> attacks;
  attacks.push_back(saturated_frames(token));
  attacks.push_back(random_frames(token, random));
  attacks.push_back(class_6_to_the_last(token));
  for (const AccessClass lower : {AccessClass::four, AccessClass::two, AccessClass::zero}) {
    attacks.push_back(just_in_time(token, lower));
  }
  Duration longest{};
  for (const auto& attack : attacks) {
    longest =
        std::max(longest, rotate_timed_token(token, *attack, rotations * token.stations).longest_rotation);
  }
  return longest;
}

QueuedFrames::QueuedFrames(const TimedToken& token, const Settings& settings, const kernel::Random& random)
    : settings_(settings) {
  for (std::size_t n = 0; n < kAccessClasses; ++n) {
    const kernel::Random of_class = random.split(name_of(static_cast<AccessClass>(n)));
    for (unsigned station = 0; station < token.stations; ++station) {
      arrivals_[n].emplace_back(settings.per_ms[n], of_class.split(station));
    }
  }
}

Taken QueuedFrames::take(unsigned station, AccessClass access_class, Time now, Duration /*left*/) {
  const auto n = static_cast<std::size_t>(access_class);
  // Those that wait are those that have come and were not drawn yet.
  PoissonArrivals& arrivals = arrivals_[n][station];
  if (arrivals.next() > now) return std::nullopt;
  const Duration delay = now + settings_.frame - arrivals.next();
  delays_[n].add(delay);
  if (delay > settings_.bound) ++beyond_;
  arrivals.draw();
  return settings_.frame;
}

}  // namespace fieldproof::traffic

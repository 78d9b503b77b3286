#include "harness/traffic/timed_token.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"
#include "harness/traffic/token_loads.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kNanosecond;
using kernel::Time;

class Source final : public FrameSource {
 public:
  using Take = std::function<std::optional<Duration>(unsigned, AccessClass, Time, Duration)>;
  explicit Source(Take take) : take_(std::move(take)) {}
  std::optional<Duration> take(unsigned station, AccessClass access_class, Time now, Duration left) override {
    return take_(station, access_class, now, left);
  }

 private:
  Take take_;
};

TimedToken ring_of(unsigned stations) {
  return {.stations = stations,
          .pass = 40 * kMicrosecond,
          .hold = 500 * kMicrosecond,
          .targets = {stations * 2 * kMillisecond, stations * 1'500 * kMicrosecond, stations * kMillisecond},
          .longest_frame = 200 * kMicrosecond};
}

constexpr double kReach = 0.94;
constexpr std::uint64_t kRotations = kernel::kIsSanitized ? 100 : 1'000;

class RingOf : public testing::TestWithParam<unsigned> {};

TEST_P(RingOf, NeverExceedsTheBoundAndReachesIt) {
  for (const bool has_class_6 : {true, false}) {
    TimedToken token = ring_of(GetParam());
    if (!has_class_6) token.hold = {};
    const Duration bound = rotation_bound(token);
    const Duration worst = longest_under_attack(token, kernel::Random(1), kRotations);
    EXPECT_LE(worst, bound);
    EXPECT_GE(static_cast<double>(worst.count()), kReach * static_cast<double>(bound.count()))
        << kernel::describe(worst) << " of " << kernel::describe(bound);
  }
}

TEST_P(RingOf, OfShortTargetsIsBoundByClass6) {
  TimedToken token = ring_of(GetParam());
  token.targets = {kMillisecond, 500 * kMicrosecond, 0 * kMicrosecond};
  token.targets[0] = std::min(token.targets[0], token.stations * token.pass);
  const Duration bound = rotation_bound(token);
  const Duration reached = longest_under_attack(token, kernel::Random(1), kRotations);
  EXPECT_LE(reached, bound);
  EXPECT_GE(static_cast<double>(reached.count()), kReach * static_cast<double>(bound.count()));
}

INSTANTIATE_TEST_SUITE_P(Stations, RingOf, testing::Values(2U, 3U, 5U, 8U, 16U, 32U, 64U));

RC_GTEST_PROP(TimedToken, NoLoadBreaksTheBound, ()) {
  const auto drawn = [](int least_us, int most_us) {
    return *rc::gen::inRange(least_us, most_us) * kMicrosecond;
  };
  TimedToken token;
  token.stations = *rc::gen::inRange(2U, 20U);
  token.pass = drawn(1, 100);
  token.longest_frame = drawn(1, 5'000);
  token.hold = *rc::gen::arbitrary<bool>() ? drawn(1, 5'000) : Duration{};
  for (Duration& target : token.targets) target = *rc::gen::arbitrary<bool>() ? drawn(1, 50'000) : Duration{};
  constexpr std::uint64_t kFewRotations = 50;
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  RC_ASSERT(longest_under_attack(token, random, kFewRotations) <= rotation_bound(token));
}

// ---- the rules one by one ----

struct Sent {
  unsigned station;
  AccessClass access_class;
  std::int64_t at_us;
  bool operator==(const Sent&) const = default;
};

std::vector<Sent> sent_of(const TimedToken& token, Duration frame, std::uint64_t visits,
                          Source::Take wanted) {
  std::vector<Sent> sent;
  Source source(
      [&](unsigned station, AccessClass access_class, Time now, Duration left) -> std::optional<Duration> {
        if (wanted && !wanted(station, access_class, now, left)) return std::nullopt;
        sent.push_back({station, access_class, (now - kernel::kStart) / kMicrosecond});
        return frame;
      });
  rotate_timed_token(token, source, visits);
  return sent;
}

TimedToken small_ring() {
  return {.stations = 2,
          .pass = 10 * kMicrosecond,
          .hold = 100 * kMicrosecond,
          .longest_frame = 40 * kMicrosecond};
}

TEST(TimedToken, Class6CompletesTheFrameThatBeganInTime) {
  // At 0, 40 and 80 us; the last one ends 20 us after the holding time.
  const std::vector<Sent> expected{{0, AccessClass::six, 0},   {0, AccessClass::six, 40},
                                   {0, AccessClass::six, 80},  {1, AccessClass::six, 130},
                                   {1, AccessClass::six, 170}, {1, AccessClass::six, 210}};
  EXPECT_EQ(sent_of(small_ring(), 40 * kMicrosecond, 2, {}), expected);
}

// Measured from service to service of the class: the time that class 6 takes at the same visit is not part of
// it.
TEST(TimedToken, LowerClassHasWhatItsTimerHasLeft) {
  TimedToken token = small_ring();
  token.hold = {};
  token.targets = {100 * kMicrosecond, Duration{}, Duration{}};
  const auto sent = sent_of(token, 40 * kMicrosecond, 4, {});
  // First visits find the timers run out. At 20 us station 0 has 80 us left: frames at 20 and 60; station 1,
  // at 110 us, had loaded its timer at 10 us: it has run out.
  const std::vector<Sent> expected{{0, AccessClass::four, 20}, {0, AccessClass::four, 60}};
  EXPECT_EQ(sent, expected);
}

TEST(TimedToken, AClassWithoutATargetIsNeverServed) {
  TimedToken token = small_ring();
  token.hold = {};
  EXPECT_TRUE(sent_of(token, 40 * kMicrosecond, 10, {}).empty());
}

// Far below what the token carries, a frame waits half an empty rotation on average, and none longer than the
// bound.
TEST(TimedToken, RareFramesWaitHalfAnEmptyRotation) {
  TimedToken token = ring_of(10);
  QueuedFrames frames(token, {.frame = 100 * kMicrosecond, .per_ms = {1e-2}}, kernel::Random(3));
  const TimedTokenFigures it = rotate_timed_token(token, frames, 4'000'000);
  const measure::Distribution& delays = frames.delays(AccessClass::six);
  const double half = 0.5 * 10 * 40e6;
  EXPECT_NEAR(delays.mean(), half + 100e6, 0.03 * half);
  EXPECT_LE(Duration{delays.max()}, rotation_bound(token) + 100 * kMicrosecond);
  EXPECT_EQ(it.frames[0], delays.count());
  EXPECT_EQ(it.frames[1] + it.frames[2] + it.frames[3], 0U);
}

TEST(TimedToken, RefusesWhatIsNoRing) {
  Source source([](unsigned, AccessClass, Time, Duration) { return std::nullopt; });
  for (const auto& change : std::vector<std::function<void(TimedToken&)>>{
           [](TimedToken& token) { token.stations = 1; }, [](TimedToken& token) { token.stations = 1'001; },
           [](TimedToken& token) { token.pass = {}; }, [](TimedToken& token) { token.longest_frame = {}; },
           [](TimedToken& token) { token.hold = -kMicrosecond; }}) {
    TimedToken token = small_ring();
    change(token);
    EXPECT_THROW(rotate_timed_token(token, source, 10), kernel::Error);
    EXPECT_THROW(rotation_bound(token), kernel::Error);
  }
  Source too_long([](unsigned, AccessClass, Time, Duration) { return 41 * kMicrosecond; });
  EXPECT_THROW(rotate_timed_token(small_ring(), too_long, 10), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::traffic

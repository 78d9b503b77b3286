#include "emc/burst_clamp.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/profile.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kStart;
using kernel::Time;
using measure::Phase;

constexpr Duration kRecovery = 4 * kMillisecond;

// A ring of the paper's network that is in the clamp and never runs.
struct Clamped {
  explicit Clamped(std::uint64_t seed, Time on)
      : network(interbus::paper_network()),
        clamp({}, LineResponse(Profile::named("A").coupling).wrong_output(1000, Polarity::positive),
              kernel::Random(seed), kRecovery) {
    clamp.couple(network, on);
  }

  interbus::RunningNetwork network;
  BurstClamp clamp;
};

TEST(BurstClamp, HoldsTheRemoteBusAndNoLocalBus) {
  Clamped clamped(1, kStart);
  EXPECT_EQ(clamped.network.ring().size(), 3U);
  EXPECT_EQ(clamped.network.ring().remote_links().size(), 2U) << "to and from the coupler";
  EXPECT_EQ(clamped.clamp.channels().size(), 2U);
  clamped.clamp.couple(clamped.network, kStart);
  EXPECT_EQ(clamped.clamp.channels().size(), 2U) << "what was coupled before is forgotten";
}

RC_GTEST_PROP(BurstClampPhases, AreThoseOfTheWindowsOneByOne, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 100);
  const Time on = kStart + *rc::gen::inRange<std::int64_t>(0, 1000) * kMillisecond;
  Clamped clamped(seed, on);
  BurstSchedule asked = clamped.clamp.channels().front().schedule();
  std::vector<BurstSchedule::Window> windows;
  for (Time pulse = asked.first_from(on); pulse < on + 3'000 * kMillisecond;
       pulse = asked.first_from(windows.back().to + asked.timing().jitter)) {
    windows.push_back(asked.window_of(pulse));
  }
  for (int n = 0; n < 50; ++n) {
    const Time from = on + *rc::gen::inRange<std::int64_t>(-100'000, 2'500'000) * kMicrosecond;
    const Time to = from + *rc::gen::inRange<std::int64_t>(1, 50'000) * kMicrosecond;
    Phase expected = Phase::quiet;
    for (const auto& window : windows) {
      const bool is_recovery = window.to + kRecovery > from && window.to < to;
      if (window.from < to && window.to > from) {
        expected = Phase::burst;
        break;
      }
      if (is_recovery) expected = Phase::recovery;
    }
    RC_ASSERT(clamped.clamp.phase_during(from, to) == expected);
  }
}

RC_GTEST_PROP(BurstClampSpans, TheBurstAfterAnInstantIsTheFirstWindowThatEndsThen, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 100);
  const Time on = kStart + *rc::gen::inRange<std::int64_t>(0, 1000) * kMillisecond;
  Clamped clamped(seed, on);
  BurstSchedule asked = clamped.clamp.channels().front().schedule();
  std::vector<BurstSchedule::Window> windows;
  for (Time pulse = asked.first_from(on); pulse < on + 3'000 * kMillisecond;
       pulse = asked.first_from(windows.back().to + asked.timing().jitter)) {
    windows.push_back(asked.window_of(pulse));
  }
  // At the edges of windows, and anywhere.
  std::vector<Time> instants;
  for (const auto& window : windows) {
    for (const Time edge : {window.from, window.to}) {
      for (const int by : {-1, 0, 1}) instants.push_back(edge + Duration{by});
    }
  }
  for (int n = 0; n < 20; ++n)
    instants.push_back(on + *rc::gen::inRange<std::int64_t>(-100'000, 2'500'000) * kMicrosecond);
  for (const Time after : instants) {
    const auto wanted = std::ranges::find_if(windows, [after](const auto& one) { return one.to > after; });
    if (wanted == windows.end()) continue;
    const auto found = clamped.clamp.burst_after(after);
    RC_ASSERT(found.has_value());
    RC_ASSERT(found->from == wanted->from && found->to == wanted->to);
  }
}

}  // namespace
}  // namespace fieldproof::emc

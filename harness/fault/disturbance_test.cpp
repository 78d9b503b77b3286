// Subject: the disturbances of an installed plan, with a model of the test. How a file writes them is a
// matter of plan_file_test, what the real models do one of those who have them.
#include "harness/fault/disturbance.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/fault/plan.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::fault {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;

constexpr std::int64_t kBitRate = 1'000'000;
constexpr std::size_t kLevels = 6;

// Flips a level that is drawn anew each time, and tells the trace.
class FlipsOne final : public Channel {
 public:
  explicit FlipsOne(const StressPlace& place) : place_(place) {}
  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    EXPECT_EQ(place_.bit_rate, kBitRate);
    arrivals.add(sent);
    arrivals.back().levels.flip(place_.random.below(kLevels));
    place_.trace.fault(place_.channel, sent.start, "flipped");
    return true;
  }

 private:
  StressPlace place_;
};

Disturbance flips_one(const std::string& receiver = "*") {
  const auto make_channel = [](const StressPlace& place) { return std::make_unique<FlipsOne>(place); };
  return {.receiver = receiver, .model = {"flips_one", "{}", make_channel}};
}

// The receivers "a" and "b" of a plan.
class TwoReceivers {
 public:
  explicit TwoReceivers(Plan plan, std::uint64_t seed = 1, std::uint64_t most_work = PlanWork::kMostSteps)
      : a_(trace.add_channel("a")),
        b_(trace.add_channel("b")),
        installed_(std::move(plan), trace, kernel::Random(seed), most_work),
        a(installed_.channel_for({"a", a_, kBitRate})),
        b(installed_.channel_for({"b", b_, kBitRate})) {}

  // What comes of six low levels; "as sent", or the levels that arrive.
  static std::string passed(Channel* channel, Duration start = {}) {
    line::Waveform sent{kStart + start, kBitRate, {}};
    sent.levels.append_fill(false, kLevels);
    line::Waveforms arrivals;
    if (channel == nullptr || !channel->pass(sent, arrivals)) return "as sent";
    std::string levels;
    for (const line::Waveform& arrival : arrivals) levels += arrival.levels.text();
    return levels;
  }

  trace::Trace trace;

 private:
  trace::Channel a_;
  trace::Channel b_;
  InstalledPlan installed_;

 public:
  Channel* a;
  Channel* b;
};

TEST(PlanWithDisturbances, MakesAChannelForTheReceiversThatAreMeant) {
  TwoReceivers line(Plan().add(flips_one("b")));
  EXPECT_EQ(line.a, nullptr);
  EXPECT_NE(TwoReceivers::passed(line.b), "as sent");
}

TEST(PlanWithDisturbances, DisturbsWhatBeginsWithinTheWindow) {
  Disturbance disturbance = flips_one();
  disturbance.from = kStart + 10 * kMicrosecond;
  disturbance.to = kStart + 20 * kMicrosecond;
  TwoReceivers line(Plan().add(disturbance));
  EXPECT_EQ(TwoReceivers::passed(line.a, 10 * kMicrosecond - kPicosecond), "as sent");
  EXPECT_NE(TwoReceivers::passed(line.a, 10 * kMicrosecond), "as sent");
  EXPECT_NE(TwoReceivers::passed(line.a, 20 * kMicrosecond - kPicosecond), "as sent");
  EXPECT_EQ(TwoReceivers::passed(line.a, 20 * kMicrosecond), "as sent");
}

TEST(PlanWithDisturbances, CountsWhatEachOfThemChangesAtAllReceivers) {
  trace::Trace trace;
  InstalledPlan installed(Plan().add(flips_one()).add(flips_one("b")).add(flips_one("c")), trace,
                          kernel::Random(1));
  Channel* const a = installed.channel_for({"a", trace.add_channel("a"), kBitRate});
  Channel* const b = installed.channel_for({"b", trace.add_channel("b"), kBitRate});
  for (Channel* channel : {a, b, b}) TwoReceivers::passed(channel);
  EXPECT_EQ(installed.changes(0), 3U);
  EXPECT_EQ(installed.changes(1), 2U);
  EXPECT_EQ(installed.changes(2), 0U);
}

TEST(PlanWithDisturbances, AsksTheRulesFirst) {
  Rule drop;
  drop.effect = Drop{};
  TwoReceivers line(Plan().add(flips_one()).add(drop));
  EXPECT_EQ(TwoReceivers::passed(line.a), "");
  EXPECT_EQ(line.trace.record_count(), 1U) << "what is lost is not disturbed";
}

TEST(PlanWithDisturbances, CanBeTooHeavy) {
  TwoReceivers line(Plan().add(flips_one()), 1, 100);
  // One question, one record of 16 steps, one word that arrives.
  for (int n = 0; n < 5; ++n) TwoReceivers::passed(line.a);
  EXPECT_THROW(TwoReceivers::passed(line.a), PlanTooHeavy);
}

TEST(PlanWithDisturbances, HasAModelForEach) {
  EXPECT_THROW(TwoReceivers(Plan().add(Disturbance{})), kernel::BrokenInvariant);
}

TEST(PlanWithDisturbances, HasOneGeneratorForAllReceiversOfADisturbance) {
  int equal = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    TwoReceivers one(Plan().add(flips_one()), seed);
    EXPECT_EQ(TwoReceivers::passed(one.a), TwoReceivers::passed(one.b));
    TwoReceivers two(Plan().add(flips_one("a")).add(flips_one("b")), seed);
    equal += TwoReceivers::passed(two.a) == TwoReceivers::passed(two.b) ? 1 : 0;
  }
  EXPECT_TRUE(equal > 3 && equal < 35) << equal;  // one of six
}

}  // namespace
}  // namespace fieldproof::fault

#include "harness/network/exchange_statistics.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace fieldproof::network {
namespace {

// One output, that shows what it is told to, and one input with an image.
class TwoWords final : public Network {
 public:
  TwoWords() {
    signals_ = {{.name = "output", .is_output = true, .safe_value = std::uint16_t{0}, .admissible_words = 2},
                {.name = "input", .is_image = true}};
  }

  const std::string& name() const override { return name_; }
  segment::Segment& segment() override { return segment_; }
  void start() override {}
  void stop() override {}
  State state() const override { return State::exchanging; }
  kernel::Duration bring_up_limit() const override { return kernel::kSecond; }
  std::span<const Place> places() const override { return {}; }
  std::span<const CycleKind> cycles() const override { return {}; }
  RecoveryLimit recovery_limit() const override { return {}; }
  std::vector<ProtectedFrame> protected_frames() const override { return {}; }
  std::span<const Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override { given.at(signal) = word; }
  void set_source_function(std::size_t, std::function<std::uint16_t(kernel::Time)>) override {}
  std::uint16_t image(std::size_t) const override { return image_; }
  std::vector<CopiedPath> paths() const override { return {}; }
  void watch(ExchangeWatcher&) override {}
  void end() override {}

  std::array<std::uint16_t, 2> given{};
  std::uint16_t image_ = 0;

 private:
  std::string name_ = "two words";
  segment::Segment segment_;
  std::vector<Signal> signals_;
};

class ExchangeStatisticsTest : public testing::Test {
 protected:
  void SetUp() override {
    exchange();
    statistics_.begin();
  }
  void exchange(Outcome outcome = Outcome::served, ExchangeKind kind = ExchangeKind::data) {
    statistics_.on_exchange({.kind = kind, .outcome = outcome, .signal_count = 2}, LineEffect::untouched);
  }
  void show(std::uint16_t word) { statistics_.on_shown(0, word, kernel::kStart); }
  void deliver() {
    show(network_.given[0]);
    network_.image_ = network_.given[1];
  }

  TwoWords network_;
  ExchangeStatistics statistics_{network_, kernel::Random(3)};
};

TEST_F(ExchangeStatisticsTest, WordsThatArriveAreRight) {
  for (int n = 0; n < 100; ++n) {
    deliver();
    exchange();
  }
  EXPECT_EQ(statistics_.counts().sent, 100U);
  EXPECT_EQ(statistics_.good_exchanges(), 101U) << "with the one before the count began";
  EXPECT_EQ(statistics_.counts().accepted_wrong() + statistics_.counts().missed_outputs, 0U);
}

TEST_F(ExchangeStatisticsTest, WhatNobodySentIsWrongAndCountsOncePerExchange) {
  show(static_cast<std::uint16_t>(network_.given[0] ^ 0x0100));
  network_.image_ = static_cast<std::uint16_t>(network_.given[1] ^ 1);
  exchange();
  EXPECT_EQ(statistics_.counts().accepted_wrong_outputs, 1U);
  EXPECT_EQ(statistics_.counts().accepted_wrong_inputs, 1U);
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 1U);
  ASSERT_TRUE(statistics_.first_wrong().has_value());
  EXPECT_EQ(statistics_.first_wrong()->signal, 0U);
}

TEST_F(ExchangeStatisticsTest, TheWordBeforeIsAdmissibleAndTheOneBeforeThatIsNot) {
  const std::uint16_t oldest = network_.given[0];
  exchange(Outcome::missing);
  show(oldest);
  EXPECT_EQ(statistics_.counts().accepted_wrong(), 0U);
  exchange(Outcome::missing);
  show(oldest);
  EXPECT_EQ(statistics_.counts().accepted_wrong_outputs, 1U);
  EXPECT_EQ(statistics_.counts().missing, 2U);
}

TEST_F(ExchangeStatisticsTest, AnOutputInItsSafeStateIsClearedAndHeldOnesAreMissed) {
  deliver();
  exchange();
  show(0);
  EXPECT_EQ(statistics_.counts().cleared_outputs, 1U);
  network_.image_ = network_.given[1];
  exchange();
  EXPECT_EQ(statistics_.counts().missed_outputs, 1U);
  EXPECT_TRUE(statistics_.has_missed());
  EXPECT_EQ(statistics_.counts().accepted_wrong(), 0U);
}

TEST_F(ExchangeStatisticsTest, AnImageThatMovesInARejectedExchangeIsWrong) {
  network_.image_ = network_.given[1];
  exchange(Outcome::rejected);
  EXPECT_EQ(statistics_.counts().accepted_wrong_inputs, 1U);
  exchange(Outcome::served, ExchangeKind::service);
  EXPECT_EQ(statistics_.counts().repeated, 1U);
}

TEST_F(ExchangeStatisticsTest, RecoveryIsOverWhenEverySignalHasBeenDelivered) {
  statistics_.begin_recovery();
  EXPECT_FALSE(statistics_.is_recovered());
  network_.image_ = network_.given[1];
  exchange();
  EXPECT_FALSE(statistics_.is_recovered()) << "the output holds";
  deliver();
  exchange();
  EXPECT_TRUE(statistics_.is_recovered());
}

TEST_F(ExchangeStatisticsTest, EachExchangeHasOneOfFourEnds) {
  const auto exchange_with = [&](LineEffect effect, Exchange exchange) {
    exchange.signal_count = 2;
    statistics_.on_exchange(exchange, effect);
  };
  for (const LineEffect effect : {LineEffect::untouched, LineEffect::hit, LineEffect::changed}) {
    deliver();
    exchange_with(effect, {});
  }
  EXPECT_EQ(statistics_.counts().untouched, 1U);
  EXPECT_EQ(statistics_.counts().without_effect, 2U);
  EXPECT_EQ(statistics_.counts().differed, 0U) << "a receiver read the same in it";
  exchange_with(LineEffect::untouched, {.outcome = Outcome::missing});
  exchange_with(LineEffect::changed, {.outcome = Outcome::rejected});
  deliver();
  exchange_with(LineEffect::changed, {.retries = 1});
  EXPECT_EQ(statistics_.counts().refused, 3U);
  EXPECT_EQ(statistics_.counts().differed, 2U);
  network_.image_ = network_.given[1];
  exchange_with(LineEffect::changed, {});
  EXPECT_EQ(statistics_.counts().refused, 4U) << "an output held its word";
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 0U);
  EXPECT_EQ(statistics_.counts().balance(), statistics_.counts().sent);
}

TEST_F(ExchangeStatisticsTest, AWrongWordOfAServiceOrAfterTheLastExchangeFindsItsExchange) {
  show(static_cast<std::uint16_t>(network_.given[0] ^ 0x0100));
  exchange(Outcome::served, ExchangeKind::service);
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 0U);
  deliver();
  exchange();
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 1U);
  show(static_cast<std::uint16_t>(network_.given[0] ^ 0x0100));
  statistics_.end();
  statistics_.end();
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 2U);
  EXPECT_EQ(statistics_.counts().sent, 2U);
  EXPECT_EQ(statistics_.counts().balance(), 2U);
}

RC_GTEST_PROP(ExchangeStatisticsProperty, ExposedIsTheSumOfTheFourEnds, ()) {
  TwoWords network;
  ExchangeStatistics statistics(network, kernel::Random(*rc::gen::arbitrary<std::uint64_t>()));
  statistics.begin();
  for (const int drawn : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 3 * 3 * 2 * 2 * 3))) {
    const int shown = drawn / 36;
    const auto word = static_cast<std::uint16_t>(network.given[0] ^ (shown == 2 ? 0x0101 : 0));
    if (shown > 0) statistics.on_shown(0, word, kernel::kStart);
    if (shown == 1) network.image_ = network.given[1];
    statistics.on_exchange({.kind = static_cast<ExchangeKind>(drawn / 18 % 2),
                            .outcome = static_cast<Outcome>(drawn / 3 % 3),
                            .retries = static_cast<std::uint64_t>(drawn / 9 % 2),
                            .signal_count = 2},
                           static_cast<LineEffect>(drawn % 3));
  }
  statistics.end();
  const ErrorStatistics& counts = statistics.counts();
  RC_ASSERT(counts.balance() == counts.sent);
  RC_ASSERT(counts.differed <= counts.refused + counts.wrong_exchanges);
  RC_ASSERT(counts.differed >= counts.wrong_exchanges);
  RC_ASSERT((counts.accepted_wrong() == 0) == (counts.wrong_exchanges == 0));
}

// Whatever comes in whatever order: served exchanges that brought their words are good, and no count is lost.
RC_GTEST_PROP(ExchangeStatisticsProperty, EveryExchangeIsCountedOnce, ()) {
  TwoWords network;
  ExchangeStatistics statistics(network, kernel::Random(*rc::gen::arbitrary<std::uint64_t>()));
  statistics.on_exchange({.signal_count = 2}, LineEffect::untouched);
  statistics.begin();
  std::uint64_t served = 0;
  std::uint64_t unserved = 0;
  for (const int outcome : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 3))) {
    if (outcome == 0) {
      statistics.on_shown(0, network.given[0], kernel::kStart);
      network.image_ = network.given[1];
    }
    statistics.on_exchange({.outcome = static_cast<Outcome>(outcome), .signal_count = 2},
                           LineEffect::untouched);
    ++(outcome == 0 ? served : unserved);
  }
  RC_ASSERT(statistics.counts().sent == served + unserved);
  RC_ASSERT(statistics.counts().detected == unserved);
  RC_ASSERT(statistics.good_exchanges() >= served);
  RC_ASSERT(statistics.counts().accepted_wrong() == 0U);
  RC_ASSERT(statistics.counts().missed_outputs == 0U);
}

}  // namespace
}  // namespace fieldproof::network

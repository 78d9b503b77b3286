// Subject: error statistics of a ring that runs.
#include <gtest/gtest.h>

#include <filesystem>

#include "harness/network/exchange_statistics.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::interbus {
namespace {

using network::Exchange;

class ExchangeStatisticsTest : public testing::Test, protected network::ExchangeWatcher {
 protected:
  void SetUp() override {
    live_.watch(*this);
    ASSERT_TRUE(live_.bring_up());
    run(3);
    statistics_.begin();
  }
  void on_exchange(const Exchange& exchange) override {
    Exchange told = exchange;
    if (is_claimed_bad_) told.outcome = network::Outcome::rejected;
    statistics_.on_exchange(told,
                            is_claimed_bad_ ? network::LineEffect::changed : network::LineEffect::untouched);
  }
  void on_shown(std::size_t signal, std::uint16_t word, kernel::Time when) override {
    statistics_.on_shown(signal, word, when);
  }
  void on_cycle_begin(std::size_t, kernel::Time) override {}

  int station_with_words() {
    int position = 1;
    while (live_.ring().configuration(position).words == 0) ++position;
    return position;
  }
  void run(std::int64_t cycles) { live_.segment().run_for(live_.status().cycle_time * cycles); }

  RunningNetwork live_{NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" /
                                                "mixed_line.json")};
  network::ExchangeStatistics statistics_{live_, kernel::Random(7)};
  bool is_claimed_bad_ = false;
};

TEST_F(ExchangeStatisticsTest, FindsNothingOnAQuietLine) {
  run(50);
  const network::ErrorStatistics& counts = statistics_.counts();
  EXPECT_EQ(counts.sent, 50U);
  EXPECT_EQ(counts.detected, 0U);
  EXPECT_EQ(counts.accepted_wrong(), 0U);
  EXPECT_EQ(counts.missed_outputs, 0U);
  EXPECT_FALSE(statistics_.first_wrong().has_value());
}

TEST_F(ExchangeStatisticsTest, AnOutputThatNobodySentIsOne) {
  const kernel::Time now = live_.segment().now();
  const int position = station_with_words();
  live_.ring().terminals(position).output(0, 0x1234, now);
  EXPECT_EQ(statistics_.counts().accepted_wrong_outputs, 1U);
  ASSERT_TRUE(statistics_.first_wrong().has_value());
  const std::size_t signal = statistics_.first_wrong()->signal;
  EXPECT_TRUE(live_.signals()[signal].is_output);
  EXPECT_EQ(signal, 2 * live_.ring().first_word(position));
  EXPECT_EQ(statistics_.first_wrong()->got, 0x1234);
  EXPECT_EQ(statistics_.first_wrong()->when, now);
}

TEST_F(ExchangeStatisticsTest, AnOutputOfZeroIsTheSafeValue) {
  live_.ring().terminals(station_with_words()).output(0, 0, live_.segment().now());
  EXPECT_EQ(statistics_.counts().cleared_outputs, 1U);
  EXPECT_EQ(statistics_.counts().accepted_wrong(), 0U);
}

// The image goes on by each cycle; one that was rejected must leave it as it was.
TEST_F(ExchangeStatisticsTest, InputsOfARejectedCycleAreWrong) {
  is_claimed_bad_ = true;
  run(1);
  EXPECT_EQ(statistics_.counts().detected, 1U);
  EXPECT_GT(statistics_.counts().accepted_wrong_inputs, 0U);
  EXPECT_EQ(statistics_.counts().wrong_exchanges, 1U);
  EXPECT_GT(statistics_.counts().partly_latched, 0U) << "outputs moved in a cycle that was called bad";
  EXPECT_FALSE(live_.signals()[statistics_.first_wrong()->signal].is_output);
}

}  // namespace
}  // namespace fieldproof::interbus

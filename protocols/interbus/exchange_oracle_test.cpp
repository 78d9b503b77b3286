#include "protocols/interbus/exchange_oracle.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "protocols/interbus/live_network.hpp"

namespace fieldproof::interbus {
namespace {

class ExchangeOracleTest : public testing::Test {
 protected:
  void SetUp() override {
    live_.master().on_cycle_end([this](kernel::Time now, bool is_data, bool accepted) {
      oracle_.on_cycle_end(now, is_data, accepted && !is_claimed_bad_, is_claimed_bad_);
    });
    ASSERT_TRUE(live_.bring_up());
    run(3);
    oracle_.begin();
  }
  int station_with_words() {
    int position = 1;
    while (live_.ring().configuration(position).words == 0) ++position;
    return position;
  }
  void run(std::int64_t cycles) { live_.segment().run_for(live_.status().cycle_time * cycles); }

  LiveNetwork live_{NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" /
                                             "mixed_line.json")};
  ExchangeOracle oracle_{live_.master(), live_.ring(), kernel::Random(7)};
  bool is_claimed_bad_ = false;
};

TEST_F(ExchangeOracleTest, FindsNothingOnAQuietLine) {
  run(50);
  const ErrorLedger& ledger = oracle_.ledger();
  EXPECT_EQ(ledger.sent, 50U);
  EXPECT_EQ(ledger.detected, 0U);
  EXPECT_EQ(ledger.accepted_wrong(), 0U);
  EXPECT_EQ(ledger.missed_outputs, 0U);
  EXPECT_FALSE(oracle_.first_wrong().has_value());
}

TEST_F(ExchangeOracleTest, AnOutputThatNobodySentIsOne) {
  const kernel::Time now = live_.segment().now();
  const int position = station_with_words();
  live_.ring().terminals(position).output(0, 0x1234, now);
  EXPECT_EQ(oracle_.ledger().accepted_wrong_outputs, 1U);
  ASSERT_TRUE(oracle_.first_wrong().has_value());
  EXPECT_TRUE(oracle_.first_wrong()->is_output);
  EXPECT_EQ(oracle_.first_wrong()->word, live_.ring().first_word(position));
  EXPECT_EQ(oracle_.first_wrong()->got, 0x1234);
  EXPECT_EQ(oracle_.first_wrong()->when, now);
}

TEST_F(ExchangeOracleTest, AnOutputOfZeroIsTheSafeValue) {
  live_.ring().terminals(station_with_words()).output(0, 0, live_.segment().now());
  EXPECT_EQ(oracle_.ledger().cleared_outputs, 1U);
  EXPECT_EQ(oracle_.ledger().accepted_wrong(), 0U);
}

// The image goes on by each cycle; one that was rejected must leave it as it was.
TEST_F(ExchangeOracleTest, InputsOfARejectedCycleAreWrong) {
  is_claimed_bad_ = true;
  run(1);
  EXPECT_EQ(oracle_.ledger().detected, 1U);
  EXPECT_GT(oracle_.ledger().accepted_wrong_inputs, 0U);
  EXPECT_EQ(oracle_.ledger().wrong_cycles, 1U);
  EXPECT_GT(oracle_.ledger().partly_latched, 0U) << "outputs moved in a cycle that was called bad";
  EXPECT_FALSE(oracle_.first_wrong()->is_output);
}

}  // namespace
}  // namespace fieldproof::interbus

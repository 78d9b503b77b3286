#include "harness/network/word_exchanges.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fieldproof::network {
namespace {

using kernel::kMillisecond;

constexpr kernel::Time at(int ms) {
  return kernel::kStart + ms * kMillisecond;
}

class Ledger final : public ExchangeWatcher {
 public:
  void on_exchange(const Exchange& exchange) override { exchanges.push_back(exchange); }
  void on_shown(std::size_t, std::uint16_t word, kernel::Time) override { shown.push_back(word); }
  void on_cycle_begin(std::size_t kind, kernel::Time) override { cycles.push_back(kind); }

  std::vector<Exchange> exchanges;
  std::vector<std::uint16_t> shown;
  std::vector<std::size_t> cycles;
};

class WordExchangesTest : public testing::Test {
 protected:
  WordExchangesTest() {
    words_.add_signal();
    words_.add_signal();
    words_.watch(ledger_);
    words_.begin();
  }

  WordExchanges words_;
  Ledger ledger_;
};

TEST_F(WordExchangesTest, AreServedRejectedOrMissing) {
  words_.call(0, at(1), at(5));
  words_.on_sent(0);
  words_.on_got(0, 0x1234, at(3));
  words_.call(1, at(2), at(4));
  words_.on_sent(1);
  EXPECT_EQ(words_.next_close(), at(4));
  std::vector<std::size_t> closed;
  const auto note = [&](std::size_t signal) { closed.push_back(signal); };
  words_.close_due(at(4), note);
  words_.close_due(at(5), note);
  words_.call(1, at(6), at(7));
  words_.close_due(at(7), note);
  EXPECT_EQ(closed, (std::vector<std::size_t>{1, 0, 1}));
  ASSERT_EQ(ledger_.exchanges.size(), 3U);
  EXPECT_EQ(ledger_.exchanges[0].outcome, Outcome::rejected);
  EXPECT_EQ(ledger_.exchanges[1].outcome, Outcome::served);
  EXPECT_EQ(ledger_.exchanges[2].outcome, Outcome::missing);
  EXPECT_EQ(ledger_.exchanges[1].end, at(5));
  EXPECT_EQ(ledger_.shown, (std::vector<std::uint16_t>{0x1234}));
  EXPECT_EQ(words_.next_close(), kernel::kNever);
}

TEST_F(WordExchangesTest, CallThatIsRepeatedIsARetry) {
  words_.call(0, at(1), at(2));
  words_.call_again(0, at(2), at(4));
  EXPECT_EQ(words_.last_call(), at(2));
  words_.close(0, at(4));
  ASSERT_EQ(ledger_.exchanges.size(), 1U);
  EXPECT_EQ(ledger_.exchanges[0].retries, 1U);
  words_.call(0, at(5), at(6));
  words_.close(0, at(6));
  EXPECT_EQ(ledger_.exchanges[1].retries, 0U);
}

TEST_F(WordExchangesTest, StartForgetsWhatWasBefore) {
  words_.on_got(0, 1, at(1));
  EXPECT_FALSE(words_.has_all_arrived());
  words_.on_got(0, 2, at(2));
  EXPECT_FALSE(words_.has_all_arrived()) << "the same word twice";
  words_.on_got(1, 1, at(3));
  EXPECT_TRUE(words_.has_all_arrived());
  words_.call(0, at(4), at(5));
  words_.begin();
  EXPECT_FALSE(words_.has_all_arrived());
  EXPECT_FALSE(words_.last_call());
  words_.close_due(at(9), [](std::size_t) { FAIL() << "it was given up with the stop"; });
  EXPECT_TRUE(ledger_.exchanges.empty());
}

TEST_F(WordExchangesTest, WordsComeFromTheApplication) {
  words_.set_word(0, 7);
  EXPECT_EQ(words_.sample(0, at(1)), 7);
  EXPECT_FALSE(words_.has_function(0));
  words_.set_function(0, [](kernel::Time now) { return static_cast<std::uint16_t>(now == at(2) ? 9 : 1); });
  EXPECT_EQ(words_.sample(0, at(2)), 9);
}

}  // namespace
}  // namespace fieldproof::network

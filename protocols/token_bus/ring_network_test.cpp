#include "protocols/token_bus/ring_network.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/error.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::token_bus {
namespace {

class RingLedger final : public network::ExchangeWatcher {
 public:
  void on_exchange(const network::Exchange& exchange) override {
    ++exchanges;
    served += exchange.outcome == network::Outcome::served ? 1U : 0U;
    retries += exchange.retries;
  }
  void on_shown(std::size_t, std::uint16_t word, kernel::Time) override { shown = word; }
  void on_cycle_begin(std::size_t, kernel::Time when) override {
    if (last != kernel::Time{}) longest = std::max(longest, when - last);
    last = when;
  }

  std::uint64_t exchanges = 0;
  std::uint64_t served = 0;
  std::uint64_t retries = 0;
  std::uint16_t shown = 0;
  kernel::Time last{};
  kernel::Duration longest{};
};

TEST(RingNetwork, ExchangesWordsWithinItsBound) {
  for (const unsigned stations : {2U, 4U}) {
    RingNetwork ring(RingDescription::built_in(stations), 1);
    ring.start();
    for (unsigned n = 0; n < 100 && ring.state() != network::State::exchanging; ++n)
      ring.segment().run_for(20 * kernel::kMillisecond);
    ASSERT_EQ(ring.state(), network::State::exchanging) << stations;
    RingLedger ledger;
    ring.watch(ledger);
    ring.set_source(0, 0x1234);
    ring.segment().run_for(200 * kernel::kMillisecond);
    EXPECT_GT(ledger.exchanges, 200U) << stations;
    EXPECT_EQ(ledger.served, ledger.exchanges) << stations;
    EXPECT_EQ(ledger.retries, 0U);
    EXPECT_LE(ledger.longest, longest_rotation(RingDescription::built_in(stations))) << stations;
    EXPECT_GT(ledger.longest, kernel::Duration{});
    ring.stop();
    ring.segment().run_for(200 * kernel::kMillisecond);
    EXPECT_EQ(ring.state(), network::State::stopped);
    ring.start();
    ring.segment().run_for(kernel::kSecond);
    EXPECT_EQ(ring.state(), network::State::exchanging) << stations;
  }
}

TEST(RingNetwork, AStationThatIsSilentKeepsItFromComingUp) {
  class Silent final : public TokenStation {
   public:
    using TokenStation::TokenStation;
    bool start(kernel::Time) override { return false; }
  };
  RingNetwork ring(RingDescription::built_in(3), 1,
                   {.make = [](std::size_t position,
                               const StationConfiguration& configuration) -> std::unique_ptr<StationDevice> {
                     if (position == 2) return std::make_unique<Silent>(configuration);
                     return nullptr;
                   }});
  ring.start();
  ring.segment().run_for(kernel::kSecond);
  EXPECT_EQ(ring.state(), network::State::coming_up);
  EXPECT_NE(ring.complaint().find("station@2"), std::string::npos);
}

constexpr kernel::Time kDead = kernel::kStart + kernel::kSecond;

// They join one by one, each through a window, within the time that they have.
TEST(RingNetwork, OfSixteenStationsComesUp) {
  constexpr unsigned kStations = 16;
  RingNetwork ring(RingDescription::built_in(kStations), 1);
  ring.start();
  while (ring.state() == network::State::coming_up) ring.segment().run_for(100 * kernel::kMillisecond);
  ASSERT_EQ(ring.state(), network::State::exchanging);
  RingLedger ledger;
  ring.watch(ledger);
  ring.segment().run_for(100 * kernel::kMillisecond);
  EXPECT_GT(ledger.exchanges, kStations * 10);
  EXPECT_EQ(ledger.served, ledger.exchanges);
  EXPECT_LE(ledger.longest, longest_rotation(RingDescription::built_in(kStations)));
}

// The others take it out of their ring, and its words are not called for any more: nothing is lost that they
// count.
TEST(RingNetwork, StopsWhenAStationDies) {
  class Dies final : public TokenStation {
   public:
    using TokenStation::TokenStation;
    void receive(segment::PortIndex port, const line::Waveform& reception) override {
      if (reception.start < kDead) TokenStation::receive(port, reception);
    }
    void on_time(kernel::Time now) override {
      if (now < kDead) TokenStation::on_time(now);
    }
    kernel::Time next_time() const override {
      const kernel::Time next = TokenStation::next_time();
      return next < kDead ? next : kernel::kNever;
    }
  };
  RingDescription slow = RingDescription::built_in(3);
  slow.rules.phy_bit_rate = 1'000'000;  // fewer frames in the time for which nobody is missed
  RingNetwork ring(slow, 1,
                   {.make = [](std::size_t position,
                               const StationConfiguration& configuration) -> std::unique_ptr<StationDevice> {
                     if (position == 2) return std::make_unique<Dies>(configuration);
                     return nullptr;
                   }});
  ring.start();
  ring.segment().run_until(kDead);
  EXPECT_EQ(ring.state(), network::State::exchanging);
  ring.segment().run_for(ring.bring_up_limit() + kernel::kSecond);
  EXPECT_EQ(ring.state(), network::State::stopped);
  EXPECT_NE(ring.complaint().find("station@2 takes part no more"), std::string::npos) << ring.complaint();
}

TEST(RingDescriptionReader, RefusesWhatIsNoRing) {
  const auto read = [](const std::string& text) {
    const config::Document document = config::Document::parse(text, "ring.json");
    return RingDescription::read(document.root());
  };
  EXPECT_EQ(read(R"({"name": "a", "stations": [2, 4], "data": [{"from": 2, "to": 4}]})").stations.size(), 2U);
  for (const char* text : {R"({"name": "", "stations": [2, 4], "data": [{"from": 2, "to": 4}]})",
                           R"({"name": "a", "stations": [2], "data": [{"from": 2, "to": 4}]})",
                           R"({"name": "a", "stations": [2, 3], "data": [{"from": 2, "to": 3}]})",
                           R"({"name": "a", "stations": [2, 2], "data": [{"from": 2, "to": 2}]})",
                           R"({"name": "a", "stations": [2, 4], "data": [{"from": 2, "to": 6}]})",
                           R"({"name": "a", "stations": [2, 4], "data": [{"from": 2, "to": 2}]})",
                           R"({"name": "a", "stations": [2, 4], "data": []})"}) {
    EXPECT_THROW(read(text), kernel::Error) << text;
  }
}

}  // namespace
}  // namespace fieldproof::token_bus

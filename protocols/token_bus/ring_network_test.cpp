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

TEST(RingDescriptionReader, RefusesWhatIsNoRing) {
  const auto read = [](const std::string& text) {
    const config::Document document = config::Document::parse(text, "ring.json");
    return RingDescription::read(document.root());
  };
  EXPECT_EQ(read(R"({"name": "a", "stations": [2, 4], "data": [{"from": 2, "to": 4}]})").stations.size(), 2U);
  for (const char* text : {R"({"name": "a", "stations": [2], "data": [{"from": 2, "to": 4}]})",
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

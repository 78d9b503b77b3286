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
  void on_delay(std::size_t kind, kernel::Time from, kernel::Time to) override {
    delays.at(kind).push_back(to - from);
  }
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
  std::array<std::vector<kernel::Duration>, 5> delays{};
};

// A station of another kind at this position.
template <typename Other>
RingStations with_at(std::size_t wanted) {
  return {.make = [wanted](std::size_t position,
                           const StationConfiguration& configuration) -> std::unique_ptr<StationDevice> {
    if (position != wanted) return nullptr;
    return std::make_unique<Other>(configuration);
  }};
}

// Runs until data are exchanged, or not any more.
void bring_up(RingNetwork& ring) {
  ring.start();
  while (ring.state() == network::State::coming_up) ring.segment().run_for(20 * kernel::kMillisecond);
  ASSERT_EQ(ring.state(), network::State::exchanging) << ring.complaint();
}

void expect_no_fault(const RingNetwork& ring) {
  for (const measure::Count& fault : ring.delivery_faults()) EXPECT_EQ(fault.count, 0U) << fault.what;
}

// All services of the stations, each to the next but one.
RingDescription with_services(unsigned stations) {
  RingDescription ring = RingDescription::built_in(stations);
  ring.name = "services";
  ring.data.clear();
  ring.rules.target_rotation_octets = {40'000, 30'000, 4'000};
  for (unsigned n = 0; n < stations; ++n) {
    const auto add = [&](RingService service, kernel::Duration every, std::int64_t load, std::size_t octets) {
      ring.data.push_back(
          {ring.stations[n], ring.stations[(n + 2) % stations], service, every, load, octets});
    };
    add(RingService::urgent, 40 * kernel::kMillisecond, 0, 8);
    add(RingService::periodic, 60 * kernel::kMillisecond, 0, 32);
    if (n % 3 == 0) add(RingService::confirmed, 90 * kernel::kMillisecond, 0, 64);
    if (n % 4 == 0) add(RingService::bulk, {}, 1'000'000, 500);
  }
  return ring;
}

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
  RingNetwork ring(RingDescription::built_in(3), 1, with_at<Silent>(2));
  ring.start();
  ring.segment().run_for(kernel::kSecond);
  EXPECT_EQ(ring.state(), network::State::coming_up);
  EXPECT_NE(ring.complaint().find("station@2"), std::string::npos);
}

TEST(RingNetwork, CarriesItsServicesWithinTheirBounds) {
  const RingDescription description = with_services(16);
  const RingBounds bounds = bounds_of(description);
  RingNetwork ring(description, 1);
  bring_up(ring);
  RingLedger ledger;
  ring.watch(ledger);
  ring.segment().run_for(300 * kernel::kMillisecond);
  expect_no_fault(ring);
  EXPECT_EQ(ledger.served, ledger.exchanges);
  EXPECT_EQ(ledger.retries, 0U);
  EXPECT_LE(ledger.longest, bounds.rotation);
  ASSERT_EQ(ring.cycles().size(), 5U);
  for (std::size_t service = 0; service < kRingServices.size(); ++service) {
    const auto& delays = ledger.delays[1 + service];
    ASSERT_GE(delays.size(), 10U) << text_of(kRingServices[service]);
    ASSERT_EQ(bounds.access[service].has_value(), kRingServices[service] != RingService::bulk);
    EXPECT_LE(std::ranges::max(delays), bounds.access[service].value_or(kernel::Duration::max()));
    EXPECT_GE(std::ranges::min(delays), octets(description.rules, 15 + 8));
  }
}

// A load that is more than its class may have: its timers hold the round.
TEST(RingNetwork, KeepsItsRoundUnderOverload) {
  RingDescription description = RingDescription::built_in(4);
  description.rules.target_rotation_octets = {9'000, 7'000, 5'000};
  for (unsigned n = 0; n < 20; ++n) {
    description.data.push_back({.from = 2 * (1 + n % 4),
                                .to = 2 * (1 + (n + 1) % 4),
                                .service = RingService::bulk,
                                .load = 4'000'000,
                                .octets = 400});
  }
  RingNetwork ring(description, 1);
  bring_up(ring);
  RingLedger ledger;
  ring.watch(ledger);
  ring.segment().run_for(300 * kernel::kMillisecond);
  expect_no_fault(ring);
  EXPECT_LE(ledger.longest, longest_rotation(description));
  EXPECT_GT(ledger.longest, longest_rotation(description) / 2);
}

// A destination that does not respond is asked again, and the next datum goes on.
TEST(RingNetwork, GoesOnWhereNobodyConfirms) {
  class Mute final : public TokenStation {
   public:
    using TokenStation::TokenStation;
    void set_response(const Octets&, kernel::Time) override {}
  };
  RingDescription description = RingDescription::built_in(3);
  description.data.push_back(
      {.from = 2, .to = 4, .service = RingService::confirmed, .every = 5 * kernel::kMillisecond});
  RingNetwork ring(description, 1, with_at<Mute>(2));
  bring_up(ring);
  RingLedger ledger;
  ring.watch(ledger);
  ring.segment().run_for(100 * kernel::kMillisecond);
  expect_no_fault(ring);  // its application drops repetitions
  EXPECT_GE(ledger.delays[2].size(), 18U);
  EXPECT_EQ(ledger.retries, ledger.delays[2].size() * description.rules.max_retry_limit);
}

// Whatever a station does to data on their way shows.
TEST(RingNetwork, SeesDataThatComeTwiceOrLateOrOtherwise) {
  class Spoils final : public TokenStation {
   public:
    using TokenStation::TokenStation;
    bool submit(const DataRequest& request, kernel::Time now) override {
      const unsigned n = count_++ % 4;
      if (n == 0) kept_ = request;
      if (n == 1) TokenStation::submit(request, now);
      if (n == 2) TokenStation::submit(kept_, now);
      if (n == 3) {
        DataRequest other = request;
        other.data.back() ^= 1;
        TokenStation::submit(other, now);
      }
      return TokenStation::submit(request, now);
    }

   private:
    unsigned count_ = 0;
    DataRequest kept_{};
  };
  RingDescription description = RingDescription::built_in(3);
  description.data = {{.from = 2, .to = 4, .every = 5 * kernel::kMillisecond, .octets = 9}};
  RingNetwork ring(description, 1, with_at<Spoils>(1));
  ring.start();
  ring.segment().run_for(kernel::kSecond);
  for (const measure::Count& fault : ring.delivery_faults()) EXPECT_GT(fault.count, 0U) << fault.what;
}

TEST(RingNetwork, NamesTheDataThatHaveNoRoom) {
  RingDescription description = RingDescription::built_in(2);
  description.rules.target_rotation_octets = {50, 50, 50};
  description.data.push_back({.from = 2, .to = 4, .service = RingService::bulk, .load = 1'000});
  RingNetwork ring(description, 1);
  ring.start();
  ring.segment().run_for(kernel::kSecond);
  EXPECT_EQ(ring.state(), network::State::coming_up);
  EXPECT_EQ(ring.complaint(), "no word of station 2 at station 4 (bulk) since power-up");
}

// More than it carries: what it does carry comes right, and the rest is said.
TEST(RingNetwork, SaysHowManyRequestsItHasNoRoomFor) {
  const auto refused_under = [](std::int64_t load) {
    RingDescription description = RingDescription::built_in(2);
    description.data.push_back({.from = 2, .to = 4, .service = RingService::urgent, .load = load});
    RingNetwork ring(description, 1);
    ring.start();
    ring.segment().run_for(kernel::kSecond / 5);
    std::uint64_t refused = 0;
    for (const measure::Count& remark : ring.remarks()) {
      if (!remark.what.starts_with("requests that the ring has no room for")) continue;
      EXPECT_NE(remark.what.find("word of station 2 at station 4 (urgent)"), std::string::npos)
          << remark.what;
      EXPECT_LE(remark.count, remark.of);
      refused += remark.count;
    }
    return refused;
  };
  EXPECT_GT(refused_under(10'000'000), 1'000U);
  EXPECT_EQ(refused_under(10'000), 0U);
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
  RingNetwork ring(slow, 1, with_at<Dies>(2));
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
  struct Bad {
    const char* place;
    const char* rest;
  };
  for (const Bad& bad :
       {Bad{"/stations", R"("stations": [2], "data": [{"from": 2, "to": 4}])"},
        {"/stations/1", R"("stations": [2, 3], "data": [{"from": 2, "to": 3}])"},
        {"/stations/1", R"("stations": [2, 2], "data": [{"from": 2, "to": 2}])"},
        {"/data/0/to", R"("stations": [2, 4], "data": [{"from": 2, "to": 6}])"},
        {"/data/1/from", R"("stations": [2, 4], "data": [{"from": 2, "to": 4}, {"from": 8, "to": 4}])"},
        {"/data/0", R"("stations": [2, 4], "data": [{"from": 2, "to": 4}], "high_priority_hold_octets": 6)"},
        {"/data/0", R"("stations": [2, 4], "data": [{"from": 2, "to": 4, "service": "bulk", "every": "1 s"}],
                              "target_rotation_octets": [9000, 9000, 0])"},
        {"/data/0/to", R"("stations": [2, 4], "data": [{"from": 2, "to": 2}])"},
        {"/data/0/octets", R"("stations": [2, 4], "data": [{"from": 2, "to": 4, "octets": 4}])"},
        {"/data/0/octets", R"("stations": [2, 4], "data": [{"from": 2, "to": 4, "octets": 8183}])"},
        {"/data/0/every", R"("stations": [2, 4], "data": [{"from": 2, "to": 4, "every": "1 us"}])"},
        {"/data/0/service", R"("stations": [2, 4], "data": [{"from": 2, "to": 4, "service": "slow"}])"},
        {"/data/0/load", R"("stations": [2, 4],
                              "data": [{"from": 2, "to": 4, "every": "1 ms", "load": "1 kbit/s"}])"},
        {"/slot_time_octets", R"("stations": [2, 4], "slot_time_octets": 7, "data": [{"from": 2, "to": 4}])"},
        {"/repeaters/0",
         R"("stations": [2, 4], "cable": "800 m", "repeaters": ["400 m", "300 m"], "slot_time_octets": 90,
                              "data": [{"from": 2, "to": 4}])"},
        {"/cable",
         R"("stations": [2, 4], "cable": "800 m", "slot_time_octets": 90, "data": [{"from": 2, "to": 4}])"},
        {"/cuts/0/after", R"("stations": [2, 4], "channels": 2, "data": [{"from": 2, "to": 4}],
                              "cuts": [{"channel": "A", "at": "0 s", "lasts": "1 s", "after": 4}])"},
        {"/data", R"("stations": [2, 4], "data": [])"}}) {
    try {
      read(std::string(R"({"name": "a", )") + bad.rest + "}");
      ADD_FAILURE() << bad.rest;
    } catch (const kernel::Error& error) {
      EXPECT_NE(std::string(error.what()).find(std::string(": ") + bad.place + ": "), std::string::npos)
          << bad.rest << error.what();
    }
  }
  EXPECT_THROW(read(R"({"name": "", "stations": [2, 4], "data": [{"from": 2, "to": 4}]})"), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::token_bus

// Subject: protocols/token_bus/token_station.hpp, several of them on one line.

#include <gtest/gtest.h>

#include <deque>
#include <set>

#include "protocols/token_bus/test_bus.hpp"

namespace fieldproof::token_bus {
namespace {

// Stations along a cable, each a tenth of a microsecond after the one before.
class Ring {
 public:
  explicit Ring(const std::vector<Address>& addresses, const Rules& rules = {}) : rules_(rules), bus_(rules) {
    for (const Address address : addresses) add(address, true);
  }
  TokenStation& add(Address address, bool is_on) {
    StationConfiguration configuration;
    configuration.rules = rules_;
    configuration.address = address;
    TokenStation& station = stations_.emplace_back(configuration);
    users_.push_back(
        &bus_.add(station, static_cast<std::int64_t>(stations_.size()) * 100 * kernel::kNanosecond));
    if (is_on) set_power(station, true);
    return station;
  }
  void set_power(TokenStation& station, bool is_on) {
    if (is_on) {
      EXPECT_TRUE(station.start(bus_.now()));
    } else {
      station.stop(bus_.now());
    }
    bus_.refresh();
  }
  TestBus& bus() { return bus_; }
  TokenStation& station(std::size_t n) { return stations_[n]; }
  TestBus::User& user(std::size_t n) { return *users_[n]; }

  // The addresses from the first one on by their successors, until one comes again.
  std::vector<Address> order() {
    std::vector<Address> all;
    std::set<Address> seen;
    for (Address at = stations_[0].address(); seen.insert(at).second;) {
      all.push_back(at);
      for (const TokenStation& one : stations_) {
        if (one.address() != at) continue;
        at = one.successor();
        break;
      }
    }
    return all;
  }
  bool all_in_ring() const {
    for (const TokenStation& one : stations_) {
      if (!one.is_in_ring()) return false;
    }
    return true;
  }
  // Runs until everybody is in it; false: not within so many slot times.
  bool comes_up(unsigned most_slots = 20'000) {
    for (unsigned n = 0; n < most_slots / 100 && !all_in_ring(); ++n) bus_.wait_slots(100);
    return all_in_ring();
  }

 private:
  Rules rules_;
  TestBus bus_;
  std::deque<TokenStation> stations_;
  std::vector<TestBus::User*> users_;
};

using Addresses = std::vector<Address>;

TEST(TokenRing, StationsThatBeginTogetherFormARingInDescendingOrder) {
  for (const Addresses& addresses :
       {Addresses{0x000A, 0x0004}, Addresses{0x0102, 0x0104, 0x0100}, Addresses{2, 4, 6, 8, 10},
        Addresses{0x8000, 0x4000, 0x2000, 0x1000, 0x0800, 0x0400, 0x0200, 0x0100}}) {
    Ring ring(addresses);
    ASSERT_TRUE(ring.comes_up()) << addresses.size();
    Addresses descending = addresses;
    std::ranges::sort(descending, std::greater<>());
    std::ranges::rotate(descending, std::ranges::find(descending, addresses[0]));
    EXPECT_EQ(ring.order(), descending);
  }
}

TEST(TokenRing, AddressesOf48BitsFormOneToo) {
  Rules rules;
  rules.address_length = AddressLength::bits_48;
  Ring ring({0x9B77'6C15'2EF0, 0x0000'0000'0002, 0x9B77'6C15'2EF2}, rules);
  ASSERT_TRUE(ring.comes_up());
  EXPECT_EQ(ring.order(), (Addresses{0x9B77'6C15'2EF0, 0x0000'0000'0002, 0x9B77'6C15'2EF2}));
}

TEST(TokenRing, TheHighestOfThoseThatClaimTogetherHasTheToken) {
  Ring ring({0x000A, 0x0014, 0x0012});
  ring.bus().wait(196 + 9 * (15 + 6 * 28 + 28));
  EXPECT_EQ(ring.user(1).take().substr(0, 12), "sole station");
  EXPECT_FALSE(ring.user(0).text.starts_with("sole"));
  EXPECT_FALSE(ring.user(2).text.starts_with("sole"));
}

TEST(TokenRing, AStationThatComesLaterIsTakenIn) {
  Ring ring({0x000E, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  for (const Address address : Addresses{0x000A, 0x0002, 0x0010}) {
    ring.add(address, true);
    ASSERT_TRUE(ring.comes_up()) << address;
  }
  EXPECT_EQ(ring.order(), (Addresses{0x000E, 0x000A, 0x0004, 0x0002, 0x0010}));
}

TEST(TokenRing, StationsOfOneWindowAreToldApartByTheirAddresses) {
  Ring ring({0x000E, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  for (const Address address : Addresses{0x0006, 0x0008, 0x000A, 0x000C}) ring.add(address, true);
  ASSERT_TRUE(ring.comes_up());
  EXPECT_EQ(ring.order(), (Addresses{0x000E, 0x000C, 0x000A, 0x0008, 0x0006, 0x0004}));
}

TEST(TokenRing, ADeadStationIsPassedOver) {
  Ring ring({0x000E, 0x000A, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  ring.set_power(ring.station(1), false);
  ring.bus().wait_slots(200);
  EXPECT_EQ(ring.station(0).successor(), 0x0004U);
  EXPECT_EQ(ring.station(2).successor(), 0x000EU);
  EXPECT_EQ(ring.station(2).predecessor(), 0x000EU);
  ring.set_power(ring.station(1), true);
  EXPECT_TRUE(ring.comes_up());
}

TEST(TokenRing, ALostTokenIsMadeAnew) {
  for (unsigned at = 0; at < 40; ++at) {
    Ring ring({0x000E, 0x000A, 0x0004});
    ASSERT_TRUE(ring.comes_up());
    // Whoever holds it now, at some instant of its round.
    ring.bus().wait(at);
    for (std::size_t n = 0; n < 3; ++n) {
      const AccessState state = ring.station(n).state();
      if (state == AccessState::idle) continue;
      ring.set_power(ring.station(n), false);
      ring.bus().wait_slots(2'000);
      ring.set_power(ring.station(n), true);
      break;
    }
    ASSERT_TRUE(ring.comes_up()) << at;
    EXPECT_EQ(ring.order(), (Addresses{0x000E, 0x000A, 0x0004})) << at;
  }
}

TEST(TokenRing, WhoLeavesIsNotMissed) {
  Ring ring({0x000E, 0x000A, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  ring.bus().take();
  ring.station(1).set_in_ring_desired(false, ring.bus().now());
  ring.bus().wait_slots(100);
  EXPECT_FALSE(ring.station(1).is_in_ring());
  EXPECT_EQ(ring.station(0).successor(), 0x0004U);
  EXPECT_EQ(ring.bus().take().find("who_follows"), std::string::npos);
}

TEST(TokenRing, TheSecondOfAnAddressGoesOffline) {
  Ring ring({0x000E, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  ring.add(0x000E, true);
  ring.bus().wait_slots(100);
  EXPECT_TRUE(ring.user(2).take().starts_with("duplicate address 000E"));
  EXPECT_EQ(ring.station(2).state(), AccessState::offline);
}

TEST(TokenRing, DataReachItsDestinationAndGroups) {
  Ring ring({0x000E, 0x000A, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  for (std::size_t n = 0; n < 3; ++n) ring.user(n).take();
  ring.station(0).submit({.priority = 6, .destination = 0x0004, .data = {1}}, ring.bus().now());
  ring.station(0).submit({.priority = 0, .destination = 0xFFFF, .data = {2}}, ring.bus().now());
  ring.station(2).set_response({3}, ring.bus().now());
  ring.station(1).submit({.action = Action::request_with_response, .destination = 0x0004, .data = {4}},
                         ring.bus().now());
  ring.bus().refresh();
  ring.bus().wait_slots(100);
  const std::string at_first = ring.user(1).take();
  const std::string at_second = ring.user(2).take();
  EXPECT_EQ(at_first.find(": 01"), std::string::npos);
  EXPECT_NE(at_first.find("000E -> FFFF: 02"), std::string::npos);
  EXPECT_NE(at_first.find("response, priority 6, 0004 -> 000A: 03"), std::string::npos);
  EXPECT_NE(at_second.find("000E -> 0004: 01"), std::string::npos);
  EXPECT_NE(at_second.find("000E -> FFFF: 02"), std::string::npos);
  EXPECT_NE(at_second.find("request with response, priority 6, 000A -> 0004: 04"), std::string::npos);
}

TEST(TokenRing, OneTokenIsOnTheLine) {
  Ring ring({0x000E, 0x000A, 0x0004});
  ASSERT_TRUE(ring.comes_up());
  for (unsigned n = 0; n < 2'000; ++n) {
    ring.bus().wait(3);
    unsigned holders = 0;
    for (std::size_t station = 0; station < 3; ++station) {
      const AccessState state = ring.station(station).state();
      holders += state == AccessState::use_token || state == AccessState::await_response ? 1U : 0U;
    }
    EXPECT_LE(holders, 1U);
  }
}

}  // namespace
}  // namespace fieldproof::token_bus

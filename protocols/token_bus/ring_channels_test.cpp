// Subject: rings on two channels, of which one is cut at a time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "protocols/token_bus/ring_network.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

class CutLedger final : public network::ExchangeWatcher {
 public:
  void on_exchange(const network::Exchange& exchange) override {
    ++exchanges;
    unserved += exchange.outcome == network::Outcome::served ? 0U : 1U;
  }
  void on_shown(std::size_t, std::uint16_t, kernel::Time) override {}
  void on_cycle_begin(std::size_t, kernel::Time when) override {
    if (last) longest = std::max(longest, when - *last);
    last = when;
  }
  void on_delay(std::size_t kind, kernel::Time from, kernel::Time to) override {
    if (kind + 1 == kinds) rounds_with_cuts.push_back(to - from);
  }

  std::size_t kinds = 0;
  std::uint64_t exchanges = 0;
  std::uint64_t unserved = 0;
  std::optional<kernel::Time> last{};
  kernel::Duration longest{};
  std::vector<kernel::Duration> rounds_with_cuts{};
};

class TwoChannels : public testing::Test {
 protected:
  static RingDescription ring_of(unsigned stations) {
    RingDescription ring = RingDescription::built_in(stations);
    ring.channels = 2;
    for (unsigned n = 0; n < stations; n += 2) {
      ring.data.push_back({.from = ring.stations[n],
                           .to = ring.stations[(n + stations / 2) % stations],
                           .service = RingService::confirmed,
                           .every = 20 * kMillisecond,
                           .octets = 40});
    }
    return ring;
  }

  // From the instant from which cuts count on.
  void run(const RingDescription& description, kernel::Duration duration) {
    ring_.emplace(description, 1);
    ledger_.kinds = ring_->cycles().size();
    ring_->watch(ledger_);
    ring_->start();
    while (ring_->state() == network::State::coming_up) ring_->segment().run_for(kMillisecond);
    ASSERT_EQ(ring_->state(), network::State::exchanging) << ring_->complaint();
    ledger_.exchanges = ledger_.unserved = 0;
    ledger_.longest = {};
    ring_->segment().run_for(duration);
    EXPECT_EQ(ring_->state(), network::State::exchanging);
    for (const measure::Count& fault : ring_->delivery_faults()) EXPECT_EQ(fault.count, 0U) << fault.what;
  }
  std::uint64_t remark(std::string_view what) const {
    const auto all = ring_->remarks();
    return std::ranges::find(all, what, &measure::Count::what)->count;
  }

  std::optional<RingNetwork> ring_;
  CutLedger ledger_;
};

TEST_F(TwoChannels, AreOneLineAsLongAsBothAreWhole) {
  const RingDescription description = ring_of(4);
  run(description, 100 * kMillisecond);
  EXPECT_GT(ledger_.exchanges, 200U);
  EXPECT_EQ(ledger_.unserved, 0U);
  EXPECT_LE(ledger_.longest, longest_rotation(description));
  EXPECT_EQ(remark("tokens that were passed again"), 0U);
  for (const char* what :
       {"faults of channel A that were reported", "faults of channel B that were reported"})
    EXPECT_EQ(remark(what), 0U) << what;
  EXPECT_EQ(ring_->places().size(), 8U);
}

// The tokens of a ring of 16 pass the place of the cut, and each of its stations sees that it is cut.
TEST_F(TwoChannels, CarryARingOnWhileOneIsCutAndRepaired) {
  RingDescription description = ring_of(16);
  description.cuts = {{Channel::a, 10 * kMillisecond, 20 * kMillisecond, 16},
                      {Channel::b, 50 * kMillisecond, 20 * kMillisecond, 8}};
  run(description, 100 * kMillisecond);
  EXPECT_LE(remark("tokens that were passed again"), 4U) << "one for each cut and repair";
  EXPECT_EQ(remark("claims of the token"), 0U);
  for (const char* channel : {"A", "B"}) {
    EXPECT_EQ(remark(fmt::format("stations that reported faults of channel {}", channel)), 16U) << channel;
    EXPECT_EQ(remark(fmt::format("stations for which channel {} has a fault still", channel)), 0U) << channel;
  }
  EXPECT_LE(ledger_.unserved, 4U);
  EXPECT_EQ(ledger_.rounds_with_cuts.size(), 4U);
  EXPECT_LE(std::ranges::max(ledger_.rounds_with_cuts), longest_disturbed_rotation(description));
  EXPECT_LE(ledger_.longest, longest_disturbed_rotation(description));
}

// Whatever is on the line at the instant: preambles, delimiters, data, gaps.
TEST_F(TwoChannels, LoseNoTokenForMoreThanOnePassWhereverTheyAreCut) {
  kernel::Random random(7);
  std::uint64_t lost = 0;
  for (const std::int64_t us : {3, 30, 300}) {
    RingDescription description = ring_of(4);
    kernel::Duration at = kMillisecond;
    for (unsigned n = 0; n < 64; ++n) {
      const kernel::Duration lasts{random.between(1, us * kMicrosecond.count())};
      description.cuts.push_back(
          {kChannels[random.below(2)], at, lasts, description.stations[random.below(3)]});
      at += lasts + kernel::Duration{random.between(kMillisecond.count(), 2 * kMillisecond.count())};
    }
    run(description, at + kMillisecond);
    EXPECT_EQ(remark("claims of the token"), 0U) << us;
    EXPECT_LE(ledger_.longest, longest_disturbed_rotation(description)) << us;
    EXPECT_GT(ledger_.rounds_with_cuts.size(), 50U);
    lost += ledger_.unserved + remark("tokens that were passed again");
  }
  EXPECT_GT(lost, 10U) << "else the cuts met nothing";
}

TEST_F(TwoChannels, WithRepeatersNeedASlotTimeThatHoldsTheSelection) {
  RingDescription description = ring_of(4);
  description.cable_m = 600;
  description.repeaters_m = {300};
  description.rules.most_octets = description.cable.most_octets_with_repeaters;
  description.rules.slot_time_octets = needed_slot_octets(description);
  RingDescription one = description;
  one.channels = 1;
  EXPECT_EQ(needed_slot_octets(description), needed_slot_octets(one) + 2) << "a skew there and back";
  description.cuts = {{Channel::a, 10 * kMillisecond, 20 * kMillisecond, 2},
                      {Channel::a, 40 * kMillisecond, 20 * kMillisecond, 6}};
  run(description, 80 * kMillisecond);
  EXPECT_EQ(remark("claims of the token"), 0U);
  EXPECT_EQ(remark("stations that reported faults of channel A"), 4U);
  EXPECT_LE(ledger_.longest, longest_disturbed_rotation(description));
}

TEST_F(TwoChannels, AreWhatCutsNeed) {
  const auto sentence = [](auto change) {
    RingDescription description = ring_of(4);
    description.cuts = {{Channel::a, {}, kMillisecond, 4}};
    change(description);
    return violation_of(description).value_or(config::Violation{}).sentence;
  };
  EXPECT_EQ(sentence([](RingDescription&) {}), "");
  EXPECT_EQ(sentence([](RingDescription& ring) { ring.channels = 1; }),
            "a ring with \"cuts\" has \"channels\": 2");
  EXPECT_NE(sentence([](RingDescription& ring) { ring.cuts[0].after = 8; }), "");
  EXPECT_NE(sentence([](RingDescription& ring) { ring.cuts.push_back({Channel::b, {}, kMillisecond, 4}); }),
            "");
}

}  // namespace
}  // namespace fieldproof::token_bus

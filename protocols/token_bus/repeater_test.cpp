#include "protocols/token_bus/repeater.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocols/token_bus/ring_network.hpp"

namespace fieldproof::token_bus {
namespace {

class TwoSegments {
 public:
  kernel::Time at(std::int64_t bits) const {
    return kernel::kStart + kernel::levels_duration(bits, Rules{}.phy_bit_rate);
  }
  // What arrives at the other side.
  std::vector<line::Waveform> through(std::vector<line::Waveform> waves) {
    Repeater repeater(Rules{}, CableRules{}, of_left_, of_right_);
    return through(repeater, std::move(waves));
  }
  std::vector<line::Waveform> through_joint(line::Waveform wave, std::vector<Joint::Cut> cuts) {
    Joint joint(of_left_, of_right_);
    joint.set_cuts(std::move(cuts));
    return through(joint, {std::move(wave)});
  }
  line::Waveform wave(line::Levels half_bits, std::int64_t begin = 0) const {
    return {at(begin), 2 * Rules{}.phy_bit_rate, std::move(half_bits)};
  }

 private:
  class Arrivals final : public segment::Tap {
   public:
    void on_wave(const line::Waveform& wave) override { waves.push_back(wave); }
    std::vector<line::Waveform> waves;
  };

  std::vector<line::Waveform> through(Divider& divider, std::vector<line::Waveform> waves) {
    Arrivals arrivals;
    right_.listen("there", {}).tap_arrived(arrivals);
    for (std::size_t n = 0; n < waves.size(); ++n) {
      segment::MediumPort& from = left_.listen("station " + std::to_string(n), {});
      divider.hear(Divider::Side::left, from, {});
      from.drive(waves[n]);
    }
    segment_.run_for(50 * kernel::kMillisecond);
    return arrivals.waves;
  }

  segment::Segment segment_;
  kernel::Random random_{1};
  segment::Medium left_{segment_, "left", segment::ContentionRule::noise, random_};
  segment::Medium right_{segment_, "right", segment::ContentionRule::noise, random_};
  segment::MediumPort& of_left_ = left_.listen("divider, left", {});
  segment::MediumPort& of_right_ = right_.listen("divider, right", {});
};

Frame datum(std::size_t octets) {
  return {.kind = FrameKind::data, .destination = 4, .source = 2, .data = Octets(octets, 0x55)};
}

constexpr std::int64_t kDelay = 20;  // bits

// A frame that lost what repeaters or receivers may lose of its front is whole again, and late by the delay.
RC_GTEST_PROP(Repeater, RegeneratesThePreamble, ()) {
  TwoSegments segments;
  const Rules rules;
  Frame frame = datum(*rc::gen::inRange<std::size_t>(0, 60));
  for (std::uint8_t& octet : frame.data) octet = *rc::gen::arbitrary<std::uint8_t>();
  const line::Levels whole = levels_of(frame, rules);
  const auto lost = *rc::gen::inRange<std::size_t>(0, 60);  // bits
  const auto arrived = segments.through({segments.wave(whole.slice(2 * lost, whole.size() - 2 * lost))});
  RC_ASSERT(arrived.size() == 1U);
  RC_ASSERT(arrived.front().start == segments.at(kDelay));
  const std::size_t left = 66 - lost;  // of the preamble
  RC_ASSERT(arrived.front().levels.size() ==
            2 * (std::max<std::size_t>(left, 64) - left) + whole.size() - 2 * lost);
  const auto read = FrameReader(rules).read(arrived.front());
  RC_ASSERT(read.size() == 1U);
  RC_ASSERT(read.front().kind == ReceptionKind::frame);
  RC_ASSERT(frame_of(read.front().octets, rules) == std::optional(frame));
}

RC_GTEST_PROP(Repeater, StretchesFragments, ()) {
  TwoSegments segments;
  line::Levels half_bits;
  const auto bits = *rc::gen::inRange<unsigned>(1, 96);
  for (unsigned n = 0; n < bits; ++n) half_bits.append(*rc::gen::element<std::uint64_t>(0, 1, 2, 3), 2);
  const auto arrived = segments.through({segments.wave(half_bits)});
  RC_ASSERT(arrived.size() == 1U);
  RC_ASSERT(arrived.front().levels.size() >= 2 * 96U);
}

TEST(Repeater, LetsCollisionsThrough) {
  TwoSegments segments;
  const line::Levels frame = levels_of(datum(20), Rules{});
  const auto arrived = segments.through({segments.wave(frame), segments.wave(frame, 31)});
  ASSERT_EQ(arrived.size(), 1U);
  EXPECT_EQ(arrived.front().start, segments.at(kDelay));
  EXPECT_GE(arrived.front().end(), segments.at(kDelay + 31 + static_cast<std::int64_t>(frame.size() / 2)));
  EXPECT_NE(FrameReader(Rules{}).read(arrived.front()).front().kind, ReceptionKind::frame);
}

TEST(Repeater, CutsJabber) {
  const Rules rules;
  // 5 ms are 50,000 bits: 3125 octets with preamble and delimiters.
  for (const std::size_t octets : {3'125U - 15U, 3'125U - 14U}) {
    TwoSegments segments;
    const auto arrived = segments.through({segments.wave(levels_of(datum(octets), rules))});
    ASSERT_EQ(arrived.size(), 1U);
    const ReceptionKind kind = FrameReader(rules).read(arrived.front()).front().kind;
    EXPECT_EQ(kind, octets == 3'125U - 15U ? ReceptionKind::frame : ReceptionKind::fragment) << octets;
    EXPECT_EQ(arrived.front().levels.size(), 100'000U);
  }
  EXPECT_LE(frame_time(rules, CableRules{}.most_octets_with_repeaters), 4 * kernel::kMillisecond)
      << "the least after which such a protection may act, from memory";
}

TEST(Joint, PassesWhatComesWhileTheCableIsWhole) {
  TwoSegments segments;
  const auto arrived = segments.through_joint(segments.wave(levels_of(datum(20), Rules{})),
                                              {{segments.at(10), segments.at(20)},
                                               {segments.at(300), segments.at(500)},
                                               {segments.at(600), segments.at(700)}});
  ASSERT_EQ(arrived.size(), 3U);
  EXPECT_EQ(arrived[0].start, segments.at(0));
  EXPECT_EQ(arrived[0].end(), segments.at(10));
  EXPECT_EQ(arrived[1].start, segments.at(20));
  EXPECT_EQ(arrived[1].end(), segments.at(300));
  EXPECT_EQ(arrived[2].start, segments.at(500));
  EXPECT_EQ(arrived[2].end(), segments.at(560));
}

// ---- in a ring ----

RingDescription long_ring() {
  RingDescription ring = RingDescription::built_in(5);
  ring.cable_m = 1'200;
  ring.repeaters_m = {400, 800};
  ring.rules.most_octets = ring.cable.most_octets_with_repeaters;
  ring.rules.slot_time_octets = needed_slot_octets(ring);
  return ring;
}

// 1200 m and two repeaters: 5.28 us and 4 us, there and back, and twice 20 us.
TEST(LongRing, NeedsASlotTimeThatHoldsItsPath) {
  RingDescription ring = long_ring();
  EXPECT_EQ(path_delay(ring), 9'280 * kernel::kNanosecond);
  EXPECT_EQ(needed_slot_octets(ring), 37U);  // 58.76 us
  EXPECT_FALSE(violation_of(ring));
  ring.rules.slot_time_octets = 36;
  EXPECT_EQ(violation_of(ring).value_or(config::Violation{}).sentence,
            "a slot time of 36 octets: a path of 9.280 us with 2 repeaters needs slot_time_octets of 37 at "
            "least, twice the path and the 20.000 us of a station");
  EXPECT_EQ(needed_slot_octets(RingDescription::built_in()), 26U);
}

TEST(LongRing, RefusesWhatNoLineIs) {
  const auto sentence = [](auto change) {
    RingDescription ring = long_ring();
    change(ring);
    return violation_of(ring).value_or(config::Violation{}).sentence;
  };
  EXPECT_NE(sentence([](RingDescription& ring) { ring.repeaters_m = {400}; }).find("a segment of 800 m"),
            std::string::npos);
  EXPECT_NE(sentence([](RingDescription& ring) { ring.repeaters_m = {400, 300}; }).find("in the order"),
            std::string::npos);
  EXPECT_NE(
      sentence([](RingDescription& ring) { ring.repeaters_m = {400, 800, 1'300}; }).find("in the order"),
      std::string::npos);
  EXPECT_NE(sentence([](RingDescription& ring) {
              ring.data.front().octets = 2'392;
            }).find("2392 octets, and a frame carries 5 to 2391, because a repeater cuts"),
            std::string::npos);
}

TEST(LongRing, ExchangesDataOverItsRepeaters) {
  const RingDescription description = long_ring();
  RingNetwork ring(description, 1);
  ring.start();
  while (ring.state() == network::State::coming_up) ring.segment().run_for(20 * kernel::kMillisecond);
  ASSERT_EQ(ring.state(), network::State::exchanging) << ring.complaint();
  class Rounds final : public network::ExchangeWatcher {
   public:
    void on_exchange(const network::Exchange& exchange) override {
      EXPECT_EQ(exchange.outcome, network::Outcome::served);
      EXPECT_EQ(exchange.retries, 0U);
      ++exchanges;
    }
    void on_shown(std::size_t, std::uint16_t, kernel::Time) override {}
    void on_cycle_begin(std::size_t, kernel::Time when) override {
      if (last) longest = std::max(longest, when - *last);
      last = when;
    }
    unsigned exchanges = 0;
    std::optional<kernel::Time> last{};
    kernel::Duration longest{};
  } rounds;
  ring.watch(rounds);
  ring.segment().run_for(100 * kernel::kMillisecond);
  EXPECT_GT(rounds.exchanges, 500U);
  EXPECT_LE(rounds.longest, longest_rotation(description));
  EXPECT_GT(rounds.longest, longest_rotation(RingDescription::built_in(5)) / 2);
  for (const measure::Count& fault : ring.delivery_faults()) EXPECT_EQ(fault.count, 0U) << fault.what;
}

}  // namespace
}  // namespace fieldproof::token_bus

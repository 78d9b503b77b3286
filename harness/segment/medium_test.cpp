#include "harness/segment/medium.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "harness/fault/scripted_channel.hpp"
#include "harness/line/written_wave.hpp"
#include "harness/segment/monitor.hpp"

namespace fieldproof::segment {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kStart;
using kernel::Time;
using line::wave_of;

std::string micros(Time time) {
  return std::to_string((time - kStart) / kMicrosecond);
}

// Writes down what it hears; drives what it was told to, at its time.
class Ear final : public Station {
 public:
  explicit Ear(Segment& segment) : segment_(segment) {}
  void receive(PortIndex, const line::Waveform& reception) override {
    heard += "@" + micros(reception.start) + " " + reception.levels.text() + " told " +
             micros(segment_.now()) + "; ";
    rate = reception.rate;
    if (answer != nullptr) std::exchange(answer, nullptr)->drive(answer_wave);
  }
  void on_activity(PortIndex, bool begins, Time now) override {
    activity += (begins ? "from " : "to ") + micros(now) + "; ";
    if (!begins) told_before_end = heard;
  }
  void on_time(Time) override {}
  Time next_time() const override { return kernel::kNever; }

  std::string heard;
  std::string activity;
  std::string told_before_end;
  std::int64_t rate = 0;
  MediumPort* answer = nullptr;
  line::Waveform answer_wave;

 private:
  Segment& segment_;
};

// Three stations at 0, 1 and 3 microseconds of cable.
class Bus {
 public:
  explicit Bus(ContentionRule rule = ContentionRule::zero_wins, bool receives_own_echo = false,
               std::uint64_t seed = 1)
      : medium(segment, "bus", rule, kernel::Random(seed)) {
    for (const int position : {0, 1, 3}) {
      const std::string name = "at " + std::to_string(position);
      Ear& ear = ears.emplace_back(segment);
      ports.push_back(
          &medium.attach(name, segment.attach(ear, name), 0, position * kMicrosecond, receives_own_echo));
    }
  }
  void drive(std::size_t station, line::Waveform wave) { ports[station]->drive(wave); }
  void run(Duration until = 1000 * kMicrosecond) { segment.run_until(kStart + until); }

  Segment segment;
  std::deque<Ear> ears;
  std::vector<MediumPort*> ports;
  Medium medium;
};

TEST(Medium, TellsActivityOfOthersWhereItIsSensed) {
  Bus bus;
  for (MediumPort* port : bus.ports) port->sense_activity();
  bus.drive(0, wave_of("0101", 5 * kMicrosecond));
  bus.drive(2, wave_of("00", 9 * kMicrosecond));
  bus.drive(0, wave_of("11", 9 * kMicrosecond));     // without a gap behind the first
  bus.drive(0, wave_of("000", 100 * kMicrosecond));  // a while later
  bus.run();
  EXPECT_EQ(bus.ears[0].activity, "from 12; to 14; ");
  EXPECT_EQ(bus.ears[1].activity, "from 6; to 13; from 101; to 104; ");
  EXPECT_EQ(bus.ears[2].activity, "from 8; to 14; from 103; to 106; ");
  EXPECT_EQ(bus.ears[2].told_before_end, bus.ears[2].heard);
}

TEST(Medium, ActivityIsWhatIsDrivenAndNotWhatAFaultMakesOfIt) {
  Bus bus;
  fault::ScriptedChannel channel;
  channel.lose();
  bus.ports[1]->sense_activity();
  bus.ports[1]->set_channel(&channel);
  bus.drive(0, wave_of("0101", 5 * kMicrosecond));
  bus.run();
  EXPECT_EQ(bus.ears[1].heard.find("0101"), std::string::npos);
  EXPECT_EQ(bus.ears[1].activity, "from 6; to 10; ");
  EXPECT_EQ(bus.ears[2].activity, "") << "who did not ask is not reported";
}

TEST(Medium, TellsATransmissionAtItsEndAsItWasDriven) {
  Bus bus;
  bus.drive(0, wave_of("0101", 5 * kMicrosecond));
  bus.run();
  EXPECT_EQ(bus.ears[0].heard, "");
  EXPECT_EQ(bus.ears[1].heard, "@6 0101 told 10; ");
  EXPECT_EQ(bus.ears[2].heard, "@8 0101 told 12; ");
}

TEST(Medium, TellsAStationThatHearsItselfItsOwnTransmission) {
  Bus bus(ContentionRule::zero_wins, true);
  bus.drive(1, wave_of("01", Duration{}));
  bus.run();
  EXPECT_EQ(bus.ears[1].heard, "@0 01 told 2; ");
}

TEST(Medium, ResolvesOverlapsAtEachPlaceForItself) {
  // At the far end the two overlap, at the near ends they do not.
  Bus bus;
  bus.drive(0, wave_of("0110", Duration{}));
  bus.drive(1, wave_of("0011", 4 * kMicrosecond));
  bus.run();
  EXPECT_EQ(bus.ears[2].heard, "@3 0110011 told 10; ") << "the last level of one is the first of the other";
  EXPECT_EQ(bus.ears[0].heard, "@5 0011 told 9; ") << "does not receive itself";
  EXPECT_EQ(bus.ears[1].heard, "@1 0110 told 5; ");
}

TEST(Medium, DoesNotCallItAnOverlapWhenOneBeginsWhereTheOtherEnds) {
  Bus bus;
  bus.drive(0, wave_of("01", Duration{}));
  bus.drive(1, wave_of("001", 3 * kMicrosecond));
  bus.run();
  EXPECT_EQ(bus.ears[2].heard, "@3 01 told 5; @5 001 told 8; ");
}

TEST(Medium, LetsTheDominantLevelWin) {
  const auto heard = [](ContentionRule rule) {
    Bus bus(rule);
    bus.drive(0, wave_of("0011", Duration{}));
    bus.drive(1, wave_of("0101", 1 * kMicrosecond));
    bus.run();
    return bus.ears[2].heard;
  };
  // Both begin at the far end at 3 and 3: on one grid.
  EXPECT_EQ(heard(ContentionRule::zero_wins), "@3 0001 told 7; ");
  EXPECT_EQ(heard(ContentionRule::one_wins), "@3 0111 told 7; ");
}

TEST(Medium, ResolvesOffTheGridAtAFinerRate) {
  Bus bus;
  bus.drive(0, wave_of("00", Duration{}));
  bus.drive(1, wave_of("1", 1 * kMicrosecond + kMicrosecond / 2));
  bus.run();
  EXPECT_EQ(bus.ears[2].rate, 16'000'000);
  EXPECT_EQ(bus.ears[2].heard, "@3 " + std::string(32, '0') + " told 5; ");
}

TEST(Medium, NoiseIsDrawnOnlyWhereDriversDisagree) {
  bool has_zero = false;
  bool has_one = false;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    Bus bus(ContentionRule::noise, false, seed);
    bus.drive(0, wave_of("0011", Duration{}));
    bus.drive(1, wave_of("0101", 1 * kMicrosecond));
    bus.run();
    const std::string& heard = bus.ears[2].heard;
    EXPECT_EQ(heard[3], '0');
    EXPECT_EQ(heard[6], '1');
    (heard[4] == '0' ? has_zero : has_one) = true;
  }
  EXPECT_TRUE(has_zero && has_one);
}

TEST(Medium, TellsContentionToWatchersAndTrace) {
  Bus bus;
  LineMonitor far({}, bus.segment.trace(), bus.ports[2]->trace_channel());
  bus.medium.watch(far);
  bus.ports[2]->tap_arrived(far);
  bus.drive(0, wave_of("0000", Duration{}));
  bus.run(2 * kMicrosecond);
  bus.drive(1, wave_of("11", 2 * kMicrosecond));
  bus.run();
  ASSERT_EQ(far.violations().size(), 1U);
  EXPECT_EQ(far.violations()[0].kind, ViolationKind::overlap);
  EXPECT_EQ(far.violations()[0].time, kStart + 3 * kMicrosecond);
}

TEST(Medium, KnowsWhereTheLineIsBusy) {
  Bus bus;
  bus.drive(0, wave_of("00", 2 * kMicrosecond));
  const auto busy = [&](Duration at) {
    std::string text;
    for (MediumPort* port : bus.ports) text += port->is_busy(kStart + at) ? 'x' : '.';
    return text;
  };
  EXPECT_EQ(busy(1 * kMicrosecond), "...");
  EXPECT_EQ(busy(2 * kMicrosecond), "x..");
  EXPECT_EQ(busy(3 * kMicrosecond), "xx.");
  EXPECT_EQ(busy(4 * kMicrosecond), ".x.");
  EXPECT_EQ(busy(5 * kMicrosecond), "..x");
  EXPECT_EQ(busy(7 * kMicrosecond), "...");
}

TEST(Medium, AStationMayAnswerWhileItIsTold) {
  Bus bus;
  bus.ears[1].answer = bus.ports[1];
  bus.ears[1].answer_wave = wave_of("001", 4 * kMicrosecond);
  bus.drive(0, wave_of("01", Duration{}));
  bus.run();
  EXPECT_EQ(bus.ears[0].heard, "@5 001 told 8; ");
  EXPECT_EQ(bus.ears[2].heard, "@3 01 told 5; @6 001 told 9; ");
}

TEST(Medium, AsksTheChannelOfEachPlace) {
  Bus bus;
  fault::ScriptedChannel channel;
  bus.ports[1]->set_channel(&channel);
  channel.on_next().delay(10 * kMicrosecond);
  channel.on(1).drop(1, 1);
  bus.drive(0, wave_of("0101", Duration{}));
  bus.drive(0, wave_of("000", 5 * kMicrosecond));
  bus.run();
  EXPECT_EQ(bus.ears[1].heard, "@6 0 told 9; @8 0 told 9; @11 0101 told 15; ");
  EXPECT_EQ(bus.ears[2].heard, "@3 0101 told 7; @8 000 told 11; ");
}

// Every place hears, at every instant, what the rule makes of the levels that reach it; an independent sum.
RC_GTEST_PROP(Medium, LeavesTheLineAsTheRuleSays, (std::uint64_t seed)) {
  constexpr std::size_t kInstants = 250;
  kernel::Random random(seed);
  const bool zero_wins = seed % 2 == 0;
  Bus ruled(zero_wins ? ContentionRule::zero_wins : ContentionRule::one_wins);
  std::vector<line::Waveform> arriving;
  for (int n = 0; n < 6; ++n) {
    line::Waveform wave;
    wave.start = kStart + kMicrosecond * random.between(0, 40);
    wave.rate = 1'000'000;
    for (std::int64_t words = random.between(1, 3); words > 0; --words)
      wave.levels.append(random.next(), static_cast<unsigned>(random.between(1, 64)));
    arriving.push_back(wave);
    const bool from_first = random.chance(0.5);
    arriving.back().start += (from_first ? 3 : 2) * kMicrosecond;
    ruled.drive(from_first ? 0 : 1, wave);
  }
  class Line final : public Tap {
   public:
    void on_wave(const line::Waveform& wave) override {
      for (std::size_t n = 0; n < wave.levels.size(); ++n) {
        levels.at(static_cast<std::size_t>((wave.time_of(n) - kStart) / kMicrosecond)) = wave.levels[n];
      }
    }
    std::vector<bool> levels = std::vector<bool>(kInstants, true);
  } heard;
  ruled.ports[2]->tap_arrived(heard);
  ruled.run();
  for (std::size_t n = 0; n < kInstants; ++n) {
    const Time at = kStart + kMicrosecond * static_cast<std::int64_t>(n);
    bool has_zero = false;
    bool has_one = false;
    for (const line::Waveform& wave : arriving) {
      if (at >= wave.start && at < wave.end()) (wave.at(at) ? has_one : has_zero) = true;
    }
    const bool expected = has_zero && has_one ? !zero_wins : !has_zero;
    RC_ASSERT(heard.levels[n] == expected);
  }
}

}  // namespace
}  // namespace fieldproof::segment

#include "harness/segment/segment.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/line/written_wave.hpp"

namespace fieldproof::segment {
namespace {

using kernel::kMicrosecond;
using kernel::kStart;

// Notes what it is told, and when; answers as a test says.
class Listener final : public Station {
 public:
  explicit Listener(Segment& segment) : segment_(segment) {}

  void receive(PortIndex port, const line::Waveform& wave) override {
    told.push_back(kernel::describe(segment_.now()) + " port " + std::to_string(port) + " " +
                   wave.levels.text());
    if (answer) answer(wave);
  }
  void on_time(kernel::Time now) override {
    told.push_back(kernel::describe(now) + " time");
    wanted = kernel::kNever;
  }
  kernel::Time next_time() const override { return wanted; }

  std::vector<std::string> told;
  kernel::Time wanted = kernel::kNever;
  std::function<void(const line::Waveform&)> answer;

 private:
  Segment& segment_;
};

// Gives each transmission twice, the second one later; loses those that are longer than four levels.
class Echo final : public fault::Channel {
 public:
  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    if (sent.levels.size() > 4) return true;
    arrivals.add(sent);
    arrivals.add(sent);
    arrivals.back().start += 50 * kMicrosecond;
    return true;
  }
};

class SegmentTest : public ::testing::Test {
 protected:
  Segment segment;
  Listener a{segment};
  std::size_t seat = segment.attach(a, "a");
  Link& link = segment.connect("a/in", seat, 3, 5 * kMicrosecond);

  void drive(kernel::Time start, const std::string& levels) {
    line::Waveform wave = line::wave_of(levels, start - kStart);
    link.drive(wave);
    EXPECT_TRUE(wave.levels.empty());
    EXPECT_EQ(wave.rate, 1'000'000);
  }
};

TEST_F(SegmentTest, ATransmissionArrivesAfterTheDelay) {
  drive(kStart + 10 * kMicrosecond, "01");
  segment.run_until(kStart + 15 * kMicrosecond - kernel::kPicosecond);
  EXPECT_TRUE(a.told.empty());
  segment.run_until(kStart + 15 * kMicrosecond);
  EXPECT_EQ(a.told, (std::vector<std::string>{"15.000 us port 3 01"}));
}

TEST_F(SegmentTest, SeveralTransmissionsAreOnTheirWayInOrder) {
  for (int n = 0; n < 20; ++n) drive(kStart + n * kMicrosecond, n % 2 == 0 ? "0" : "1");
  segment.run_until(kStart + 100 * kMicrosecond);
  ASSERT_EQ(a.told.size(), 20U);
  EXPECT_EQ(a.told.front(), "5.000 us port 3 0");
  EXPECT_EQ(a.told.back(), "24.000 us port 3 1");
}

TEST_F(SegmentTest, AChannelMayRepeatAndLose) {
  Echo echo;
  link.set_channel(&echo);
  drive(kStart, "01");
  drive(kStart + 20 * kMicrosecond, "010101");
  drive(kStart + 40 * kMicrosecond, "0");
  segment.run_until(kStart + 200 * kMicrosecond);
  EXPECT_EQ(a.told, (std::vector<std::string>{"5.000 us port 3 01", "45.000 us port 3 0",
                                              "55.000 us port 3 01", "95.000 us port 3 0"}));
}

TEST_F(SegmentTest, ALinkThatIsNotConnectedCarriesNothing) {
  link.set_connected(false);
  drive(kStart, "01");
  segment.run_until(kStart + 20 * kMicrosecond);
  link.set_connected(true);
  drive(kStart + 20 * kMicrosecond, "00");
  segment.run_until(kStart + 40 * kMicrosecond);
  EXPECT_EQ(a.told, (std::vector<std::string>{"25.000 us port 3 00"}));
}

TEST_F(SegmentTest, OverlapsAreCounted) {
  drive(kStart, "0000");
  drive(kStart + 4 * kMicrosecond, "0000");
  EXPECT_EQ(link.overlap_count(), 0U);
  drive(kStart + 7 * kMicrosecond, "0");
  EXPECT_EQ(link.overlap_count(), 1U);
}

TEST_F(SegmentTest, NobodyDrivesInThePast) {
  segment.run_until(kStart + kMicrosecond);
  line::Waveform wave = line::wave_of("0");
  try {
    link.drive(wave);
    FAIL() << "a wave in the past was taken";
  } catch (const kernel::Error& error) {
    // The driver is blamed, with the line, not the bench.
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    EXPECT_NE(std::string(error.what()).find(link.name()), std::string::npos) << error.what();
  }
  wave = line::wave_of("0", kMicrosecond);
  EXPECT_NO_THROW(link.drive(wave));
}

TEST_F(SegmentTest, AStationIsToldTheTimeThatItWants) {
  a.wanted = kStart + 7 * kMicrosecond;
  segment.refresh(seat);
  segment.run_until(kStart + 20 * kMicrosecond);
  EXPECT_EQ(a.told, (std::vector<std::string>{"7.000 us time"}));
}

TEST_F(SegmentTest, AWantedTimeThatMovesLaterIsNotToldEarly) {
  a.wanted = kStart + 10 * kMicrosecond;
  segment.refresh(seat);
  a.answer = [&](const line::Waveform&) { a.wanted = kStart + 30 * kMicrosecond; };
  drive(kStart, "0");
  segment.run_until(kStart + 50 * kMicrosecond);
  EXPECT_EQ(a.told, (std::vector<std::string>{"5.000 us port 3 0", "30.000 us time"}));
}

TEST_F(SegmentTest, EqualHistoriesHaveEqualFingerprintsAndOthersHaveNot) {
  const auto fingerprint = [](kernel::Duration shift, const std::string& levels) {
    Segment other;
    Listener station(other);
    Link& to = other.connect("x", other.attach(station, "x"), 0, {});
    line::Waveform wave = line::wave_of(levels, shift);
    to.drive(wave);
    return other.trace().fingerprint();
  };
  EXPECT_EQ(fingerprint({}, "0101"), fingerprint({}, "0101"));
  EXPECT_NE(fingerprint({}, "0101"), fingerprint({}, "0111"));
  EXPECT_NE(fingerprint({}, "0101"), fingerprint({}, "01011"));
  EXPECT_NE(fingerprint({}, "0101"), fingerprint(kernel::kPicosecond, "0101"));
}

// Asks for the instant at which it is, always.
class Stuck final : public Station {
 public:
  void receive(PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kStart + 3 * kMicrosecond; }
};

TEST(Segment, AStationThatAsksForTheSameInstantForEverEndsTheRunWithItsName) {
  Segment segment;
  Stuck stuck;
  segment.attach(stuck, "node");
  try {
    segment.run_for(5 * kMicrosecond);
    FAIL() << "the run ended";
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    const std::string sentence = error.what();
    EXPECT_NE(sentence.find("\"node\""), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("same instant"), std::string::npos) << sentence;
  }
}

}  // namespace
}  // namespace fieldproof::segment

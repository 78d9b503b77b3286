#include "harness/fault/arrivals.hpp"
#include "harness/line/written_wave.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace fieldproof::fault {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;
using line::wave_of;
using line::Waveform;
using line::Waveforms;

TEST(ArrivalWriter, JoinsPiecesWithoutAGap) {
  const Waveform sent = wave_of("01100");
  Waveforms arrivals;
  ArrivalWriter writer(sent, arrivals);
  writer.write({0, 2});
  writer.write(wave_of("11").levels, {0, 2}, 2);
  writer.shift(2);
  writer.write({2, 100});
  writer.finish();
  ASSERT_EQ(arrivals.size(), 1U);
  EXPECT_EQ(arrivals[0].levels.text(), "0111100");
  EXPECT_EQ(arrivals[0].start, sent.start);
}

TEST(ArrivalWriter, LetsTheLaterArrivalWinFromItsStartOn) {
  const Waveform sent = wave_of("0000011111");
  Waveforms arrivals;
  ArrivalWriter writer(sent, arrivals);
  writer.write({0, 5}, 3 * kMicrosecond);
  writer.write({5, 5});
  writer.finish();
  ASSERT_EQ(arrivals.size(), 2U);
  EXPECT_EQ(arrivals[0].levels.text(), "00");
  EXPECT_EQ(arrivals[0].end(), arrivals[1].start);
  EXPECT_EQ(arrivals[1].levels.text(), "11111");
}

TEST(CutBack, KeepsLevelsThatEndInTime) {
  Waveform exact = wave_of("0101");
  cut_back(exact, kStart + 2 * kMicrosecond);
  EXPECT_EQ(exact.levels.text(), "01");
  Waveform just_before = wave_of("0101");
  cut_back(just_before, kStart + 2 * kMicrosecond - kPicosecond);
  EXPECT_EQ(just_before.levels.text(), "0");
  Waveform last = wave_of("0101");
  cut_back(last, kStart + 4 * kMicrosecond - kPicosecond);
  EXPECT_EQ(last.levels.text(), "010");
  Waveform all = wave_of("0101");
  cut_back(all, kStart);
  EXPECT_TRUE(all.levels.empty());
}

TEST(CutFront, KeepsLevelsThatBeginInTime) {
  Waveform exact = wave_of("0100");
  cut_front(exact, kStart + 1 * kMicrosecond);
  EXPECT_EQ(exact.levels.text(), "100");
  EXPECT_EQ(exact.start, kStart + 1 * kMicrosecond);
  Waveform just_behind = wave_of("0100");
  cut_front(just_behind, kStart + 1 * kMicrosecond + kPicosecond);
  EXPECT_EQ(just_behind.levels.text(), "00");
}

RC_GTEST_PROP(Arrivals, NeverOverlapAndAreInOrder, ()) {
  Waveform sent;
  sent.rate = *rc::gen::inRange<std::int64_t>(1'000, 20'000'000);
  sent.levels.append(*rc::gen::arbitrary<std::uint64_t>(), 60);
  Waveforms arrivals;
  ArrivalWriter writer(sent, arrivals);
  std::size_t at = 0;
  while (at < 60) {
    const auto count = *rc::gen::inRange<std::size_t>(1, 20);
    if (*rc::gen::inRange(0, 3) == 0) writer.shift(Duration{*rc::gen::inRange<std::int64_t>(0, 50'000'000)});
    writer.write({at, count}, Duration{*rc::gen::inRange<std::int64_t>(0, 90'000'000)});
    at += count;
  }
  writer.finish();
  for (std::size_t i = 0; i + 1 < arrivals.size(); ++i) {
    RC_ASSERT(!arrivals[i].levels.empty());
    RC_ASSERT(arrivals[i].end() <= arrivals[i + 1].start);
  }
}

}  // namespace
}  // namespace fieldproof::fault

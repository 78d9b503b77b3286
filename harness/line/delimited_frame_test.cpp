#include "harness/line/delimited_frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "harness/line/frame_check_16.hpp"

namespace fieldproof::line {
namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t kOneMegabit = 1'000'000;
constexpr std::int64_t kHalfBitRate = 2 * kOneMegabit;

// Frames that the hardware model of nanoFIP and its bus arbiter put on a line: an open implementation of the
// same physical layer, by CERN [searched]. Each ends with its frame check.
const std::vector<Octets>& golden_frames() {
  static const std::vector<Octets> all = {
      {0x03, 0x91, 0x01, 0x18, 0x31},
      {0x02, 0x40, 0x12, 0x81, 0xcb, 0xd3, 0x3d, 0x5c, 0x47, 0x02, 0x2f, 0x15,
       0x28, 0x02, 0x33, 0xeb, 0x99, 0xed, 0xf6, 0x94, 0x05, 0x84, 0xf3},
      {0x03, 0x05, 0x5a, 0x75, 0xa2},
      {0x02, 0x40, 0x0c, 0xe8, 0xe0, 0xcb, 0xa2, 0x86, 0xe8, 0x3c, 0xbd, 0xee, 0x52, 0xd9, 0x05, 0x82, 0xb7},
      {0x03, 0x06, 0x5a, 0xf7, 0xb1},
      {0x02, 0x40, 0x12, 0x05, 0xa6, 0x0b, 0x8a, 0xc9, 0x7c, 0x1e, 0xb7, 0xfa,
       0x20, 0x5e, 0x71, 0x37, 0x54, 0x15, 0xbb, 0x00, 0x05, 0x07, 0x37},
      {0x03, 0x14, 0x5a, 0xba, 0x2e},
      {0x02, 0x50, 0x05, 0x80, 0x03, 0x00, 0xf0, 0x00, 0x9a, 0x24},
      {0x03, 0x10, 0x5a, 0xab, 0x60},
      {0x02, 0x52, 0x08, 0x01, 0x00, 0x00, 0xc3, 0x3c, 0x00, 0x00, 0x00, 0x29, 0xd4},
      {0x02, 0x40, 0x12, 0xb0, 0xd4, 0x2d, 0x7b, 0xc9, 0x7c, 0x1e, 0xb7, 0xfa,
       0x20, 0x7d, 0x0a, 0xf5, 0x74, 0x15, 0xbb, 0x00, 0x05, 0xa0, 0xf6},
      {0x02, 0x40, 0x12, 0x84, 0x5e, 0x4e, 0xe0, 0x03, 0x23, 0xb2, 0x30, 0x97,
       0x3d, 0xfd, 0x37, 0x50, 0xc3, 0x15, 0xbb, 0x00, 0x05, 0x80, 0x62},
      {0x02, 0x40, 0x03, 0x36, 0x95, 0x05, 0x97, 0x15},
  };
  return all;
}

Waveform frame_wave(const Octets& octets, unsigned preamble = 1) {
  Waveform wave{kernel::kStart, kHalfBitRate, {}};
  DelimitedFrameCode().append(wave.levels, octets, preamble);
  return wave;
}

// As written in the facts: 1 is HL, 0 is LH, + is HH, - is LL.
std::string levels_written(std::string_view symbols) {
  std::string levels;
  for (const char symbol : symbols) {
    levels += symbol == '1' ? "10" : symbol == '0' ? "01" : symbol == '+' ? "11" : "00";
  }
  return levels;
}

std::string symbols_of(const Octets& octets) {
  std::string bits;
  for (const std::uint8_t octet : octets) {
    for (int bit = 7; bit >= 0; --bit) bits += (octet >> bit & 1) != 0 ? '1' : '0';
  }
  return bits;
}

TEST(DelimitedFrame, GoldenFramesAreEncodedSymbolBySymbol) {
  for (const Octets& octets : golden_frames()) {
    EXPECT_EQ(frame_wave(octets).levels.text(), levels_written("10101010"
                                                               "1+-10-+0" +
                                                               symbols_of(octets) + "1+-+-101"));
  }
}

TEST(DelimitedFrame, GoldenFramesComeBackAndTheirCheckFits) {
  const FrameCheck16& check = shared_frame_check_16("CRC-16/PROFIBUS");
  for (const Octets& octets : golden_frames()) {
    const auto frames = delimited_frames_in(frame_wave(octets), kOneMegabit);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].end, FrameEnd::whole);
    EXPECT_EQ(frames[0].octets, octets);
    EXPECT_EQ(frames[0].half_bit, 16U);
    const Octets content(octets.begin(), octets.end() - 2);
    EXPECT_EQ(check.compute(content), octets.end()[-2] << 8 | octets.end()[-1]);
  }
}

TEST(DelimitedFrame, AFrameLastsAsLongAsItsFormulaSays) {
  EXPECT_EQ(frame_wave(Octets(75), 8).levels.size(), DelimitedFrameCode::levels_of(75, 8));
  // 75 octets and one of preamble at 1 Mbit/s: 624 us.
  EXPECT_EQ(frame_wave(Octets(75)).end() - kernel::kStart, 624 * kernel::kMicrosecond);
}

RC_GTEST_PROP(DelimitedFrameProperty, ComesBackBehindAnyPreambleThatIsCutAnywhere, ()) {
  const auto octets = *rc::gen::arbitrary<Octets>();
  const auto preamble = *rc::gen::inRange(1U, 9U);
  const auto cut = *rc::gen::inRange<std::size_t>(0, 16 * preamble + 1);
  Waveform wave = frame_wave(octets, preamble);
  wave.levels = wave.levels.slice(cut, wave.levels.size() - cut);
  const auto frames = delimited_frames_in(wave, kOneMegabit);
  RC_ASSERT(frames.size() == 1U);
  RC_ASSERT(frames[0].end == FrameEnd::whole);
  RC_ASSERT(frames[0].octets == octets);
}

// Each edge up to a tenth of a bit beside its place.
RC_GTEST_PROP(DelimitedFrameProperty, ComesBackWithJitterToItsLimit, (const Octets& octets)) {
  constexpr std::size_t kFine = 20;  // levels for each half bit
  const Levels straight = frame_wave(octets).levels;
  Waveform wave{kernel::kStart, kHalfBitRate * static_cast<std::int64_t>(kFine), {}};
  std::size_t placed = 0;
  for (std::size_t at = 0; at < straight.size();) {
    const std::size_t end = straight.end_of_run(at);
    const auto late = *rc::gen::inRange(0, 9);  // of 4, so from -0.1 to 0.1 bit
    const std::size_t border =
        end == straight.size() ? end * kFine : end * kFine + static_cast<std::size_t>(late) - 4;
    wave.levels.append_fill(straight[at], border - placed);
    placed = border;
    at = end;
  }
  const auto frames = delimited_frames_in(wave, kOneMegabit);
  RC_ASSERT(frames.size() == 1U);
  RC_ASSERT(frames[0].end == FrameEnd::whole);
  RC_ASSERT(frames[0].octets == octets);
}

// One half bit between the delimiters is never taken for another octet: no data symbol is one half bit away
// from another.
RC_GTEST_PROP(DelimitedFrameProperty, OneFlippedHalfBitIsSeenWithoutTheCheck, ()) {
  const auto octets = *rc::gen::nonEmpty<Octets>();
  Waveform wave = frame_wave(octets);
  wave.levels.flip(32 + *rc::gen::inRange<std::size_t>(0, 16 * octets.size()));
  for (const DelimitedFrame& frame : delimited_frames_in(wave, kOneMegabit)) {
    RC_ASSERT(frame.end != FrameEnd::whole);
  }
}

TEST(DelimitedFrame, HalfAnOctetIsToldAsThat) {
  Waveform wave = frame_wave({0x12, 0x34});
  Levels shorter = wave.levels.slice(0, 32 + 24);
  shorter.append(wave.levels.slice(32 + 32, 16));
  wave.levels = shorter;
  const auto frames = delimited_frames_in(wave, kOneMegabit);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].end, FrameEnd::cut_octet);
  EXPECT_EQ(frames[0].octets, Octets{0x12});
}

TEST(DelimitedFrame, AnotherStartBeginsAnotherFrame) {
  Waveform wave = frame_wave({0x12, 0x34});
  wave.levels = wave.levels.slice(0, 32 + 16);
  wave.levels.append(frame_wave({0x56}).levels, 16, 48);
  const auto frames = delimited_frames_in(wave, kOneMegabit);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].end, FrameEnd::begun_anew);
  EXPECT_EQ(frames[1].end, FrameEnd::whole);
  EXPECT_EQ(frames[1].octets, Octets{0x56});
}

TEST(DelimitedFrame, WhatBreaksOffIsLost) {
  Waveform wave = frame_wave({0x12, 0x34});
  wave.levels = wave.levels.slice(0, 32 + 20);
  const auto frames = delimited_frames_in(wave, kOneMegabit);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].end, FrameEnd::signal_lost);
}

TEST(DelimitedFrame, TurnedPolarityHasNoStart) {
  for (const Octets& octets : golden_frames()) {
    const Waveform wave = frame_wave(octets);
    EXPECT_TRUE(delimited_frames_in(turned(wave), kOneMegabit).empty());
    EXPECT_EQ(delimited_frames_in(turned(turned(wave)), kOneMegabit).size(), 1U);
  }
}

TEST(DelimitedFrame, NoiseIsNoFrame) {
  Waveform wave{kernel::kStart, kHalfBitRate, {}};
  EXPECT_TRUE(delimited_frames_in(wave, kOneMegabit).empty());
  wave.levels.append_fill(false, 10'000);
  EXPECT_TRUE(delimited_frames_in(wave, kOneMegabit).empty());
}

}  // namespace
}  // namespace fieldproof::line

#include "harness/line/uart.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <vector>

#include "harness/line/gap_frame.hpp"
#include "harness/line/uart_codec.hpp"

namespace fieldproof::line {
namespace {

using kernel::Duration;
using kernel::Time;
using Octets = std::vector<std::uint8_t>;

Uart any_uart() {
  constexpr std::array kRates{2'404, 9'600, 375'000, 12'000'000};
  Uart uart;
  uart.bit_rate = *rc::gen::elementOf(kRates);
  uart.format.data_bits = *rc::gen::inRange(8U, 10U);
  uart.format.parity = static_cast<Parity>(*rc::gen::inRange(0, 5));
  uart.format.stop_bits = static_cast<StopBits>(*rc::gen::inRange(0, 3));
  if (uart.format.data_bits == 9) uart.upper_data_bits = *rc::gen::element<std::uint16_t>(0, 0x100);
  return uart;
}

// Keeps what is driven.
struct Driven {
  void drive(Waveform& wave) {
    waves.push_back(wave);
    wave.levels.clear();
  }
  std::vector<Waveform> waves;
};

// Eleven bits at 375 kbit/s, worked by hand.
TEST(Uart, HasTimesOfItsBitRateAndFormat) {
  const Uart uart{375'000, {.data_bits = 9}, 0x100};
  EXPECT_EQ(kernel::describe(uart.bits(3)), "8.000 us");
  EXPECT_EQ(kernel::describe(uart.character_time()), "29.333333 us");
  EXPECT_EQ(kernel::describe(uart.half_characters(7)), "102.666667 us");
  EXPECT_EQ(kernel::describe(uart.character_notice()), "32.000 us");
  EXPECT_EQ(uart.character_of(0x5A), 0x15A);
}

TEST(Uart, ANinthBitIsAParityBitForAUartOfEight) {
  Uart uart{9'600, {.data_bits = 9}, 0x100};
  EXPECT_EQ(uart.eight_bit_format().text(), "8m1");
  uart.upper_data_bits = 0;
  EXPECT_EQ(uart.eight_bit_format().text(), "8s1");
  uart.format = {.parity = Parity::even, .stop_bits = StopBits::two};
  EXPECT_EQ(uart.eight_bit_format().text(), "8e2");
}

// ---- the codec ----

RC_GTEST_PROP(UartCodec, DecodesWhatItDrives, (const Octets& octets)) {
  const Uart uart = any_uart();
  const UartCodec::DriverTime driver{*rc::gen::inRange(0U, 4U), *rc::gen::inRange(0U, 4U)};
  const Time start = kernel::kStart + kernel::kMillisecond;
  UartCodec codec(uart);
  Driven driven;
  const Time end = codec.drive(driven, octets, start, driver);
  RC_ASSERT(driven.waves.size() == octets.size());
  Octets received;
  for (const Waveform& wave : driven.waves) {
    codec.decode(wave, [&](const UartCharacter& one) {
      const auto before = 2 * static_cast<std::int64_t>(received.size());
      RC_ASSERT(std::chrono::abs(one.start - (start + uart.half_characters(before))) <= kernel::kNanosecond);
      RC_ASSERT(std::chrono::abs(one.busy_until - one.start - uart.character_time()) <= kernel::kNanosecond);
      RC_ASSERT(one.data == uart.character_of(one.octet()));
      RC_ASSERT(one.is_good());
      received.push_back(one.octet());
    });
  }
  RC_ASSERT(received == octets);
  if (octets.empty()) return;
  const auto length = static_cast<std::int64_t>(octets.size());
  const Duration off = end - (start + uart.half_characters(2 * length) + uart.bits(driver.after));
  RC_ASSERT(std::chrono::abs(off) <= kernel::kNanosecond);
  const Duration before = start - driven.waves.front().start - uart.bits(driver.before);
  RC_ASSERT(std::chrono::abs(before) <= kernel::kNanosecond);
}

TEST(UartCodec, RequiresTheStopBit) {
  UartCodec codec(Uart{9'600, {}, 0});
  Waveform wave;
  wave.rate = 9'600;
  codec.append(wave.levels, Octets{0x5A});
  for (const bool is_good : {true, false}) {
    unsigned characters = 0;
    codec.decode(wave, [&](const UartCharacter& one) {
      ++characters;
      EXPECT_EQ(one.octet(), 0x5A);
      EXPECT_EQ(one.is_good(), is_good);
    });
    EXPECT_EQ(characters, 1U);
    wave.levels.flip(9);
  }
}

// ---- frames between gaps ----

using Collector = GapFrameCollector<8>;
using Frame = GapFrame<8>;

constexpr Duration kCharacter = 10 * kernel::kMicrosecond;

// What is collected of octets with these gaps between them.
std::vector<Frame> collected(const InterCharacterGaps& gaps, const Octets& octets,
                             const std::vector<Duration>& between) {
  Collector collector(gaps);
  std::vector<Frame> frames;
  Time start{};
  for (std::size_t n = 0; n < octets.size(); ++n) {
    if (collector.ends_at() <= start) {
      frames.push_back(collector.frame());
      collector.clear();
    }
    const Time end = start + kCharacter;
    collector.add({.start = start, .busy_until = end, .data = octets[n]});
    start = end + (n < between.size() ? between[n] : Duration{});
  }
  if (!collector.is_empty()) frames.push_back(collector.frame());
  return frames;
}

// Whatever the limits are: a gap on either side of each.
RC_GTEST_PROP(GapFrameCollector, TakesGapsOnBothSidesOfEachLimit, ()) {
  InterCharacterGaps gaps;
  gaps.longest = Duration{*rc::gen::inRange(0, 1'000'000)};
  gaps.delimiter = gaps.longest + Duration{*rc::gen::inRange(2, 1'000'000)};
  gaps.notice = Duration{*rc::gen::inRange(0, 1'000'000)};
  const auto frames_of = [&](Duration gap) { return collected(gaps, {1, 2}, {gap}); };
  RC_ASSERT(!frames_of(gaps.longest).front().is_spoilt);
  RC_ASSERT(frames_of(gaps.longest).front().whole(2).has_value());
  RC_ASSERT(frames_of(gaps.longest + kernel::kPicosecond).front().is_spoilt);
  RC_ASSERT(frames_of(gaps.delimiter - kernel::kPicosecond).size() == 1U);
  RC_ASSERT(frames_of(gaps.delimiter - kernel::kPicosecond).front().is_spoilt);
  RC_ASSERT(frames_of(gaps.delimiter).size() == 2U);
  RC_ASSERT(!frames_of(gaps.delimiter).front().is_spoilt);
}

// Each gap alone decides, so frames are as long as the runs of short gaps.
RC_GTEST_PROP(GapFrameCollector, FramesAreTheRunsBetweenDelimiters, (const std::vector<bool>& ends)) {
  const InterCharacterGaps gaps{3 * kernel::kMicrosecond, 7 * kernel::kMicrosecond, {}};
  std::vector<Duration> between;
  std::vector<std::size_t> lengths{1};
  for (const bool is_end : ends) {
    between.push_back(is_end ? gaps.delimiter : gaps.longest);
    if (is_end) lengths.push_back(0);
    ++lengths.back();
  }
  const auto frames = collected(gaps, Octets(ends.size() + 1, 0x7E), between);
  RC_ASSERT(frames.size() == lengths.size());
  for (std::size_t n = 0; n < frames.size(); ++n) {
    RC_ASSERT(frames[n].count == lengths[n]);
    RC_ASSERT(!frames[n].is_spoilt);
    RC_ASSERT(frames[n].whole(lengths[n]).has_value() == (lengths[n] <= 8));
  }
}

TEST(GapFrameCollector, IsSureOfTheEndANoticeAfterIt) {
  Collector collector({{}, 7 * kernel::kMicrosecond, 2 * kernel::kMicrosecond});
  EXPECT_EQ(collector.ends_at(), kernel::kNever);
  EXPECT_EQ(collector.known_at(), kernel::kNever);
  collector.add({.start = kernel::kStart, .busy_until = kernel::kStart + kCharacter, .data = 1});
  EXPECT_EQ(collector.ends_at(), kernel::kStart + 17 * kernel::kMicrosecond);
  EXPECT_EQ(collector.known_at(), kernel::kStart + 19 * kernel::kMicrosecond);
}

TEST(GapFrameCollector, AWrongCharacterSpoilsItsFrame) {
  for (const UartCharacter& wrong :
       {UartCharacter{.is_parity_wrong = true}, UartCharacter{.is_stop_missing = true}}) {
    Collector collector({});
    collector.add(wrong);
    EXPECT_TRUE(collector.frame().is_spoilt);
    EXPECT_FALSE(collector.frame().whole(1));
  }
}

TEST(GapFrameCollector, CountsMoreOctetsThanItKeeps) {
  const auto frames = collected({}, Octets(300, 7), {});
  ASSERT_EQ(frames.size(), 300U);  // a delimiter of nothing
  const auto one = collected({{}, kernel::kPicosecond, {}}, Octets(300, 7), {});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].count, 300U);
  EXPECT_FALSE(one[0].whole(5));
  EXPECT_FALSE(one[0].whole(300));
}

}  // namespace
}  // namespace fieldproof::line

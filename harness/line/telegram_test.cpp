#include "harness/line/telegram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/line/telegram_receiver.hpp"

namespace fieldproof::line {
namespace {

constexpr std::int64_t kTelegramRate = 500'000;
const kernel::Duration kBit = kernel::levels_duration(1, kTelegramRate);

const TelegramCode& code() {
  static const TelegramCode code{TelegramLayout{}};
  return code;
}

struct Seen {
  kernel::Time start;
  std::uint8_t header;
  std::uint8_t data;
  friend bool operator==(const Seen&, const Seen&) = default;
};

void showValue(const Seen& seen, std::ostream& os) {
  os << kernel::describe(seen.start) << " " << int{seen.header} << " " << int{seen.data};
}

std::vector<Seen> hear(TelegramReceiver& receiver, const std::vector<Waveform>& waves) {
  std::vector<Seen> seen;
  const auto sink = [&](const Waveform& wave, const Telegram& t) {
    seen.push_back({wave.time_of(t.level), t.header, t.data});
  };
  for (const Waveform& wave : waves) {
    if (receiver.pending_until() <= wave.start) receiver.flush(sink);
    receiver.receive(wave, sink);
  }
  receiver.flush(sink);
  return seen;
}

std::vector<Seen> hear(const std::vector<Waveform>& waves, TelegramReceiverOptions options = {}) {
  TelegramReceiver receiver(code(), kTelegramRate, options);
  return hear(receiver, waves);
}

// The receiver that a reader believes: one level after the other, by the text of the layout.
std::vector<Seen> hear_bit_by_bit(const Waveform& wave) {
  std::vector<Seen> seen;
  const Levels& levels = wave.levels;
  std::size_t n = 0;
  while (n < levels.size()) {
    if (levels[n]) {
      ++n;
      continue;
    }
    Seen telegram{wave.time_of(n), 0, 0};
    if (levels[n + 1]) telegram.header |= kSelect;
    if (levels[n + 2]) telegram.header |= kControl;
    const bool is_data = levels[n + 3];
    if (is_data) telegram.header |= kDataTelegram;
    std::size_t stop = n + 4;
    for (unsigned bit = 0; is_data && bit < 8; ++bit) {
      telegram.data = static_cast<std::uint8_t>(telegram.data << 1 | (levels[stop++] ? 1 : 0));
    }
    const bool is_stopped = levels[stop];
    if (!is_stopped) telegram.header |= kStopMissing;
    n = stop + (is_stopped ? 1 : 0);
    while (!is_stopped && n < levels.size() && !levels[n]) ++n;
    seen.push_back(telegram);
  }
  return seen;
}

Waveform random_wave() {
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  for (const auto word : *rc::gen::arbitrary<std::vector<std::uint32_t>>())
    wave.levels.append(word, word % 33);
  return wave;
}

// The same levels at a rate `times` as fine.
Waveform refined(const Waveform& wave, unsigned times) {
  Waveform fine{wave.start, wave.rate * times, {}};
  for (std::size_t n = 0; n < wave.levels.size(); ++n) fine.levels.append_fill(wave.levels[n], times);
  return fine;
}

TEST(TelegramCode, WritesTheTelegramsAsTheLayoutSays) {
  Levels levels;
  code().append(levels, kDataTelegram, 0xA5);
  EXPECT_EQ(levels.text(), "0001101001011");
  levels.clear();
  code().append(levels, kDataTelegram | kControl, 0x01);
  EXPECT_EQ(levels.text(), "0011000000011");
  levels.clear();
  code().append(levels, kSelect, 0);
  EXPECT_EQ(levels.text(), "01001");
}

TEST(TelegramCode, TheLayoutCanBeExchanged) {
  const TelegramCode other(TelegramLayout{
      .header = {HeaderLevel::flag, HeaderLevel::control, HeaderLevel::select},
      .select_level = false,
      .control_level = true,
      .data_flag_level = false,
      .most_significant_first = false,
  });
  Levels levels;
  other.append(levels, kDataTelegram | kSelect, 0x01);
  EXPECT_EQ(levels.text(), "0000100000001");
  std::vector<Telegram> seen;
  other.decode(levels, 0, [&](const Telegram& t) { seen.push_back(t); });
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].header, kDataTelegram | kSelect);
  EXPECT_EQ(seen[0].data, 0x01);
}

RC_GTEST_PROP(TelegramProperty, EveryTelegramComesBack, (std::vector<std::uint16_t> words)) {
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  std::vector<Seen> sent;
  for (const std::uint16_t word : words) {
    wave.levels.append_idle((word >> 11) % 20);
    const auto header = static_cast<std::uint8_t>((word >> 8) & 7);
    const auto data = static_cast<std::uint8_t>((header & kDataTelegram) != 0 ? word & 0xFF : 0);
    sent.push_back({wave.end(), header, data});
    code().append(wave.levels, header, data);
  }
  RC_ASSERT(hear({wave}) == sent);
  RC_ASSERT(hear({refined(wave, 20)}) == sent);
}

RC_GTEST_PROP(TelegramProperty, AnyLevelsDecodeAsBitByBit, ()) {
  const Waveform wave = random_wave();
  RC_ASSERT(hear({wave}) == hear_bit_by_bit(wave));
}

RC_GTEST_PROP(TelegramProperty, ASearchThatEndsEarlyGivesTheFirstOfThemAll, ()) {
  const Waveform wave = random_wave();
  const auto until = *rc::gen::inRange<std::size_t>(0, wave.levels.size() + 30);
  std::vector<Telegram> all;
  std::vector<Telegram> first;
  const std::size_t end = code().decode(wave.levels, 0, [&](const Telegram& t) { all.push_back(t); });
  const std::size_t next =
      code().decode_until(wave.levels, 0, until, [&](const Telegram& t) { first.push_back(t); });
  RC_ASSERT(first.size() <= all.size());
  RC_ASSERT(std::equal(first.begin(), first.end(), all.begin()));
  if (next < wave.levels.size() && next != end) RC_ASSERT(next > until);
  // It goes on there.
  std::vector<Telegram> rest;
  RC_ASSERT(code().decode(wave.levels, next, [&](const Telegram& t) { rest.push_back(t); }) == end);
  first.insert(first.end(), rest.begin(), rest.end());
  RC_ASSERT(first == all);
}

RC_GTEST_PROP(TelegramProperty, TheSamplingReceiverAgreesOnBitWideLevels, ()) {
  const Waveform wave = random_wave();
  const auto times = *rc::gen::inRange(2U, 25U);
  RC_ASSERT(hear({refined(wave, times)}) == hear({wave}));
}

RC_GTEST_PROP(TelegramProperty, ItMakesNoDifferenceHowASenderDividesItsLevels, ()) {
  const Waveform wave = random_wave();
  std::vector<Waveform> parts;
  std::size_t at = 0;
  while (at < wave.levels.size()) {
    const std::size_t count = std::min(*rc::gen::inRange<std::size_t>(1, 60), wave.levels.size() - at);
    const unsigned times = *rc::gen::element(1U, 1U, 4U);
    parts.push_back(refined({wave.time_of(at), kTelegramRate, wave.levels.slice(at, count)}, times));
    at += count;
  }
  RC_ASSERT(hear(parts) == hear({wave}));
}

// The last sample of a stop bit sees the line idle, the two before it do not: the next edge counts.
TEST(TelegramReceiver, ALineThatRisesWithinAMissingStopBitMayFallAgain) {
  constexpr unsigned kTimes = 20;  // the last sample lies within a level, the search goes on behind it
  Waveform bits{kernel::kStart, kTelegramRate, {}};
  code().append(bits.levels, 0, 0);
  bits.levels.set(bits.levels.size() - 1, false);
  Waveform wave = refined(bits, kTimes);
  wave.levels.set(wave.levels.size() - kTimes + 11, true);  // its third sample
  wave.levels.resize(wave.levels.size() - kTimes + 12);
  const std::size_t cut = wave.levels.size();
  code().append(bits.levels, kDataTelegram, 0x0F);
  wave.levels.append(refined({kernel::kStart, kTelegramRate, bits.levels.slice(5, 13)}, kTimes).levels);
  const std::vector<Seen> heard = hear({wave});
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0].header, kStopMissing);
  EXPECT_EQ(heard[1], (Seen{wave.time_of(cut), kDataTelegram, 0x0F}));
  const Waveform first{wave.start, wave.rate, wave.levels.slice(0, cut)};
  const Waveform second{wave.time_of(cut), wave.rate, wave.levels.slice(cut, wave.levels.size() - cut)};
  EXPECT_EQ(hear({first, second}), heard);
}

TEST(TelegramReceiver, AWaveformMayEndInTheMiddleOfAStartBit) {
  Waveform bits{kernel::kStart, kTelegramRate, {}};
  code().append(bits.levels, kDataTelegram, 0x0F);
  const Waveform wave = refined(bits, 20);
  for (std::size_t cut = 1; cut < 20; ++cut) {
    const Waveform first{wave.start, wave.rate, wave.levels.slice(0, cut)};
    const Waveform second{wave.time_of(cut), wave.rate, wave.levels.slice(cut, wave.levels.size() - cut)};
    EXPECT_EQ(hear({first, second}), hear({wave})) << cut;
  }
}

TEST(TelegramReceiver, GlitchesShorterThanHalfABitAreNoStart) {
  for (unsigned width = 1; width < 20; ++width) {  // twentieths of a bit
    Waveform wave{kernel::kStart, kTelegramRate * 20, {}};
    wave.levels.append_fill(false, width);
    wave.levels.append_idle(20 * 20);
    // Two of the samples at 7/16, 8/16 and 9/16 must be low: the pulse must outlast 8/16 = 10/20.
    EXPECT_EQ(hear({wave}).size(), width > 10 ? 1U : 0U) << width;
    EXPECT_EQ(hear({wave}, {.sampling = {}, .validates_start = false}).size(), 1U) << width;
  }
}

TEST(TelegramReceiver, AcceptsOnePerCentAndLosesSixPerCentOfRate) {
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  for (int i = 0; i < 20; ++i) code().append(wave.levels, kDataTelegram, 0x55);
  const auto data_at = [&](std::int64_t rate) {
    Waveform other = wave;
    other.rate = rate;
    std::vector<std::uint8_t> data;
    for (const Seen& seen : hear({other})) {
      if ((seen.header & kStopMissing) == 0) data.push_back(seen.data);
    }
    return data;
  };
  const std::vector<std::uint8_t> expected(20, 0x55);
  EXPECT_EQ(data_at(kTelegramRate * 99 / 100), expected);
  EXPECT_EQ(data_at(kTelegramRate * 101 / 100), expected);
  EXPECT_NE(data_at(kTelegramRate * 94 / 100), expected);
  EXPECT_NE(data_at(kTelegramRate * 106 / 100), expected);
}

TEST(TelegramReceiver, ATelegramMayGoOnAtAnotherRate) {
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  const std::vector<std::uint8_t> sent{0x55, 0x00, 0xFF, 0x33};
  for (const std::uint8_t data : sent) code().append(wave.levels, kDataTelegram, data);
  for (const std::int64_t rate : {kTelegramRate * 99 / 100, kTelegramRate * 101 / 100, kTelegramRate + 1}) {
    for (std::size_t cut = 1; cut < wave.levels.size(); ++cut) {
      const Waveform first{wave.start, wave.rate, wave.levels.slice(0, cut)};
      const Waveform second{wave.time_of(cut), rate, wave.levels.slice(cut, wave.levels.size() - cut)};
      std::vector<std::uint8_t> data;
      for (const Seen& seen : hear({first, second})) {
        EXPECT_EQ(seen.header, kDataTelegram);
        data.push_back(seen.data);
      }
      EXPECT_EQ(data, sent) << cut << " " << rate;
    }
  }
}

// A minute at one level in a second would be 10^10 levels at the rate of the telegram before it.
TEST(TelegramReceiver, ACutTelegramMayBeFollowedByAVerySlowLine) {
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  code().append(wave.levels, kDataTelegram, 0x0F);
  const Waveform first{wave.start, wave.rate, wave.levels.slice(0, 9)};
  Waveform slow{wave.time_of(9), 1, {}};
  slow.levels.append_idle(60);
  const std::vector<Seen> seen = hear({first, slow});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].data, 0x0F);
}

TEST(TelegramReceiver, ACutTelegramIsCompletedByTheIdleLine) {
  TelegramReceiver receiver(code(), kTelegramRate);
  Waveform wave{kernel::kStart, kTelegramRate, {}};
  code().append(wave.levels, kDataTelegram, 0x0F);
  wave.levels.resize(6);
  std::vector<Seen> seen;
  const auto sink = [&](const Waveform& w, const Telegram& t) {
    seen.push_back({w.time_of(t.level), t.header, t.data});
  };
  receiver.receive(wave, sink);
  EXPECT_TRUE(seen.empty());
  EXPECT_EQ(receiver.pending_until(), kernel::kStart + 13 * kBit);
  receiver.flush(sink);
  EXPECT_EQ(receiver.pending_until(), kernel::kNever);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].data, 0x3F);
}

}  // namespace
}  // namespace fieldproof::line

#include "emc/burst_channel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/telegram_receiver.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kNanosecond;
using kernel::kStart;
using line::Sampling;

constexpr std::int64_t kBitRate = 500'000;
constexpr Duration kBit = 2 * kMicrosecond;

// The output is forced to `forced` for the time [from, to) after each pulse.
WrongOutput forced(bool forced, Duration from, Duration to) {
  WrongOutput wrong;
  wrong.of_level.at(forced ? 0 : 1) = {{from, to}};
  return wrong;
}

// Each telegram as it was sampled.
using Telegrams = std::vector<std::tuple<std::uint16_t, std::uint8_t>>;

Telegrams heard_by(line::TelegramReceiver receiver, std::span<const line::Waveform> waves) {
  Telegrams heard;
  const auto keep = [&](const line::Waveform&, const line::Telegram& telegram) {
    heard.emplace_back(telegram.sampled, telegram.header);
  };
  for (const line::Waveform& wave : waves) receiver.receive(wave, keep);
  receiver.flush(keep);
  return heard;
}

class FaultTimes final : public trace::Recorder {
 public:
  void on_driven(trace::Channel, const line::Waveform&) override {}
  void on_fault(trace::Channel, kernel::Time time, std::string_view what) override {
    EXPECT_EQ(what, "burst pulse");
    times.push_back(time);
  }
  void on_observation(trace::Channel, kernel::Time, std::string_view, std::uint64_t) override {}

  std::vector<kernel::Time> times;
};

// A channel whose first pulse comes at an instant that the test knows.
class BurstChannelTest : public testing::Test {
 protected:
  static BurstReceiver telegrams() {
    return {kBitRate, std::make_shared<TelegramFraming>(line::TelegramLayout{}), Sampling{}, true, true};
  }

  BurstChannel channel(const WrongOutput& wrong, BurstReceiver receiver = telegrams()) {
    trace_.set_recorder(&faults_);
    return {schedule_, wrong, std::move(receiver), trace_, place_};
  }

  // A telegram whose level `level` begins `offset` before the pulse.
  line::Waveform telegram(std::uint8_t data, std::size_t level, Duration offset) {
    line::Waveform wave;
    wave.rate = kBitRate;
    code_.append(wave.levels, line::kDataTelegram, data);
    wave.start = pulse_ - offset - static_cast<std::int64_t>(level) * kBit;
    return wave;
  }

  std::vector<std::uint8_t> read(const line::Waveform& wave) {
    line::TelegramReceiver receiver(code_, kBitRate);
    std::vector<std::uint8_t> octets;
    const auto keep = [&](const line::Waveform&, const line::Telegram& telegram) {
      octets.push_back(telegram.data);
    };
    receiver.receive(wave, keep);
    receiver.flush(keep);
    return octets;
  }

  const line::TelegramCode& code_ = line::shared_telegram_code(line::TelegramLayout{});
  trace::Trace trace_;
  trace::Channel place_ = trace_.add_channel("rx");
  FaultTimes faults_;
  BurstSchedule schedule_{BurstSettings{}, kernel::Random(1)};
  kernel::Time pulse_ = BurstSchedule(schedule_).first_from(kStart + kernel::kSecond);
  line::Waveforms arrivals_;
};

TEST_F(BurstChannelTest, AWrongTimeAtTheSamplesOfABitFlipsIt) {
  BurstChannel channel = this->channel(forced(true, {}, 300 * kNanosecond));
  // The first data level (level 4, most significant): samples at 875, 1000 and 1125 ns.
  const line::Waveform sent = telegram(0x00, 4, 870 * kNanosecond);
  ASSERT_TRUE(channel.pass(sent, arrivals_));
  ASSERT_EQ(arrivals_.size(), 1U);
  EXPECT_EQ(arrivals_.front().rate, kBitRate);
  EXPECT_EQ(read(arrivals_.front()), std::vector<std::uint8_t>{0x80});
  EXPECT_EQ(channel.statistics().flipped_bits, 1U);
  EXPECT_EQ(channel.statistics().wrong_levels, 1U);
  EXPECT_EQ(faults_.times, std::vector<kernel::Time>{pulse_});
}

TEST_F(BurstChannelTest, AWrongTimeBetweenTheSamplesIsNotSeen) {
  for (const Duration offset :
       {100 * kNanosecond, 500 * kNanosecond, 1150 * kNanosecond, 1690 * kNanosecond}) {
    BurstChannel channel = this->channel(forced(true, {}, 300 * kNanosecond));
    EXPECT_FALSE(channel.pass(telegram(0x00, 4, offset), arrivals_)) << kernel::describe(offset);
    EXPECT_EQ(channel.statistics().hit_transmissions, 1U);
    EXPECT_EQ(channel.statistics().changed_transmissions, 0U);
  }
  EXPECT_TRUE(faults_.times.empty());
}

TEST_F(BurstChannelTest, WhatIsForcedToTheDrivenLevelIsNoHit) {
  BurstChannel channel = this->channel(forced(true, {}, 300 * kNanosecond));
  EXPECT_FALSE(channel.pass(telegram(0xFF, 4, 870 * kNanosecond), arrivals_));
  EXPECT_EQ(channel.statistics().hit_transmissions, 0U);
}

TEST_F(BurstChannelTest, OneSampleOfThreeIsOutvotedAndDecidesAlone) {
  const WrongOutput wrong = forced(true, {}, 120 * kNanosecond);
  for (const auto& [kind, expected] :
       {std::pair{Sampling::Kind::majority_of_three, false}, {Sampling::Kind::mid_bit, true}}) {
    BurstReceiver receiver = telegrams();
    receiver.sampling.kind = kind;
    BurstChannel channel = this->channel(wrong, receiver);
    EXPECT_EQ(channel.pass(telegram(0x00, 4, 940 * kNanosecond), arrivals_), expected);
  }
}

// 875 ns are seven sixteenths of a bit.
TEST_F(BurstChannelTest, AGlitchOnTheIdleLineIsRefusedByTheValidationOfTheStart) {
  const auto with_idle = [&](Duration before) {
    line::Waveform wave;
    wave.rate = kBitRate;
    wave.levels.append_idle(10);
    code_.append(wave.levels, line::kDataTelegram, 0x5A);
    wave.start = pulse_ + before - 10 * kBit;  // the start bit comes `before` behind the pulse
    return wave;
  };
  BurstChannel channel = this->channel(forced(false, {}, 700 * kNanosecond));
  EXPECT_FALSE(channel.pass(with_idle(5 * kMicrosecond), arrivals_));
  EXPECT_EQ(channel.statistics().hit_transmissions, 1U);

  // Long enough to pass for a start bit: the receiver reads a telegram of its own into the line.
  BurstChannel strong = this->channel(forced(false, {}, 1200 * kNanosecond));
  ASSERT_TRUE(strong.pass(with_idle(5 * kMicrosecond), arrivals_));
  EXPECT_EQ(strong.statistics().rewritten_transmissions, 1U);
  EXPECT_NE(read(arrivals_.back()), std::vector<std::uint8_t>{0x5A});
}

// A glitch that is less than seven sixteenths of a bit in front of the start edge and reaches it is taken for
// the edge: the grid of the samples is early by as much.
TEST_F(BurstChannelTest, AGlitchInFrontOfAStartShiftsTheGrid) {
  line::Waveform wave;
  wave.rate = kBitRate;
  wave.levels.append_idle(4);
  code_.append(wave.levels, line::kDataTelegram, 0x5A);
  wave.start = pulse_ + 600 * kNanosecond - 4 * kBit;
  BurstChannel channel = this->channel(forced(false, {}, 300 * kNanosecond));
  ASSERT_TRUE(channel.pass(wave, arrivals_));
  const line::Waveform& arrival = arrivals_.front();
  EXPECT_EQ(arrival.rate, kBitRate * BurstChannel::kTicksPerBit);
  EXPECT_EQ(read(arrival), std::vector<std::uint8_t>{0x5A});  // silently
  const std::size_t edge = line::falling_edge(arrival.levels, 0);
  const Duration early = wave.time_of(4) - arrival.time_of(edge);
  EXPECT_LE(abs(early - 600 * kNanosecond), kBit / BurstChannel::kTicksPerBit / 2 + kernel::kPicosecond);
}

TEST_F(BurstChannelTest, TheRewrittenWaveIsWrongWhereTheOutputIsWrong) {
  BurstReceiver unknown{kBitRate, nullptr, {}, true, true};
  const WrongOutput wrong = forced(true, 40 * kNanosecond, 240 * kNanosecond);
  BurstChannel channel = this->channel(wrong, unknown);
  const line::Waveform sent = telegram(0x00, 4, 500 * kNanosecond);
  ASSERT_TRUE(channel.pass(sent, arrivals_));
  const line::Waveform& arrival = arrivals_.front();
  EXPECT_EQ(arrival.start, sent.start);
  EXPECT_EQ(arrival.levels.size(), sent.levels.size() * BurstChannel::kTicksPerBit);
  const Duration tick = kBit / BurstChannel::kTicksPerBit;
  std::int64_t wrong_ticks = 0;
  for (std::size_t n = 0; n < arrival.levels.size(); ++n) {
    const kernel::Time middle = arrival.time_of(n) + tick / 2;
    const Duration behind = middle - pulse_;
    const bool is_wrong = arrival.levels[n] != sent.at(middle);
    wrong_ticks += is_wrong;
    const bool is_within = behind > 40 * kNanosecond + tick && behind < 240 * kNanosecond - tick;
    const bool is_outside = behind < 40 * kNanosecond - tick || behind > 240 * kNanosecond + tick;
    EXPECT_TRUE(is_wrong || !is_within) << kernel::describe(behind);
    EXPECT_FALSE(is_wrong && is_outside) << kernel::describe(behind);
  }
  EXPECT_NEAR(static_cast<double>(wrong_ticks * tick.count()), 200e3, static_cast<double>(tick.count()));
}

TEST_F(BurstChannelTest, BeforeTheFirstPulseNothingIsTouched) {
  BurstSettings settings;
  settings.on = kStart + kernel::kSecond;
  schedule_ = BurstSchedule(settings, kernel::Random(1));
  BurstChannel channel = this->channel(forced(true, {}, 300 * kNanosecond));
  line::Waveform wave = telegram(0, 4, {});
  for (wave.start = kStart; wave.start < settings.on - kernel::kMillisecond;
       wave.start += kernel::kMillisecond) {
    EXPECT_FALSE(channel.pass(wave, arrivals_));
  }
  EXPECT_EQ(channel.statistics().transmissions, 999U);
  EXPECT_EQ(channel.statistics().hit_transmissions, 0U);
}

TEST_F(BurstChannelTest, WithoutWrongTimesNoPulseMatters) {
  BurstChannel channel = this->channel(WrongOutput{});
  EXPECT_FALSE(channel.pass(telegram(0, 4, 870 * kNanosecond), arrivals_));
  EXPECT_EQ(channel.statistics().pulses, 0U);
}

TEST_F(BurstChannelTest, LevelsFinerThanBitsAreRewrittenOnTheirOwnGrid) {
  const line::Waveform sent = telegram(0x00, 4, 870 * kNanosecond);
  // Levels per bit, and the least multiple of it and of 16 that is not below 64.
  for (const auto& [times, ticks] :
       {std::pair<std::size_t, std::int64_t>{2, 64}, {3, 96}, {7, 112}, {10, 80}, {20, 80}}) {
    line::Waveform fine;
    fine.rate = kBitRate * static_cast<std::int64_t>(times);
    fine.start = sent.start;
    for (std::size_t n = 0; n < sent.levels.size(); ++n) fine.levels.append_fill(sent.levels[n], times);
    BurstChannel channel = this->channel(forced(true, {}, 300 * kNanosecond));
    arrivals_.clear();
    ASSERT_TRUE(channel.pass(fine, arrivals_)) << times;
    EXPECT_EQ(arrivals_.front().rate, kBitRate * ticks) << times;
    EXPECT_EQ(read(arrivals_.front()), std::vector<std::uint8_t>{0x80}) << times;
  }
}

// Up to a sixteenth of a bit no phase of a pulse is heard by a majority of three, however fine the levels
// are.
TEST_F(BurstChannelTest, AReceiverThatVotesIsImmuneOnAnyGrid) {
  for (const std::size_t times : {1U, 3U, 7U, 10U, 20U}) {
    for (std::int64_t phase = 0; phase < 2'000; phase += 13) {
      const line::Waveform sent = telegram(0x00, 4, phase * kNanosecond);
      line::Waveform fine;
      fine.rate = kBitRate * static_cast<std::int64_t>(times);
      fine.start = sent.start;
      for (std::size_t n = 0; n < sent.levels.size(); ++n) fine.levels.append_fill(sent.levels[n], times);
      BurstChannel channel =
          this->channel(forced(true, {}, 125 * kNanosecond), {kBitRate, nullptr, {}, true, true});
      arrivals_.clear();
      if (!channel.pass(fine, arrivals_)) continue;
      EXPECT_EQ(read(arrivals_.front()), std::vector<std::uint8_t>{0x00}) << times << " at " << phase;
    }
  }
}

// ---- the short cuts give what the receiver would make of the rewritten wave ----

// One wrong time at each of the 64 places of each bit, from as short as a place to longer than the samples of
// a bit lie apart.
TEST_F(BurstChannelTest, ShortCutsGiveTheSameAtEveryPlaceOfATelegram) {
  constexpr Duration kTick = kBit / BurstChannel::kTicksPerBit;
  constexpr std::int64_t kPlaces = BurstChannel::kTicksPerBit * line::kDataTelegramLevels;
  std::uint64_t spared = 0;
  for (const auto kind : {Sampling::Kind::mid_bit, Sampling::Kind::majority_of_three}) {
    for (const std::int64_t length : {1, 3, 5, 9, 40}) {
      for (std::int64_t place = 0; place < kPlaces; ++place) {
        line::Waveform sent = telegram(0xA5, 0, place * kTick);
        sent.levels.append_idle(1);
        code_.append(sent.levels, line::kDataTelegram, 0x3C);
        const auto heard = [&](std::shared_ptr<const Framing> framing) {
          const Sampling sampling{kind};
          BurstChannel channel = this->channel(forced(false, {}, length * kTick),
                                               {kBitRate, std::move(framing), sampling, true, true});
          arrivals_.clear();
          if (!channel.pass(sent, arrivals_)) arrivals_.add(sent);
          spared += channel.statistics().hit_transmissions - channel.statistics().rewritten_transmissions;
          return heard_by(line::TelegramReceiver(code_, kBitRate, {sampling, true}), arrivals_);
        };
        EXPECT_EQ(heard(std::make_shared<TelegramFraming>(line::TelegramLayout{})), heard(nullptr))
            << place << " of length " << length;
      }
    }
  }
  EXPECT_GT(spared, 1000U) << "a comparison of two rewritten waves says nothing";
}

struct Line {
  std::vector<line::Waveform> waves;
  WrongOutput wrong;
  BurstSettings settings;
  std::uint64_t seed;
  Sampling sampling;
};

WrongOutput arbitrary_wrong_output() {
  WrongOutput wrong;
  const int longest = *rc::gen::element(100, 300, 1000);
  for (auto& intervals : wrong.of_level) {
    Duration at{};
    const int count = *rc::gen::inRange(0, 3);
    for (int n = 0; n < count; ++n) {
      at += *rc::gen::inRange(1, longest) * kNanosecond;
      const Duration to = at + *rc::gen::inRange(1, longest) * kNanosecond;
      intervals.push_back({at, to});
      at = to;
    }
  }
  return wrong;
}

// What a real receiver of telegrams reads through a channel.
Telegrams heard_through(BurstChannel& channel, const Line& line) {
  line::Waveforms arrivals;
  for (const line::Waveform& wave : line.waves) {
    if (!channel.pass(wave, arrivals)) arrivals.add(wave);
  }
  return heard_by(line::TelegramReceiver(line::shared_telegram_code(line::TelegramLayout{}), kBitRate,
                                         {line.sampling, true}),
                  arrivals);
}

Line arbitrary_line() {
  Line line;
  line.wrong = arbitrary_wrong_output();
  line.seed = *rc::gen::arbitrary<std::uint64_t>();
  line.settings.repetition = Repetition::khz_100;
  line.sampling.kind = *rc::gen::element(Sampling::Kind::majority_of_three, Sampling::Kind::mid_bit);
  const kernel::Random random(line.seed);
  kernel::Time at = BurstSchedule(line.settings, random).first_from(kStart + kernel::kSecond);
  kernel::Random draws = random.split("telegrams");
  const auto& code = line::shared_telegram_code(line::TelegramLayout{});
  const int waves = *rc::gen::inRange(1, 6);
  for (int n = 0; n < waves; ++n) {
    line::Waveform wave;
    wave.rate = kBitRate;
    wave.start = at;
    wave.levels.append_idle(draws.below(4));
    const std::uint64_t telegrams = 1 + draws.below(15);
    for (std::uint64_t k = 0; k < telegrams; ++k) {
      const auto header = static_cast<std::uint8_t>(draws.below(8));
      code.append(wave.levels, header, static_cast<std::uint8_t>(draws.below(256)));
      wave.levels.append_idle(draws.below(k + 1 == telegrams ? 2 : 4));
    }
    at = wave.end() + Duration{draws.between(0, 40'000'000)};
    line.waves.push_back(std::move(wave));
  }
  // No other comes after the last one: it may be cut in the middle of a unit, or have any level wrong.
  line::Levels& last = line.waves.back().levels;
  if (*rc::gen::arbitrary<bool>())
    last.resize(last.size() - draws.below(std::min<std::size_t>(13, last.size())));
  if (*rc::gen::arbitrary<bool>()) last.set(draws.below(last.size()), false);
  return line;
}

RC_GTEST_PROP(BurstChannelProperty, ShortCutsGiveWhatTheReceiverMakesOfTheWrongWave, ()) {
  const Line line = arbitrary_line();
  trace::Trace trace;
  const trace::Channel place = trace.add_channel("rx");
  const BurstSchedule schedule(line.settings, kernel::Random(line.seed));
  const auto framing = std::make_shared<TelegramFraming>(line::TelegramLayout{});
  BurstChannel quick(schedule, line.wrong, {kBitRate, framing, line.sampling, true, true}, trace, place);
  BurstChannel full(schedule, line.wrong, {kBitRate, nullptr, line.sampling, true, true}, trace, place);
  const auto by_short_cuts = heard_through(quick, line);
  const auto in_full = heard_through(full, line);
  RC_CLASSIFY(quick.statistics().flipped_bits > 0, "flips");
  RC_CLASSIFY(quick.statistics().rewritten_transmissions < full.statistics().rewritten_transmissions,
              "spared a rewriting");
  RC_ASSERT(by_short_cuts == in_full);
}

// The same for characters, whose receiver hears each transmission by itself.
RC_GTEST_PROP(BurstChannelProperty, ShortCutsGiveWhatTheReceiverOfCharactersMakesOfTheWrongWave, ()) {
  const line::CharacterFormat format{8, line::Parity::even, line::StopBits::two};
  const line::CharacterCode code(format);
  const WrongOutput wrong = arbitrary_wrong_output();
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  BurstSettings settings;
  settings.repetition = Repetition::khz_100;
  const BurstSchedule schedule(settings, random);
  line::Waveform wave;
  wave.rate = kBitRate;
  wave.start = BurstSchedule(schedule).first_from(kStart + kernel::kSecond);
  kernel::Random draws = random.split("characters");
  for (int n = 0; n < 16; ++n) {
    code.append(wave.levels, static_cast<unsigned>(draws.below(256)));
    wave.levels.append_idle(draws.below(3));
  }
  trace::Trace trace;
  const trace::Channel place = trace.add_channel("rx");
  BurstChannel quick(schedule, wrong, {kBitRate, std::make_shared<CharacterFraming>(format), {}, true, true},
                     trace, place);
  BurstChannel full(schedule, wrong, {kBitRate, nullptr, {}, true, true}, trace, place);
  line::CharacterReceiver receiver(format, kBitRate);
  const auto heard_through = [&](BurstChannel& channel) {
    line::Waveforms arrivals;
    if (!channel.pass(wave, arrivals)) arrivals.add(wave);
    std::vector<line::CharacterReceiver::Received> received;
    receiver.receive(arrivals.front(), received);
    std::vector<std::tuple<std::uint16_t, bool, bool>> heard;
    for (const auto& one : received) {
      heard.emplace_back(one.character.data, one.character.is_parity_wrong, one.character.is_stop_missing);
    }
    return heard;
  };
  RC_ASSERT(heard_through(quick) == heard_through(full));
}

}  // namespace
}  // namespace fieldproof::emc

#include "emc/checked_frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "emc/burst_channel.hpp"
#include "emc/generator.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kNanosecond;
using kernel::kStart;
using line::CharacterFormat;
using line::Parity;
using line::Sampling;
using line::StopBits;

constexpr std::int64_t kFrameRate = 500'000;
constexpr Duration kFrameBit = 2 * kMicrosecond;
// XOR: 0x9C.
constexpr std::array<std::uint16_t, 4> kMessage{0x05, 0x00, 0xA5, 0x3C};

struct HitBit {
  unsigned character;
  unsigned bit;  // of the character, its start bit is 0
};

CheckedFrameFormat format_of(const CharacterFormat& character) {
  return {.character = character, .bit_rate = kFrameRate};
}

// Pulses in the middle of these bits.
FrameFate fate_of(const CheckedFrameFormat& format, ForcedLevel forced, const std::vector<HitBit>& bits,
                  Duration wrong_time = 300 * kNanosecond) {
  CheckedFrame frame(format, pulse_effects(forced, wrong_time));
  const std::int64_t length = format.character.half_bits() / 2;
  std::vector<FramePulse> pulses;
  for (const HitBit& hit : bits) {
    const Duration begin = ((hit.character + 1) * length + hit.bit) * kFrameBit;
    pulses.push_back({kStart + begin + (kFrameBit - wrong_time) / 2, 0});
  }
  return frame.fate(kMessage, pulses);
}

TEST(CheckedFrame, LastsItsCharactersAndTwoQuietOnes) {
  const CheckedFrame frame(format_of({8, Parity::even, StopBits::one}),
                           pulse_effects(ForcedLevel::drawn, 300 * kNanosecond));
  EXPECT_EQ(frame.end(), kStart + 7 * 11 * kFrameBit);
  EXPECT_EQ(frame.reach(), (Interval{{}, 300 * kNanosecond}));
}

class EitherClock : public testing::TestWithParam<ReceiverClock> {
 protected:
  static CheckedFrameFormat format(const CharacterFormat& character = {}) {
    CheckedFrameFormat result = format_of(character);
    result.clock = GetParam();
    return result;
  }
};

INSTANTIATE_TEST_SUITE_P(CheckedFrame, EitherClock,
                         testing::Values(ReceiverClock::of_each_start_edge, ReceiverClock::of_the_sender),
                         [](const auto& clock) {
                           return clock.param == ReceiverClock::of_the_sender ? "Sender" : "StartEdge";
                         });

TEST_P(EitherClock, FindsWhatTheExclusiveOrFinds) {
  using enum FrameFate;
  constexpr ForcedLevel kOpposite = ForcedLevel::opposite;
  EXPECT_EQ(fate_of(format(), kOpposite, {}), intact);
  EXPECT_EQ(fate_of(format(), kOpposite, {{1, 4}}), detected);
  EXPECT_EQ(fate_of(format(), kOpposite, {{1, 4}, {3, 4}}), undetected);
  EXPECT_EQ(fate_of(format(), kOpposite, {{1, 4}, {3, 5}}), detected);
  EXPECT_EQ(fate_of(format(), kOpposite, {{0, 8}, {1, 8}, {4, 8}}), detected);
  EXPECT_EQ(fate_of(format(), kOpposite, {{0, 1}, {0, 2}, {4, 1}, {4, 2}}), undetected);
}

TEST_P(EitherClock, HearsOnlyALevelThatIsNotTheDrivenOne) {
  // 0x05 has its lowest bit set and the next one not.
  EXPECT_EQ(fate_of(format(), ForcedLevel::low, {{0, 1}}), FrameFate::detected);
  EXPECT_EQ(fate_of(format(), ForcedLevel::low, {{0, 2}}), FrameFate::intact);
  EXPECT_EQ(fate_of(format(), ForcedLevel::high, {{0, 1}}), FrameFate::intact);
  EXPECT_EQ(fate_of(format(), ForcedLevel::high, {{0, 2}}), FrameFate::detected);
}

TEST_P(EitherClock, DetectsABrokenFraming) {
  EXPECT_EQ(fate_of(format(), ForcedLevel::opposite, {{2, 9}}), FrameFate::detected);  // a stop bit
  // With a pair in one column, which alone would pass.
  EXPECT_EQ(fate_of(format(), ForcedLevel::opposite, {{1, 4}, {2, 9}, {3, 4}}), FrameFate::detected);
  EXPECT_EQ(fate_of(format(), ForcedLevel::opposite, {{1, 0}}), FrameFate::detected);  // a start bit
  // Of two stop bits a receiver looks at one.
  const CharacterFormat two{8, Parity::none, StopBits::two};
  EXPECT_EQ(fate_of(format(two), ForcedLevel::opposite, {{2, 9}}), FrameFate::detected);
  EXPECT_EQ(fate_of(format(two), ForcedLevel::opposite, {{2, 10}}), FrameFate::intact);
}

TEST_P(EitherClock, LooksAtParityWhereItIsAskedTo) {
  CheckedFrameFormat even = format({8, Parity::even, StopBits::one});
  EXPECT_EQ(fate_of(even, ForcedLevel::opposite, {{1, 4}, {3, 4}}), FrameFate::detected);
  EXPECT_EQ(fate_of(even, ForcedLevel::opposite, {{1, 4}, {1, 7}, {3, 4}, {3, 7}}), FrameFate::undetected);
  EXPECT_EQ(fate_of(even, ForcedLevel::opposite, {{2, 9}}), FrameFate::detected);
  even.checks_parity = false;
  EXPECT_EQ(fate_of(even, ForcedLevel::opposite, {{1, 4}, {3, 4}}), FrameFate::undetected);
  EXPECT_EQ(fate_of(even, ForcedLevel::opposite, {{2, 9}}), FrameFate::intact);
}

// 120 ns are less than a sixteenth of a bit: one of three samples. In the middle of it a single sample lies.
TEST_P(EitherClock, SamplesAsItIsTold) {
  CheckedFrameFormat voting = format();
  EXPECT_EQ(fate_of(voting, ForcedLevel::opposite, {{1, 4}}, 120 * kNanosecond), FrameFate::intact);
  voting.sampling = line::kMidBit;
  EXPECT_EQ(fate_of(voting, ForcedLevel::opposite, {{1, 4}}, 120 * kNanosecond), FrameFate::detected);
}

// A low glitch of 1.3 us passes for a start bit: what is read from then on is a character that nobody sent,
// and the start of the first one is lost in it.
TEST(CheckedFrame, HearsACharacterInTheSilenceInFront) {
  const CheckedFrameFormat own = format_of({});
  CheckedFrame frame(own, pulse_effects(ForcedLevel::low, 1300 * kNanosecond));
  const std::array<FramePulse, 1> early{{{kStart + 3 * kFrameBit, 0}}};
  EXPECT_EQ(frame.fate(kMessage, early), FrameFate::detected);
  CheckedFrameFormat in_step = own;
  in_step.clock = ReceiverClock::of_the_sender;
  CheckedFrame deaf(in_step, pulse_effects(ForcedLevel::low, 1300 * kNanosecond));
  EXPECT_EQ(deaf.fate(kMessage, early), FrameFate::intact);
  // After the frame it is one character more.
  const std::array<FramePulse, 1> late{{{kStart + 61 * kFrameBit, 0}}};
  EXPECT_EQ(frame.fate(kMessage, late), FrameFate::detected);
}

// A glitch at the start edge of the third character starts the receiver's clock 240 ns early, and a pulse in
// that character that lies after its samples by the sender's clock then meets them by the receiver's.
TEST(CheckedFrame, APulseAtAStartEdgeMovesTheSamples) {
  const auto fate = [](ReceiverClock clock, bool has_edge) {
    CheckedFrameFormat format = format_of({});
    format.clock = clock;
    format.sampling = line::kMidBit;
    CheckedFrame frame(format, pulse_effects(ForcedLevel::low, 300 * kNanosecond));
    const kernel::Time edge = kStart + 30 * kFrameBit;
    // 0xA5 has its lowest bit set. Its sample comes 3 us after the edge, or 240 ns earlier.
    std::vector<FramePulse> pulses{{edge + 2600 * kNanosecond, 0}};
    if (has_edge) pulses.insert(pulses.begin(), {edge - 240 * kNanosecond, 0});
    return frame.fate(kMessage, pulses);
  };
  EXPECT_EQ(fate(ReceiverClock::of_each_start_edge, false), FrameFate::intact);
  EXPECT_EQ(fate(ReceiverClock::of_each_start_edge, true), FrameFate::detected);
  EXPECT_EQ(fate(ReceiverClock::of_the_sender, false), FrameFate::intact);
  EXPECT_EQ(fate(ReceiverClock::of_the_sender, true), FrameFate::intact);
}

TEST(CheckedFrame, RefusesWhatIsNoFrame) {
  CheckedFrameFormat format;
  format.characters = 1;
  EXPECT_THROW(CheckedFrame(format, {}), kernel::Error);
  format.characters = CheckedFrame::kMostCharacters + 1;
  EXPECT_THROW(CheckedFrame(format, {}), kernel::Error);
  format.characters = 5;
  format.bit_rate = 0;
  EXPECT_THROW(CheckedFrame(format, {}), kernel::Error);
  format.bit_rate = 9600;
  format.character.stop_bits = StopBits::one_and_a_half;
  EXPECT_NO_THROW(CheckedFrame(format, {}));
  format.clock = ReceiverClock::of_the_sender;
  EXPECT_THROW(CheckedFrame(format, {}), kernel::Error);
}

CharacterFormat arbitrary_character() {
  return {*rc::gen::inRange(5U, 10U),
          *rc::gen::element(Parity::none, Parity::even, Parity::odd, Parity::mark),
          *rc::gen::element(StopBits::one, StopBits::two)};
}

std::vector<std::uint16_t> arbitrary_message(unsigned characters, unsigned data_bits) {
  return *rc::gen::container<std::vector<std::uint16_t>>(
      characters - 1, rc::gen::inRange<std::uint16_t>(0, static_cast<std::uint16_t>(1U << data_bits)));
}

// The same frame through a channel of bursts that rewrites every hit, and what comes out of it judged here.
RC_GTEST_PROP(CheckedFrameProperty, HasTheFateThatABurstChannelAndAReceiverGiveIt, ()) {
  CheckedFrameFormat format = format_of(arbitrary_character());
  if (*rc::gen::inRange(0, 4) == 0) format.character.stop_bits = StopBits::one_and_a_half;
  format.characters = *rc::gen::inRange(2U, 8U);
  format.sampling.kind = *rc::gen::element(Sampling::Kind::majority_of_three, Sampling::Kind::mid_bit);
  format.checks_parity = *rc::gen::arbitrary<bool>();
  const auto message = arbitrary_message(format.characters, format.character.data_bits);
  const Duration wrong_time = *rc::gen::inRange(100, 1500) * kNanosecond;
  const WrongOutput wrong =
      pulse_effects(*rc::gen::element(ForcedLevel::low, ForcedLevel::high, ForcedLevel::opposite), wrong_time)
          .front();

  line::Waveform wave;
  const line::CharacterCode code(format.character);
  wave.rate = kFrameRate * code.levels_per_bit();
  std::vector<unsigned> sent(message.begin(), message.end());
  sent.push_back(0);
  for (const std::uint16_t character : message) sent.back() ^= character;
  wave.levels.append_idle(code.levels_per_character());
  for (const unsigned character : sent) code.append(wave.levels, character);
  wave.levels.append_idle(code.levels_per_character());

  BurstSettings settings;
  settings.repetition = Repetition::khz_100;
  BurstSchedule schedule(settings, kernel::Random(*rc::gen::arbitrary<std::uint64_t>()));
  wave.start = schedule.first_from(kStart + kernel::kSecond) + *rc::gen::inRange(-100, 700) * kMicrosecond;
  trace::Trace trace;
  BurstChannel channel(schedule, wrong, {kFrameRate, nullptr, format.sampling, true, true}, trace,
                       trace.add_channel("rx"));
  line::Waveforms arrivals;
  if (!channel.pass(wave, arrivals)) arrivals.add(wave);
  std::vector<line::CharacterReceiver::Received> heard;
  line::CharacterReceiver(format.character, kFrameRate, format.sampling).receive(arrivals.front(), heard);
  unsigned sum = 0;
  std::vector<unsigned> data;
  bool is_refused = heard.size() != sent.size();
  for (const auto& one : heard) {
    data.push_back(one.character.data);
    sum ^= one.character.data;
    is_refused |= one.character.is_stop_missing || (format.checks_parity && one.character.is_parity_wrong);
  }
  const FrameFate expected = is_refused     ? FrameFate::detected
                             : data == sent ? FrameFate::intact
                             : sum == 0     ? FrameFate::undetected
                                            : FrameFate::detected;

  CheckedFrame frame(format, {wrong});
  std::vector<FramePulse> pulses;
  const Duration moved = wave.start - kStart;
  kernel::Time from = wave.start - frame.reach().to;
  for (; schedule.has_pulse_in(from, wave.end()); from = schedule.first_from(from) + kernel::kPicosecond) {
    pulses.push_back({schedule.first_from(from) - moved, 0});
  }
  RC_CLASSIFY(expected == FrameFate::intact, "intact");
  RC_CLASSIFY(expected == FrameFate::undetected, "undetected");
  RC_ASSERT(frame.fate(message, pulses) == expected);
}

// Where pulses leave start and stop bits and all edges alone, it is no matter whose clock the receiver has.
RC_GTEST_PROP(CheckedFrameProperty, ClocksDifferOnlyAtFraming, ()) {
  CheckedFrameFormat format = format_of(arbitrary_character());
  format.characters = *rc::gen::inRange(2U, 8U);
  const auto message = arbitrary_message(format.characters, format.character.data_bits);
  const std::int64_t length = format.character.half_bits() / 2;
  std::vector<FramePulse> pulses;
  for (std::int64_t character = 1; character <= format.characters; ++character) {
    for (std::int64_t bit = 1; bit < format.character.bits_before_stop(); ++bit) {
      if (*rc::gen::inRange(0, 8) != 0) continue;
      const Duration middle = (character * length + bit) * kFrameBit + kFrameBit / 2;
      pulses.push_back(
          {kStart + middle - *rc::gen::inRange(0, 500) * kNanosecond, *rc::gen::inRange(0U, 2U)});
    }
  }
  const auto effects = pulse_effects(ForcedLevel::drawn, 400 * kNanosecond);
  const FrameFate by_edges = CheckedFrame(format, effects).fate(message, pulses);
  format.clock = ReceiverClock::of_the_sender;
  RC_ASSERT(CheckedFrame(format, effects).fate(message, pulses) == by_edges);
}

}  // namespace
}  // namespace fieldproof::emc

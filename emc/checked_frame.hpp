#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/framing.hpp"
#include "emc/sampled_impact.hpp"
#include "emc/wrong_spans.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/line/sampling.hpp"
#include "harness/line/waveform.hpp"

// One frame of characters under pulses: does its receiver notice?
//
// The last character is the exclusive or of the others. The characters follow each other without a gap, with
// a quiet character in front and one after; pulses make the receiver's output wrong, and a real
// CharacterReceiver finds edges and samples in what is left. A frame is taken when it has as many characters
// as were sent, each with its stop bit (and with the right parity, where that is looked at), and the
// exclusive or of all is 0. So a frame whose framing breaks, or that has a character more or less, is
// detected.
//
// The other receiver here has the clock of the sender: it samples each bit where the sender's grid says, and
// start and stop bits are to it two more bits that have to be right. That is how closed forms see a line. A
// real one starts its clock at the falling edge of each character, so a pulse at that edge moves all samples
// of the character, and a start bit that is lost moves the characters after it.
//
// As in a burst channel the real receiver gets the frame with bits flipped where only sampled bits are wrong,
// and at 64 levels per bit else; why that is the same stands in sampled_impact.hpp.
//
// Limits: what a pulse does is not changed by the one before. The quiet characters are the whole silence: a
// receiver that wants a longer one between frames would see more. Silence within a frame, which would end it
// for such a receiver, is not looked at.
namespace fieldproof::emc {

enum class ReceiverClock : std::uint8_t { of_each_start_edge, of_the_sender };

struct CheckedFrameFormat {
  line::CharacterFormat character{};
  std::int64_t bit_rate = 375'000;
  unsigned characters = 5;  // with the check
  line::Sampling sampling{};
  bool checks_parity = true;  // where the characters have a parity bit
  ReceiverClock clock = ReceiverClock::of_each_start_edge;
};

enum class ForcedLevel : std::uint8_t {
  low,
  high,
  drawn,     // low or high, each pulse for itself
  opposite,  // of what is driven: every bit that is hit is wrong
};

// What a pulse can do that forces the output for this time from its begin on.
std::vector<WrongOutput> pulse_effects(ForcedLevel forced, kernel::Duration wrong_time);

struct FramePulse {
  kernel::Time time;
  std::size_t effect;  // which one of the effects it has
};

enum class FrameFate : std::uint8_t {
  intact,      // every character that was sent, and no other
  detected,    // otherwise, and not taken
  undetected,  // otherwise, and taken
};

class CheckedFrame {
 public:
  static constexpr unsigned kMostCharacters = 1024;
  static constexpr std::int64_t kMostBitsPerSecond = 1'000'000'000;

  // `effects` are what a pulse can do to the output. A frame that is not of 2 to kMostCharacters characters,
  // a bit rate that is not from 1 to kMostBitsPerSecond, and one and a half stop bits by the sender's clock
  // are a kernel::Error (usage).
  CheckedFrame(const CheckedFrameFormat& format, std::vector<WrongOutput> effects);

  // The quiet character in front begins at kStart.
  kernel::Time end() const { return end_; }  // of the one behind
  // In front of and after a pulse this is where it can do anything, whatever its effect.
  const Interval& reach() const { return reach_; }

  // `message` is the characters in front of the check, pulses are in order.
  FrameFate fate(std::span<const std::uint16_t> message, std::span<const FramePulse> pulses);

 private:
  void send(std::span<const std::uint16_t> message);
  void flip();
  void rewrite(const std::vector<Span>& heard);
  void read_in_step();
  FrameFate judged() const;

  CheckedFrameFormat format_;
  std::vector<WrongOutput> effects_;
  Interval reach_{};
  kernel::Time end_;
  line::CharacterCode code_;
  // Null for one and a half stop bits: then each frame that is hit is shown to the receiver at the fine rate.
  std::unique_ptr<const Framing> framing_;
  TickGrid grid_;
  SampledImpact impact_;
  line::CharacterReceiver receiver_;

  // Of the frame that is judged.
  std::vector<std::uint16_t> sent_characters_;
  line::Waveform sent_;
  line::Waveform arrival_;
  WrongSpans spans_;
  std::vector<line::CharacterReceiver::Received> received_;
  bool is_start_missing_ = false;
};

}  // namespace fieldproof::emc

#include "emc/checked_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "emc/burst_channel.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

Interval reach_of(const std::vector<WrongOutput>& effects) {
  Interval reach{};
  bool is_first = true;
  for (const WrongOutput& effect : effects) {
    if (effect.empty()) continue;
    const Interval hull = effect.hull();
    reach = is_first ? hull : Interval{std::min(reach.from, hull.from), std::max(reach.to, hull.to)};
    is_first = false;
  }
  return reach;
}

bool is_in_step(const CheckedFrameFormat& format) {
  return format.clock == ReceiverClock::of_the_sender;
}

bool has_half_bits(const CheckedFrameFormat& format) {
  return format.character.stop_bits == line::StopBits::one_and_a_half;
}

std::unique_ptr<const Framing> framing_of(const CheckedFrameFormat& format) {
  if (is_in_step(format)) return std::make_unique<const SynchronousFraming>();
  if (has_half_bits(format)) return nullptr;
  return std::make_unique<const CharacterFraming>(format.character);
}

CheckedFrameFormat required(CheckedFrameFormat format) {
  if (format.characters < 2 || format.characters > CheckedFrame::kMostCharacters) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("a frame with a check cannot have {} characters; it has 2 to {}.",
                                    format.characters, CheckedFrame::kMostCharacters));
  }
  if (format.bit_rate < 1 || format.bit_rate > CheckedFrame::kMostBitsPerSecond) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("a line cannot run at {} bit/s here; it takes 1 to {} bit/s.",
                                    format.bit_rate, CheckedFrame::kMostBitsPerSecond));
  }
  if (is_in_step(format) && has_half_bits(format)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "one and a half stop bits put characters between the bits of a standing clock; take "
                        "one or two.");
  }
  return format;
}

}  // namespace

std::vector<WrongOutput> pulse_effects(ForcedLevel forced, kernel::Duration wrong_time) {
  const Interval wrong{kernel::Duration::zero(), wrong_time};
  WrongOutput low;
  WrongOutput high;
  low.of_level[1] = {wrong};
  high.of_level[0] = {wrong};
  switch (forced) {
    case ForcedLevel::low:
      return {low};
    case ForcedLevel::high:
      return {high};
    case ForcedLevel::drawn:
      return {low, high};
    case ForcedLevel::opposite:
      break;
  }
  WrongOutput opposite;
  opposite.of_level = {high.of_level[0], low.of_level[1]};
  return {opposite};
}

CheckedFrame::CheckedFrame(const CheckedFrameFormat& format, std::vector<WrongOutput> effects)
    : format_(required(format)),
      effects_(std::move(effects)),
      reach_(reach_of(effects_)),
      code_(format.character),
      framing_(framing_of(format)),
      grid_(BurstChannel::kTicksPerBit / code_.levels_per_bit()),
      impact_(framing_.get(), format.sampling, true),
      receiver_(format.character, format.bit_rate, format.sampling) {
  sent_.start = kernel::kStart;
  sent_.rate = format.bit_rate * code_.levels_per_bit();
  const auto levels = std::int64_t{code_.levels_per_character()} * (format.characters + 2);
  end_ = kernel::level_time(kernel::kStart, levels, sent_.rate);
}

FrameFate CheckedFrame::fate(std::span<const std::uint16_t> message, std::span<const FramePulse> pulses) {
  FIELDPROOF_CHECK(message.size() + 1 == format_.characters, "a message has another length than its frame");
  send(message);
  spans_.begin(sent_, grid_);
  for (const FramePulse& pulse : pulses) spans_.add(pulse.time, effects_.at(pulse.effect));
  const std::vector<Span>& heard = spans_.resolve();
  if (heard.empty()) return FrameFate::intact;
  impact_.judge(sent_.levels, heard, grid_);
  received_.clear();
  if (impact_.is_unclear()) {
    FIELDPROOF_CHECK(!is_in_step(format_),
                     "a receiver that does not look at the framing is uncertain about it");
    rewrite(heard);
  } else {
    if (impact_.flipped_bits().empty()) return FrameFate::intact;
    flip();
  }
  if (is_in_step(format_)) {
    read_in_step();
  } else {
    receiver_.receive(arrival_, received_);
  }
  return judged();
}

void CheckedFrame::send(std::span<const std::uint16_t> message) {
  sent_characters_.assign(message.begin(), message.end());
  std::uint16_t sum = 0;
  const auto data_mask = static_cast<std::uint16_t>((1U << format_.character.data_bits) - 1);
  for (std::uint16_t& character : sent_characters_) {
    character &= data_mask;
    sum ^= character;
  }
  sent_characters_.push_back(sum);
  sent_.levels.clear();
  sent_.levels.append_idle(code_.levels_per_character());
  for (const std::uint16_t character : sent_characters_) code_.append(sent_.levels, character);
  sent_.levels.append_idle(code_.levels_per_character());
}

void CheckedFrame::flip() {
  arrival_.start = sent_.start;
  arrival_.rate = sent_.rate;
  arrival_.levels = sent_.levels;
  for (const std::size_t bit : impact_.flipped_bits()) arrival_.levels.flip(bit);
}

void CheckedFrame::rewrite(const std::vector<Span>& heard) {
  const std::int64_t ticks = grid_.per_level();
  arrival_.start = sent_.start;
  arrival_.rate = sent_.rate * ticks;
  arrival_.levels.clear();
  arrival_.levels.append_stretched(sent_.levels, static_cast<std::size_t>(ticks));
  for (const Span& span : heard) {
    arrival_.levels.invert(static_cast<std::size_t>(span.from), static_cast<std::size_t>(span.to));
  }
}

// Each character from the place where it was sent.
void CheckedFrame::read_in_step() {
  is_start_missing_ = false;
  for (std::size_t n = 1; n <= sent_characters_.size(); ++n) {
    const std::uint64_t bits = arrival_.levels.window(n * code_.levels_per_character());
    is_start_missing_ = is_start_missing_ || (bits & 1) != 0;
    received_.emplace_back().character = code_.from_bits(static_cast<std::uint32_t>(bits));
  }
}

FrameFate CheckedFrame::judged() const {
  if (is_start_missing_ || received_.size() != sent_characters_.size()) return FrameFate::detected;
  bool is_intact = true;
  std::uint16_t sum = 0;
  for (std::size_t n = 0; n < received_.size(); ++n) {
    const line::Character& character = received_[n].character;
    if (character.is_stop_missing || (format_.checks_parity && character.is_parity_wrong)) {
      return FrameFate::detected;
    }
    is_intact = is_intact && character.data == sent_characters_[n];
    sum ^= character.data;
  }
  if (is_intact) return FrameFate::intact;
  return sum == 0 ? FrameFate::undetected : FrameFate::detected;
}

}  // namespace fieldproof::emc

#include "protocols/valve_bus/attached_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostCharacters = 4096;

}  // namespace

CharacterProfile character_profile_of(const iut::CaseBegin& begin) {
  return static_cast<CharacterProfile>(std::clamp<std::int64_t>(iut::setting(begin, "characters", 0), 0, 2));
}

void AttachedLine::begin(const Rules& rules, kernel::Time now) {
  rules_ = rules;
  codec_ = CharacterCodec(rules);
  driven_until_ = now;
}

void AttachedLine::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (attached_.hears_levels()) {
    attached_.call(reception.end(), [&](iut::Device& device) { device.receive(port, reception); });
    return;
  }
  characters_.clear();
  codec_.hear(reception, [&](const HeardCharacter& heard) {
    characters_.push_back(
        {heard.start, heard.busy_until, heard.data, heard.is_parity_wrong, heard.is_stop_missing});
  });
  // What is no character an asynchronous receiver does not hear.
  for (std::span<const iut::Character> rest(characters_); !rest.empty();) {
    const auto part = rest.first(std::min(rest.size(), kMostCharacters));
    attached_.call(reception.end(),
                   [&](iut::Device& device) { device.receive(port, part, reception.end()); });
    rest = rest.subspan(part.size());
  }
}

// What follows without a gap has instants that are rounded, each for itself.
kernel::Time AttachedLine::behind_the_last(kernel::Time start) const {
  return start < driven_until_ && driven_until_ - start <= kernel::kNanosecond ? driven_until_ : start;
}

kernel::Time AttachedLine::drive_idle(kernel::Time from, kernel::Time to) {
  constexpr std::int64_t kFiner = 16;  // the driver comes and goes between bits, too
  line::Waveform idle;
  idle.start = from;
  idle.rate = rules_.bit_rate * kFiner;
  const kernel::Duration half = kernel::levels_duration(1, 2 * idle.rate);
  auto count = static_cast<std::size_t>(kernel::levels_within(to - from + half, idle.rate));
  // The nearest sixteenth, but not into what follows.
  if (kernel::level_time(from, static_cast<std::int64_t>(count), idle.rate) > to + kernel::kNanosecond)
    --count;
  idle.levels.append_idle(count);
  const kernel::Time end = idle.end();
  if (count > 0) line_->drive(idle);
  return std::max(to, end);
}

void AttachedLine::expect_port(unsigned port) const {
  attached_.expect_supplied();
  if (port != 0) iut::refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
}

void AttachedLine::transmit(const iut::Transmission& transmission) {
  expect_port(transmission.port);
  const std::size_t count = transmission.characters.size();
  if (count > kMostCharacters) iut::refuse_impossible(fmt::format("sends {} characters at once", count));
  const kernel::Duration length = half_characters(rules_, 2 * static_cast<unsigned>(count));
  const auto describe = [&] {
    return fmt::format("drives from {} to {}, with {} of characters from {} on",
                       kernel::describe(transmission.driver_on), kernel::describe(transmission.driver_off),
                       kernel::describe(length), kernel::describe(transmission.start));
  };
  attached_.expect_span(transmission.driver_on, transmission.driver_off, describe);
  attached_.expect_span(transmission.driver_on, transmission.start, describe);
  if (transmission.start + length > transmission.driver_off + kernel::kNanosecond) {
    iut::refuse_impossible(describe());
  }
  const kernel::Time driver_on = behind_the_last(transmission.driver_on);
  const kernel::Time start = drive_idle(driver_on, std::max(driver_on, transmission.start));
  const kernel::Time driven = codec_.drive_characters(*line_, transmission.characters, start);
  driven_until_ = drive_idle(driven, std::max(driven, transmission.driver_off));
}

void AttachedLine::transmit(unsigned port, line::Waveform& wave) {
  expect_port(port);
  attached_.expect_drive(wave);
  wave.start = behind_the_last(wave.start);
  driven_until_ = wave.end();
  line_->drive(wave);
}

}  // namespace fieldproof::valve_bus

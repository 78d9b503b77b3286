#include "protocols/valve_bus/attached_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostCharacters = 4096;

}  // namespace

CharacterProfile character_profile_of(const iut::CaseBegin& begin) {
  return static_cast<CharacterProfile>(std::clamp<std::int64_t>(iut::setting(begin, "characters", 0), 0, 2));
}

AttachedLine::AttachedLine(iut::AttachedCase& attached, const Rules& rules)
    : attached_(attached), rules_(rules), codec_(rules), transmitter_(rules) {
  if (attached.unit_kind() != iut::UnitKind::telegrams) return;
  throw kernel::Error(kernel::ErrorKind::implementation,
                      "a station of the valve bus hears and says characters or levels; this implementation "
                      "announces telegrams");
}

void AttachedLine::begin(const Rules& rules, kernel::Time now) {
  rules_ = rules;
  codec_ = CharacterCodec(rules);
  transmitter_ = Transmitter(rules);
  transmitter_.begin_at(now);
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
  attached_.expect_span(transmission.driver_on, transmission.start, describe);
  attached_.expect_drive(transmission.driver_on, transmission.driver_off, describe);
  if (transmission.start + length > transmission.driver_off + kernel::kNanosecond) {
    iut::refuse_impossible(describe());
  }
  transmitter_.drive(*line_, transmission);
}

void AttachedLine::transmit(unsigned port, line::Waveform& wave) {
  expect_port(port);
  attached_.expect_drive(wave);
  transmitter_.drive(*line_, wave);
}

}  // namespace fieldproof::valve_bus

#include "protocols/valve_bus/attached_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr std::size_t kKnownInstants = 256;

}  // namespace

AttachedLine::AttachedLine(iut::AttachedCase& attached, const Rules& rules)
    : attached_(attached), rules_(rules), codec_(rules), transmitter_(rules) {
  if (attached.unit_kind() != iut::UnitKind::telegrams) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      "a station of the valve bus receives and sends characters or levels; this implementation "
      "announces telegrams");
}

void AttachedLine::begin(const Rules& rules, kernel::Time now) {
  rules_ = rules;
  codec_ = CharacterCodec(rules);
  transmitter_ = Transmitter(rules);
  transmitter_.begin_at(now);
}

// A UART sends whole characters of its format at its bit rate.
void AttachedLine::expect_exact(const line::Waveform& reception) const {
  if (reception.rate != rules_.bit_rate)
    throw iut::CannotBeDone("serial: characters at another bit rate cannot be driven");
  line::Levels levels;
  if (characters_.size() == 1) {
    const auto octet = static_cast<std::uint8_t>(characters_.front().data);
    codec_.append(levels, std::span(&octet, 1));
  }
  if (levels.empty() || levels != reception.levels)
    throw iut::CannotBeDone("serial: levels that are no right character cannot be driven");
}

iut::TimingUncertainty AttachedLine::uncertainty_of(kernel::Time driver_on) const {
  // Instants are rounded where a transmission follows another without a gap.
  const auto found = std::ranges::find_if(known_, [&](const Known& one) {
    return std::chrono::abs(one.driver_on - driver_on) <= kernel::kNanosecond;
  });
  return found == known_.end() ? iut::TimingUncertainty{} : found->uncertainty;
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
  if (attached_.capabilities().is_wall_clock) expect_exact(reception);
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
  if (uncertainty_ != iut::TimingUncertainty{}) {
    known_.push_back({transmission.driver_on, uncertainty_});
    if (known_.size() > kKnownInstants) known_.pop_front();
  }
  transmitter_.drive(*line_, transmission);
}

void AttachedLine::transmit(unsigned port, line::Waveform& wave) {
  expect_port(port);
  attached_.expect_drive(wave);
  transmitter_.drive(*line_, wave);
}

}  // namespace fieldproof::valve_bus

#include "protocols/valve_bus/attached_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kKnownInstants = 256;

}  // namespace

AttachedLine::AttachedLine(iut::AttachedCase& attached, const Rules& rules)
    : attached_(attached), rules_(rules), codec_(rules), driver_(attached, rules) {
  if (attached.unit_kind() != iut::UnitKind::telegrams) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      "a station of the valve bus receives and sends characters or levels; this implementation "
      "announces telegrams");
}

void AttachedLine::begin(const Rules& rules, kernel::Time now) {
  rules_ = rules;
  codec_ = CharacterCodec(rules);
  driver_.begin(rules, now);
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
    after_call(reception.end());
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
    const auto part = rest.first(std::min(rest.size(), LineDriver::kMostAtOnce));
    attached_.call(reception.end(),
                   [&](iut::Device& device) { device.receive(port, part, reception.end()); });
    rest = rest.subspan(part.size());
  }
  after_call(reception.end());
}

void AttachedLine::on_time(kernel::Time now) {
  if (attached_.next_time() <= now || !driver_.has_work()) attached_.on_time(now);
  after_call(now);
}

void AttachedLine::put(kernel::Time now) {
  const kernel::Time next_call = attached_.next_time();
  attached_.call(now, [&](iut::Device&) { driver_.put(*line_, now, next_call); });
}

void AttachedLine::end() {
  if (attached_.is_well()) {
    attached_.call(attached_.now(), [&](iut::Device&) { driver_.expect_no_hanging_driver(); });
  }
  attached_.end();
}

void AttachedLine::expect_port(unsigned port) const {
  attached_.expect_supplied();
  if (port != 0) iut::refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
}

void AttachedLine::set_driver(unsigned port, bool is_on, kernel::Time at) {
  expect_port(port);
  driver_.set(is_on, at);
  if (!is_on || uncertainty_ == iut::TimingUncertainty{}) return;
  known_.push_back({at, uncertainty_});
  if (known_.size() > kKnownInstants) known_.pop_front();
}

void AttachedLine::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  expect_port(port);
  driver_.send(start, characters);
}

void AttachedLine::transmit(unsigned port, line::Waveform& wave) {
  expect_port(port);
  attached_.expect_drive(wave);
  driver_.drive(*line_, wave);
}

}  // namespace fieldproof::valve_bus

#include "harness/iut/attached_uart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::iut {
namespace {

constexpr std::size_t kKnownInstants = 256;

}  // namespace

AttachedUart::AttachedUart(AttachedCase& attached, const line::Uart& uart)
    : attached_(attached), uart_(uart), codec_(uart), driver_(attached, uart) {
  if (attached.unit_kind() != UnitKind::telegrams) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      "a station of a UART line receives and sends characters or levels; this implementation announces "
      "telegrams");
}

void AttachedUart::begin(const line::Uart& uart, kernel::Time now) {
  uart_ = uart;
  codec_ = line::UartCodec(uart);
  driver_.begin(uart, now);
}

// A UART sends whole characters of its format at its bit rate.
void AttachedUart::expect_exact(const line::Waveform& reception) const {
  if (reception.rate != uart_.bit_rate * uart_.levels_per_bit())
    throw CannotBeDone("serial: characters at another bit rate cannot be driven");
  line::Levels levels;
  if (characters_.size() == 1) {
    const auto octet = static_cast<std::uint8_t>(characters_.front().data);
    codec_.append(levels, std::span(&octet, 1));
  }
  if (levels.empty() || levels != reception.levels)
    throw CannotBeDone("serial: levels that are no right character cannot be driven");
}

TimingUncertainty AttachedUart::uncertainty_of(kernel::Time driver_on) const {
  // Instants are rounded where a transmission follows another without a gap.
  const auto found = std::ranges::find_if(known_, [&](const Known& one) {
    return std::chrono::abs(one.driver_on - driver_on) <= kernel::kNanosecond;
  });
  return found == known_.end() ? TimingUncertainty{} : found->uncertainty;
}

void AttachedUart::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (attached_.hears_levels()) {
    attached_.call(reception.end(), [&](Device& device) { device.receive(port, reception); });
    after_call(reception.end());
    return;
  }
  characters_.clear();
  codec_.decode(reception, [&](const Character& received) { characters_.push_back(received); });
  if (attached_.capabilities().is_wall_clock) expect_exact(reception);
  // What is no character an asynchronous receiver does not receive.
  for (std::span<const Character> rest(characters_); !rest.empty();) {
    const auto part = rest.first(std::min(rest.size(), EnabledDriver::kMostAtOnce));
    attached_.call(reception.end(), [&](Device& device) { device.receive(port, part, reception.end()); });
    rest = rest.subspan(part.size());
  }
  after_call(reception.end());
}

void AttachedUart::on_activity(segment::PortIndex port, bool begins, kernel::Time now) {
  attached_.call(now, [&](Device& device) { device.on_activity(port, begins, now); });
  after_call(now);
}

void AttachedUart::on_time(kernel::Time now) {
  if (attached_.next_time() <= now || !driver_.has_work()) attached_.on_time(now);
  after_call(now);
}

void AttachedUart::put(kernel::Time now) {
  const kernel::Time next_call = attached_.next_time();
  attached_.call(now, [&](Device&) { driver_.put(*line_, now, next_call); });
}

void AttachedUart::end() {
  if (attached_.is_well()) {
    attached_.call(attached_.now(), [&](Device&) { driver_.expect_no_hanging_driver(); });
  }
  attached_.end();
}

void AttachedUart::expect_port(unsigned port) const {
  attached_.expect_supplied();
  if (port != 0) refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
}

void AttachedUart::set_driver(unsigned port, bool is_on, kernel::Time at) {
  expect_port(port);
  driver_.set(is_on, at);
  if (!is_on || uncertainty_ == TimingUncertainty{}) return;
  known_.push_back({at, uncertainty_});
  if (known_.size() > kKnownInstants) known_.pop_front();
}

void AttachedUart::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  expect_port(port);
  driver_.send(start, characters);
}

void AttachedUart::transmit(unsigned port, line::Waveform& wave) {
  expect_port(port);
  attached_.expect_drive(wave);
  driver_.drive(*line_, wave);
}

}  // namespace fieldproof::iut

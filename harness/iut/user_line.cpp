#include "harness/iut/user_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::iut {

void put_number(std::vector<std::uint8_t>& octets, std::uint64_t number, unsigned size) {
  while (size-- > 0) octets.push_back(static_cast<std::uint8_t>(number >> 8 * size));
}

std::uint64_t number_at(std::span<const std::uint8_t> octets, std::size_t at, unsigned size) {
  std::uint64_t number = 0;
  for (const std::uint8_t octet : octets.subspan(at, size)) number = number << 8 | octet;
  return number;
}

// ---- what is reported to it ----

void UserLine::receive_levels(const line::Waveform& reception) {
  attached_.call(reception.end(), [&](Device& device) { device.receive(kLinePort, reception); });
}

void UserLine::on_activity(bool begins, kernel::Time now) {
  attached_.call(now, [&](Device& device) { device.on_activity(kLinePort, begins, now); });
}

bool UserLine::ask(const std::vector<std::uint8_t>& request, kernel::Time now) {
  std::vector<Character> characters;
  for (const std::uint8_t octet : request) characters.push_back({now, now, octet});
  return is_taken(
      [&] { attached_.call(now, [&](Device& device) { device.receive(kUserPort, characters, now); }); });
}

bool UserLine::start(kernel::Time now) {
  return is_taken([&] { attached_.set_power(true, now); });
}

void UserLine::stop(kernel::Time now) {
  ahead_.clear();
  attached_.set_power(false, now);
}

void UserLine::refuse() {
  if (!is_asking_) refuse_impossible("refuses something, and nothing is asked of it");
  is_refused_ = true;
}

void UserLine::on_time(kernel::Time now) {
  drive_due(now);
  if (attached_.next_time() <= now) attached_.on_time(now);
}

kernel::Time UserLine::next_time() const {
  const kernel::Time asked_for = attached_.next_time();
  return ahead_.empty() ? asked_for : std::min(asked_for, ahead_.front().start);
}

// ---- what it does ----

void UserLine::expect_line_port(unsigned port) {
  if (port != kLinePort) refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
}

void UserLine::expect_activity() const {
  if (attached_.capabilities().senses_activity) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      "the timers of this role stop while others drive the line; this implementation does not ask "
      "for activity, so it should: 1 at the end of its capabilities, on_activity in its table of "
      "functions");
}

void UserLine::transmit(unsigned port, line::Waveform& wave) {
  attached_.expect_supplied();
  expect_line_port(port);
  drive(std::exchange(wave, {}));
}

void UserLine::drive(line::Waveform&& wave) {
  attached_.expect_drive(wave);
  if (wave.start < driven_until_) {
    refuse_impossible(fmt::format("drives from {} on, and drives already until {}",
                                  kernel::describe(wave.start), kernel::describe(driven_until_)));
  }
  driven_until_ = wave.end();
  ahead_.push_back(std::move(wave));
  drive_due(attached_.now());
}

void UserLine::drive_due(kernel::Time now) {
  while (!ahead_.empty() && ahead_.front().start <= now) {
    line::Waveform wave = std::move(ahead_.front());
    ahead_.pop_front();
    line_->drive(wave);
  }
}

std::vector<std::uint8_t> UserLine::reported_octets(std::span<const std::uint16_t> characters,
                                                    std::size_t most) {
  std::vector<std::uint8_t> octets;
  for (const std::uint16_t one : characters) {
    if (one > 0xFF || octets.size() >= most) refuse_impossible("reports no octets to its user");
    octets.push_back(static_cast<std::uint8_t>(one));
  }
  return octets;
}

}  // namespace fieldproof::iut

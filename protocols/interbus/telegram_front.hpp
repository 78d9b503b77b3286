#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/rules.hpp"

// The line interface of a station outside that hears and says telegrams: the bench finds them on its lines,
// and drives the levels of those that it says. A telegram travels as a character:
//
//   bits 0 to 7   its octet, 0 of a status telegram
//   bit 8, 9, 10  SL and CR are set, FL says data, whatever their levels on the line are
//
// It starts at its start level and is over 13 or 5 bits later; `is_stop_missing` as the receiver saw it.
// What begins within a reception is told when that begins. A telegram that the end of a reception cuts is
// told when the next one completes it, or 13 bits after its start.
namespace fieldproof::interbus {

inline constexpr unsigned kTelegramHeaderBit = 8;  // of the character, where line::kSelect stands

iut::Character character_of(const line::Telegram& telegram, kernel::Time start, std::int64_t bit_rate);

class TelegramFront {
 public:
  static constexpr std::size_t kPorts = 3;
  static constexpr std::size_t kMostAtOnce = 1024;  // telegrams of one call

  explicit TelegramFront(const Rules& rules);

  // Calls tell(characters) until all that are known are told.
  template <typename Tell>
  void hear(unsigned port, const line::Waveform& reception, Tell&& tell) {
    heard_.clear();
    receivers_.at(port).receive(reception, std::bind_front(&TelegramFront::note, this));
    tell_heard(tell);
  }

  // The same for telegrams that were cut and are over: calls tell(port, characters).
  template <typename Tell>
  void complete(kernel::Time now, Tell&& tell) {
    for (unsigned port = 0; port < kPorts; ++port) {
      if (receivers_.at(port).pending_until() > now) continue;
      heard_.clear();
      receivers_.at(port).flush(std::bind_front(&TelegramFront::note, this));
      tell_heard([&](std::span<const iut::Character> characters) { tell(port, characters); });
    }
  }
  // When `complete` has something to do.
  kernel::Time next_time() const;
  // Forgets what was cut.
  void reset();

  // The levels of what the implementation says. Throws iut::Misbehaviour for what is no telegram; the
  // instants are the caller's to judge. Good until the next call.
  line::Waveform& levels_of(kernel::Time start, std::span<const std::uint16_t> characters);

 private:
  void note(const line::Waveform& wave, const line::Telegram& telegram) {
    heard_.push_back(character_of(telegram, wave.time_of(telegram.level), said_.rate));
  }
  template <typename Tell>
  void tell_heard(Tell&& tell) {
    for (std::span<const iut::Character> left = heard_; !left.empty();) {
      const auto now = left.first(std::min(left.size(), kMostAtOnce));
      tell(now);
      left = left.subspan(now.size());
    }
  }

  const line::TelegramCode& code_;
  std::array<line::TelegramReceiver, kPorts> receivers_;
  std::vector<iut::Character> heard_;
  line::Waveform said_;
};

// The front of an implementation that announces telegrams, null for one that announces levels. Throws
// kernel::Error for one that announces what the role ("slave") does not hear.
std::unique_ptr<TelegramFront> front_of(const iut::AttachedCase& attached, const Rules& rules,
                                        std::string_view role);

}  // namespace fieldproof::interbus

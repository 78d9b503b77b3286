#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "harness/line/waveform.hpp"

// The telegram line code: a start level, three header levels, eight data levels in a data telegram and none
// in a status telegram, a stop level; 13 or 5 levels. Which header level is which, their polarity and the
// order of the data levels are a table (`TelegramLayout`), because a bus's standard fixes them and not this
// code.
//
// Decoding never fails: a missing stop level is a value (`kStopMissing`). After a missing stop level the next
// telegram begins with the first falling edge, as in any asynchronous receiver.
namespace fieldproof::line {

enum class HeaderLevel : std::uint8_t { select, control, flag };

struct TelegramLayout {
  std::array<HeaderLevel, 3> header = {HeaderLevel::select, HeaderLevel::control, HeaderLevel::flag};
  bool select_level = true;   // the level that means "select is set"
  bool control_level = true;  // the level that means "control is set"
  bool data_flag_level = true;
  bool most_significant_first = true;

  friend bool operator==(const TelegramLayout&, const TelegramLayout&) = default;
};

inline constexpr unsigned kDataTelegramLevels = 13;
inline constexpr unsigned kStatusTelegramLevels = 5;

// Header of a decoded telegram.
inline constexpr std::uint8_t kSelect = 1;
inline constexpr std::uint8_t kControl = 2;
inline constexpr std::uint8_t kDataTelegram = 4;
inline constexpr std::uint8_t kStopMissing = 8;

struct Telegram {
  std::uint32_t level = 0;  // index of its start level in the waveform that carries it
  std::uint8_t header = 0;
  std::uint8_t data = 0;      // of a data telegram
  std::uint16_t sampled = 0;  // its levels as they were read, the start level in bit 0

  bool is_data() const { return (header & kDataTelegram) != 0; }
  bool is_stop_missing() const { return (header & kStopMissing) != 0; }
  unsigned levels() const { return is_data() ? kDataTelegramLevels : kStatusTelegramLevels; }

  friend bool operator==(const Telegram&, const Telegram&) = default;
};

class TelegramCode {
 public:
  explicit TelegramCode(const TelegramLayout& layout);

  // The levels of a telegram, the first in bit 0; `header` is kSelect | kControl | kDataTelegram.
  std::uint64_t levels_of(std::uint8_t header, std::uint8_t data) const {
    const std::uint64_t head = header_levels_[header & 7];
    return (header & kDataTelegram) != 0
               ? head | std::uint64_t{data_levels_[data]} << 4 | std::uint64_t{1} << 12
               : head | std::uint64_t{1} << 4;
  }

  void append(Levels& levels, std::uint8_t header, std::uint8_t data) const {
    levels.append(levels_of(header, data),
                  (header & kDataTelegram) != 0 ? kDataTelegramLevels : kStatusTelegramLevels);
  }

  // The telegram in 13 sampled levels whose first, in bit 0, is its start level.
  Telegram from_levels(std::uint64_t sampled) const {
    Telegram telegram;
    telegram.header = headers_[(sampled >> 1) & 7];
    if (telegram.is_data()) {
      telegram.data = octets_[(sampled >> 4) & 0xFF];
      telegram.sampled = static_cast<std::uint16_t>(sampled & 0x1FFF);
      if ((sampled & 0x1000) == 0) telegram.header |= kStopMissing;
    } else {
      telegram.sampled = static_cast<std::uint16_t>(sampled & 0x1F);
      if ((sampled & 0x10) == 0) telegram.header |= kStopMissing;
    }
    return telegram;
  }

  // Calls sink(telegram) for each telegram in levels that are exactly bit-wide, from level `at` on; gives the
  // start of a telegram that is cut by the end of the levels, or size().
  template <typename Sink>
  std::size_t decode(const Levels& levels, std::size_t at, Sink&& sink) const {
    return decode_until(levels, at, levels.size(), sink);
  }

  // The same for who wants the telegrams that begin up to level `until`, and bears a few after it. What is
  // given, when it lies in the levels after `until`, is where to go on: no telegram begins in between.
  template <typename Sink>
  std::size_t decode_until(const Levels& levels, std::size_t at, std::size_t until, Sink&& sink) const {
    const std::size_t size = levels.size();
    const std::size_t last = until < size ? std::min(size, until + kDataTelegramLevels) : size;
    // As many telegrams as a window holds are taken out of it: what one telegram costs is then a few shifts
    // of a register and not a look-up that waits for the one before it.
    while (at + kDataTelegramLevels <= last) {
      std::uint64_t window = levels.window(at);
      auto left = static_cast<unsigned>(size - at < 64 ? size - at : 64);  // levels of the line in the window
      while (true) {
        const unsigned idle = idle_in_front(window);
        at += idle;
        if (left < kDataTelegramLevels + idle) break;
        left -= idle;
        window >>= idle;
        Telegram telegram = from_levels(window);
        telegram.level = static_cast<std::uint32_t>(at);
        sink(telegram);
        if (telegram.is_stop_missing()) {
          at = next_idle(levels, at + telegram.levels() - 1);
          break;
        }
        const unsigned length = telegram.is_data() ? kDataTelegramLevels : kStatusTelegramLevels;
        at += length;
        left -= length;
        window >>= length;
      }
    }
    return last < size ? std::min(at, size) : decode_end(levels, at, sink);
  }

 private:
  // The last levels, in which a telegram may be cut.
  template <typename Sink>
  std::size_t decode_end(const Levels& levels, std::size_t at, Sink& sink) const {
    const std::size_t size = levels.size();
    while (at < size) {
      const std::uint64_t window = levels.window(at);
      const unsigned idle = idle_in_front(window);
      if (idle > 0) {
        at += idle;
        continue;
      }
      Telegram telegram = from_levels(window);
      if (at + telegram.levels() > size) return at;
      telegram.level = static_cast<std::uint32_t>(at);
      sink(telegram);
      at += telegram.levels();
      if (telegram.is_stop_missing()) at = next_idle(levels, at - 1);
    }
    return size;
  }

  // Idle levels in front of the start level. One or two, as they stand within a cycle, are left to the branch
  // predictor; to count them takes several times as long.
  static unsigned idle_in_front(std::uint64_t window) {
    if ((window & 1) == 0) return 0;
    if ((window & 7) == 3) return 2;
    if ((window & 3) == 1) return 1;
    return static_cast<unsigned>(std::countr_one(window));
  }

  // The first idle level at or after `at`: a start level needs an edge.
  static std::size_t next_idle(const Levels& levels, std::size_t at);

  std::array<std::uint8_t, 8> header_levels_{};  // header -> start level and header levels
  std::array<std::uint8_t, 8> headers_{};        // header levels -> header
  std::array<std::uint8_t, 256> data_levels_{};  // octet -> levels
  std::array<std::uint8_t, 256> octets_{};       // levels -> octet
};

// One code per layout, shared by all stations of the program: its tables stay in the cache of the processor.
const TelegramCode& shared_telegram_code(const TelegramLayout& layout);

}  // namespace fieldproof::line

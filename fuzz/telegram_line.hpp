#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "fuzz/octet_reader.hpp"
#include "fuzz/reference_line.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/telegram_receiver.hpp"

// A line of telegrams in any division into waveforms, heard by the receiver under test: what the targets
// `telegram` (levels as wide as bits) and `sampling` (any other rate) share.
namespace fieldproof::fuzz {

inline constexpr std::int64_t kBitRate = 500'000;
inline constexpr std::size_t kMostLevels = 2048;

struct Seen {
  std::int64_t start;
  std::uint8_t header;
  std::uint8_t data;
  friend bool operator==(const Seen&, const Seen&) = default;
};

class Log {
 public:
  void clear() { count_ = 0; }
  // A telegram has an edge of its own, so there are at most half as many as levels.
  void add(const Seen& seen) {
    FIELDPROOF_CHECK(count_ < seen_.size(), "a receiver gives no more telegrams than fit the line");
    seen_[count_++] = seen;
  }
  FIELDPROOF_UNINSTRUMENTED bool is_same(const Log& other) const {
    if (count_ != other.count_) return false;
    for (std::size_t n = 0; n < count_; ++n) {
      if (!(seen_[n] == other.seen_[n])) return false;
    }
    return true;
  }

 private:
  std::array<Seen, kMostLevels / 2> seen_;
  std::size_t count_ = 0;
};

// Where a line is cut: the first part and each further one but the last have these numbers of levels.
struct Cuts {
  std::size_t count = 0;
  std::size_t first = 1;
  std::size_t step = 1;
};

inline Cuts read_cuts(OctetReader& input) {
  const std::uint8_t first = input.octet();
  return {first & 3U, static_cast<std::size_t>(first >> 2) * 3 + 1, std::size_t{input.octet()} + 1};
}

// Kept from one input to the next so that no input pays for its making.
class Hearing {
 public:
  void hear_whole(const line::Waveform& wave, Log& log) { hear_divided(wave, {}, log); }

  void hear_divided(const line::Waveform& wave, const Cuts& cuts, Log& log) {
    log.clear();
    const auto sink = [&log](const line::Waveform& heard, const line::Telegram& telegram) {
      log.add({heard.time_of(telegram.level).time_since_epoch().count(), telegram.header, telegram.data});
    };
    receiver_.reset();
    const std::size_t size = wave.levels.size();
    std::size_t at = 0;
    for (std::size_t cut = 0; at < size; ++cut) {
      const std::size_t count = cut < cuts.count ? (cut == 0 ? cuts.first : cuts.step) : size;
      part_.start = wave.time_of(at);
      part_.rate = wave.rate;
      part_.levels.clear();
      part_.levels.append(wave.levels, at, std::min(count, size - at));
      at += part_.levels.size();
      receiver_.receive(part_, sink);
    }
    receiver_.flush(sink);
    FIELDPROOF_CHECK(receiver_.pending_until() == kernel::kNever, "a flushed receiver has nothing pending");
  }

  // The same by the definition, for levels as wide as bits.
  static void hear_bits(const line::Levels& levels, Log& log) {
    constexpr std::int64_t kPicosecondsPerBit = kernel::kSecond.count() / kBitRate;
    log.clear();
    hear_bit_by_bit(levels, [&log](const HeardTelegram& heard) {
      log.add({static_cast<std::int64_t>(heard.level) * kPicosecondsPerBit, heard.header, heard.data});
    });
  }

 private:
  const line::TelegramCode code_{line::TelegramLayout{}};
  line::TelegramReceiver receiver_{code_, kBitRate};
  line::Waveform part_;
};

}  // namespace fieldproof::fuzz

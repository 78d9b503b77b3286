#pragma once

#include <algorithm>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"

// Retimes telegrams: each one that goes through a station leaves it a constant delay after it began to
// arrive, on the station's own bit rate. Telegrams that arrive on the grid of the station's bits leave as one
// waveform; off that grid each leaves as its own.
namespace fieldproof::interbus {

class TelegramRelay {
 public:
  explicit TelegramRelay(std::int64_t bit_rate) { out_.rate = bit_rate; }

  // What follows comes from `reception` and goes to `port` (null: nothing is plugged in).
  void open(segment::Port* port, kernel::Duration delay, kernel::Time now) {
    port_ = port;
    delay_ = delay;
    now_ = now;
  }

  void put(const line::Waveform& reception, std::uint32_t level, std::uint64_t levels, unsigned count) {
    if (&reception != reception_) begin(reception, level);
    out_.levels.place(level - base_, levels, count);
  }

  // The telegram as it came, with a stop bit.
  void put(const line::Waveform& reception, const line::Telegram& telegram) {
    if (telegram.is_data()) {
      put(reception, telegram.level, telegram.sampled | 0x1000U, line::kDataTelegramLevels);
    } else {
      put(reception, telegram.level, telegram.sampled | 0x10U, line::kStatusTelegramLevels);
    }
  }

  void close() {
    reception_ = nullptr;
    if (out_.levels.empty()) return;
    if (port_ == nullptr) return out_.levels.clear();
    driven_until_ = out_.end();
    port_->drive(out_);
  }

 private:
  void begin(const line::Waveform& reception, std::uint32_t level) {
    close();
    // Off the grid the next telegram begins a waveform of its own.
    if (reception.rate == out_.rate) reception_ = &reception;
    base_ = level;
    out_.levels.make_room(reception.levels.size() - level + line::kDataTelegramLevels);
    // A telegram that only a later reception completed would have left before now.
    out_.start = std::max({reception.time_of(level) + delay_, now_, driven_until_});
  }

  line::Waveform out_;
  segment::Port* port_ = nullptr;
  kernel::Duration delay_{};
  kernel::Time now_{};
  kernel::Time driven_until_{kernel::Duration::min()};
  const line::Waveform* reception_ =
      nullptr;              // what is collected now; null when the next telegram begins anew
  std::uint32_t base_ = 0;  // level of the reception with which out_ begins
};

}  // namespace fieldproof::interbus

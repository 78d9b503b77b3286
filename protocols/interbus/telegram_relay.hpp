#pragma once

#include <algorithm>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"

// Retimes telegrams: each one that goes through a station leaves it a constant delay after it began to
// arrive, on the station's own bit rate, or when what left before has ended. Telegrams that arrive on the
// grid of the station's bits and leave in time do so as one waveform; others each as their own.
namespace fieldproof::interbus {

class TelegramRelay {
 public:
  explicit TelegramRelay(std::int64_t bit_rate) { out_.rate = bit_rate; }

  // Until when something is driven at a port, whichever relay drives it.
  struct Way {
    segment::Port* port = nullptr;  // null: nothing is plugged in
    kernel::Time driven_until{kernel::Duration::min()};
  };

  // What follows goes this way.
  void open(Way& way, kernel::Duration delay, kernel::Time now) {
    way_ = &way;
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
    if (way_->port == nullptr) return out_.levels.clear();
    way_->driven_until = out_.end();
    way_->port->drive(out_);
  }

 private:
  // Once for a reception; apart, so that what is done for each telegram stays small.
  [[gnu::noinline]] void begin(const line::Waveform& reception, std::uint32_t level) {
    close();
    base_ = level;
    out_.levels.make_room(reception.levels.size() - level + line::kDataTelegramLevels);
    // A telegram that only a later reception completed would have left before now.
    const kernel::Time in_time = reception.time_of(level) + delay_;
    out_.start = std::max({in_time, now_, way_->driven_until});
    // Off the grid, or late, the next telegram begins a waveform of its own: it may be in time.
    if (reception.rate == out_.rate && out_.start == in_time) reception_ = &reception;
  }

  line::Waveform out_;
  Way* way_ = nullptr;
  kernel::Duration delay_{};
  kernel::Time now_{};
  const line::Waveform* reception_ =
      nullptr;              // what is collected now; null when the next telegram begins anew
  std::uint32_t base_ = 0;  // level of the reception with which out_ begins
};

}  // namespace fieldproof::interbus

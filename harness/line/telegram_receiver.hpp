#pragma once

#include <cstdint>
#include <optional>

#include "harness/kernel/time.hpp"
#include "harness/line/sampling.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"

// The receiver of telegrams at one station: levels in, telegrams out, at any rate of the waveform.
//
// A waveform of the receiver's own bit rate is decoded level by level (a sample in the middle of an aligned
// bit is that level); any other is sampled as a receiver does: the start bit is validated, each bit is
// sampled where `Sampling` says, and after the stop bit the next falling edge begins a telegram. A telegram
// that the end of a waveform cuts is kept: it is completed by the next reception or, when none comes in time,
// by the idle line
// (`flush` at `pending_until`). So it makes no difference how a sender divides its telegrams into waveforms.
namespace fieldproof::line {

struct TelegramReceiverOptions {
  Sampling sampling;
  // A receiver that does not validate takes each falling edge for a start bit.
  bool validates_start = true;
};

class TelegramReceiver {
 public:
  TelegramReceiver(const TelegramCode& code, std::int64_t bit_rate, TelegramReceiverOptions options = {});

  // Calls sink(wave, telegram) for each telegram that is complete; `telegram.level` counts in the levels of
  // the `wave` that the sink is given (not always the one that was received).
  template <typename Sink>
  void receive(const Waveform& wave, Sink&& sink) {
    if (has_pending_ && wave.start >= pending_until_) flush(sink);
    if (!has_pending_) return decode(wave, first_level(wave), sink);
    has_pending_ = false;
    if (join_on_grid(wave)) return decode(joined_, first_level(joined_), sink);
    // Off the grid only as much is joined as completes what began before: the rest may be long and slow.
    join_head(wave);
    if (const auto next = complete_pending(joined_, wave, sink)) decode(wave, *next, sink);
  }

  // Forgets everything that was heard.
  void reset() {
    has_pending_ = false;
    low_until_ = kernel::kNever;
  }

  // The begin and the end of a telegram that is not complete, kNever when there is none.
  kernel::Time pending_from() const { return has_pending_ ? pending_.start : kernel::kNever; }
  kernel::Time pending_until() const { return has_pending_ ? pending_until_ : kernel::kNever; }

  // Completes a pending telegram with the idle line.
  template <typename Sink>
  void flush(Sink&& sink) {
    if (!has_pending_) return;
    has_pending_ = false;
    std::swap(joined_, pending_);
    joined_.levels.append_idle(idle_levels(joined_));
    decode(joined_, first_level(joined_), sink);
    has_pending_ = false;  // what a flushed rest leaves behind is shorter than a telegram of the idle line
  }

 private:
  template <typename Sink>
  void decode(const Waveform& wave, std::size_t at, Sink& sink) {
    const std::size_t size = wave.levels.size();
    if (size == 0) return;
    if (wave.rate == bit_rate_) {
      at = code_.decode(wave.levels, at, [&](const Telegram& telegram) { sink(wave, telegram); });
    } else {
      Telegram telegram;
      while (at < size && sample_telegram(wave, at, telegram)) sink(wave, telegram);
    }
    if (at < size) {
      keep(wave, at);
    } else if (!wave.levels[size - 1]) {
      // After a missing stop bit: a start bit needs an edge, so the next reception may have to rise first.
      low_until_ = wave.end();
    }
  }

  // The telegrams that began before `wave`. Gives the level of it at which the search goes on, nothing when
  // the end of the wave cuts the telegram again.
  template <typename Sink>
  std::optional<std::size_t> complete_pending(const Waveform& joined, const Waveform& wave, Sink& sink) {
    std::size_t at = 0;
    Telegram telegram;
    while (begins_before(joined, at, wave.start)) {
      if (sample_telegram(joined, at, telegram)) {
        sink(joined, telegram);
      } else if (begins_before(joined, at, wave.start)) {
        keep(joined, at);
        return std::nullopt;
      } else {
        break;
      }
    }
    const std::size_t next = wave.first_level_at(joined.time_of(at));
    // Where they end on a low line that goes on, the next edge is after it.
    const bool stays_low = at == joined.levels.size() && !joined.levels[at - 1];
    return stays_low ? next_idle(wave.levels, next) : next;
  }

  // Where the search in a waveform begins: a low line that goes on from the one before has no edge.
  std::size_t first_level(const Waveform& wave) const {
    return wave.start == low_until_ ? next_idle(wave.levels, 0) : 0;
  }
  static std::size_t next_idle(const Levels& levels, std::size_t from);
  static bool begins_before(const Waveform& wave, std::size_t from, kernel::Time time);
  // Finds and samples the next telegram from level `at` on; false when there is none or when the end of the
  // waveform cuts it (`at` is then its first level), else `at` is where the search goes on.
  bool sample_telegram(const Waveform& wave, std::size_t& at, Telegram& telegram);
  void keep(const Waveform& wave, std::size_t from);
  // Idle levels after a cut telegram that complete it whatever it is.
  std::size_t idle_levels(const Waveform& wave) const;
  // Makes one waveform of what is pending and `second` after it; false when they share no grid.
  bool join_on_grid(const Waveform& second);
  // The same at a rate at which both can be written, with as much of `second` as a telegram that began before
  // it can last.
  void join_head(const Waveform& second);

  const TelegramCode& code_;
  std::int64_t bit_rate_;
  TelegramReceiverOptions options_;
  Sampler sampler_;
  bool has_pending_ = false;
  kernel::Time pending_until_{};
  Waveform pending_;
  Waveform joined_;                          // what is pending with what follows it; a member for its buffer
  kernel::Time low_until_ = kernel::kNever;  // end of a reception that left the line low
};

}  // namespace fieldproof::line

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/fault/arrivals.hpp"
#include "harness/fault/channel.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"

// A channel that a test case programs by hand: on the next transmission, or the n-th from now, change exactly
// these levels. One-shot: what has been applied is forgotten.
//
//   channel.on_next().flip(17).flip(20);
//   channel.on(2).drop_telegram(4);
//
// Contract: all positions mean the transmission as it was sent, whatever else is changed in it. Flips and
// forces are applied first, in order; then the parts that are dropped, removed, repeated or inserted, from
// front to back (parts should not overlap; one that begins inside the part before it is ignored); then the
// start and the rate. Positions after the end do nothing. Arming allocates nothing once the channel is warm.
namespace fieldproof::fault {

class ScriptedChannel final : public Channel {
 public:
  // The telegram operations need the code by which telegrams are found; it must outlive the channel.
  explicit ScriptedChannel(const line::TelegramCode* code = nullptr) : code_(code) {}

  // Which transmission the following orders mean: 0 is the next one from now (also when nothing is said).
  ScriptedChannel& on(std::uint64_t transmission) {
    meant_ = passed_ + transmission;
    return *this;
  }
  ScriptedChannel& on_next() { return on(0); }

  ScriptedChannel& flip(std::size_t level) { return order(Kind::flip, level, 1); }
  ScriptedChannel& force(bool level, std::size_t first, std::size_t count) {
    return order(level ? Kind::force_one : Kind::force_zero, first, count);
  }

  // The levels do not arrive; what is after them arrives in time.
  ScriptedChannel& drop(std::size_t first, std::size_t count) { return order(Kind::drop, first, count); }
  // The levels do not arrive; what is after them arrives earlier by their length.
  ScriptedChannel& remove(std::size_t first, std::size_t count) { return order(Kind::remove, first, count); }
  // The levels arrive twice; what is after them arrives later by their length.
  ScriptedChannel& repeat(std::size_t first, std::size_t count) { return order(Kind::repeat, first, count); }
  // New levels in front of level `at` (size() appends them); what is after arrives later by their length.
  ScriptedChannel& insert(std::size_t at, const line::Levels& levels);
  ScriptedChannel& insert(std::size_t at, std::uint64_t bits, unsigned count);
  // Nothing from level `at` on arrives.
  ScriptedChannel& cut(std::size_t at) { return order(Kind::drop, at, kToTheEnd); }
  ScriptedChannel& lose() { return cut(0); }

  // The same on telegram k of the transmission, from 0; after the last telegram they do nothing.
  ScriptedChannel& drop_telegram(std::size_t k) { return order(Kind::drop, k, kTelegram); }
  ScriptedChannel& remove_telegram(std::size_t k) { return order(Kind::remove, k, kTelegram); }
  ScriptedChannel& repeat_telegram(std::size_t k) { return order(Kind::repeat, k, kTelegram); }
  // Level `level` of telegram k, from 0 (its start level).
  ScriptedChannel& flip_in_telegram(std::size_t k, std::size_t level);

  // The transmission arrives later, or at another rate from its start on.
  ScriptedChannel& delay(kernel::Duration duration);
  ScriptedChannel& rate(std::int64_t levels_per_second);
  // Other levels arrive instead, at the start and rate of the transmission; positions then mean the new ones.
  ScriptedChannel& replace(const line::Levels& levels);

  // Forgets what has not been applied yet.
  void disarm();
  bool is_armed() const { return !orders_.empty(); }
  // Transmissions that have passed so far.
  std::uint64_t passed() const { return passed_; }

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

 private:
  enum class Kind : std::uint8_t {
    flip,
    force_zero,
    force_one,
    flip_in_telegram,
    drop,
    remove,
    repeat,
    insert,
    delay,
    rate,
    replace,
  };
  static constexpr std::size_t kToTheEnd = ~std::size_t{0};
  static constexpr std::size_t kTelegram = ~std::size_t{0} - 1;

  struct Order {
    std::uint64_t transmission;
    Kind kind;
    std::size_t first;
    std::size_t count;   // or kTelegram: `first` is the number of a telegram
    std::int64_t value;  // picoseconds, levels per second, or the first of the stored levels
  };

  // What takes the levels apart or makes more of them.
  struct Cut {
    Kind kind;
    Piece part;
    std::int64_t stored;
  };

  ScriptedChannel& order(Kind kind, std::size_t first, std::size_t count, std::int64_t value = 0);
  static bool is_cut(Kind kind) { return kind >= Kind::drop && kind <= Kind::insert; }
  void change(const Order& order);
  void add_cut(const Order& order);
  void write(line::Waveforms& arrivals);
  void find_telegrams(const line::Levels& levels);

  const line::TelegramCode* code_;
  std::uint64_t passed_ = 0;
  std::uint64_t meant_ = 0;
  std::vector<Order> orders_;
  line::Levels stored_;  // what is inserted or put in place
  line::Waveform changed_;
  std::vector<line::Telegram> telegrams_;
  std::vector<Cut> cuts_;  // ordered by part
};

}  // namespace fieldproof::fault

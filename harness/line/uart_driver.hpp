#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>

#include "harness/kernel/time.hpp"
#include "harness/line/uart.hpp"
#include "harness/line/uart_codec.hpp"
#include "harness/line/waveform.hpp"

// The driver of a UART line whose enable is switched by somebody else: driver enable on, characters and off
// come each at its own time, or ahead, and nobody knows the end of what has begun. So while the driver is on
// and nothing is sent, the idle line is driven in pieces: up to the next call of whoever switches it, and not
// longer than half a character. What comes for an instant that a piece covers already begins after that
// piece.
//
// What is known when it is put on the line is driven as one who knows all beforehand drives it: the first
// character together with the idle bits before it, the last one together with those after it.
//
// Contract: instants come in order, but for a nanosecond of rounding; characters come while the enable is on,
// and not into each other.
namespace fieldproof::line {

class UartDriver {
 public:
  static constexpr kernel::Duration kRounding = kernel::kNanosecond;
  using Drive = std::function<void(Waveform&)>;

  explicit UartDriver(const Uart& uart) : uart_(uart), codec_(uart) {}

  // The driver is off, and nothing has been driven before `now`.
  void begin(const Uart& uart, kernel::Time now);

  // ---- what is to be driven ----
  void enable(bool is_on, kernel::Time at) { acts_.push_back({is_on ? Kind::on : Kind::off, at, 0}); }
  void send(kernel::Time start, std::uint16_t character) {
    acts_.push_back({Kind::character, start, character});
  }

  // ---- what is on the line ----
  bool has_work() const { return is_driving_ || !acts_.empty(); }
  bool is_driving() const { return is_driving_; }
  kernel::Time driving_since() const { return driving_since_; }
  kernel::Time driven_until() const { return driven_until_; }
  // When it is to be put on the line again; kNever where there is nothing.
  kernel::Time next_time() const;
  // All that is known at `now`. Whoever switches the driver is called again at `next_call`.
  void put(const Drive& drive, kernel::Time now, kernel::Time next_call);
  // Levels as they are.
  void put_levels(const Drive& drive, Waveform& wave);

 private:
  enum class Kind : std::uint8_t { on, character, off };
  struct Act {
    Kind kind = Kind::on;
    kernel::Time at{};
    std::uint16_t data = 0;
  };

  // How many whole bits lie between the two, none where they are not whole.
  std::size_t idle_bits(kernel::Time from, kernel::Time to) const;
  void put_acts(const Drive& drive, kernel::Time now);
  void put_character(const Drive& drive);
  // Shorter than what can be driven: nothing is.
  kernel::Duration least_idle() const;
  void put_idle(const Drive& drive, kernel::Time to);
  void put_idle(const Drive& drive, std::int64_t levels, std::int64_t rate);
  void put_piece(const Drive& drive, kernel::Time now, kernel::Time next_call);

  Uart uart_;
  UartCodec codec_;
  Waveform wave_;
  std::deque<Act> acts_;  // not yet on the line
  bool is_driving_ = false;
  kernel::Time driving_since_{};
  kernel::Time driven_until_{};
};

}  // namespace fieldproof::line

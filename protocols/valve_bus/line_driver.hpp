#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

#include "harness/iut/attached_case.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/codec.hpp"

// Puts what an implementation says of its driver and its characters onto the line of the bench.
//
// Each is said at its own time, or ahead, and nobody knows the end of what has begun. So while the driver is
// on and nothing is sent, the idle line is driven in pieces: up to the next call of the implementation, and
// not longer than half a character. What is said for an instant that a piece covers already (a reception has
// called the implementation before its time) begins after that piece.
//
// What is known when a call ends is driven as a station of ours drives it: the first character together with
// the idle bits before it, the last one together with those after it.
//
// Contract: instants of one line come in order. What cannot be (characters without the driver, or into those
// before; a driver that goes off within a character) is Misbehaviour; so is a driver that is on for longer
// than 10 s, or at the end of a case for longer than kIdleAtEnd with nothing to send.
namespace fieldproof::valve_bus {

class LineDriver {
 public:
  static constexpr int kIdleAtEnd = 8;              // characters
  static constexpr std::size_t kMostAtOnce = 4096;  // characters of one message, in either direction

  LineDriver(iut::AttachedCase& attached, const Rules& rules)
      : attached_(attached), rules_(rules), codec_(rules) {}

  // The driver is off, and nothing has been driven before `now`.
  void begin(const Rules& rules, kernel::Time now);

  // ---- within a call of the implementation ----
  void set(bool is_on, kernel::Time at);
  void send(kernel::Time start, std::span<const std::uint16_t> characters);
  // Levels as they are.
  void drive(segment::Port& line, line::Waveform& wave);

  // ---- between calls ----
  bool has_work() const { return is_driving_ || !acts_.empty(); }
  // The call at `now` is over, or `next_time` has come. The implementation is called again at `next_call`.
  void put(segment::Port& line, kernel::Time now, kernel::Time next_call);
  kernel::Time next_time() const;
  // The case is over.
  void expect_no_hanging_driver() const;

 private:
  enum class Kind : std::uint8_t { on, character, off };
  struct Act {
    Kind kind = Kind::on;
    kernel::Time at{};
    std::uint16_t data = 0;
  };

  kernel::Duration length_of(std::size_t characters) const {
    return half_characters(rules_, 2 * static_cast<unsigned>(characters));
  }
  void expect_later(kernel::Time at, std::string_view does) const;
  // Where an instant lies that may have been rounded into what was driven before.
  kernel::Time behind_the_last(kernel::Time at) const;
  // How many whole bits lie between the two, none where they are not whole.
  std::size_t idle_bits(kernel::Time from, kernel::Time to) const;
  void put_acts(segment::Port& line, kernel::Time now);
  void put_character(segment::Port& line);
  // Shorter than what can be driven: nothing is.
  kernel::Duration least_idle() const;
  void put_idle(segment::Port& line, kernel::Time to);
  void put_idle(segment::Port& line, std::int64_t levels, std::int64_t rate);
  void put_piece(segment::Port& line, kernel::Time now, kernel::Time next_call);

  iut::AttachedCase& attached_;
  Rules rules_;
  CharacterCodec codec_;
  line::Waveform wave_;

  // As it was said.
  bool is_on_ = false;
  kernel::Time on_since_{};
  kernel::Time said_until_{};  // the last instant that was said, the end of the last character
  std::deque<Act> acts_;       // not yet on the line

  // As it is on the line.
  bool is_driving_ = false;
  kernel::Time driving_since_{};
  kernel::Time driven_until_{};
};

}  // namespace fieldproof::valve_bus

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "harness/iut/attached_case.hpp"
#include "harness/line/uart_driver.hpp"
#include "harness/segment/station.hpp"

// Puts what an implementation reports of its driver enable and its characters onto the line of the bench, and
// holds it to what can be.
//
// Contract: instants of one line come in order. What cannot be (characters without the driver, or into those
// before; a driver that goes off within a character) is Misbehaviour; so is a driver that is on for longer
// than 10 s, or at the end of a case for longer than kIdleAtEnd with nothing to send.
namespace fieldproof::iut {

class EnabledDriver {
 public:
  static constexpr int kIdleAtEnd = 8;              // characters
  static constexpr std::size_t kMostAtOnce = 4096;  // characters of one message, in either direction

  EnabledDriver(AttachedCase& attached, const line::Uart& uart)
      : attached_(attached), uart_(uart), driver_(uart) {}

  // The driver is off, and nothing has been driven before `now`.
  void begin(const line::Uart& uart, kernel::Time now);

  // ---- within a call of the implementation ----
  void set(bool is_on, kernel::Time at);
  void send(kernel::Time start, std::span<const std::uint16_t> characters);
  // Levels as they are.
  void drive(segment::Port& line, line::Waveform& wave);

  // ---- between calls ----
  bool has_work() const { return driver_.has_work(); }
  // The call at `now` is over, or `next_time` has come. The implementation is called again at `next_call`.
  void put(segment::Port& line, kernel::Time now, kernel::Time next_call);
  kernel::Time next_time() const { return driver_.next_time(); }
  // The case is over.
  void expect_no_hanging_driver() const;

 private:
  kernel::Duration length_of(std::size_t characters) const {
    return uart_.half_characters(2 * static_cast<std::int64_t>(characters));
  }
  void expect_later(kernel::Time at, std::string_view does) const;

  AttachedCase& attached_;
  line::Uart uart_;
  line::UartDriver driver_;

  // As it was reported.
  bool is_on_ = false;
  kernel::Time on_since_{};
  kernel::Time reported_until_{};  // the last instant, the end of the last character
};

}  // namespace fieldproof::iut

#include "harness/line/uart_driver.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace fieldproof::line {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr Uart kUart{9'600, {.parity = Parity::even}, 0};

class OnTheLine {
 public:
  explicit OnTheLine(const Uart& uart) : uart_(uart), driver_(uart) { driver_.begin(uart, kernel::kStart); }

  UartDriver& driver() { return driver_; }
  // As one who is called only when the driver asks for it.
  void run_until(Time until) {
    while (driver_.has_work() && driver_.next_time() < until) put(driver_.next_time(), until);
  }
  void put(Time now, Time next_call) {
    driver_.put([this](Waveform& wave) { keep(wave); }, now, next_call);
  }

  const std::vector<UartCharacter>& characters() const { return characters_; }
  Time on() const { return on_; }
  Time off() const { return off_; }
  bool has_gap() const { return has_gap_; }

 private:
  void keep(Waveform& wave) {
    if (on_ == kernel::kNever) on_ = off_ = wave.start;
    has_gap_ = has_gap_ || std::chrono::abs(wave.start - off_) > UartDriver::kRounding;
    off_ = wave.end();
    UartCodec(uart_).decode(wave, [&](const UartCharacter& one) { characters_.push_back(one); });
    wave.levels.clear();
  }

  Uart uart_;
  UartDriver driver_;
  std::vector<UartCharacter> characters_;
  Time on_ = kernel::kNever;
  Time off_{};
  bool has_gap_ = false;
};

// However long before, between and after the characters the driver is on, and whether all is known ahead or
// each comes at its time: the line is driven from on to off without a gap, and carries them where they began.
RC_GTEST_PROP(UartDriver, DrivesFromOnToOffWhatIsSent, (bool is_ahead)) {
  Uart uart = kUart;
  uart.format.stop_bits = static_cast<StopBits>(*rc::gen::inRange(0, 3));
  const auto any_time = [] { return Duration{*rc::gen::inRange(0, 2'000'000)} * 1000; };
  OnTheLine line(uart);
  const Time on = kernel::kStart + any_time();
  std::vector<Time> starts;
  Time at = on;
  for (auto n = *rc::gen::inRange(1U, 6U); n > 0; --n) {
    starts.push_back(at + any_time());
    at = starts.back() + uart.character_time();
  }
  const Time off = at + any_time();

  line.driver().enable(true, on);
  if (!is_ahead) line.put(on, starts.front());
  for (std::size_t n = 0; n < starts.size(); ++n) {
    if (!is_ahead) line.run_until(starts[n]);
    line.driver().send(starts[n], static_cast<std::uint16_t>(n));
    if (!is_ahead) line.put(starts[n], starts[n] + uart.character_time());
  }
  if (!is_ahead) line.run_until(off);
  line.driver().enable(false, off);
  line.put(is_ahead ? kernel::kStart : off, kernel::kNever);

  RC_ASSERT(!line.driver().has_work());
  RC_ASSERT(!line.has_gap());
  RC_ASSERT(line.on() == on);
  const Duration least_idle = uart.bits(1) / 16;
  RC_ASSERT(std::chrono::abs(line.off() - off) <= least_idle);
  RC_ASSERT(line.characters().size() == starts.size());
  for (std::size_t n = 0; n < starts.size(); ++n) {
    RC_ASSERT(line.characters()[n].data == n);
    RC_ASSERT(std::chrono::abs(line.characters()[n].start - starts[n]) <= least_idle);
  }
}

// Known when it is to come, and said then: where the pieces before end has no part in it.
RC_GTEST_PROP(UartDriver, WhatComesAfterIdleBeginsToTheNanosecond, ()) {
  Uart uart = kUart;
  uart.bit_rate = *rc::gen::element<std::int64_t>(1'200, 9'600, 62'500, 375'000);
  OnTheLine line(uart);
  const auto lead =
      kernel::Duration{uart.bits(1).count() * *rc::gen::inRange<std::int64_t>(1'000, 20'000) / 1'000};
  const Time start = kernel::kStart + lead;
  line.driver().enable(true, kernel::kStart);
  line.put(kernel::kStart, start);
  line.run_until(start);
  line.driver().send(start, 0x55);
  line.put(start, start + uart.character_time());
  RC_ASSERT(line.characters().size() == 1U);
  RC_ASSERT(std::chrono::abs(line.characters()[0].start - start) <= UartDriver::kRounding);
}

// Each when the one before has left, as a UART that is free reports it, with instants that were rounded up.
RC_GTEST_PROP(UartDriver, CharactersOneAfterAnotherBeginWhenTheyAreSaid, ()) {
  Uart uart = kUart;
  uart.bit_rate = *rc::gen::element<std::int64_t>(1'200, 9'600, 62'500, 375'000);
  OnTheLine line(uart);
  const auto rounding = kernel::Duration{*rc::gen::inRange<std::int64_t>(0, 300)};
  line.driver().enable(true, kernel::kStart);
  Time start = kernel::kStart + uart.bits(1);
  line.put(kernel::kStart, start);
  std::vector<Time> starts;
  for (int n = 0; n < 5; ++n) {
    line.run_until(start);
    line.driver().send(start, static_cast<std::uint16_t>(n));
    starts.push_back(start);
    const Time next = start + uart.character_time() + rounding;
    line.put(start, next);
    start = next;
  }
  RC_ASSERT(line.characters().size() == starts.size());
  RC_ASSERT(!line.has_gap());
  for (std::size_t n = 0; n < starts.size(); ++n)
    RC_ASSERT(std::chrono::abs(line.characters()[n].start - starts[n]) <= UartDriver::kRounding);
}

TEST(UartDriver, ThatIsOnAndSilentIsDrivenInPieces) {
  OnTheLine line(kUart);
  EXPECT_EQ(line.driver().next_time(), kernel::kNever);
  line.driver().enable(true, kernel::kStart);
  line.put(kernel::kStart, kernel::kNever);
  EXPECT_EQ(line.off() - line.on(), kUart.bits(1));
  for (int n = 0; n < 1000; ++n) {
    const Time before = line.off();
    line.put(line.driver().next_time(), kernel::kNever);
    ASSERT_GT(line.off(), before);
    ASSERT_LE(line.off() - before, kUart.half_characters(1) + kernel::kNanosecond);
  }
  // Not into the call of who may switch it off.
  const Time next_call = line.off() + kUart.bits(2);
  line.put(line.off(), next_call);
  EXPECT_EQ(line.off(), next_call);
}

TEST(UartDriver, OneThatGoesOnLaterIsNotDrivenYet) {
  OnTheLine line(kUart);
  line.driver().enable(true, kernel::kStart + kernel::kMillisecond);
  line.put(kernel::kStart, kernel::kNever);
  EXPECT_EQ(line.on(), kernel::kNever);
  EXPECT_FALSE(line.driver().is_driving());
  EXPECT_EQ(line.driver().next_time(), kernel::kStart + kernel::kMillisecond);
}

}  // namespace
}  // namespace fieldproof::line

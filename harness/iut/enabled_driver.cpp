#include "harness/iut/enabled_driver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

constexpr kernel::Duration kRounding = line::UartDriver::kRounding;

using kernel::describe;

}  // namespace

void EnabledDriver::begin(const line::Uart& uart, kernel::Time now) {
  uart_ = uart;
  driver_.begin(uart, now);
  is_on_ = false;
  reported_until_ = now;
}

void EnabledDriver::expect_later(kernel::Time at, std::string_view does) const {
  if (at + kRounding >= reported_until_) return;
  refuse_impossible(
      fmt::format("{} at {}, and has said already what it does on this line until {}; instants of a line "
                  "come in order",
                  does, describe(at), describe(reported_until_)));
}

void EnabledDriver::set(bool is_on, kernel::Time at) {
  const char* const does = is_on ? "switches its driver on" : "switches its driver off";
  attached_.expect_act(at, does);
  if (is_on == is_on_) return;  // as it is already
  if (!is_on && at + kRounding < reported_until_) {
    refuse_impossible(fmt::format("switches its driver off at {}, while it sends until {}", describe(at),
                                  describe(reported_until_)));
  }
  expect_later(at, does);
  if (!is_on && at - on_since_ > kLongestDrive) {
    refuse_impossible(fmt::format("has its driver on from {} to {}, longer than {}", describe(on_since_),
                                  describe(at), describe(kLongestDrive)));
  }
  is_on_ = is_on;
  if (is_on) on_since_ = at;
  reported_until_ = std::max(reported_until_, at);
  driver_.enable(is_on, at);
}

void EnabledDriver::send(kernel::Time start, std::span<const std::uint16_t> characters) {
  const std::size_t count = characters.size();
  if (count > kMostAtOnce) refuse_impossible(fmt::format("sends {} characters at once", count));
  attached_.expect_ahead(start, "sends characters");
  if (!is_on_) {
    refuse_impossible(
        fmt::format("sends characters at {} without its driver, which is off", describe(start)));
  }
  expect_later(start, "sends characters");
  const unsigned bits = uart_.format.data_bits;
  for (const std::uint16_t one : characters) {
    if (one >> bits != 0)
      refuse_impossible(fmt::format("sends the character {:#x}; characters here have {} bits", one, bits));
  }
  const kernel::Time end = start + length_of(count);
  attached_.expect_drive(start, end, [&] {
    return fmt::format("sends {} characters from {} to {}", count, describe(start), describe(end));
  });
  for (std::size_t n = 0; n < count; ++n) driver_.send(start + length_of(n), characters[n]);
  reported_until_ = std::max(reported_until_, end);
}

void EnabledDriver::drive(segment::Port& line, line::Waveform& wave) {
  driver_.put_levels([&line](line::Waveform& one) { line.drive(one); }, wave);
}

void EnabledDriver::put(segment::Port& line, kernel::Time now, kernel::Time next_call) {
  driver_.put([&line](line::Waveform& one) { line.drive(one); }, now, next_call);
  const kernel::Time since = driver_.driving_since();
  if (driver_.is_driving() && driver_.driven_until() - since > kLongestDrive + length_of(1)) {
    refuse_impossible(fmt::format("has its driver on since {}, and it is {}: longer than {}", describe(since),
                                  describe(now), describe(kLongestDrive)));
  }
}

void EnabledDriver::expect_no_hanging_driver() const {
  if (!is_on_ || !driver_.is_driving()) return;
  const kernel::Time idle_since = std::max(on_since_, reported_until_);
  if (driver_.driven_until() - idle_since <= length_of(kIdleAtEnd)) return;
  refuse_impossible(
      fmt::format("has its driver still on at the end of the case, at {}: since {}, and has "
                  "sent nothing since {}",
                  describe(driver_.driven_until()), describe(on_since_), describe(idle_since)));
}

}  // namespace fieldproof::iut

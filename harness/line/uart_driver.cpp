#include "harness/line/uart_driver.hpp"

#include <algorithm>
#include <chrono>

namespace fieldproof::line {
namespace {

constexpr std::int64_t kFiner = 16;        // levels of idle in a bit: the driver comes and goes between bits
constexpr std::int64_t kFinest = 4096;     // at bit rates at which that is needed
constexpr std::size_t kMostIdleBits = 64;  // in the waveform of a character

// A rate is a whole number: two bits of idle end where they should, up to a quarter of a nanosecond.
std::int64_t levels_in_a_bit(std::int64_t bit_rate) {
  return std::clamp<std::int64_t>(4'000'000'000 / bit_rate / bit_rate, kFiner, kFinest);
}

}  // namespace

void UartDriver::begin(const Uart& uart, kernel::Time now) {
  uart_ = uart;
  codec_ = UartCodec(uart);
  acts_.clear();
  is_driving_ = false;
  driven_until_ = now;
}

kernel::Time UartDriver::next_time() const {
  if (!acts_.empty()) return acts_.front().at;
  return is_driving_ ? driven_until_ : kernel::kNever;
}

void UartDriver::put(const Drive& drive, kernel::Time now, kernel::Time next_call) {
  put_acts(drive, now);
  if (is_driving_ && acts_.empty()) put_piece(drive, now, next_call);
}

void UartDriver::put_levels(const Drive& drive, Waveform& wave) {
  // An instant may have been rounded into what was driven before.
  if (wave.start < driven_until_ && driven_until_ - wave.start <= kRounding) wave.start = driven_until_;
  driven_until_ = wave.end();
  drive(wave);
}

// A driver that goes on later may still be followed by what comes until then.
void UartDriver::put_acts(const Drive& drive, kernel::Time now) {
  while (!acts_.empty()) {
    const Act act = acts_.front();
    if (act.kind == Kind::on) {
      if (acts_.size() == 1 && act.at > now) return;
      is_driving_ = true;
      driven_until_ = std::max(driven_until_, act.at);
      driving_since_ = driven_until_;
    } else if (act.kind == Kind::off) {
      put_idle(drive, act.at);
      is_driving_ = false;
    } else {
      put_character(drive);
    }
    acts_.pop_front();
  }
}

std::size_t UartDriver::idle_bits(kernel::Time from, kernel::Time to) const {
  if (to <= from) return 0;
  const kernel::Duration half = kernel::levels_duration(1, 2 * uart_.bit_rate);
  const auto count = kernel::levels_within(to - from + half, uart_.bit_rate);
  const kernel::Duration off = kernel::level_time(from, count, uart_.bit_rate) - to;
  const bool is_whole =
      std::chrono::abs(off) <= kRounding && count <= static_cast<std::int64_t>(kMostIdleBits);
  return is_whole ? static_cast<std::size_t>(count) : 0;
}

// The character at the front.
void UartDriver::put_character(const Drive& drive) {
  const Act& act = acts_.front();
  const std::size_t before = idle_bits(driven_until_, act.at);
  if (before == 0) put_idle(drive, act.at);
  const std::size_t levels_per_bit = uart_.levels_per_bit();
  wave_.levels.clear();
  wave_.rate = uart_.bit_rate * static_cast<std::int64_t>(levels_per_bit);
  // A gap that is too short to be driven is none; one by rounding stays as it came.
  const kernel::Duration gap = act.at - driven_until_;
  const bool follows = before > 0 || (gap > kRounding && gap <= least_idle());
  wave_.start = follows ? driven_until_ : std::max(driven_until_, act.at);
  wave_.levels.append_idle(before * levels_per_bit);
  codec_.append_character(wave_.levels, act.data);
  const bool is_last = acts_.size() > 1 && acts_[1].kind == Kind::off;
  if (is_last) wave_.levels.append_idle(idle_bits(wave_.end(), acts_[1].at) * levels_per_bit);
  driven_until_ = wave_.end();
  drive(wave_);
}

kernel::Duration UartDriver::least_idle() const {
  return std::max(kRounding, kernel::levels_duration(1, 4 * kFiner * uart_.bit_rate));
}

void UartDriver::put_idle(const Drive& drive, std::int64_t levels, std::int64_t rate) {
  wave_.start = driven_until_;
  wave_.rate = rate;
  wave_.levels.clear();
  wave_.levels.append_idle(static_cast<std::size_t>(levels));
  driven_until_ = wave_.end();
  drive(wave_);
}

// The driver on and nothing sent, up to the nanosecond: levels of the line's rate up to the last bits, then
// some of a rate that ends there.
void UartDriver::put_idle(const Drive& drive, kernel::Time to) {
  if (to - driven_until_ <= least_idle()) return;
  const std::size_t bits = idle_bits(driven_until_, to);
  if (bits > 0) {
    put_idle(drive, static_cast<std::int64_t>(bits), uart_.bit_rate);
  } else {
    const auto far = kernel::levels_within(to - driven_until_, uart_.bit_rate) - 1;
    if (far > 0) put_idle(drive, far, uart_.bit_rate);
    const kernel::Duration rest = to - driven_until_;
    const std::int64_t rate = levels_in_a_bit(uart_.bit_rate) * uart_.bit_rate;
    const auto count = std::max<std::int64_t>(1, kernel::levels_within(rest, rate));
    put_idle(drive, count, (count * kernel::kSecond.count() + rest.count() / 2) / rest.count());
  }
  driven_until_ = std::max(to, driven_until_);
}

// The longer it has been on, the longer the pieces: a driver that hangs costs little.
void UartDriver::put_piece(const Drive& drive, kernel::Time now, kernel::Time next_call) {
  if (driven_until_ > now) return;
  // Who says each character as the one before has left may have rounded its instant: there is no room for
  // idle.
  if (next_call > now && next_call - driven_until_ <= kRounding) {
    driven_until_ = next_call;
    return;
  }
  const kernel::Duration longest =
      std::clamp((driven_until_ - driving_since_) / 8, uart_.bits(1), uart_.half_characters(1));
  if (next_call <= now) return;
  const kernel::Duration shortest = least_idle() + kernel::kPicosecond;
  // What would be left of the way to the next call has to be a piece as well, or none: what is said then
  // begins when it says so.
  const kernel::Time end = driven_until_ + longest;
  const kernel::Time to = next_call - end <= shortest ? next_call : end;
  put_idle(drive, std::max(driven_until_ + shortest, to));
}

}  // namespace fieldproof::line

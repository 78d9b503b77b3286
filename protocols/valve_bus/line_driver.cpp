#include "protocols/valve_bus/line_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::int64_t kFiner = 16;        // levels of idle in a bit: the driver comes and goes between bits
constexpr std::size_t kMostIdleBits = 64;  // in the waveform of a character
constexpr kernel::Duration kRounding = kernel::kNanosecond;

using kernel::describe;

}  // namespace

void LineDriver::begin(const Rules& rules, kernel::Time now) {
  rules_ = rules;
  codec_ = CharacterCodec(rules);
  acts_.clear();
  is_on_ = is_driving_ = false;
  said_until_ = driven_until_ = now;
}

// ---- what the implementation says ----

void LineDriver::expect_later(kernel::Time at, std::string_view does) const {
  if (at + kRounding >= said_until_) return;
  iut::refuse_impossible(
      fmt::format("{} at {}, and has said already what it does on this line until {}; instants of a line "
                  "come in order",
                  does, describe(at), describe(said_until_)));
}

void LineDriver::set(bool is_on, kernel::Time at) {
  const char* const does = is_on ? "switches its driver on" : "switches its driver off";
  attached_.expect_act(at, does);
  if (is_on == is_on_) return;  // as it is already
  if (!is_on && at + kRounding < said_until_) {
    iut::refuse_impossible(fmt::format("switches its driver off at {}, while it sends until {}", describe(at),
                                       describe(said_until_)));
  }
  expect_later(at, does);
  if (!is_on && at - on_since_ > iut::kLongestDrive) {
    iut::refuse_impossible(fmt::format("has its driver on from {} to {}, longer than {}", describe(on_since_),
                                       describe(at), describe(iut::kLongestDrive)));
  }
  is_on_ = is_on;
  if (is_on) on_since_ = at;
  said_until_ = std::max(said_until_, at);
  acts_.push_back({is_on ? Kind::on : Kind::off, at, 0});
}

void LineDriver::send(kernel::Time start, std::span<const std::uint16_t> characters) {
  const std::size_t count = characters.size();
  if (count > kMostAtOnce) iut::refuse_impossible(fmt::format("sends {} characters at once", count));
  attached_.expect_ahead(start, "sends characters");
  if (!is_on_) {
    iut::refuse_impossible(
        fmt::format("sends characters at {} without its driver, which is off", describe(start)));
  }
  expect_later(start, "sends characters");
  const unsigned bits = character_format(rules_).data_bits;
  for (const std::uint16_t one : characters) {
    if (one >> bits != 0)
      iut::refuse_impossible(
          fmt::format("sends the character {:#x}; characters here have {} bits", one, bits));
  }
  const kernel::Time end = start + length_of(count);
  attached_.expect_drive(start, end, [&] {
    return fmt::format("sends {} characters from {} to {}", count, describe(start), describe(end));
  });
  for (std::size_t n = 0; n < count; ++n)
    acts_.push_back({Kind::character, start + length_of(n), characters[n]});
  said_until_ = std::max(said_until_, end);
}

void LineDriver::drive(segment::Port& line, line::Waveform& wave) {
  wave.start = behind_the_last(wave.start);
  driven_until_ = wave.end();
  line.drive(wave);
}

// ---- what is on the line ----

kernel::Time LineDriver::behind_the_last(kernel::Time at) const {
  return at < driven_until_ && driven_until_ - at <= kRounding ? driven_until_ : at;
}

kernel::Time LineDriver::next_time() const {
  if (!acts_.empty()) return acts_.front().at;
  return is_driving_ ? driven_until_ : kernel::kNever;
}

void LineDriver::put(segment::Port& line, kernel::Time now, kernel::Time next_call) {
  put_acts(line, now);
  if (is_driving_ && acts_.empty()) put_piece(line, now, next_call);
  if (is_driving_ && driven_until_ - driving_since_ > iut::kLongestDrive + length_of(1)) {
    iut::refuse_impossible(fmt::format("has its driver on since {}, and it is {}: longer than {}",
                                       describe(driving_since_), describe(now),
                                       describe(iut::kLongestDrive)));
  }
}

// A driver that goes on later may still be followed by what is said until then.
void LineDriver::put_acts(segment::Port& line, kernel::Time now) {
  while (!acts_.empty()) {
    const Act act = acts_.front();
    if (act.kind == Kind::on) {
      if (acts_.size() == 1 && act.at > now) return;
      is_driving_ = true;
      driven_until_ = act.at > driven_until_ ? act.at : driven_until_;
      driving_since_ = driven_until_;
    } else if (act.kind == Kind::off) {
      put_idle(line, act.at);
      is_driving_ = false;
    } else {
      put_character(line);
    }
    acts_.pop_front();
  }
}

std::size_t LineDriver::idle_bits(kernel::Time from, kernel::Time to) const {
  if (to <= from) return 0;
  const kernel::Duration half = kernel::levels_duration(1, 2 * rules_.bit_rate);
  const auto count = kernel::levels_within(to - from + half, rules_.bit_rate);
  const kernel::Duration off = kernel::level_time(from, count, rules_.bit_rate) - to;
  const bool is_whole =
      std::chrono::abs(off) <= kRounding && count <= static_cast<std::int64_t>(kMostIdleBits);
  return is_whole ? static_cast<std::size_t>(count) : 0;
}

// The character at the front.
void LineDriver::put_character(segment::Port& line) {
  const Act& act = acts_.front();
  const std::size_t before = idle_bits(driven_until_, act.at);
  if (before == 0) put_idle(line, act.at);
  wave_.levels.clear();
  wave_.rate = rules_.bit_rate;
  // A gap that is too short to be driven is none; one by rounding stays as it was said.
  const kernel::Duration gap = act.at - driven_until_;
  const bool follows = before > 0 || (gap > kRounding && gap <= least_idle());
  wave_.start = follows ? driven_until_ : std::max(driven_until_, act.at);
  wave_.levels.append_idle(before);
  codec_.append_character(wave_.levels, act.data);
  const bool is_last = acts_.size() > 1 && acts_[1].kind == Kind::off;
  if (is_last) wave_.levels.append_idle(idle_bits(wave_.end(), acts_[1].at));
  driven_until_ = wave_.end();
  line.drive(wave_);
}

kernel::Duration LineDriver::least_idle() const {
  return std::max(kRounding, kernel::levels_duration(1, 4 * kFiner * rules_.bit_rate));
}

void LineDriver::put_idle(segment::Port& line, std::int64_t levels, std::int64_t rate) {
  wave_.start = driven_until_;
  wave_.rate = rate;
  wave_.levels.clear();
  wave_.levels.append_idle(static_cast<std::size_t>(levels));
  driven_until_ = wave_.end();
  line.drive(wave_);
}

// The driver on and nothing sent, up to the nanosecond: levels of the line's rate while that is far, then
// some of a rate that ends there.
void LineDriver::put_idle(segment::Port& line, kernel::Time to) {
  if (to - driven_until_ <= least_idle()) return;
  const std::size_t bits = idle_bits(driven_until_, to);
  if (bits > 0) {
    put_idle(line, static_cast<std::int64_t>(bits), rules_.bit_rate);
  } else {
    const auto far = kernel::levels_within(to - driven_until_, rules_.bit_rate) - 1;
    if (far >= static_cast<std::int64_t>(kMostIdleBits)) put_idle(line, far, rules_.bit_rate);
    const kernel::Duration rest = to - driven_until_;
    const auto count = std::max<std::int64_t>(1, kernel::levels_within(rest, kFiner * rules_.bit_rate));
    put_idle(line, count, (count * kernel::kSecond.count() + rest.count() / 2) / rest.count());
  }
  driven_until_ = std::max(to, driven_until_);
}

// The longer it has been on, the longer the pieces: a driver that hangs costs little.
void LineDriver::put_piece(segment::Port& line, kernel::Time now, kernel::Time next_call) {
  if (driven_until_ > now) return;
  const kernel::Duration bit = kernel::levels_duration(1, rules_.bit_rate);
  const kernel::Duration half_character = half_characters(rules_, 1);
  const kernel::Duration longest = std::clamp((driven_until_ - driving_since_) / 8, bit, half_character);
  if (next_call <= now) return;
  const kernel::Time least = driven_until_ + least_idle() + kernel::kPicosecond;
  put_idle(line, std::max(least, std::min(next_call, driven_until_ + longest)));
}

void LineDriver::expect_no_hanging_driver() const {
  if (!is_on_ || !is_driving_) return;
  const kernel::Time idle_since = std::max(on_since_, said_until_);
  if (driven_until_ - idle_since <= length_of(kIdleAtEnd)) return;
  iut::refuse_impossible(
      fmt::format("has its driver still on at the end of the case, at {}: since {}, and has "
                  "sent nothing since {}",
                  describe(driven_until_), describe(on_since_), describe(idle_since)));
}

}  // namespace fieldproof::valve_bus

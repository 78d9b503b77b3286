#include "harness/iut/attached_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/limits.hpp"
#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

constexpr kernel::Duration kFarthestAhead = 3600 * kernel::kSecond;
constexpr std::int64_t kMostLines = 3;         // that an implementation drives at a time: those of a slave
constexpr std::int64_t kMostActs = 3'000'000;  // of a case, beside one for each microsecond
constexpr std::int64_t kMostLevels = 100'000'000;  // the same, beside one for each nanosecond
// Who asks for kMostActions calls within this stands still: they are a nanosecond apart on average.
constexpr kernel::Duration kStandstill = kMostActions * kernel::kNanosecond;

}  // namespace

void refuse_impossible(const std::string& sentence) {
  throw Misbehaviour(reasons::kImpossible, "the implementation " + sentence);
}

void Bench::set_driver(unsigned port, bool is_on, kernel::Time) {
  refuse_impossible(fmt::format("switches the driver of port {} {}; that port has none to be switched", port,
                                is_on ? "on" : "off"));
}

std::int64_t setting(const CaseBegin& begin, std::string_view name, std::int64_t absent) {
  const auto found = std::ranges::find(begin.settings, name, [](const auto& one) { return one.first; });
  return found == begin.settings.end() ? absent : found->second;
}

AttachedCase::~AttachedCase() {
  try {
    end();
  } catch (const kernel::Error&) {
    // The case has ended before, with a verdict; the next one begins with a new implementation.
  }
}

void AttachedCase::begin(const CaseBegin& begin, Bench& bench) {
  call(kernel::kStart, [&](Device& device) {
    if (device.begin(begin, bench)) return;
    throw Misbehaviour(reasons::kUnsupported, "the implementation answers 'unsupported' to this case");
  });
  has_begun_ = true;
}

void AttachedCase::set_power(bool is_on, kernel::Time now) {
  // At a real line, what happened before the switch is only known within this call.
  is_supplied_ = is_on || (is_supplied_ && capabilities().is_wall_clock);
  for (auto& [kind, last] : last_) last = now;
  call(now, [&](Device& device) { device.set_power(is_on, now); });
  is_supplied_ = is_on;
}

void AttachedCase::on_time(kernel::Time now) {
  call(now, [&](Device& device) { tell_time(device, now); });
}

void AttachedCase::tell_time(Device& device, kernel::Time now) {
  if (++calls_ > kMostActions) {
    expect_time_to_pass();
    counted_from_ = now_;
    calls_ = 0;
  }
  device.on_time(now);
}

void AttachedCase::expect_time_to_pass() const {
  if (now_ - counted_from_ >= kStandstill) return;
  throw Misbehaviour(reasons::kFloods,
                     fmt::format("the implementation has asked for {} calls since {}, and it is {}; its next "
                                 "time must lie after the one that has come",
                                 kMostActions, kernel::describe(counted_from_), kernel::describe(now_)));
}

kernel::Time AttachedCase::next_time() const {
  return is_well_ ? attachment_.device->next_time() : kernel::kNever;
}

void AttachedCase::end() {
  if (!is_well_ || has_ended_ || !has_begun_) return;
  has_ended_ = true;
  call(now_, [](Device& device) { device.end(); });
  if (attachment_.on_well_ended) attachment_.on_well_ended();
}

// ---- what the implementation does ----

void AttachedCase::expect_supplied() const {
  if (!has_begun_) refuse_impossible("acts while the case begins; it has no supply yet");
  if (!is_supplied_) refuse_impossible("acts without supply");
}

bool AttachedCase::is_within_reach(kernel::Time when) const {
  return when <= now_ + kFarthestAhead;
}

void AttachedCase::expect_ahead(kernel::Time when, std::string_view does) const {
  expect_supplied();
  if (now_ <= when && is_within_reach(when)) return;
  refuse_impossible(
      fmt::format("{} at {} when it is {}", does, kernel::describe(when), kernel::describe(now_)));
}

// What is kept of a case grows by each of them.
void AttachedCase::count_act() {
  if (++acts_ <= kMostActs + now_.time_since_epoch() / kernel::kMicrosecond) return;
  throw Misbehaviour(reasons::kFloods,
                     fmt::format("the implementation has driven lines and moved outputs {} times until {}",
                                 acts_, kernel::describe(now_)));
}

void AttachedCase::expect_in_order(kernel::Time when, std::string_view does) {
  expect_ahead(when, does);
  count_act();
  const auto last = last_.try_emplace(std::string(does), kernel::kStart).first;
  if (when < last->second) {
    refuse_impossible(fmt::format("{} at an instant that lies before the last one", does));
  }
  last->second = when;
}

void AttachedCase::expect_act(kernel::Time when, std::string_view does) {
  expect_ahead(when, does);
  count_act();
}

void AttachedCase::expect_span(kernel::Time begin, kernel::Time end,
                               const std::function<std::string()>& describe) const {
  // In this order: none of the sums is further than time reaches.
  const bool is_near = now_ <= begin && begin <= end && is_within_reach(end) && end - begin <= kLongestDrive;
  if (!is_near) refuse_impossible(describe());
}

void AttachedCase::expect_drive(kernel::Time begin, kernel::Time end,
                                const std::function<std::string()>& describe) {
  expect_span(begin, end, describe);
  count_act();
  driven_ += end - begin;
  if (driven_ <= kMostLines * now_.time_since_epoch() + kLongestDrive) return;
  refuse_impossible(fmt::format("has driven {} of levels until {}; a line does not carry that",
                                kernel::describe(driven_), kernel::describe(now_)));
}

void AttachedCase::expect_drive(const line::Waveform& wave) {
  expect_supplied();
  if (wave.levels.empty()) refuse_impossible("drives no level at all");
  // No sum of what lies further than time reaches.
  const kernel::Time end = is_within_reach(wave.start) ? wave.end() : wave.start;
  levels_ += static_cast<std::int64_t>(wave.levels.size());
  if (levels_ > kMostLevels + now_.time_since_epoch() / kernel::kNanosecond) {
    throw Misbehaviour(reasons::kFloods, fmt::format("the implementation has driven {} levels until {}",
                                                     levels_, kernel::describe(now_)));
  }
  expect_drive(wave.start, end, [&] {
    return fmt::format("drives from {} to {}", kernel::describe(wave.start), kernel::describe(end));
  });
}

}  // namespace fieldproof::iut

#include "protocols/interbus/telegram_speaker.hpp"

#include <algorithm>

#include "harness/field/settings.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
namespace {

// Between two telegrams of one reception. What is farther apart is told as two: levels cost memory, however
// idle.
constexpr std::int64_t kMostIdleBits = 65'536;

}  // namespace

bool TelegramSpeaker::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  Rules rules;
  field::take_settings(kRulesTable, begin.settings, rules);
  code_ = &line::shared_telegram_code(rules.telegram);
  heard_.rate = rules.bit_rate;
  bench_ = &bench;
  now_ = kernel::kStart;
  pushed_until_.fill(kernel::Time{kernel::Duration::min()});
  return device_->begin(begin, *this);
}

void TelegramSpeaker::set_power(bool is_on, kernel::Time now) {
  now_ = now;
  device_->set_power(is_on, now);
}

void TelegramSpeaker::on_time(kernel::Time now) {
  now_ = now;
  device_->on_time(now);
}

void TelegramSpeaker::receive(unsigned, const line::Waveform&) {
  FIELDPROOF_CHECK(false, "a speaker of telegrams has not asked for levels");
}

// ---- what it hears ----

void TelegramSpeaker::receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) {
  now_ = now;
  if (port >= line_ports_) return device_->receive(port, characters, now);
  heard_.levels.clear();
  for (const iut::Character& telegram : characters) {
    if (!goes_on(telegram)) {
      hand_over(port);
      heard_.start = telegram.start;
    }
    code_->append(heard_.levels, static_cast<std::uint8_t>(telegram.data >> kTelegramHeaderBit & 7),
                  static_cast<std::uint8_t>(telegram.data & 0xFF));
    if (telegram.is_stop_missing) heard_.levels.set(heard_.levels.size() - 1, false);
  }
  hand_over(port);
}

bool TelegramSpeaker::goes_on(const iut::Character& telegram) {
  const kernel::Time end = heard_.end();
  if (heard_.levels.empty() || telegram.start < end) return false;
  const auto idle = kernel::levels_within(telegram.start - end, heard_.rate);
  if (idle > kMostIdleBits) return false;
  for (const std::int64_t count : {idle, idle + 1}) {
    const auto level = static_cast<std::int64_t>(heard_.levels.size()) + count;
    if (kernel::level_time(heard_.start, level, heard_.rate) != telegram.start) continue;
    heard_.levels.append_idle(static_cast<std::size_t>(count));
    return true;
  }
  return false;
}

void TelegramSpeaker::hand_over(unsigned port) {
  if (heard_.levels.empty()) return;
  device_->receive(port, heard_);
  heard_.levels.clear();
}

// ---- what it says ----

// A station that is told a cut telegram late answers as if it had been told in time; so does what follows, as
// soon as it can.
void TelegramSpeaker::transmit(unsigned port, line::Waveform& wave) {
  line::TelegramReceiver receiver(*code_, heard_.rate);
  kernel::Time begin{};
  kernel::Time end{kernel::Duration::min()};
  kernel::Time& pushed_until = pushed_until_.at(port);
  const auto say = [&] {
    if (!said_.empty()) bench_->send(port, begin, said_);
    said_.clear();
  };
  const auto take = [&](const line::Waveform& levels, const line::Telegram& telegram) {
    const kernel::Time meant = levels.time_of(telegram.level);
    const kernel::Time start = std::max({meant, now_, end, pushed_until});
    const iut::Character one = character_of(telegram, start, heard_.rate);
    if (start > meant) pushed_until = one.busy_until;
    if (start != end) say();
    if (said_.empty()) begin = start;
    said_.push_back(one.data);
    end = one.busy_until;
  };
  receiver.receive(wave, take);
  receiver.flush(take);
  say();
  wave.levels.clear();
}

void TelegramSpeaker::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  bench_->write(item, value, std::max(when, now_));
}

std::uint64_t TelegramSpeaker::read(iut::Item item, kernel::Time when) {
  return bench_->read(item, std::max(when, now_));
}

}  // namespace fieldproof::interbus

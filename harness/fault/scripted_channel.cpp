#include "harness/fault/scripted_channel.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::fault {

ScriptedChannel& ScriptedChannel::order(Kind kind, std::size_t first, std::size_t count, std::int64_t value) {
  FIELDPROOF_CHECK(count != kTelegram || code_ != nullptr,
                   "a scripted channel that is asked for telegrams knows their code");
  // What was meant has passed: the next one is meant.
  orders_.push_back({std::max(meant_, passed_), kind, first, count, value});
  return *this;
}

ScriptedChannel& ScriptedChannel::insert(std::size_t at, const line::Levels& levels) {
  const auto stored = static_cast<std::int64_t>(stored_.size());
  stored_.append(levels);
  return order(Kind::insert, at, levels.size(), stored);
}

ScriptedChannel& ScriptedChannel::insert(std::size_t at, std::uint64_t bits, unsigned count) {
  const auto stored = static_cast<std::int64_t>(stored_.size());
  stored_.append(bits, count);
  return order(Kind::insert, at, count, stored);
}

ScriptedChannel& ScriptedChannel::flip_in_telegram(std::size_t k, std::size_t level) {
  return order(Kind::flip_in_telegram, k, kTelegram, static_cast<std::int64_t>(level));
}

ScriptedChannel& ScriptedChannel::delay(kernel::Duration duration) {
  FIELDPROOF_CHECK(duration >= kernel::Duration{}, "nothing arrives before it was sent");
  return order(Kind::delay, 0, 0, duration.count());
}

ScriptedChannel& ScriptedChannel::rate(std::int64_t levels_per_second) {
  FIELDPROOF_CHECK(levels_per_second > 0, "levels have a positive rate");
  return order(Kind::rate, 0, 0, levels_per_second);
}

ScriptedChannel& ScriptedChannel::replace(const line::Levels& levels) {
  const auto stored = static_cast<std::int64_t>(stored_.size());
  stored_.append(levels);
  return order(Kind::replace, 0, levels.size(), stored);
}

void ScriptedChannel::disarm() {
  orders_.clear();
  stored_.clear();
}

bool ScriptedChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  const std::uint64_t number = passed_++;
  const auto is_meant = [&](const Order& order) { return order.transmission == number; };
  if (std::none_of(orders_.begin(), orders_.end(), is_meant)) return false;
  changed_ = sent;
  for (const Order& order : orders_) {
    if (is_meant(order) && order.kind == Kind::replace) change(order);
  }
  find_telegrams(changed_.levels);
  cuts_.clear();
  for (const Order& order : orders_) {
    if (!is_meant(order) || order.kind == Kind::replace) continue;
    if (is_cut(order.kind)) {
      add_cut(order);
    } else {
      change(order);
    }
  }
  write(arrivals);
  std::erase_if(orders_, [&](const Order& order) { return order.transmission <= number; });
  if (orders_.empty()) stored_.clear();
  return true;
}

void ScriptedChannel::change(const Order& order) {
  line::Levels& levels = changed_.levels;
  switch (order.kind) {
    case Kind::flip:
      if (order.first < levels.size()) levels.flip(order.first);
      break;
    case Kind::flip_in_telegram:
      if (order.first < telegrams_.size()) {
        const std::size_t level = telegrams_[order.first].level + static_cast<std::size_t>(order.value);
        if (level < levels.size()) levels.flip(level);
      }
      break;
    case Kind::force_zero:
    case Kind::force_one:
      for (std::size_t n = order.first; n < levels.size() && n - order.first < order.count; ++n) {
        levels.set(n, order.kind == Kind::force_one);
      }
      break;
    case Kind::delay:
      changed_.start += kernel::Duration{order.value};
      break;
    case Kind::rate:
      changed_.rate = order.value;
      break;
    case Kind::replace:
      levels.clear();
      levels.append(stored_, static_cast<std::size_t>(order.value), order.count);
      break;
    case Kind::drop:
    case Kind::remove:
    case Kind::repeat:
    case Kind::insert:
      break;
  }
}

void ScriptedChannel::add_cut(const Order& order) {
  const std::size_t size = changed_.levels.size();
  Cut cut{order.kind, {order.first, order.count}, order.value};
  if (order.count == kTelegram) {
    if (order.first >= telegrams_.size()) return;
    const line::Telegram& telegram = telegrams_[order.first];
    cut.part = {telegram.level, telegram.levels()};
  }
  if (cut.part.first > size) return;
  if (order.kind != Kind::insert) cut.part.count = std::min(cut.part.count, size - cut.part.first);
  const auto behind = std::find_if(cuts_.begin(), cuts_.end(),
                                   [&](const Cut& other) { return other.part.first > cut.part.first; });
  cuts_.insert(behind, cut);
}

void ScriptedChannel::write(line::Waveforms& arrivals) {
  ArrivalWriter writer(changed_, arrivals);
  std::size_t written = 0;
  for (const Cut& cut : cuts_) {
    if (cut.part.first < written) continue;
    writer.write({written, cut.part.first - written});
    written = cut.kind == Kind::insert ? cut.part.first : cut.part.end();
    const auto length = static_cast<std::int64_t>(cut.part.count);
    if (cut.kind == Kind::repeat) {
      writer.write(cut.part);
      writer.shift(length);
      writer.write(cut.part);
    } else if (cut.kind == Kind::insert) {
      writer.write(stored_, {static_cast<std::size_t>(cut.stored), cut.part.count}, cut.part.first);
      writer.shift(length);
    } else if (cut.kind == Kind::remove) {
      writer.shift(-length);
    }
  }
  writer.write({written, changed_.levels.size() - written});
  writer.finish();
}

void ScriptedChannel::find_telegrams(const line::Levels& levels) {
  telegrams_.clear();
  const bool is_wanted = std::any_of(orders_.begin(), orders_.end(), [&](const Order& order) {
    return order.transmission < passed_ && order.count == kTelegram;
  });
  if (!is_wanted) return;
  code_->decode(levels, 0, [&](const line::Telegram& telegram) { telegrams_.push_back(telegram); });
}

}  // namespace fieldproof::fault

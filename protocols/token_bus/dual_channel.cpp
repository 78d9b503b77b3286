#include "protocols/token_bus/dual_channel.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::token_bus {
namespace {

// A start delimiter, and a symbol because the clock of a channel may be slow.
constexpr std::int64_t kDelimiterHeld = 9;

}  // namespace

ChannelManager::ChannelManager(const ChannelManagerConfiguration& configuration,
                               std::unique_ptr<ChannelSelection> selection)
    : configuration_(configuration),
      selection_(std::move(selection)),
      sides_{Side(Channel::a, configuration.rules), Side(Channel::b, configuration.rules)} {
  selection_->wire(*this);
}

void ChannelManager::wire(segment::Port& mac, segment::Port& a, segment::Port& b, ChannelListener& listener) {
  indications_.wire(mac);
  side(Channel::a).requests.wire(a);
  side(Channel::b).requests.wire(b);
  listener_ = &listener;
}

void ChannelManager::set_power(bool is_on, kernel::Time now) {
  is_powered_ = is_on;
  now_ = now;
  requests_.clear();
  indications_.clear();
  selection_->reset();
  for (Side& one : sides_) {
    one.input.clear();
    one.requests.clear();
    one.watch.reset();
    one.held.clear();
    one.is_silent = true;
    one.received_until = one.answered_until = now;
  }
  sources_.assign(1, {now, source()});
}

void ChannelManager::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (!is_powered_) return;
  ServiceInput& input = port == kTowardsMac           ? requests_
                        : port == port_of(Channel::a) ? side(Channel::a).input
                                                      : side(Channel::b).input;
  input.add(at_rate(reception, mac_side_rate(configuration_.rules.phy_bit_rate)));
}

// ---- time ----

// By then a next symbol would have begun, however it is rounded.
kernel::Time ChannelManager::silent_at(const Side& side) const {
  if (side.is_silent) return kernel::kNever;
  const kernel::Time at = side.received_until + symbols(1) / 2;
  return side.input.empty() || side.input.front().begin > at ? at : kernel::kNever;
}

void ChannelManager::work_up_to(kernel::Time now) {
  for (;;) {
    const kernel::Time request = requests_.empty() ? kernel::kNever : requests_.front().end;
    kernel::Time first = std::min(request, selection_->next_time());
    for (const Side& one : sides_) {
      first = std::min(first, silent_at(one));
      if (!one.input.empty()) first = std::min(first, one.input.front().end);
    }
    if (first > now || first == kernel::kNever) return;
    if (request == first) {
      follow_request();
      continue;
    }
    bool has_followed = false;
    for (const Channel channel : kChannels) {
      Side& one = side(channel);
      if (silent_at(one) == first) {
        one.is_silent = has_followed = true;
        one.watch.fall_silent(first, *selection_);
      } else if (!one.input.empty() && one.input.front().end == first) {
        has_followed = true;
        follow_channel(channel);
      }
    }
    if (!has_followed) selection_->on_time(first);
    keep_source(first);
  }
}

void ChannelManager::on_time(kernel::Time now) {
  if (!is_powered_) return;
  now_ = now;
  work_up_to(now);
  indicate_up_to(now - symbols(kDelimiterHeld + configuration_.channels.skew_symbols));
  for (Side& one : sides_) one.requests.drive(now);
  indications_.drive(now);
}

// In pieces: what has come is given on when its oldest symbol is almost due.
kernel::Time ChannelManager::next_time() const {
  if (!is_powered_) return kernel::kNever;
  kernel::Time next = selection_->next_time();
  if (!requests_.empty()) next = std::min(next, requests_.end_of_piece(configuration_.delay_symbols - 1));
  const kernel::Duration rest = symbols(indication_delay_symbols(configuration_) - 1);
  for (const Side& one : sides_) {
    if (!one.held.empty()) {
      next = std::min(next, one.held.front().unit.begin + rest);
    } else if (!one.input.empty()) {
      next = std::min(next, one.input.front().begin + rest);
    }
    next = std::min(next, silent_at(one));
  }
  return next;
}

// ---- from the MAC ----

void ChannelManager::follow_request() {
  const ServiceUnit unit = requests_.front();
  const std::uint64_t levels = unit_at(requests_.levels(), requests_.number());
  const MacRequest what = mac_request_at(requests_.levels(), requests_.number());
  requests_.pop();
  const bool is_management = what.command.has_value();
  if (!is_management && what.symbol == MacSymbol::silence) return;
  for (const Channel channel : kChannels) {
    if (!sends_on(channel, is_management)) continue;
    side(channel).requests.append(unit.begin + request_delay(channel), unit.rate, requested(channel, levels),
                                  kUnitLevels);
  }
}

// ---- from the channels ----

void ChannelManager::follow_channel(Channel channel) {
  Side& one = side(channel);
  const ServiceUnit unit = one.input.front();
  const std::uint64_t levels = unit_at(one.input.levels(), one.input.number());
  const MacIndication what = mac_indication_at(one.input.levels(), one.input.number());
  one.input.pop();
  one.received_until = unit.end;
  one.is_silent = what.answer.has_value() || what.symbol == MacSymbol::silence;
  const MacSymbol symbol = what.answer ? MacSymbol::silence : what.symbol;
  one.watch.take(symbol, unit.begin, unit.end, *selection_);
  if (what.answer || symbol != MacSymbol::silence)
    one.held.push_back({unit, levels, what.answer.has_value()});
}

// Not the rest of what has begun on the other channel.
std::optional<Channel> ChannelManager::source() const {
  if (selection_->serving()) return selection_->serving();
  const Channel preferred = selection_->preferred();
  return selection_->is_within_transmission(preferred) ? std::nullopt : std::optional(preferred);
}

void ChannelManager::keep_source(kernel::Time when) {
  if (source() != sources_.back().channel) sources_.push_back({when, source()});
}

// What has been decided since is of what came before.
void ChannelManager::on_selected(Channel channel, kernel::Time) {
  const kernel::Time from = side(channel).watch.start_delimiter();
  while (sources_.size() > 1 && sources_.back().from >= from) sources_.pop_back();
  sources_.push_back({from, channel});
}

void ChannelManager::on_channel_event(const ChannelEvent& event, kernel::Time when) {
  listener_->on_channel_event(event, std::max(when, now_));
}

// ---- to the MAC ----

void ChannelManager::indicate_up_to(kernel::Time begin) {
  for (;;) {
    Side* first = nullptr;
    Channel channel = Channel::a;
    for (const Channel one : kChannels) {
      Side& its = side(one);
      if (its.held.empty() || its.held.front().unit.begin > begin) continue;
      if (first != nullptr && first->held.front().unit.begin <= its.held.front().unit.begin) continue;
      first = &its;
      channel = one;
    }
    if (first == nullptr) return;
    const Held one = first->held.front();
    first->held.pop_front();
    while (sources_.size() > 1 && sources_[1].from <= one.unit.begin) sources_.pop_front();
    indicate(channel, one);
  }
}

bool ChannelManager::has_answer(Channel channel, const ServiceUnit& unit) const {
  const Side& one = side(channel);
  const bool comes =
      !one.held.empty() && one.held.front().is_answer && one.held.front().unit.begin < unit.end;
  return comes || one.answered_until > unit.begin;
}

void ChannelManager::indicate(Channel channel, const Held& one) {
  if (one.is_answer) {
    side(channel).answered_until = one.unit.end;
    if (!gives_answer(channel, has_answer(other_than(channel), one.unit))) return;
  } else if (!gives_symbols(channel, sources_.front().channel)) {
    return;
  }
  indications_.append(one.unit.begin + indication_delay(), one.unit.rate, indicated(one.levels), kUnitLevels);
}

}  // namespace fieldproof::token_bus

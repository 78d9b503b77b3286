#include "protocols/token_bus/translator.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::token_bus {

void Translator::wire(segment::Port& phy, segment::Port& mac) {
  signals_.wire(phy);
  indications_.wire(mac);
}

void Translator::set_power(bool is_on, kernel::Time now) {
  is_powered_ = is_on;
  requests_.clear();
  bits_.clear();
  signals_.clear();
  indications_.clear();
  blocks_.manager->power_on();
  blocks_.transmitter->reset();
  blocks_.receiver->reset();
  blocks_.blanking->reset();
  blocks_.jabber->reset();
  requested_until_ = pair_begin_ = now;
  last_bit_ = {now, now, 1};
  transmissions_.clear();
}

void Translator::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (!is_powered_) return;
  const std::int64_t rate = configuration_.rules.phy_bit_rate;
  if (port == kMacSide) {
    requests_.add(at_rate(reception, mac_side_rate(rate)));
  } else {
    bits_.add(at_rate(reception, phy_side_rate(rate)));
  }
}

// A bit that is left over has its partner in the silence after it. By then a next one would have come,
// however it is rounded.
kernel::Time Translator::half_pair_until() const {
  if (!blocks_.receiver->is_within_pair()) return kernel::kNever;
  return last_bit_.end + (last_bit_.end - last_bit_.begin) * 3 / 2;
}

void Translator::on_time(kernel::Time now) {
  if (!is_powered_) return;
  for (;;) {
    const kernel::Time request = requests_.empty() ? kernel::kNever : requests_.front().end;
    const kernel::Time bit = bits_.empty() ? kernel::kNever : bits_.front().end;
    const kernel::Time half = half_pair_until();
    const kernel::Time first = std::min({request, bit, half});
    if (first > now || first == kernel::kNever) break;
    if (request == first) {
      follow_request();
    } else if (bit == first) {
      follow_phy();
    } else {
      complete_pair();
    }
  }
  signals_.drive(now);
  indications_.drive(now);
}

unsigned Translator::delay_symbols() const {
  return std::min(configuration_.delay_symbols, configuration_.answer_symbols);
}

// One symbol less than the delay: the clock of a side may be a little slow.
kernel::Time Translator::next_time() const {
  if (!is_powered_) return kernel::kNever;
  const std::size_t symbols = delay_symbols() - 1;
  kernel::Time next = half_pair_until();
  if (!requests_.empty()) next = std::min(next, requests_.end_of_piece(symbols));
  if (!bits_.empty()) next = std::min(next, bits_.end_of_piece(2 * symbols));
  return next;
}

// ---- from the MAC ----

void Translator::follow_request() {
  const ServiceUnit unit = requests_.front();
  const MacRequest what = mac_request_at(requests_.levels(), requests_.number());
  requests_.pop();
  // Nothing was requested in between: silence.
  if (unit.begin > requested_until_ + mac_symbols(configuration_.rules, 1) / 2) {
    blocks_.transmitter->reset();
    blocks_.jabber->reset();
  }
  requested_until_ = unit.end;
  if (what.command) {
    manage(unit, *what.command);
  } else {
    request(unit, what.symbol);
  }
}

void Translator::manage(const ServiceUnit& unit, ManagementCommand command) {
  const bool was_looped_back = blocks_.manager->is_looped_back();
  const ManagementAnswer answer = blocks_.manager->take(command, unit.end);
  if (command == ManagementCommand::reset || was_looped_back != blocks_.manager->is_looped_back()) {
    blocks_.receiver->reset();
    blocks_.blanking->reset();
  }
  blocks_.transmitter->reset();
  blocks_.jabber->reset();
  indications_.append(unit.begin + delay(), unit.rate, levels_of(MacIndication{.answer = answer}),
                      kUnitLevels);
}

void Translator::request(const ServiceUnit& unit, MacSymbol symbol) {
  if (blocks_.jabber->is_too_long(symbol, blocks_.manager->may_transmit(), configuration_))
    blocks_.manager->on_jabber();
  const PhyPair pair = blocks_.transmitter->encode(symbol);
  const bool is_on = symbol != MacSymbol::silence;
  if (is_on && blocks_.manager->may_transmit()) {
    const std::uint64_t first = levels_of(PhyCell{pair.first, {}});
    const std::uint64_t second = levels_of(PhyCell{pair.second, {}});
    signals_.append(unit.begin + delay(), 2 * unit.rate, first | second << kUnitLevels, 2 * kUnitLevels);
    note_transmission(unit.begin + delay(), unit.end + delay());
  }
  if (!blocks_.manager->is_looped_back()) return;
  const kernel::Time middle = unit.begin + (unit.end - unit.begin) / 2;
  const LineStatus status{.has_carrier = is_on};
  decode({unit.begin, middle, unit.rate}, pair.first, status);
  decode({middle, unit.end, unit.rate}, pair.second, status);
}

// ---- from the line ----

bool Translator::is_error_masked(kernel::Duration after_own_transmission) const {
  return after_own_transmission >= kernel::Duration{} &&
         after_own_transmission < mac_symbols(configuration_.rules, configuration_.error_mask_symbols);
}

void Translator::note_transmission(kernel::Time begin, kernel::Time end) {
  const kernel::Duration tolerance = mac_symbols(configuration_.rules, 1) / 4;
  if (!transmissions_.empty() && begin < transmissions_.back().end + tolerance) {
    transmissions_.back().end = end;
  } else {
    transmissions_.push_back({begin, end});
  }
}

// Within one it is negative. Without one it is long ago: no test of the transceiver follows.
kernel::Duration Translator::after_own_transmission(kernel::Time at) {
  while (transmissions_.size() > 1 && transmissions_[1].begin <= at) transmissions_.pop_front();
  if (transmissions_.empty() || transmissions_.front().begin > at) return kernel::kSecond;
  return at - transmissions_.front().end;
}

void Translator::follow_phy() {
  const ServiceUnit unit = bits_.front();
  PhyCell cell = phy_cell_at(bits_.levels(), bits_.number());
  bits_.pop();
  const kernel::Duration after = after_own_transmission(unit.begin);
  if (!takes_line(blocks_.manager->is_looped_back(), after < kernel::Duration{})) return;
  if (!works_in_management_mode() && is_management_within(unit.begin, unit.end)) return;
  if (is_error_masked(after)) cell.status.has_signal_error = false;
  decode({unit.begin, unit.end, unit.rate / 2}, cell.symbol, cell.status);
}

void Translator::complete_pair() {
  const kernel::Duration length = last_bit_.end - last_bit_.begin;
  decode({last_bit_.end, last_bit_.end + length, last_bit_.rate}, PhySymbol::idl, {.has_carrier = false});
}

void Translator::decode(const Bit& bit, PhySymbol symbol, LineStatus status) {
  // A transmission that begins later is another one, and so is its phase.
  if (bit.begin > last_bit_.end + (bit.end - bit.begin) / 2) {
    if (blocks_.receiver->is_within_pair()) complete_pair();
    blocks_.receiver->reset();
  }
  if (!blocks_.receiver->is_within_pair()) pair_begin_ = bit.begin;
  last_bit_ = bit;
  if (const auto indicated = blocks_.receiver->take(symbol, status))
    indicate({pair_begin_, bit.end, bit.rate}, *indicated);
}

// A command that has begun and is not over is one, too.
bool Translator::is_management_within(kernel::Time begin, kernel::Time end) const {
  if (blocks_.manager->is_management(begin)) return true;
  return !requests_.empty() && requests_.front().begin < end &&
         mac_request_at(requests_.levels(), requests_.number()).command.has_value();
}

void Translator::indicate(const Bit& pair, MacSymbol symbol) {
  symbol = blocks_.blanking->pass(symbol, pair.begin, pair.end, configuration_.rules);
  const bool is_management = is_management_within(pair.begin, pair.end);
  if (!blocks_.multiplexer->passes_symbols(is_management) || symbol == MacSymbol::silence) return;
  indications_.append(pair.begin + delay(), pair.rate, levels_of(MacIndication{.symbol = symbol}),
                      kUnitLevels);
}

}  // namespace fieldproof::token_bus

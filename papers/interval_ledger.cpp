#include "papers/interval_ledger.hpp"

#include <algorithm>

namespace fieldproof::papers {

using bandwidth::Load;
using bandwidth::Packet;
using bandwidth::Sent;
using bandwidth::WindowRun;
using bandwidth::WindowTraffic;

void IntervalLedger::on_sent(const Sent& sent) {
  if (sent.packet == Packet::periodic) on_periodic(sent);
  if (sent.packet == Packet::non_real_time) on_non_real_time(sent);
  is_real_time_late_ |= sent.node == node_ && sent.begin == end_ && sent.packet == Packet::real_time &&
                        last_ != Packet::real_time && last_ != Packet::none;
  node_ = sent.node;
  end_ = sent.end;
  last_ = sent.packet;
}

void IntervalLedger::on_periodic(const Sent& sent) {
  // Who has begun an interval ends it when it is visited again, and may begin the next one at once.
  if (is_periodic_ && sent.byte.is_of(sent.node)) longest_ = std::max(longest_, sent.begin - begin_);
  if (!is_periodic_ || sent.byte.is_of(sent.node)) begin_ = sent.begin;
  is_periodic_ = true;
  const std::int64_t slot = (sent.generated - kernel::kStart) / slot_;
  if (slot != of_slot_) {
    of_slot_ = slot;

    packets_ = static_cast<std::uint64_t>(
        std::ranges::count_if(others_, [&](const Sent& one) { return one.end > sent.generated; }));
    others_.clear();
  }
  most_ = std::max(most_, packets_);
}

void IntervalLedger::on_non_real_time(const Sent& sent) {
  has_sent_within_ |= sent.byte.is_periodic();
  // The interval has ended with the visit of who has begun it.
  if (is_periodic_) longest_ = std::max(longest_, sent.begin - begin_);
  is_periodic_ = false;
  others_.push_back(sent);
}

IntervalLedger ledger_of(const WindowTraffic& traffic, Load others, std::uint64_t slots, std::uint64_t seed) {
  IntervalLedger ledger(traffic.slot);
  WindowRun run{.seed = seed, .slots = slots, .real_time = others, .non_real_time = others};
  run.on_sent = [&](const Sent& sent) { ledger.on_sent(sent); };
  run_windows(traffic, run);
  return ledger;
}

}  // namespace fieldproof::papers

#include "protocols/token_bus/channel_selection.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::token_bus {

std::string_view text_of(Channel channel) {
  return channel == Channel::a ? "A" : "B";
}

std::string_view text_of(ChannelEventKind kind) {
  constexpr std::array<std::string_view, kChannelEventKinds> kTexts{"no start delimiter", "bad signal",
                                                                    "frame errors", "clean again"};
  return kTexts.at(static_cast<std::size_t>(kind));
}

Carried carried_by(std::span<const Reception> receptions) {
  Carried carried = Carried::clean;
  for (const Reception& one : receptions) {
    if (one.kind == ReceptionKind::fragment || one.kind == ReceptionKind::fcs_error) return Carried::spoiled;
    if (one.kind != ReceptionKind::frame) carried = Carried::neither;
  }
  return carried;
}

void ChannelSelection::reset() {
  states_ = {};
  preferred_ = Channel::a;
  serving_.reset();
  waiting_.reset();
}

// ---- what a channel shows ----

void ChannelSelection::on_start_delimiter(Channel channel, kernel::Time when) {
  settle(when);
  State& own = of(channel);
  State& other = of(other_than(channel));
  // It answers one of the other channel, or is answered.
  if (own.missing_at == kernel::kNever && is_missed_by(other_than(channel), when))
    other.missing_at =
        begins_slot_anew() ? when + missing_after() : std::min(other.missing_at, when + missing_after());
  // What the other channel was selected for comes here later: it is no second one.
  const bool is_late = own.missing_at != kernel::kNever && !waiting_;
  own.missing_at = kernel::kNever;
  if (takes_late_copies() || !is_late) choose(channel, when);
  own.start_delimiter = when;
  if (!own.is_within) own.ended.reset();
  own.is_within = true;
  own.is_bad = false;
}

void ChannelSelection::choose(Channel channel, kernel::Time when) {
  if (serving_ && (serving_ == channel || !is_new_transmission(channel, when))) return;
  if (channel == preferred_) return select(channel, when);
  if (!waiting_) waiting_ = {channel, when};
}

bool ChannelSelection::may_complete(Channel channel, kernel::Time when) const {
  const State& state = of(channel);
  return state.is_within && !state.is_bad &&
         when <= *state.start_delimiter + octets(rules_, rules_.most_octets + 2);
}

// What the serving channel still shows is nothing that could be completed.
bool ChannelSelection::is_new_transmission(Channel channel, kernel::Time when) const {
  return !of(channel).is_within && !may_complete(*serving_, when);
}

void ChannelSelection::on_bad_signal(Channel channel, kernel::Time when) {
  settle(when);
  State& own = of(channel);
  State& other = of(other_than(channel));
  own.is_bad = true;
  if (other.bad_at != kernel::kNever && !is_bad_signal_a_fault(true)) other.bad_at = kernel::kNever;
  const bool is_in_time = other.start_delimiter && when <= *other.start_delimiter + bad_signal_counts_for();
  if (is_in_time && is_bad_signal_a_fault(other.is_bad)) own.bad_at = std::min(own.bad_at, when + skew());
}

void ChannelSelection::on_end(Channel channel, Carried carried, kernel::Time when) {
  settle(when);
  State& own = of(channel);
  if (!own.is_within) return;
  own.is_within = own.is_bad = false;
  own.ended = Ended{carried, *own.start_delimiter};
  if (serving_ == channel) serving_.reset();
  own.clean = clean_after(own.clean, carried);
  if (own.has_fault && own.clean >= channels_.clean_in_a_row) {
    own.has_fault = false;
    user_->on_channel_event(reported({ChannelEventKind::clean, channel}), when);
  }
  compare(when);
}

unsigned ChannelSelection::clean_after(unsigned clean, Carried carried) const {
  return carried == Carried::clean ? clean + 1 : carried == Carried::spoiled ? 0 : clean;
}

// Once both have carried the same transmission. One that the other channel did not carry has no other.
void ChannelSelection::compare(kernel::Time when) {
  auto& [a, b] = states_;
  if (!a.ended || !b.ended) return;
  State& earlier = a.ended->start_delimiter <= b.ended->start_delimiter ? a : b;
  const State& later = &earlier == &a ? b : a;
  const bool is_same = later.ended->start_delimiter <= earlier.ended->start_delimiter + slot();
  if (!is_same) return earlier.ended.reset();
  const std::array carried{a.ended->carried, b.ended->carried};
  for (State& one : states_) one.ended.reset();
  for (const Channel channel : kChannels) {
    State& own = of(channel);
    own.errors = errors_after(own.errors, carried[static_cast<std::size_t>(channel)],
                              carried[static_cast<std::size_t>(other_than(channel))]);
    if (own.errors >= channels_.errors_in_a_row) find_fault(channel, ChannelEventKind::frame_errors, when);
  }
}

unsigned ChannelSelection::errors_after(unsigned errors, Carried carried, Carried other) const {
  if (carried == Carried::clean) return 0;
  return carried == Carried::spoiled && other == Carried::clean ? errors + 1 : errors;
}

// ---- what time brings ----

kernel::Time ChannelSelection::selected_at() const {
  return waiting_ ? waiting_->start_delimiter + waits_for_preferred() : kernel::kNever;
}

kernel::Time ChannelSelection::next_time() const {
  kernel::Time next = selected_at();
  for (const State& one : states_) next = std::min({next, one.missing_at, one.bad_at});
  return next;
}

// Only what was due before: what is shown at the very instant still counts.
void ChannelSelection::settle(kernel::Time until) {
  for (kernel::Time next = next_time(); next < until; next = next_time()) settle_at(next);
}

void ChannelSelection::on_time(kernel::Time now) {
  settle(now);
  if (next_time() == now) settle_at(now);
}

void ChannelSelection::settle_at(kernel::Time at) {
  if (selected_at() <= at) {
    const Channel channel = waiting_->channel;
    select(channel, waiting_->start_delimiter);
    if (!of(channel).is_within && !keeps_an_abort()) serving_.reset();  // it has ended meanwhile
  }
  for (const Channel channel : kChannels) {
    State& own = of(channel);
    if (own.bad_at <= at) {
      own.bad_at = kernel::kNever;
      find_fault(channel, ChannelEventKind::bad_signal, at);
    }
    if (own.missing_at <= at) {
      own.missing_at = kernel::kNever;
      find_fault(channel, ChannelEventKind::no_start_delimiter, at);
    }
  }
}

void ChannelSelection::select(Channel channel, kernel::Time start_delimiter) {
  waiting_.reset();
  serving_ = channel;
  preferred_ = preferred_after_selection(channel);
  FIELDPROOF_CHECK(user_ != nullptr, "who chooses has somebody to tell");
  user_->on_selected(channel, start_delimiter);
}

void ChannelSelection::find_fault(Channel channel, ChannelEventKind kind, kernel::Time when) {
  State& own = of(channel);
  own.clean = own.errors = 0;
  const bool is_new = is_reported(channel, own.has_fault);
  if (preferred_ == channel && is_left_for(kind)) preferred_ = other_than(channel);
  own.has_fault = true;
  if (is_new) user_->on_channel_event(reported({kind, channel}), when);
}

}  // namespace fieldproof::token_bus

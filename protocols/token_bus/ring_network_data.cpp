#include <algorithm>
#include <utility>

#include "protocols/token_bus/ring_network.hpp"

// What the applications of a ring do, and what its lower tester sees on the line.
namespace fieldproof::token_bus {
namespace {

// Rounds of the token after which a datum that was not sent is missing.
constexpr std::int64_t kRoundsWaited = 2;
// The first kind of cycle.
constexpr std::size_t kRotation = 0;

}  // namespace

using kernel::Duration;
using kernel::Time;

RingNetwork::Seat& RingNetwork::seat_of(Address address) {
  return *std::ranges::find(seats_, address, &Seat::address);
}

// One datum at a time: what waits for a token goes first.
void RingNetwork::give(std::size_t signal, Time now) {
  RingFlow& flow = flows_[signal];
  if (!flow.may_give() || words_.is_called(signal)) return;
  const auto datum = flow.next_datum(words_.sample(signal, now));
  const RingData& data = flow.data();
  Seat& seat = seat_of(data.from);
  const bool is_taken = seat.device->submit({.action = action_of(data.service),
                                             .priority = priority_of(data.service),
                                             .destination = data.to,
                                             .data = octets_of(*datum, data.octets)},
                                            now);
  segment_.refresh(seat.number);
  if (!is_taken) return flow.on_done();
  deliveries_.give(*datum);
  words_.call(signal, now, now + kRoundsWaited * bounds_.rotation);
}

void RingNetwork::on_wave(const line::Waveform& wave) {
  for (const Reception& one : tester_.read(wave)) {
    const auto frame =
        one.kind == ReceptionKind::frame ? frame_of(one.octets, description_.rules) : std::nullopt;
    if (!frame) continue;
    if (frame->kind == FrameKind::token) on_token(frame->destination, wave.start, wave.end());
    if (frame->kind == FrameKind::data) on_datum(*frame, wave.start, wave.end());
    if (frame->kind == FrameKind::claim_token && came_up_at_) ++claims_;
  }
}

void RingNetwork::on_token(Address destination, Time begin, Time end) {
  last_token_at_ = begin;
  // A token that is repeated begins no other round.
  const bool is_next = std::exchange(last_token_, destination) != destination;
  if (is_next && destination == description_.stations.front()) begin_round(begin);
  if (!is_next && came_up_at_) ++repeated_tokens_;
  const auto seat = std::ranges::find(seats_, destination, &Seat::address);
  if (seat == seats_.end()) return;
  if (seat->turnaround) seat->turnaround->ask(end);
  const bool is_first = !std::exchange(seat->has_had_token, true);
  for (std::size_t n = 0; n < flows_.size(); ++n) {
    RingFlow& flow = flows_[n];
    if (flow.data().from != destination) continue;
    if (is_first) flow.begin(begin);
    if (words_.is_called(n) && words_.is_sent(n) && flow.data().is_under_each_token()) close(n, begin);
    if (words_.is_called(n)) {
      // What is due under each token has missed one.
      const bool is_retry = !is_next || flow.data().is_under_each_token();
      if (is_retry && !words_.is_sent(n)) words_.call_again(n, begin);
    } else if (flow.given()) {
      words_.call(n, begin, begin + kRoundsWaited * bounds_.rotation);
    } else if (flow.data().is_under_each_token()) {
      flow.request(begin);
      give(n, begin);
    }
  }
  set_wake();
}

void RingNetwork::begin_round(Time now) {
  words_.begin_cycle(kRotation, now);
  const auto before = std::exchange(last_round_at_, now);
  if (!before || !came_up_at_) return;
  const auto is_within = [&](Duration instant) {
    return *before <= *came_up_at_ + instant && *came_up_at_ + instant < now;
  };
  for (const RingCut& cut : description_.cuts) {
    if (!is_within(cut.at) && !is_within(cut.at + cut.lasts)) continue;
    words_.end_delay(cut_kind_, *before, now);
    return;
  }
}

void RingNetwork::begin_cuts(std::optional<Time> from) {
  came_up_at_ = from;
  if (!from) last_round_at_.reset();
  for (RingLine& line : lines_) line.begin_cuts(from);
}

void RingNetwork::on_datum(const Frame& frame, Time begin, Time end) {
  const auto datum = datum_of(frame.data);
  if (!datum || datum->flow >= flows_.size()) return;
  const std::size_t signal = datum->flow;
  RingFlow& flow = flows_[signal];
  const RingData& data = flow.data();
  if (frame.source != data.from || !flow.given() || flow.given()->datum != *datum) return;
  if (const auto requested = flow.on_sent(*datum)) {
    words_.end_delay(delay_kinds_[static_cast<std::size_t>(data.service)], *requested, end);
  } else if (words_.is_called(signal)) {
    words_.call_again(signal, begin);
  }
  Duration due = slots(description_.rules, 1);
  if (data.service == RingService::confirmed) {
    seat_of(data.from).asks = signal;
    due += slots(description_.rules, description_.rules.response_wait_slots) +
           frame_time(description_.rules, kResponseOctets);
  } else {
    flow.on_done();
  }
  words_.on_sent(signal, end + due);
  set_wake();
}

void RingNetwork::on_data(Address at, const Frame& frame, Time when) {
  if (frame.action == Action::response) return on_response(seat_of(at), frame, when);
  const auto datum = datum_of(frame.data);
  if (!datum || datum->flow >= flows_.size()) return count(Delivery::wrong);
  const RingData& data = flows_[datum->flow].data();
  const bool is_its = data.to == at && data.from == frame.source && data.octets == frame.data.size();
  const Delivery delivery = is_its ? deliveries_.get(*datum) : Delivery::wrong;
  const bool is_repetition = data.service == RingService::confirmed && delivery == Delivery::twice;
  if (is_repetition) return;
  count(delivery);
  if (delivery != Delivery::first) return;
  words_.on_got(datum->flow, datum->word, when);
  if (!came_up_at_ && words_.has_all_arrived()) begin_cuts(when);
}

void RingNetwork::on_response(Seat& seat, const Frame& frame, Time when) {
  if (!seat.asks || flows_[*seat.asks].data().to != frame.source) return;
  if (frame.data != response_of(frame.source)) return count(Delivery::wrong);
  close(*std::exchange(seat.asks, std::nullopt), when);
}

void RingNetwork::on_event(Address at, const Event& event, Time when) {
  Seat& seat = seat_of(at);
  const bool is_about_it =
      event.kind == EventKind::response_missing && seat.asks && flows_[*seat.asks].data().to == event.address;
  if (is_about_it) close(*std::exchange(seat.asks, std::nullopt), when);
}

// Nothing more comes of what was sent; the next one may go.
void RingNetwork::close(std::size_t signal, Time now) {
  if (words_.is_called(signal)) words_.close(signal, now);
  after_close(signal, now);
}

void RingNetwork::after_close(std::size_t signal, Time now) {
  RingFlow& flow = flows_[signal];
  if (flow.given() && flow.given()->is_sent) flow.on_done();
  give(signal, now);
  set_wake();
}

void RingNetwork::set_wake() {
  wakes_at_ = words_.next_close();
  for (const RingFlow& flow : flows_) wakes_at_ = std::min(wakes_at_, flow.next_request());
  if (has_tester_) segment_.refresh(tester_number_);
}

void RingNetwork::on_time(Time now) {
  words_.close_due(now, [&](std::size_t signal) { after_close(signal, now); });
  for (std::size_t n = 0; n < flows_.size(); ++n) {
    flows_[n].take_due(now);
    give(n, now);
  }
  set_wake();
}

}  // namespace fieldproof::token_bus

#include "protocols/token_bus/token_station.hpp"

// How the station listens, joins, and claims a token that nobody has.
namespace fieldproof::token_bus {

// ---- listening ----

void TokenStation::on_idle_frame(const Frame& frame, kernel::Time end) {
  switch (frame.kind) {
    case FrameKind::token:
      if (frame.destination == address()) take_token(frame.source, end);
      break;
    case FrameKind::solicit_successor_1:
    case FrameKind::solicit_successor_2:
      on_solicitation(frame, end);
      break;
    case FrameKind::who_follows:
      if (follows(frame)) {
        contest_pass_ = 0;
        answer(frame.source, end);
      }
      break;
    case FrameKind::set_successor:
      if (frame.destination == address()) set_successor(address_of(frame.data), end);
      break;
    case FrameKind::data:
    case FrameKind::management_data:
      if (is_for_me(frame)) on_indication(frame, end);
      break;
    case FrameKind::claim_token:
    case FrameKind::resolve_contention:
      break;
  }
}

void TokenStation::on_demand_frame(const Frame& frame, kernel::Time end) {
  if (state_ == AccessState::demand_in && frame.kind == FrameKind::resolve_contention &&
      resolves(contest_pass_)) {
    demanded_of_ = frame.source;
    const unsigned delay = demand_slots(demand_bits(contest_pass_++));
    enter(AccessState::demand_delay, end + slots(rules(), delay));
    return;
  }
  go_idle();
  on_idle_frame(frame, end);
}

void TokenStation::on_indication(const Frame& frame, kernel::Time end) {
  user_->on_data(frame, end);
  const bool is_asked = frame.action == Action::request_with_response && frame.destination == address();
  if (!is_asked || !response_ || frame.kind != FrameKind::data) return;
  send(response_to(frame, *response_), end + octets(rules(), rules().response_gap_octets), false);
}

Frame TokenStation::response_to(const Frame& request, const Octets& data) const {
  return {.kind = FrameKind::data,
          .action = Action::response,
          .priority = request.priority,
          .destination = request.source,
          .source = address(),
          .data = data};
}

void TokenStation::set_successor(Address successor, kernel::Time now) {
  if (successor == successor_ || is_group(successor)) return;
  successor_ = successor;
  report(successor == address() ? EventKind::sole_station : EventKind::successor_changed, successor, now);
}

// ---- joining ----

// Below a sender that is the lowest, or between it and its successor, in the first window; above the highest
// in the second. A sender that solicits anybody names itself as its successor.
std::optional<unsigned> TokenStation::window_of(const Frame& solicitation) const {
  const Address sender = solicitation.source;
  const Address successor = solicitation.destination;
  if (solicitation.kind == FrameKind::solicit_successor_1) {
    if (address() < sender && address() > successor) return 0;
    return std::nullopt;
  }
  if (address() < sender) return 0;
  if (address() > successor) return 1;
  return std::nullopt;
}

void TokenStation::on_solicitation(const Frame& frame, kernel::Time end) {
  const auto window = window_of(frame);
  if (!window || !wants_ring()) return;
  contest_pass_ = 0;
  offered_successor_ = frame.destination;
  if (*window == 0) {
    answer(frame.source, end + window_delay(0));
    return;
  }
  // A station of the second window answers when the first one was silent.
  demanded_of_ = frame.source;
  enter(AccessState::demand_delay, end + window_delay(*window));
}

// In a window that begins then. Who else answers in it is not looked at: that is what a contest is for.
void TokenStation::answer(Address destination, kernel::Time window_begin) {
  enter(AccessState::demand_in);
  send(control(FrameKind::set_successor, destination, answered_with()),
       window_begin + octets(rules(), rules().response_gap_octets), false);
}

unsigned TokenStation::contest_bits(unsigned pass) {
  const unsigned pairs = 4 * address_octets(rules());
  if (pass >= pairs) return static_cast<unsigned>(random_.below(4));
  return static_cast<unsigned>(address() >> 2 * (pairs - 1 - pass) & 3U);
}

// ---- claiming ----

void TokenStation::claim(kernel::Time now) {
  contest_pass_ = 0;
  enter(AccessState::claim_token);
  claim_goes_on(now);
}

void TokenStation::claim_goes_on(kernel::Time now) {
  if (contest_pass_ > 0 && loses_claim()) {
    go_idle();
    return;
  }
  if (contest_pass_ == claim_passes()) {
    if (is_alone_after_claim()) successor_ = predecessor_ = address();
    is_in_ring_ = true;
    offered_successor_.reset();
    report(EventKind::sole_station, address(), now);
    hold_token(now);
    return;
  }
  Frame frame = control(FrameKind::claim_token, 0);
  frame.data.resize(std::size_t{claim_slots(claim_bits(contest_pass_++))} * rules().slot_time_octets);
  send(frame, now);
}

}  // namespace fieldproof::token_bus

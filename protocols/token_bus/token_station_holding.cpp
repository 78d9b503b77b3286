#include <algorithm>

#include "protocols/token_bus/token_station.hpp"

// What the station does with the token: four classes of data, and requests that are answered at once.
namespace fieldproof::token_bus {
namespace {

constexpr unsigned kRingMaintenance = 0;  // the place of its rotation timer: class 6 has none

}  // namespace

void TokenStation::take_token(Address from, kernel::Time now) {
  predecessor_ = from;
  if (!is_in_ring_) {
    is_in_ring_ = true;
    successor_ = offered_successor_.value_or(from);
    report(EventKind::joined, from, now);
  }
  offered_successor_.reset();
  hold_token(now);
}

void TokenStation::hold_token(kernel::Time now) {
  on_token_taken(now);
  place_ = 0;
  hold_until_ = now + hold_time(0, now);
  enter(AccessState::use_token);
  serve(now);
}

void TokenStation::reload(unsigned place, kernel::Time now) {
  const std::uint32_t target = place == kRingMaintenance ? rules().ring_maintenance_octets
                                                         : rules().target_rotation_octets.at(place - 1);
  rotation_until_.at(place) = now + octets(rules(), target);
}

// The timer of a class begins anew when its service does, not when the token comes.
kernel::Duration TokenStation::hold_time(unsigned place, kernel::Time now) {
  if (place == 0) return octets(rules(), rules().high_priority_hold_octets);
  const kernel::Duration left = residual(place, now);
  reload(place, now);
  return left;
}

void TokenStation::serve(kernel::Time now) {
  const kernel::Time begin = earliest_begin(now);
  for (;;) {
    if (!queues_.at(place_).empty() && may_begin(place_, begin)) {
      send_request(now);
      return;
    }
    enter(AccessState::check_access_class);
    if (++place_ == kAccessClasses) break;
    hold_until_ = now + hold_time(place_, now);
    enter(AccessState::use_token);
  }
  pass(now);
}

void TokenStation::send_request(kernel::Time now) {
  const DataRequest request = queues_.at(place_).front();
  const bool is_answered = request.action == Action::request_with_response;
  // It stays in front until it is on the line, one that is answered until it is done: a token that is dropped
  // before costs no data.
  enter(is_answered ? AccessState::await_ifm_response : AccessState::use_token);
  repetitions_ = 0;
  send(data_frame(request), now);
}

Frame TokenStation::data_frame(const DataRequest& request) const {
  return {.kind = FrameKind::data,
          .action = request.action,
          .priority = request.priority,
          .destination = request.destination,
          .source = address(),
          .data = request.data};
}

// Another holds the token, too.
void TokenStation::on_holding_frame(const Frame& frame, kernel::Time end) {
  if (drops_token_on(frame)) drop_token(frame, end);
}

void TokenStation::drop_token(const Frame& frame, kernel::Time end) {
  go_idle();
  report(EventKind::unexpected_frame, frame.source, end);
  if (state_ == AccessState::idle) on_idle_frame(frame, end);
}

void TokenStation::on_response_frame(const Frame& frame, kernel::Time end) {
  const bool is_response =
      frame.kind == FrameKind::data && frame.action == Action::response && frame.destination == address();
  if (!is_response) {
    if (drops_token_on(frame)) return drop_token(frame, end);
    return on_response_missing(end);
  }
  queues_.at(place_).pop_front();
  enter(AccessState::use_token, end);
  user_->on_data(frame, end);
}

void TokenStation::on_response_missing(kernel::Time now) {
  const DataRequest request = queues_.at(place_).front();
  if (repetitions_ < request_repetitions()) {
    ++repetitions_;
    enter(AccessState::await_ifm_response);
    send(data_frame(request), now);
    return;
  }
  queues_.at(place_).pop_front();
  enter(AccessState::use_token, now);
  report(EventKind::response_missing, request.destination, now);
}

}  // namespace fieldproof::token_bus

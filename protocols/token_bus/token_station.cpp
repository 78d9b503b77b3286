#include "protocols/token_bus/token_station.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::token_bus {

std::string_view text_of(EventKind kind) {
  switch (kind) {
    case EventKind::joined:
      return "joined";
    case EventKind::left:
      return "left";
    case EventKind::sole_station:
      return "sole station";
    case EventKind::successor_changed:
      return "successor changed";
    case EventKind::pass_failed:
      return "pass failed";
    case EventKind::unexpected_frame:
      return "unexpected frame";
    case EventKind::response_missing:
      return "response missing";
    case EventKind::duplicate_address:
      return "duplicate address";
    case EventKind::faulty_transmitter:
      return "faulty transmitter";
  }
  return "";
}

std::string_view text_of(AccessState state) {
  constexpr std::array<std::string_view, 11> kNames{"offline",
                                                    "idle",
                                                    "demand_in",
                                                    "demand_delay",
                                                    "claim_token",
                                                    "use_token",
                                                    "await_ifm_response",
                                                    "check_access_class",
                                                    "pass_token",
                                                    "check_token_pass",
                                                    "await_response"};
  return kNames.at(static_cast<std::size_t>(state));
}

TokenStation::TokenStation(const StationConfiguration& configuration)
    : configuration_(configuration),
      line_(configuration.rules),
      random_(kernel::Random(configuration.address).split("token station")),
      is_desired_(configuration.in_ring_desired),
      successor_(configuration.address),
      predecessor_(configuration.address) {}

void TokenStation::wire(segment::Port& line, StationUser& user) {
  line_.wire(line);
  user_ = &user;
}

// ---- the host ----

bool TokenStation::start(kernel::Time now) {
  const bool is_possible = !impossible(rules()) && !is_group(address()) && address() <= broadcast(rules());
  if (!is_possible) return false;
  line_.begin(now);
  if (forgets_ring()) {
    is_in_ring_ = false;
    successor_ = predecessor_ = address();
  }
  is_leaving_ = false;
  offered_successor_.reset();
  failures_ = 0;
  counters_ = {};
  inter_solicit_count_ = rules().max_inter_solicit_count;
  rotation_until_.fill(now);
  if (rules().solicits_at_first) reload(0, now);
  go_idle();
  return true;
}

void TokenStation::stop(kernel::Time) {
  go_offline();
  drop_data();
  response_.reset();
  is_desired_ = configuration_.in_ring_desired;
}

bool TokenStation::submit(const DataRequest& request, kernel::Time) {
  const bool is_request = request.action != Action::response && request.priority <= 7 &&
                          request.data.size() <= most_data(rules()) &&
                          request.destination <= broadcast(rules());
  // Nobody answers for a group.
  const bool is_answered_by_many =
      request.action == Action::request_with_response && is_group(request.destination);
  if (!is_request || is_answered_by_many || state_ == AccessState::offline) return false;
  auto& queue = queues_.at(3 - access_class(request.priority) / 2);
  queue.insert(queue.begin() + static_cast<std::ptrdiff_t>(place_of(request, queue)), request);
  return true;
}

void TokenStation::set_in_ring_desired(bool is_desired, kernel::Time) {
  is_desired_ = is_desired;
}

void TokenStation::set_response(const Octets& data, kernel::Time) {
  response_ = data;
}

bool TokenStation::wants_ring() const {
  return is_desired_ || std::ranges::any_of(queues_, [](const auto& queue) { return !queue.empty(); });
}

// ---- the line ----

void TokenStation::receive(segment::PortIndex, const line::Waveform& reception) {
  if (state_ == AccessState::offline) return;
  const kernel::Time end = reception.end();
  const bool is_of_own_time = line_.is_of_own_time(reception);
  const auto wave = line_.seen(reception);
  if (!wave) return;
  if (is_of_own_time) {
    on_noise(end);
    return;
  }
  bool has_frame = false;
  for (const Reception& one : received(*wave)) {
    if (one.kind != ReceptionKind::frame) {
      count(one.kind);
      continue;
    }
    if (!one.more_follows) line_.blank_from(end);
    const auto frame = understood(one.octets);
    if (!frame) continue;
    has_frame = true;
    on_frame(*frame, end);
    if (state_ == AccessState::offline) return;
  }
  if (!has_frame) on_noise(end);
}

void TokenStation::count(ReceptionKind kind) {
  ++counters_.at(static_cast<std::size_t>(kind) - 1);
}

void TokenStation::on_activity(segment::PortIndex, bool begins, kernel::Time now) {
  if (state_ == AccessState::offline) return;
  line_.on_activity(begins, now);
  if (line_.takes_notice(now)) on_notice(now);
  if (line_.has_ended_unseen()) on_noise(now);
}

kernel::Time TokenStation::next_time() const {
  if (state_ == AccessState::offline) return kernel::kNever;
  return std::min({line_.next_time(), deadline_, pending_due(), idle_due()});
}

void TokenStation::on_time(kernel::Time now) {
  if (state_ == AccessState::offline) return;
  if (line_.takes_notice(now)) on_notice(now);
  if (deadline_ <= now) {
    deadline_ = kernel::kNever;
    on_deadline(now);
  }
  if (idle_due() <= now) claim(now);
  if (pending_due() <= now) send_pending(now);
}

// ---- the machine ----

void TokenStation::enter(AccessState state, kernel::Time deadline) {
  state_ = state;
  deadline_ = deadline;
  pending_.reset();
}

void TokenStation::go_offline() {
  if (forgets_ring()) is_in_ring_ = false;
  enter(AccessState::offline);
}

kernel::Time TokenStation::idle_due() const {
  const kernel::Time since = line_.silent_since();
  const bool waits = state_ == AccessState::idle && !pending_ && wants_ring() && since != kernel::kNever;
  return waits ? since + slots(rules(), bus_idle_slots()) : kernel::kNever;
}

unsigned TokenStation::bus_idle_slots() const {
  return is_in_ring_ && is_lowest() ? rules().lowest_bus_idle_slots : rules().bus_idle_slots;
}

void TokenStation::send(const Frame& frame, kernel::Time earliest, bool waits_for_silence) {
  pending_ = Pending{frame, earliest, waits_for_silence};
}

kernel::Time TokenStation::pending_due() const {
  if (!pending_) return kernel::kNever;
  if (!pending_->waits_for_silence) return begin_of(pending_->frame, pending_->earliest);
  if (line_.is_active()) return kernel::kNever;
  return begin_of(pending_->frame, earliest_begin(pending_->earliest));
}

kernel::Time TokenStation::earliest_begin(kernel::Time now) const {
  const kernel::Time since = line_.silent_since();
  if (since == kernel::kNever) return now;
  return std::max(now, since + octets(rules(), rules().response_gap_octets));
}

void TokenStation::send_pending(kernel::Time now) {
  const Frame frame = std::exchange(pending_, std::nullopt)->frame;
  on_sent(frame.kind, line_.drive(written(frame, now), now));
}

line::Levels TokenStation::written(const Frame& frame, kernel::Time) const {
  return levels_of(frame, rules());
}

Frame TokenStation::control(FrameKind kind, Address destination, std::optional<Address> data) const {
  return {.kind = kind,
          .destination = destination,
          .source = address(),
          .data = data ? octets_of(*data, rules()) : Octets{}};
}

void TokenStation::on_frame(const Frame& frame, kernel::Time end) {
  if (is_duplicate(frame)) {
    go_offline();
    report(EventKind::duplicate_address, frame.source, end);
    return;
  }
  switch (state_) {
    case AccessState::idle:
      return on_idle_frame(frame, end);
    case AccessState::demand_in:
    case AccessState::demand_delay:
      return on_demand_frame(frame, end);
    case AccessState::claim_token:
      go_idle();
      return on_idle_frame(frame, end);
    case AccessState::use_token:
      return on_holding_frame(frame, end);
    case AccessState::await_ifm_response:
      return on_response_frame(frame, end);
    case AccessState::check_token_pass:
      return on_pass_success(frame, end);
    case AccessState::await_response:
      return on_await_frame(frame, end);
    case AccessState::pass_token:
      return drop_token(frame, end);
    case AccessState::offline:
    case AccessState::check_access_class:
      return;
  }
}

// What was received has no frame in it.
void TokenStation::on_noise(kernel::Time end) {
  if (state_ == AccessState::await_ifm_response && !pending_) {
    on_response_missing(end);
  } else if (state_ == AccessState::await_response && !pending_) {
    on_contention(end);
  } else if (state_ == AccessState::check_token_pass && !pending_) {
    switch (noise_after_token()) {
      case NoiseAfterToken::wait_on:
        is_noise_after_token_ = true;
        deadline_ = end + slots(rules(), rules().noise_wait_slots);
        break;
      case NoiseAfterToken::success:
        failures_ = 0;
        go_idle();
        break;
      case NoiseAfterToken::failure:
        next_stage(end);
        break;
    }
  }
}

// Others begin to be on the line.
void TokenStation::on_notice(kernel::Time now) {
  switch (state_) {
    case AccessState::demand_delay:
      if (yields_in_delay()) go_idle();
      break;
    case AccessState::await_ifm_response:
    case AccessState::await_response:
      deadline_ = kernel::kNever;
      break;
    case AccessState::check_token_pass:
      deadline_ = kernel::kNever;
      if (is_noise_after_token_) on_pass_success({.kind = FrameKind::token}, now);
      break;
    default:
      break;
  }
}

void TokenStation::on_deadline(kernel::Time now) {
  switch (state_) {
    case AccessState::demand_in:
      // Nobody gave it the token: it is as before.
      if (forgets_offer()) offered_successor_.reset();
      go_idle();
      break;
    case AccessState::demand_delay:
      answer(demanded_of_, now);
      break;
    case AccessState::claim_token:
      claim_goes_on(now);
      break;
    case AccessState::use_token:
      serve(now);
      break;
    case AccessState::await_ifm_response:
      on_response_missing(now);
      break;
    case AccessState::check_token_pass:
      next_stage(now);
      break;
    case AccessState::await_response:
      on_window_over(now);
      break;
    default:
      break;
  }
}

// The station has begun a transmission that ends then.
void TokenStation::on_sent(FrameKind kind, kernel::Time end) {
  switch (state_) {
    case AccessState::demand_in:
      deadline_ = end + slots(rules(), rules().demand_wait_slots);
      break;
    case AccessState::claim_token:
      deadline_ = end + slots(rules(), 1);
      break;
    case AccessState::use_token:
      queues_.at(place_).pop_front();
      deadline_ = end;
      break;
    case AccessState::await_ifm_response:
      deadline_ = end + slots(rules(), rules().response_wait_slots);
      break;
    case AccessState::pass_token:
      // The predecessor knows its new successor: now the token.
      if (kind == FrameKind::set_successor) send_token(end);
      break;
    case AccessState::check_token_pass:
      deadline_ = end + slots(rules(), 1);
      break;
    case AccessState::await_response:
      deadline_ = end + slots(rules(), windows_of(kind));
      break;
    default:
      break;
  }
}

}  // namespace fieldproof::token_bus

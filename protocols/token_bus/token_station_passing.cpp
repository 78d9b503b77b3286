#include "protocols/token_bus/token_station.hpp"

// How the token leaves the station: windows for others to join, the pass itself, and what follows when nobody
// takes it.
namespace fieldproof::token_bus {

void TokenStation::pass(kernel::Time now) {
  attempts_ = 0;
  is_leaving_ = false;
  enter(AccessState::pass_token);
  if (!wants_ring()) {
    leave(now);
  } else if (opens_window(now)) {
    open_window(now);
  } else {
    send_token(now);
  }
}

Frame TokenStation::leaving_frame() const {
  return control(FrameKind::set_successor, predecessor_, successor_);
}

void TokenStation::leave(kernel::Time now) {
  if (successor_ == address()) {
    is_in_ring_ = false;
    go_idle();
    report(EventKind::left, address(), now);
    return;
  }
  is_leaving_ = true;
  send(leaving_frame(), now);
}

// A station that is alone asks each time; in a ring that is fast enough each of so many tokens.
bool TokenStation::opens_window(kernel::Time now) {
  constexpr unsigned kRingMaintenancePlace = 0;
  const bool is_in_time = residual(kRingMaintenancePlace, now) > kernel::Duration::zero();
  reload(kRingMaintenancePlace, now);
  if (successor_ == address()) return true;
  if (!is_in_time || !is_window_due(inter_solicit_count_)) return false;
  // Stations that began together do not go on together.
  inter_solicit_count_ = (rules().max_inter_solicit_count & ~3U) | drawn_count_bits();
  return true;
}

void TokenStation::open_window(kernel::Time now) {
  solicit(is_lowest() || successor_ == address() ? FrameKind::solicit_successor_2
                                                 : FrameKind::solicit_successor_1,
          now);
}

unsigned TokenStation::windows_of(FrameKind kind) const {
  switch (kind) {
    case FrameKind::solicit_successor_1:
      return 1;
    case FrameKind::solicit_successor_2:
      return 2;
    case FrameKind::who_follows:
      return 3;
    default:
      return 4;
  }
}

// Opens the windows of this frame.
void TokenStation::solicit(FrameKind kind, kernel::Time now) {
  awaited_by_ = kind;
  contest_pass_ = 0;
  enter(AccessState::await_response);
  const bool is_who_follows = kind == FrameKind::who_follows;
  send(control(kind, successor_, is_who_follows ? std::optional(successor_) : std::nullopt), now);
}

void TokenStation::send_token(kernel::Time now) {
  ++attempts_;
  is_noise_after_token_ = false;
  enter(AccessState::check_token_pass);
  send(control(FrameKind::token, successor_), now);
}

// ---- after the token ----

TokenStation::PassStage TokenStation::stage_after(unsigned attempts) const {
  if (attempts < 2) return PassStage::token;
  if (attempts < 4) return PassStage::who_follows;
  return attempts == 4 ? PassStage::solicit_any : PassStage::failed;
}

void TokenStation::next_stage(kernel::Time now) {
  switch (stage_after(attempts_)) {
    case PassStage::token:
      return send_token(now);
    case PassStage::who_follows:
      ++attempts_;
      return solicit(FrameKind::who_follows, now);
    case PassStage::solicit_any:
      ++attempts_;
      successor_ = address();
      return solicit(FrameKind::solicit_successor_2, now);
    case PassStage::failed:
      return on_pass_failed(now);
  }
}

void TokenStation::on_pass_success(const Frame& frame, kernel::Time end) {
  if (forgives_failures()) failures_ = 0;
  if (inter_solicit_count_ > 0) --inter_solicit_count_;
  const bool has_left = is_leaving_;
  is_leaving_ = false;
  if (has_left) is_in_ring_ = false;
  go_idle();
  if (has_left) report(EventKind::left, address(), end);
  // Whose activity it was is known at its end.
  if (!is_noise_after_token_) on_idle_frame(frame, end);
}

void TokenStation::on_pass_failed(kernel::Time now) {
  is_in_ring_ = is_leaving_ = false;
  successor_ = predecessor_ = address();
  if (++failures_ >= rules().transmitter_fault_limit) {
    go_offline();
    report(EventKind::faulty_transmitter, address(), now);
    return;
  }
  go_idle();
  report(EventKind::pass_failed, address(), now);
}

// ---- response windows ----

void TokenStation::on_await_frame(const Frame& frame, kernel::Time end) {
  if (frame.kind == FrameKind::set_successor && takes_successor(frame)) {
    set_successor(address_of(frame.data), end);
    attempts_ = 0;
    send_token(end);
  } else if (drops_token_on(frame)) {
    drop_token(frame, end);
  } else {
    on_window_over(end);
  }
}

// Several have answered at once.
void TokenStation::on_contention(kernel::Time end) {
  if (!resolves(contest_pass_)) return on_window_over(end);
  ++contest_pass_;
  enter(AccessState::await_response);
  send(control(FrameKind::resolve_contention, address()), end);
}

// Nobody has answered, or no single one.
void TokenStation::on_window_over(kernel::Time now) {
  if (attempts_ > 0) return next_stage(now);
  if (successor_ == address()) return hold_token(now);
  send_token(now);
}

}  // namespace fieldproof::token_bus

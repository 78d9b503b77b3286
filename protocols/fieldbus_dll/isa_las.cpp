#include "protocols/fieldbus_dll/isa_las.hpp"

#include <algorithm>

namespace fieldproof::fieldbus_dll {

IsaLas::IsaLas(const IsaConfiguration& configuration) : IsaDle(configuration) {}

bool IsaLas::start(kernel::Time now) {
  if (!IsaDle::start(now)) return false;
  if (!configuration().begins_as_scheduler) return true;
  begin_ = now;
  next_ = 0;
  enter_las(LasState::scheduling);
  return true;
}

void IsaLas::stop(kernel::Time now) {
  IsaDle::stop(now);
  enter_las(LasState::standby);
  own_not_before_ = kernel::kStart;
  has_shown_itself_ = true;
  ordered_heir_.reset();
  heir_.reset();
}

bool IsaLas::order_transfer(std::uint8_t node, kernel::Time) {
  if (state_ != LasState::standby) ordered_heir_ = node;
  return true;
}

bool IsaLas::submit(const IsaRequest& request, kernel::Time now) {
  own_not_before_ = kernel::kStart;
  return IsaDle::submit(request, now);
}

void IsaLas::enter_las(LasState state) {
  state_ = state;
  if (is_awaiting() || state == LasState::transferring) return;
  response_until_ = supervision_until_ = kernel::kNever;
}

bool IsaLas::is_awaiting() const {
  return state_ == LasState::awaiting_single || state_ == LasState::awaiting_sequence;
}

// ---- what is heard ----

void IsaLas::on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) {
  if (dlpdu.type == IsaType::tl && is_meant(dlpdu)) return take_scheduler(dlpdu, place.end);
  if (state_ == LasState::transferring && shows_transfer(dlpdu)) {
    on_transferred(place.end);
  } else if (state_ != LasState::standby && is_of_scheduler(dlpdu.type)) {
    tell(IsaEventKind::second_scheduler, dlpdu.source, place.end);
    if (yields_to(dlpdu)) leave(dlpdu.source, place.end);
  } else if (is_awaiting() && is_from_holder(dlpdu)) {
    on_holder(dlpdu, place.end);
  }
  IsaDle::on_dlpdu(dlpdu, place);
}

void IsaLas::on_holder(const IsaDlpdu& dlpdu, kernel::Time now) {
  if (dlpdu.type == IsaType::ee) return enter_las(LasState::scheduling);
  if (state_ == LasState::awaiting_sequence) {
    response_until_ = kernel::kNever;
    return;
  }
  if (is_single_used_) tell(IsaEventKind::token_overrun, holder_, now);
  is_single_used_ = true;
  response_until_ = dlpdu.type == IsaType::cd ? response_end_behind_cd(now) : response_end(now);
}

void IsaLas::on_activity(segment::PortIndex port, bool begins, kernel::Time now) {
  IsaDle::on_activity(port, begins, now);
  if (!begins && state_ == LasState::awaiting_single)
    response_until_ = std::max(response_until_, response_end(now));
}

// ---- what happens when ----

kernel::Time IsaLas::timer() const {
  const kernel::Time at = std::min(response_until_, supervision_until_);
  return line().hears_activity() && !reclaims_while_busy() ? kernel::kNever : at;
}

kernel::Time IsaLas::next_time() const {
  if (state_ == LasState::standby) return IsaDle::next_time();
  const kernel::Time next = std::min(IsaDle::next_time(), timer());
  if (state_ != LasState::scheduling || IsaDle::state() != DleState::idle) return next;
  kernel::Time wanted = next_item() != nullptr ? due(*next_item()) : kernel::kNever;
  if (ordered_heir_ || !has_shown_itself_) wanted = kernel::kStart;
  if (!queues().empty()) wanted = std::min(wanted, own_not_before_);
  return std::min(next, std::max(wanted, may_begin()));
}

void IsaLas::on_time(kernel::Time now) {
  IsaDle::on_time(now);
  // Its own reply to the holder takes its time, too.
  if (state_ == LasState::awaiting_single && line().is_driving(now))
    response_until_ = std::max(response_until_, response_end(line().driven_until()));
  if (timer() <= now) on_timer(now);
  if (state_ == LasState::scheduling && IsaDle::state() == DleState::idle && may_begin_now(now))
    schedule(now);
}

void IsaLas::on_timer(kernel::Time now) {
  if (state_ == LasState::transferring) {
    tell(IsaEventKind::transfer_failed, *heir_, now);
    heir_.reset();
    return enter_las(retakes() ? LasState::scheduling : LasState::standby);
  }
  reclaim(supervision_until_ <= now && response_until_ > now ? IsaEventKind::token_overrun
                                                             : IsaEventKind::token_reclaimed,
          now);
}

void IsaLas::reclaim(IsaEventKind kind, kernel::Time now) {
  tell(kind, holder_, now);
  enter_las(LasState::scheduling);
}

// ---- the schedule ----

const IsaScheduleItem* IsaLas::next_item() const {
  const auto& items = configuration().schedule.items;
  return next_ < items.size() ? &items[next_] : nullptr;
}

void IsaLas::advance() {
  const IsaSchedule& schedule = configuration().schedule;
  if (++next_ < schedule.items.size() || schedule.period == kernel::Duration{}) return;
  next_ = 0;
  begin_ += schedule.period;
}

void IsaLas::schedule(kernel::Time now) {
  if (ordered_heir_) return transfer(now);
  if (const IsaScheduleItem* const item = next_item(); item != nullptr && due(*item) <= now) {
    delegate(*item, now);
    return;
  }
  if (!send_own(now) && !has_shown_itself_) show_itself(now);
}

void IsaLas::delegate(const IsaScheduleItem& item, kernel::Time now) {
  IsaDlpdu dlpdu;
  dlpdu.type = item.type;
  dlpdu.priority = item.least;
  dlpdu.destination = item.node;
  dlpdu.source = address();
  dlpdu.duration = item.duration;
  const kernel::Time end = transmit(dlpdu, now);
  has_shown_itself_ = true;
  holder_ = item.node;
  is_single_used_ = false;
  const bool is_sequence = item.type == IsaType::es;
  enter_las(is_sequence ? LasState::awaiting_sequence : LasState::awaiting_single);
  response_until_ = response_end(end);
  supervision_until_ = is_sequence ? supervision_end(item, end) : kernel::kNever;
  own_not_before_ = kernel::kStart;
  advance();
}

bool IsaLas::send_own(kernel::Time now) {
  const auto priority = next_to_send(queues(), Priority::time_available);
  if (!priority) return false;
  const IsaScheduleItem* const item = next_item();
  const IsaRequest& request = queues().queue(*priority).front();
  if (item != nullptr && now + needed_for(request) > due(*item)) {
    own_not_before_ = due(*item);
    return false;
  }
  has_shown_itself_ = true;
  send(queues().pop(*priority), now);
  return true;
}

// ---- who is the scheduler ----

void IsaLas::transfer(kernel::Time now) {
  IsaDlpdu tl;
  tl.type = IsaType::tl;
  tl.destination = *ordered_heir_;
  tl.source = address();
  tl.schedule_version = configuration().schedule.version;
  const kernel::Time end = transmit(tl, now);
  heir_ = ordered_heir_;
  ordered_heir_.reset();
  enter_las(LasState::transferring);
  response_until_ = response_end(end);
}

void IsaLas::on_transferred(kernel::Time now) {
  tell(IsaEventKind::transferred, *heir_, now);
  heir_.reset();
  ordered_heir_.reset();
  enter_las(LasState::standby);
}

void IsaLas::take_scheduler(const IsaDlpdu& tl, kernel::Time now) {
  if (IsaDle::state() == DleState::awaiting_reply) tell(IsaEventKind::token_dropped, tl.source, now);
  drop_token();
  enter(DleState::idle);
  begin_ = now;
  next_ = 0;
  has_shown_itself_ = !shows_itself();
  enter_las(LasState::scheduling);
  tell(IsaEventKind::scheduler_taken, tl.source, now);
}

// Who gave the link away waits for a sign of life.
void IsaLas::show_itself(kernel::Time now) {
  IsaDlpdu du;
  du.type = IsaType::du;
  du.destination = rules().everybody;
  du.source = address();
  transmit(du, now);
  has_shown_itself_ = true;
}

void IsaLas::leave(std::uint8_t other, kernel::Time now) {
  ordered_heir_.reset();
  heir_.reset();
  enter_las(LasState::standby);
  tell(IsaEventKind::scheduler_left, other, now);
}

kernel::Time IsaLas::supervision_end(const IsaScheduleItem& item, kernel::Time es_end) const {
  return es_end + octet_times(item.duration) + octet_times(rules().supervision_margin_octets);
}

}  // namespace fieldproof::fieldbus_dll

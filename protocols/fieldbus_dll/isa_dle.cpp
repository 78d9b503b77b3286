#include "protocols/fieldbus_dll/isa_dle.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::fieldbus_dll {

std::string_view text_of(IsaEventKind kind) {
  switch (kind) {
    case IsaEventKind::reply_missing:
      return "reply missing";
    case IsaEventKind::token_dropped:
      return "token dropped";
    case IsaEventKind::token_reclaimed:
      return "token reclaimed";
    case IsaEventKind::token_overrun:
      return "token overrun";
    case IsaEventKind::second_scheduler:
      return "second scheduler";
    case IsaEventKind::scheduler_left:
      return "scheduler left";
    case IsaEventKind::transfer_failed:
      return "transfer failed";
    case IsaEventKind::transferred:
      return "transferred";
    case IsaEventKind::scheduler_taken:
      return "scheduler taken";
  }
  return "";
}

IsaDle::IsaDle(const IsaConfiguration& configuration)
    : configuration_(configuration), line_(configuration.rules.link) {}

void IsaDle::wire(segment::Port& line, IsaUser& user) {
  line_.wire(line);
  user_ = &user;
}

bool IsaDle::start(kernel::Time now) {
  line_.on_supply(now);
  is_stopped_ = are_impossible();
  return !is_stopped_;
}

void IsaDle::stop(kernel::Time) {
  is_stopped_ = true;
  enter(DleState::idle);
  to_send_ = {};
  replies_ = {};
  token_.reset();
  awaited_.reset();
  compelled_.reset();
}

bool IsaDle::submit(const IsaRequest& request, kernel::Time) {
  if (request.service > IsaService::reply_data || request.priority < Priority::time_available ||
      request.priority > Priority::urgent)
    return false;
  const bool is_address =
      request.service == IsaService::reply_data ||
      (request.destination >= rules().first_address && request.destination <= rules().last_address) ||
      (request.service == IsaService::unit_data && request.destination == rules().everybody);
  const bool has_stray_data = request.service == IsaService::compel && !request.data.empty();
  if (!is_address || has_stray_data || is_too_long(request)) return false;
  (request.service == IsaService::reply_data ? replies_ : to_send_).push(request);
  return true;
}

// ---- the line ----

void IsaDle::receive(segment::PortIndex, const line::Waveform& reception) {
  if (is_stopped_) return;
  for (const Arrived& arrived : heard_in(reception)) {
    if (const auto dlpdu = understood(arrived.octets)) on_dlpdu(*dlpdu, {arrived.begin, arrived.end});
  }
}

void IsaDle::on_activity(segment::PortIndex, bool begins, kernel::Time now) {
  line_.on_activity(begins, now);
}

kernel::Time IsaDle::may_begin() const {
  const kernel::Time since = line_.silent_since();
  return since == kernel::kNever ? since : since + silence_before_sending();
}

kernel::Time IsaDle::transmit(const IsaDlpdu& dlpdu, kernel::Time now) {
  return put_on_line(written(dlpdu), now);
}

kernel::Time IsaDle::put_on_line(const Octets& octets, kernel::Time now) {
  return line_.transmit(octets, now);
}

// ---- what happens when ----

void IsaDle::on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) {
  if (state_ == DleState::awaiting_reply) {
    if (is_expected_reply(dlpdu)) {
      awaited_.reset();
      user_->on_data(dlpdu, place.end);
      resume(place.end);
      return;
    }
    awaited_.reset();
    drop_token();
    enter(DleState::idle);
    tell(IsaEventKind::token_dropped, dlpdu.source, place.end);
    return;
  }
  // Whichever is told first of what happens at one instant: a token whose duration is over is none.
  if (state_ == DleState::holding && (token_->ends <= place.end || is_of_scheduler(dlpdu.type))) {
    drop_token();
    enter(DleState::idle);
  }
  if (state_ == DleState::replying) end_reply();
  if (state_ == DleState::idle && is_meant(dlpdu)) {
    if (dlpdu.type == IsaType::et || dlpdu.type == IsaType::es) take_token(dlpdu, place);
    if (dlpdu.type == IsaType::cd) begin_reply(dlpdu, place.end);
  }
  if (is_delivered(dlpdu)) deliver(dlpdu, place.end);
}

kernel::Time IsaDle::next_time() const {
  switch (state_) {
    case DleState::idle:
      return kernel::kNever;
    case DleState::holding:
      return std::min(may_begin(), token_->ends);
    case DleState::awaiting_reply:
      return must_wait_for_reply() ? kernel::kNever : awaited_->until;
    case DleState::replying:
      return has_reply() || !compelled_->waits_for_user ? std::min(may_begin(), compelled_->until)
                                                        : compelled_->until;
  }
  return kernel::kNever;
}

void IsaDle::on_time(kernel::Time now) {
  switch (state_) {
    case DleState::idle:
      return;
    case DleState::holding:
      use_token(now);
      return;
    case DleState::awaiting_reply:
      if (!must_wait_for_reply() && awaited_->until <= now) on_reply_wait_over(now);
      return;
    case DleState::replying:
      reply(now);
      return;
  }
}

// ---- the token ----

void IsaDle::take_token(const IsaDlpdu& dlpdu, const Place& place) {
  token_ = Token{dlpdu, dlpdu.type == IsaType::es ? token_end(dlpdu, place) : kernel::kNever};
  enter(DleState::holding);
}

void IsaDle::use_token(kernel::Time now) {
  if (token_->ends <= now) {
    drop_token();
    enter(DleState::idle);
    return;
  }
  if (!may_begin_now(now)) return;
  if (token_->is_used && is_single(token_->by)) return end_token(EndReason::single_frame_done, now);
  const auto priority = next_to_send(to_send_, token_->by.priority);
  if (!priority) return end_token(EndReason::nothing_to_send, now);
  if (!fits(to_send_.queue(*priority).front(), now)) return end_token(EndReason::no_time, now);
  token_->is_used = true;
  send(to_send_.pop(*priority), now);
}

void IsaDle::send(const IsaRequest& request, kernel::Time now) {
  IsaDlpdu dlpdu;
  dlpdu.type = request.service == IsaService::compel ? IsaType::cd : IsaType::du;
  dlpdu.priority = request.priority;
  dlpdu.destination = request.destination;
  dlpdu.source = address();
  dlpdu.data = request.data;
  const kernel::Time end = transmit(dlpdu, now);
  if (dlpdu.type != IsaType::cd) return;
  awaited_ = Awaited{request.destination, end + reply_wait()};
  enter(DleState::awaiting_reply);
}

void IsaDle::end_token(EndReason reason, kernel::Time now) {
  if (returns_token(reason, now)) {
    IsaDlpdu ee;
    ee.type = IsaType::ee;
    ee.destination = token_->by.source;
    ee.source = address();
    ee.reason = reason;
    transmit(ee, now);
  }
  drop_token();
  enter(DleState::idle);
}

void IsaDle::on_reply_wait_over(kernel::Time now) {
  const std::uint8_t node = awaited_->node;
  awaited_.reset();
  tell(IsaEventKind::reply_missing, node, now);
  resume(now);
}

void IsaDle::resume(kernel::Time) {
  enter(token_ ? DleState::holding : DleState::idle);
}

// ---- replies ----

void IsaDle::begin_reply(const IsaDlpdu& cd, kernel::Time cd_end) {
  compelled_ = Compelled{cd, cd_end + reply_forming()};
  enter(DleState::replying);
}

bool IsaDle::has_reply() const {
  return next_to_send(replies_, compelled_->by.priority).has_value();
}

void IsaDle::end_reply() {
  compelled_.reset();
  enter(DleState::idle);
}

void IsaDle::reply(kernel::Time now) {
  const bool is_late = compelled_->until <= now;
  if (!may_begin_now(now) || (compelled_->waits_for_user && !has_reply())) {
    if (is_late) end_reply();
    return;
  }
  const auto priority = next_to_send(replies_, compelled_->by.priority);
  if (!priority && !compelled_->waits_for_user && waits_for_user(compelled_->by.priority, now)) {
    compelled_->waits_for_user = true;
    return;
  }
  IsaDlpdu dt;
  dt.type = IsaType::dt;
  dt.priority = compelled_->by.priority;
  dt.is_final = true;
  dt.destination = compelled_->by.source;
  dt.source = address();
  if (priority) {
    dt.priority = *priority;
    dt.data = replies_.pop(*priority).data;
  }
  end_reply();
  transmit(dt, now);
}

void IsaDle::deliver(const IsaDlpdu& dlpdu, kernel::Time now) {
  user_->on_data(dlpdu, now);
}

// ---- decisions ----

std::optional<IsaDlpdu> IsaDle::understood(std::span<const std::uint8_t> octets) const {
  return isa_dlpdu_of(octets, rules());
}

bool IsaDle::is_meant(const IsaDlpdu& dlpdu) const {
  return dlpdu.destination == address();
}

bool IsaDle::is_delivered(const IsaDlpdu& dlpdu) const {
  const bool is_to_all = dlpdu.type == IsaType::du && dlpdu.destination == rules().everybody;
  return is_to_all || ((dlpdu.type == IsaType::dt || dlpdu.type == IsaType::du) && is_meant(dlpdu));
}

kernel::Duration IsaDle::silence_before_sending() const {
  return octet_times(rules().link.inter_pdu_delay_octets);
}

kernel::Time IsaDle::token_end(const IsaDlpdu& es, const Place& place) const {
  return place.end + octet_times(es.duration);
}

std::optional<Priority> IsaDle::next_to_send(const Queues& queues, Priority least) const {
  for (const Priority priority : Queues::kMostUrgentFirst) {
    if (may_send(priority, least) && !queues.queue(priority).empty()) return priority;
  }
  return std::nullopt;
}

bool IsaDle::fits(const IsaRequest& request, kernel::Time now) const {
  return token_->ends == kernel::kNever || now + needed_for(request) <= token_->ends;
}

kernel::Duration IsaDle::needed_for(const IsaRequest& request) const {
  const LinkRules& link = rules().link;
  const bool compels = request.service == IsaService::compel;
  kernel::Duration needed =
      frame_time(link, octets_on_line(compels ? IsaType::cd : IsaType::du, request.data.size()));
  if (compels) {
    needed += reply_wait() + frame_time(link, octets_on_line(IsaType::dt, most_data(link, request.priority)));
  }
  return needed + silence_before_sending() + frame_time(link, octets_on_line(IsaType::ee));
}

bool IsaDle::returns_token(EndReason, kernel::Time now) const {
  return now + frame_time(rules().link, octets_on_line(IsaType::ee)) <= token_->ends;
}

bool IsaDle::is_expected_reply(const IsaDlpdu& dlpdu) const {
  return dlpdu.type == IsaType::dt && is_meant(dlpdu) && dlpdu.source == awaited_->node;
}

bool IsaDle::is_too_long(const IsaRequest& request) const {
  return request.data.size() > most_data(rules().link, request.priority);
}

}  // namespace fieldproof::fieldbus_dll

#include "protocols/fieldbus_dll/ff_las.hpp"

#include <algorithm>

namespace fieldproof::fieldbus_dll {
namespace {

// The lowest link master claims after V(ST) x 16; half of that leaves room for what was begun.
constexpr unsigned kKeepActiveSlots = 8;

}  // namespace

FfLas::FfLas(const FfConfiguration& configuration) : FfStation(configuration) {
  begin_anew();
}

// What it knows of the link before anything happens.
void FfLas::begin_anew() {
  las_ = FfLasState::standby;
  live_.assign(kNodeNumbers, false);
  misses_.assign(kNodeNumbers, 0);
  for (const std::uint8_t node : configuration().live) live_[node] = true;
  last_probe_ = rules().last_node;
  revision_ = 0;
  rotation_ = {};
  to_tell_.clear();
  ordered_heir_.reset();
}

void FfLas::stop(kernel::Time now) {
  FfStation::stop(now);
  begin_anew();
}

bool FfLas::start(kernel::Time now) {
  const FfSchedule& schedule = configuration().schedule;
  const auto is_outside = [&](const FfScheduleItem& item) { return item.at >= schedule.macrocycle; };
  if (schedule.macrocycle == 0 || std::ranges::any_of(schedule.items, is_outside)) return false;
  if (!FfStation::start(now)) return false;
  started_ = now;
  live_[node()] = true;
  if (configuration().begins_as_scheduler) take_link(now);
  return true;
}

bool FfLas::order_transfer(std::uint8_t node, kernel::Time) {
  if (is_scheduler()) ordered_heir_ = node;
  blocked_until_ = kernel::kStart;
  return true;
}

bool FfLas::submit(const FfRequest& request, kernel::Time now) {
  blocked_until_ = kernel::kStart;
  return FfStation::submit(request, now);
}

void FfLas::take_link(kernel::Time now) {
  drop_token();
  enter(FfState::idle);
  enter_las(FfLasState::scheduling);
  set_schedule(now);
  last_distribution_ = now - time_distributed_every();
  turn_ = 0;
  is_first_token_ = true;
  has_circulated_ = false;
  token_priority_ = Priority::urgent;
  blocked_until_ = kernel::kStart;
  std::ranges::fill(misses_, 0U);
}

void FfLas::leave(kernel::Time now) {
  ordered_heir_.reset();
  to_tell_.clear();
  enter_las(FfLasState::standby);
  enter(FfState::idle);
  tell(FfEventKind::left, node(), now);
}

// ---- what is heard ----

void FfLas::on_dlpdu(const FfDlpdu& dlpdu, const Place& place) {
  const bool is_for_it = dlpdu.type == FfType::tl && is_mine(dlpdu.node);
  const bool is_right_version = dlpdu.schedule_version == configuration().schedule.version;
  if (is_for_it && !is_right_version && is_scheduler()) return;
  if (is_for_it && is_right_version) {
    take_link(place.end);
    tell(FfEventKind::taken, node(), place.end);
    return;
  }
  if (las_ == FfLasState::transferring) {
    enter_las(FfLasState::standby);
    tell(FfEventKind::transferred, awaited_, place.end);
  } else if (is_scheduler() && leaves_to(dlpdu)) {
    leave(place.end);
  }
  if (!is_scheduler()) {
    if (dlpdu.type == FfType::pt) live_[dlpdu.node] = true;
    FfStation::on_dlpdu(dlpdu, place);
    return;
  }
  if (dlpdu.type == FfType::pr && las_ == FfLasState::awaiting_probe && dlpdu.node == awaited_) {
    set_live(awaited_, true);
    tell(FfEventKind::node_found, awaited_, place.end);
    to_tell_.push_front(
        {Priority::normal, address_of(awaited_), {static_cast<std::uint8_t>(SpduKind::activation)}});
    on_back(place.end);
  }
  if (las_ == FfLasState::awaiting_holder || las_ == FfLasState::awaiting_reply) {
    has_answered_ = true;
    if (las_ == FfLasState::awaiting_holder) on_token_used(awaited_);
    if (returns_token(dlpdu) && is_from_awaited(dlpdu)) on_back(place.end);
  }
  if (dlpdu.type == FfType::ct) {
    const kernel::Time begin = place.end + silence_before_sending();
    if (const FfDlpdu td = time_dlpdu(begin); has_time(td, {}, begin)) answer(td, place);
    return;
  }
  FfStation::on_dlpdu(dlpdu, place);
}

void FfLas::on_spdu(const FfDlpdu& dlpdu, kernel::Time now) {
  FfStation::on_spdu(dlpdu, now);
  if (is_scheduler() || dlpdu.data[0] != static_cast<std::uint8_t>(SpduKind::live_list)) return;
  if (dlpdu.data.size() != live_list_spdu(0, {}).size()) return;
  revision_ = dlpdu.data[1];
  for (unsigned n = 0; n < kNodeNumbers; ++n) live_[n] = (dlpdu.data[2 + n / 8] & (0x80U >> n % 8)) != 0;
  live_[node()] = true;
}

void FfLas::on_activity(segment::PortIndex port, bool begins, kernel::Time now) {
  FfStation::on_activity(port, begins, now);
  // Who has begun to answer may fall silent no longer than who has not.
  const bool is_awaiting = las_ == FfLasState::awaiting_holder || las_ == FfLasState::awaiting_reply ||
                           las_ == FfLasState::awaiting_probe || las_ == FfLasState::transferring;
  if (!begins && is_awaiting) answer_until_ = std::max(answer_until_, now + response_delay(rules().link));
}

// ---- what happens when ----

kernel::Time FfLas::timer() const {
  if (line().hears_activity()) return kernel::kNever;
  if (las_ == FfLasState::standby) {
    const kernel::Time since = silent_for_claim_since();
    return FfStation::state() == FfState::stopped ? kernel::kNever : since + claim_silence();
  }
  if (las_ == FfLasState::scheduling || las_ == FfLasState::own_turn) return kernel::kNever;
  return std::min(answer_until_, token_until_);
}

kernel::Time FfLas::next_time() const {
  const kernel::Time next = std::min(FfStation::next_time(), timer());
  const bool may_act = las_ == FfLasState::scheduling || las_ == FfLasState::own_turn;
  if (!may_act || FfStation::state() != FfState::idle) return next;
  return std::min(next, std::max(may_begin(), std::min(blocked_until_, next_cd())));
}

void FfLas::on_time(kernel::Time now) {
  FfStation::on_time(now);
  // Its own answer to a holder takes its time, too.
  if (is_scheduler() && line().is_driving(now))
    answer_until_ = std::max(answer_until_, line().driven_until() + response_delay(rules().link));
  if (timer() <= now) on_answer_time_over(now);
  const bool may_act = las_ == FfLasState::scheduling || las_ == FfLasState::own_turn;
  if (may_act && FfStation::state() == FfState::idle && may_begin_now(now)) schedule(now);
}

void FfLas::on_answer_time_over(kernel::Time now) {
  switch (las_) {
    case FfLasState::standby:
      take_link(now);
      transmit({.type = FfType::cl, .node = node()}, now);
      tell(FfEventKind::claimed, node(), now);
      return;
    case FfLasState::awaiting_holder:
      if (!has_answered_) return miss(now);
      tell(FfEventKind::token_reclaimed, awaited_, now);
      return on_back(now);
    case FfLasState::awaiting_reply:
      if (!has_answered_) tell(FfEventKind::reply_missing, awaited_, now);
      return on_back(now);
    case FfLasState::transferring:
      tell(FfEventKind::transfer_failed, awaited_, now);
      return retakes() ? on_back(now) : enter_las(FfLasState::standby);
    default:
      return on_back(now);
  }
}

void FfLas::on_back(kernel::Time) {
  answer_until_ = token_until_ = kernel::kNever;
  blocked_until_ = kernel::kStart;
  enter_las(FfLasState::scheduling);
}

void FfLas::miss(kernel::Time now) {
  tell(FfEventKind::token_missed, awaited_, now);
  if (is_missed_too_often(++misses_[awaited_])) {
    set_live(awaited_, false);
    tell(FfEventKind::node_removed, awaited_, now);
  }
  on_back(now);
}

void FfLas::set_live(std::uint8_t node, bool is_live) {
  if (live_[node] == is_live) return;
  live_[node] = is_live;
  misses_[node] = 0;
  ++revision_;
  // One that waits already tells an older state.
  std::erase_if(to_tell_, [](const FfRequest& one) { return one.destination == kEverybody; });
  to_tell_.push_back({Priority::normal, kEverybody, live_list()});
}

void FfLas::await(FfLasState state, std::uint8_t node, const Place& question) {
  enter_las(state);
  awaited_ = node;
  has_answered_ = false;
  answer_until_ = answer_awaited_until(question);
  token_until_ = kernel::kNever;
}

// ---- the schedule ----

void FfLas::set_schedule(kernel::Time now) {
  const FfSchedule& schedule = configuration().schedule;
  cycle_ = link_time(now) / schedule.macrocycle * schedule.macrocycle;
  item_ = 0;
  if (schedule.items.empty()) return;
  while (due(schedule.items[item_]) < now) advance();
}

void FfLas::advance() {
  if (++item_ < configuration().schedule.items.size()) return;
  item_ = 0;
  cycle_ += configuration().schedule.macrocycle;
}

kernel::Time FfLas::due(const FfScheduleItem& item) const {
  return instant_of(cycle_ + item.at);
}

kernel::Time FfLas::next_cd() const {
  const auto& items = configuration().schedule.items;
  return items.empty() ? kernel::kNever : due(items[item_]);
}

bool FfLas::has_time(const FfDlpdu& dlpdu, kernel::Duration more, kernel::Time now) const {
  const kernel::Time cd = next_cd();
  if (cd == kernel::kNever) return true;
  return now + frame_time(rules().link, octets_on_line(dlpdu, rules())) + more + kept_free_before_cd() <= cd;
}

void FfLas::schedule(kernel::Time now) {
  if (compel(now)) return;
  if (blocked_until_ <= now) {
    blocked_until_ = kernel::kStart;
    if (distribute_time(now) || tell_entities(now) || transfer(now) || circulate(now)) return;
    // Nothing else has time before what is due.
    blocked_until_ = next_cd();
  }
  keep_active(now);
}

void FfLas::say(const FfDlpdu& dlpdu, kernel::Time now) {
  transmit(dlpdu, now);
}

bool FfLas::compel(kernel::Time now) {
  if (next_cd() > now) return false;
  const FfScheduleItem item = configuration().schedule.items[item_];
  advance();
  blocked_until_ = kernel::kStart;
  if (is_mine(node_of(item.address))) {
    Buffer* const buffer = buffer_of(item.address);
    if (buffer == nullptr || !buffer->is_written) return true;
    FfDlpdu dt3 = published(item.address, *buffer);
    dt3.priority = item.priority;
    dt3.is_final = false;
    say(dt3, now);
    return true;
  }
  const Place cd = send_question({.type = FfType::cd,
                                  .priority = item.priority,
                                  .has_long_addresses = is_long(item.address),
                                  .destination = item.address},
                                 now);
  await(FfLasState::awaiting_reply, node_of(item.address), cd);
  return true;
}

FfDlpdu FfLas::time_dlpdu(kernel::Time now) const {
  FfDlpdu td{.type = FfType::td};
  td.link_time = link_time(now + frame_time(rules().link, octets_on_line(td, rules())));
  return td;
}

bool FfLas::distribute_time(kernel::Time now) {
  if (now < last_distribution_ + time_distributed_every()) return false;
  const FfDlpdu td = time_dlpdu(now);
  if (!has_time(td, {}, now)) return false;
  last_distribution_ = now;
  say(td, now);
  return true;
}

bool FfLas::tell_entities(kernel::Time now) {
  if (to_tell_.empty()) return false;
  const FfRequest& first = to_tell_.front();
  const FfDlpdu dt1{.type = FfType::dt1,
                    .priority = first.priority,
                    .destination = first.destination,
                    .source = address_of(node(), kEntity),
                    .data = first.data};
  if (!has_time(dt1, {}, now)) return false;
  to_tell_.pop_front();
  say(dt1, now);
  return true;
}

bool FfLas::transfer(kernel::Time now) {
  if (!ordered_heir_) return false;
  const FfDlpdu tl{
      .type = FfType::tl, .node = *ordered_heir_, .schedule_version = configuration().schedule.version};
  if (!has_time(tl, response_delay(rules().link), now)) return false;
  await(FfLasState::transferring, *ordered_heir_, send_question(tl, now));
  ordered_heir_.reset();
  return true;
}

// ---- the token ----

void FfLas::begin_circulation(kernel::Time now) {
  if (has_circulated_) {
    rotation_ = rotation_of(circulation_begin_, now);
    token_priority_ = next_priority(token_priority_, is_too_slow(rotation_));
  }
  has_circulated_ = true;
  circulation_begin_ = now;
  is_first_token_ = false;
}

bool FfLas::circulate(kernel::Time now) {
  if (las_ == FfLasState::own_turn) {
    if (use_own_turn(now)) return true;
    enter_las(FfLasState::scheduling);
  }
  while (turn_ < kNodeNumbers) {
    const auto node = static_cast<std::uint8_t>(turn_);
    if (!live_[node]) {
      ++turn_;
    } else if (is_mine(node)) {
      ++turn_;
      own_turn_until_ = now + octet_times(rules().token_holding_octets);
      enter_las(FfLasState::own_turn);
      if (use_own_turn(now)) return true;
      enter_las(FfLasState::scheduling);
    } else {
      return pass_token(node, now);
    }
  }
  // Of a circulation without a token it is the probe that tells where it begins.
  const bool is_alone = is_first_token_ && turn_ == kNodeNumbers;
  if (!probe(now)) return false;
  if (is_alone) begin_circulation(now);
  turn_ = 0;
  is_first_token_ = true;
  return true;
}

bool FfLas::pass_token(std::uint8_t node, kernel::Time now) {
  FfDlpdu pt{.type = FfType::pt, .node = node, .duration = 1};
  const kernel::Duration pt_time = frame_time(rules().link, octets_on_line(pt, rules()));
  const kernel::Time cd = next_cd();
  const unsigned grant =
      token_grant(cd == kernel::kNever ? cd - now : cd - now - pt_time - kept_free_before_cd());
  if (grant < rules().least_token_octets) return false;
  pt.begins_circulation = is_first_token_;
  if (is_first_token_) begin_circulation(now);
  pt.priority = token_priority_;
  pt.duration = static_cast<std::uint16_t>(grant);
  const Place passed = send_question(pt, now);
  ++turn_;
  await(FfLasState::awaiting_holder, node, passed);
  token_until_ = holder_until(passed.end, grant);
  return true;
}

unsigned FfLas::token_grant(kernel::Duration left) const {
  const std::int64_t octets_left = std::max<std::int64_t>(0, left / octet_times(1));
  return static_cast<unsigned>(std::min<std::int64_t>(rules().token_holding_octets, octets_left));
}

bool FfLas::use_own_turn(kernel::Time now) {
  const auto priority = next_to_send(queues(), token_priority_);
  if (!priority) return false;
  const FfDlpdu dt1 = dt1_of(queues().queue(*priority).front());
  const bool is_in_turn = now + frame_time(rules().link, octets_on_line(dt1, rules())) <= own_turn_until_;
  if (!is_in_turn || !has_time(dt1, {}, now)) return false;
  queues().pop(*priority);
  say(dt1, now);
  return true;
}

bool FfLas::probe(kernel::Time now) {
  const std::uint8_t node = next_probe(last_probe_);
  if (!probes_now() || node == this->node()) {
    // Without anything on the line a circulation would take no time.
    say({.type = FfType::idle}, now);
    return true;
  }
  const FfDlpdu pn{.type = FfType::pn, .node = node};
  const FfDlpdu pr{.type = FfType::pr, .node = node};
  const kernel::Duration answer =
      response_delay(rules().link) + frame_time(rules().link, octets_on_line(pr, rules()));
  if (!has_time(pn, answer, now)) return false;
  last_probe_ = node;
  await(FfLasState::awaiting_probe, node, send_question(pn, now));
  return true;
}

std::uint8_t FfLas::next_probe(std::uint8_t last) const {
  const unsigned first = rules().first_node;
  const unsigned count = rules().last_node - first + 1U;
  for (unsigned n = 1; n <= count; ++n) {
    const unsigned node = first + (last - first + n) % count;
    const bool is_unpolled =
        node >= rules().first_unpolled && node < rules().first_unpolled + rules().unpolled;
    if (!is_unpolled && !live_[node]) return static_cast<std::uint8_t>(node);
  }
  return node();  // all are live
}

void FfLas::keep_active(kernel::Time now) {
  const FfDlpdu idle{.type = FfType::idle};
  const kernel::Time silent_until = line().silent_since() + longest_silence();
  if (silent_until <= now && has_time(idle, {}, now)) {
    say(idle, now);
    blocked_until_ = kernel::kStart;
    return;
  }
  if (silent_until > now) blocked_until_ = std::min(blocked_until_, silent_until);
}

// ---- decisions ----

// RT, SR and DT3 do not say who sent them.
bool FfLas::is_from_awaited(const FfDlpdu& dlpdu) const {
  return dlpdu.type != FfType::dt1 || node_of(dlpdu.source) == awaited_;
}

kernel::Duration FfLas::claim_silence() const {
  const std::int64_t slots = node();
  return octet_times(slots * rules().link.slot_time_octets + rules().claim_delay_octets);
}

Priority FfLas::next_priority(Priority now, bool is_too_slow) const {
  if (!rules().steers_by_three_steps) return is_too_slow ? Priority::urgent : Priority::time_available;
  if (is_too_slow) return now == Priority::time_available ? Priority::normal : Priority::urgent;
  return now == Priority::urgent ? Priority::normal : Priority::time_available;
}

kernel::Duration FfLas::kept_free_before_cd() const {
  return octet_times(rules().scheduling_overhead_octets) + silence_before_sending();
}

kernel::Duration FfLas::longest_silence() const {
  return octet_times(std::int64_t{kKeepActiveSlots} * rules().link.slot_time_octets);
}

}  // namespace fieldproof::fieldbus_dll

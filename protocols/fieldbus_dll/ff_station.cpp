#include "protocols/fieldbus_dll/ff_station.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::fieldbus_dll {

std::string_view text_of(FfEventKind kind) {
  switch (kind) {
    case FfEventKind::activated:
      return "activated";
    case FfEventKind::reply_missing:
      return "reply missing";
    case FfEventKind::token_missed:
      return "token missed";
    case FfEventKind::token_reclaimed:
      return "token reclaimed";
    case FfEventKind::node_found:
      return "node found";
    case FfEventKind::node_removed:
      return "node removed";
    case FfEventKind::claimed:
      return "claimed";
    case FfEventKind::taken:
      return "taken";
    case FfEventKind::transferred:
      return "transferred";
    case FfEventKind::transfer_failed:
      return "transfer failed";
    case FfEventKind::left:
      return "left";
  }
  return "";
}

Octets live_list_spdu(std::uint8_t revision, const std::vector<bool>& live) {
  Octets octets{static_cast<std::uint8_t>(SpduKind::live_list), revision};
  octets.resize(2 + kNodeNumbers / 8);
  for (std::size_t node = 0; node < live.size() && node < kNodeNumbers; ++node) {
    if (live[node]) octets[2 + node / 8] |= static_cast<std::uint8_t>(0x80U >> node % 8);
  }
  return octets;
}

FfStation::FfStation(const FfConfiguration& configuration)
    : configuration_(configuration),
      line_(configuration.rules.link),
      subscribed_(configuration.subscribed.begin(), configuration.subscribed.end()) {
  for (const FfAddress address : configuration.published) buffers_[address] = {};
}

void FfStation::wire(segment::Port& line, FfUser& user) {
  line_.wire(line);
  user_ = &user;
}

bool FfStation::start(kernel::Time now) {
  if (are_impossible()) return false;
  line_.on_supply(now);
  set_link_time(0, now);
  enter(FfState::offline);
  return true;
}

void FfStation::stop(kernel::Time) {
  enter(FfState::stopped);
  token_.reset();
  answer_.reset();
  to_send_ = {};
  for (auto& [address, buffer] : buffers_) buffer = {};
}

bool FfStation::submit(const FfRequest& request, kernel::Time) {
  if (request.priority < Priority::time_available || request.priority > Priority::urgent) return false;
  if (is_too_long(request.priority, request.data.size())) return false;
  to_send_.push(request);
  return true;
}

bool FfStation::write(FfAddress address, const Octets& data, kernel::Time) {
  Buffer* const buffer = buffer_of(address);
  if (buffer == nullptr || is_too_long(Priority::urgent, data.size())) return false;
  buffer->data = data;
  buffer->is_written = true;
  ++buffer->writes;
  return true;
}

FfStation::Buffer* FfStation::buffer_of(FfAddress address) {
  const auto found = buffers_.find(address);
  return found == buffers_.end() ? nullptr : &found->second;
}

// ---- the line ----

void FfStation::receive(segment::PortIndex, const line::Waveform& reception) {
  if (state_ == FfState::stopped) return;
  for (const Arrived& arrived : heard_in(reception)) {
    if (const auto dlpdu = understood(arrived.octets)) on_dlpdu(*dlpdu, {arrived.begin, arrived.end});
  }
}

void FfStation::on_activity(segment::PortIndex, bool begins, kernel::Time now) {
  line_.on_activity(begins, now);
}

kernel::Time FfStation::may_begin() const {
  const kernel::Time since = line_.silent_since();
  return since == kernel::kNever ? since : since + silence_before_sending();
}

kernel::Time FfStation::transmit(const FfDlpdu& dlpdu, kernel::Time now) {
  return put_on_line(written(dlpdu), now);
}

kernel::Time FfStation::put_on_line(const Octets& octets, kernel::Time now) {
  return line_.transmit(octets, now);
}

// ---- what happens when ----

void FfStation::on_dlpdu(const FfDlpdu& dlpdu, const Place& place) {
  if (state_ == FfState::replying) {
    answer_.reset();
    enter(behind_answer_);
  }
  if (state_ == FfState::holding && is_of_scheduler(dlpdu.type)) {
    drop_token();
    enter(FfState::idle);
  }
  const bool is_live = state_ == FfState::idle;
  switch (dlpdu.type) {
    case FfType::pn:
      if (is_mine(dlpdu.node) && answers_probe()) answer({.type = FfType::pr, .node = node()}, place);
      return;
    case FfType::pt:
      if (!is_live || !is_mine(dlpdu.node)) return;
      token_ = Token{dlpdu, token_end(dlpdu, place)};
      enter(FfState::holding);
      return;
    case FfType::cd:
      if (!is_live || !is_mine(node_of(dlpdu.destination))) return;
      if (Buffer* const buffer = buffer_of(dlpdu.destination); buffer != nullptr && buffer->is_written) {
        FfDlpdu dt3 = published(dlpdu.destination, *buffer);
        dt3.priority = dlpdu.priority;
        answer(dt3, place);
      } else {
        answer({.type = FfType::sr,
                .is_final = true,
                .status = buffer == nullptr ? FfStatus::unknown_address : FfStatus::nothing_written},
               place);
      }
      return;
    case FfType::td:
      set_link_time(dlpdu.link_time, place.end);
      return;
    case FfType::dt1:
      on_data(dlpdu, place.end);
      return;
    case FfType::dt3:
      if (subscribed_.contains(dlpdu.source)) user_->on_published(dlpdu, place.end);
      return;
    default:
      return;
  }
}

void FfStation::on_data(const FfDlpdu& dlpdu, kernel::Time now) {
  const bool is_for_all = dlpdu.destination == kEverybody;
  if (!is_for_all && !is_mine(node_of(dlpdu.destination))) return;
  if (!configuration_.supports_long_addresses && dlpdu.has_long_addresses) return;
  const bool is_for_entity = is_for_all || (dlpdu.destination & 0xFF) == kEntity;
  if (is_for_entity && (dlpdu.source & 0xFF) == kEntity && !dlpdu.data.empty()) return on_spdu(dlpdu, now);
  user_->on_data(dlpdu, now);
}

void FfStation::on_spdu(const FfDlpdu& dlpdu, kernel::Time now) {
  const bool activates = dlpdu.data[0] == static_cast<std::uint8_t>(SpduKind::activation);
  if (!activates || state_ != FfState::offline || dlpdu.destination == kEverybody) return;
  enter(FfState::idle);
  tell(FfEventKind::activated, node(), now);
}

kernel::Time FfStation::next_time() const {
  switch (state_) {
    case FfState::holding:
      return std::min(may_begin(), token_->ends);
    case FfState::replying:
      return std::min(may_begin(), answer_->until);
    default:
      return kernel::kNever;
  }
}

void FfStation::on_time(kernel::Time now) {
  if (state_ == FfState::holding) {
    use_token(now);
  } else if (state_ == FfState::replying) {
    send_answer(now);
  }
}

void FfStation::answer(const FfDlpdu& dlpdu, const Place& place) {
  answer_ = Answer{dlpdu, answer_until(place)};
  behind_answer_ = state_;
  enter(FfState::replying);
}

void FfStation::send_answer(kernel::Time now) {
  if (!may_begin_now(now) && answer_->until > now) return;
  const Answer answer = *std::exchange(answer_, std::nullopt);
  enter(behind_answer_);
  if (may_begin_now(now)) transmit(answer.dlpdu, now);
}

// ---- the token ----

void FfStation::use_token(kernel::Time now) {
  if (token_->ends <= now) {
    drop_token();
    enter(FfState::idle);
    return;
  }
  if (!may_begin_now(now)) return;
  const Priority least = token_->by.priority;
  const auto priority = next_to_send(to_send_, least);
  if (priority && fits(dt1_of(to_send_.queue(*priority).front()), now)) {
    // Would anything follow? What becomes urgent later waits for the next token.
    const FfRequest request = to_send_.pop(*priority);
    FfDlpdu dt1 = dt1_of(request);
    const kernel::Time next_begin =
        now + frame_time(rules().link, octets_on_line(dt1, rules())) + silence_before_sending();
    const auto next = next_to_send(to_send_, least);
    const bool is_last = !next || !fits(dt1_of(to_send_.queue(*next).front()), next_begin);
    dt1.is_final = is_last && rules().returns_with_last_data;
    transmit(dt1, now);
    if (!dt1.is_final || returns_by_rt(true)) return;
  } else if (returns_by_rt(false)) {
    const FfDlpdu rt{.type = FfType::rt};
    if (fits(rt, now)) transmit(rt, now);
  }
  drop_token();
  enter(FfState::idle);
}

FfDlpdu FfStation::dt1_of(const FfRequest& request) const {
  const bool has_long_addresses = is_long(request.destination);
  // The own address has the link of the destination, which is where it is heard.
  const FfAddress source = address_of(node(), kEntity + 1) | (request.destination & 0xFFFF0000U);
  return {.type = FfType::dt1,
          .priority = request.priority,
          .has_long_addresses = has_long_addresses,
          .destination = request.destination,
          .source = source,
          .data = request.data};
}

// ---- link time ----

std::uint64_t FfStation::link_time(kernel::Time now) const {
  return told_time_ + static_cast<std::uint64_t>((now - told_at_) / kTick);
}

kernel::Time FfStation::instant_of(std::uint64_t ticks) const {
  return told_at_ + static_cast<std::int64_t>(ticks - told_time_) * kTick;
}

void FfStation::set_link_time(std::uint64_t ticks, kernel::Time now) {
  told_time_ = ticks;
  told_at_ = now;
}

// ---- decisions ----

std::optional<FfDlpdu> FfStation::understood(std::span<const std::uint8_t> octets) const {
  return ff_dlpdu_of(octets, rules());
}

kernel::Duration FfStation::silence_before_sending() const {
  return octet_times(rules().link.inter_pdu_delay_octets);
}

kernel::Time FfStation::token_end(const FfDlpdu& pt, const Place& place) const {
  return place.end + octet_times(pt.duration);
}

std::optional<Priority> FfStation::next_to_send(const Queues& queues, Priority least) const {
  for (const Priority priority : Queues::kMostUrgentFirst) {
    if (may_send(priority, least) && !queues.queue(priority).empty()) return priority;
  }
  return std::nullopt;
}

kernel::Duration FfStation::needed_for(const FfDlpdu& dlpdu) const {
  return frame_time(rules().link, octets_on_line(dlpdu, rules()));
}

bool FfStation::fits(const FfDlpdu& dlpdu, kernel::Time begin) const {
  return begin + needed_for(dlpdu) <= token_->ends;
}

FfDlpdu FfStation::published(FfAddress address, Buffer& buffer) {
  return {.type = FfType::dt3,
          .has_long_addresses = is_long(address),
          .is_final = true,
          .source = address,
          .writes = buffer.writes,
          .data = buffer.data};
}

bool FfStation::is_too_long(Priority priority, std::size_t octets) const {
  return octets > most_data(rules().link, priority);
}

}  // namespace fieldproof::fieldbus_dll

#include "conformance/fieldbus_dll/isa_model.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaEventKind;
using fieldbus_dll::IsaService;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;
using kernel::Duration;
using kernel::Time;

constexpr std::array kPrioritiesOfIsa{Priority::urgent, Priority::normal, Priority::time_available};
constexpr std::uint8_t kFinalOfIsa = 0x04;
constexpr std::size_t kHeaderOfIsa = 3;
constexpr std::size_t kOctetsOfAnEnd = kHeaderOfIsa + 1;

std::uint8_t control_with(std::uint8_t code, Priority priority) {
  return static_cast<std::uint8_t>(code | static_cast<unsigned>(priority));
}

}  // namespace

void IsaModel::set_supply(bool is_on) {
  has_supply_ = is_on;
  if (is_on) return;
  to_send_ = {};
  replies_ = {};
  token_.reset();
  awaited_.reset();
  answer_.reset();
}

bool IsaModel::submit(IsaService service, Priority priority, std::uint8_t destination, const Octets& data,
                      Time now) {
  const auto number = static_cast<std::size_t>(priority);
  if (data.size() > rules_.link.most_data.at(number - 1)) return false;
  const bool is_address = (destination >= rules_.first_address && destination <= rules_.last_address) ||
                          (service == IsaService::unit_data && destination == rules_.everybody);
  if (service != IsaService::reply_data && !is_address) return false;
  if (service == IsaService::compel && !data.empty()) return false;
  if (service == IsaService::reply_data) reply_since_ = now;
  (service == IsaService::reply_data ? replies_ : to_send_)
      .at(number)
      .push_back({service == IsaService::compel, priority, destination, data});
  return true;
}

// ---- what was heard ----

// A DLPDU came in place of a reply, and nothing else comes of it: the station has no token any more.
bool IsaModel::is_another_dlpdu_for_waiting(Time end) {
  silent_since_ = end;
  answer_.reset();
  if (!std::exchange(awaited_, std::nullopt)) return false;
  token_.reset();
  return true;
}

void IsaModel::hear_noise(Time end) {
  silent_since_ = end;
  if (awaited_ && awaited_->until <= end) miss_reply();
}

void IsaModel::miss_reply() {
  report(IsaEventKind::reply_missing, awaited_->node);
  resumes_at_ = awaited_->until;
  awaited_.reset();
}

void IsaModel::hear(const Octets& octets, Time begin, Time end) {
  if (awaited_ && awaited_->until <= begin) miss_reply();
  const auto dlpdu = isa_dlpdu_of(octets, rules_);
  if (!dlpdu || !has_supply_) return hear_noise(end);
  const bool is_mine = dlpdu->destination == address_;
  const bool is_reply = awaited_ && dlpdu->type == IsaType::dt && is_mine && dlpdu->source == awaited_->node;
  const bool is_another = awaited_ && !is_reply;
  if (is_another) report(IsaEventKind::token_dropped, dlpdu->source);
  const bool is_token = dlpdu->type == IsaType::et || dlpdu->type == IsaType::es;
  if (is_token && is_mine) {
    hear_token(dlpdu->priority,
               dlpdu->type == IsaType::es ? std::optional<unsigned>(dlpdu->duration) : std::nullopt,
               dlpdu->source, end);
  } else if (dlpdu->type == IsaType::cd && is_mine) {
    hear_cd(dlpdu->priority, dlpdu->source, end);
  } else if (is_reply) {
    hear_dt(dlpdu->source, end);
  } else {
    hear_other(is_of_scheduler(dlpdu->type), end);
  }
  const bool is_data = (dlpdu->type == IsaType::dt && is_mine) ||
                       (dlpdu->type == IsaType::du && (is_mine || dlpdu->destination == rules_.everybody));
  if (is_data && !is_another) reports_.push_back({*dlpdu});
}

void IsaModel::hear_other(bool is_of_scheduler, Time end) {
  if (!is_another_dlpdu_for_waiting(end) && is_of_scheduler) token_.reset();
}

void IsaModel::hear_token(Priority least, std::optional<unsigned> duration, std::uint8_t from, Time end) {
  if (is_another_dlpdu_for_waiting(end)) return;
  token_ = Token{from, least, {}};
  if (duration) token_->ends = end + times(*duration);
}

void IsaModel::hear_cd(Priority least, std::uint8_t from, Time end) {
  if (is_another_dlpdu_for_waiting(end)) return;
  // Who holds a token is not compelled; whose token is over holds none.
  if (token_ && token_->ends && *token_->ends <= end) token_.reset();
  if (token_) return;
  answer_ = Answer{least, from, end + times(rules_.reply_forming_octets)};
}

void IsaModel::hear_dt(std::uint8_t from, Time end) {
  if (awaited_ && awaited_->node == from) {
    awaited_.reset();
    silent_since_ = end;
    return;
  }
  hear_other(false, end);
}

// ---- what is said ----

Duration IsaModel::frame_of(std::size_t octets) const {
  constexpr std::size_t kCheck = 2;
  return frame_time(rules_.link, octets + kCheck);
}

Time IsaModel::earliest() const {
  const Time silent = silent_since_ + times(rules_.link.inter_pdu_delay_octets);
  return std::max(awaited_ ? awaited_->until : resumes_at_, silent);
}

// Before anything was seen of it: a slot time.
Duration IsaModel::delay() const {
  return slowest_.value_or(times(rules_.link.slot_time_octets));
}

std::deque<IsaModel::Request>* IsaModel::most_urgent(Queues& queues, Priority least) {
  for (const Priority priority : kPrioritiesOfIsa) {
    auto& queue = queues.at(static_cast<std::size_t>(priority));
    if (priority >= least && !queue.empty()) return &queue;
  }
  return nullptr;
}

std::optional<std::uint8_t> IsaModel::compelled() const {
  if (!awaited_) return std::nullopt;
  return awaited_->node;
}

std::optional<LinkObjection> IsaModel::say(const DrivenDlpdu& dlpdu) {
  const Time begin = dlpdu.begin + kLinkRounding;
  if (awaited_ && begin < awaited_->until)
    return LinkObjection{"does_not_wait_for_reply", "V(RR) of silence after its CD, or a reply"};
  if (begin < earliest())
    return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  if (!answer_ && !token_)
    return LinkObjection{"speaks_unasked", "silence: nothing that it received asks for it"};
  const bool was_waiting = awaited_.has_value();
  if (awaited_) miss_reply();
  const Time from = answer_ ? std::max(earliest(), reply_since_) : earliest();
  const Duration later = std::max(dlpdu.begin - from, Duration{});
  if (was_waiting && slowest_ && later > *slowest_ + times(1))
    return LinkObjection{"waits_too_long_for_reply",
                         "it goes on when V(RR) is over, as soon as it does after V(MID)"};
  slowest_ = std::max(slowest_.value_or(later), later);
  auto objection = answer_ ? say_reply(dlpdu) : say_under_token(dlpdu);
  silent_since_ = dlpdu.end;
  return objection;
}

Octets IsaModel::expected_reply() {
  auto* const queue = most_urgent(replies_, answer_->least);
  const Priority priority = queue == nullptr ? answer_->least : queue->front().priority;
  Octets dt{static_cast<std::uint8_t>(control_with(rules_.codes.dt, priority) | kFinalOfIsa), answer_->to,
            address_};
  if (queue == nullptr) return dt;
  dt.insert(dt.end(), queue->front().data.begin(), queue->front().data.end());
  queue->pop_front();
  return dt;
}

std::optional<LinkObjection> IsaModel::say_reply(const DrivenDlpdu& dlpdu) {
  if (works_ && most_urgent(replies_, answer_->least) == nullptr)
    return LinkObjection{"does_not_wait_for_user", "silence: its user works on data for the CD"};
  const Octets expected = expected_reply();
  const Time until = std::exchange(answer_, std::nullopt)->until;
  if (dlpdu.begin > until + kLinkRounding)
    return LinkObjection{"replies_too_late", "it begins within V(FD), or is not sent"};
  if (dlpdu.octets == expected) return std::nullopt;
  return LinkObjection{"reply_wrong", words_of(expected, rules_)};
}

bool IsaModel::fits(const Request& request, Time begin) const {
  if (!token_->ends) return true;
  Duration needed = times(rules_.link.inter_pdu_delay_octets) + frame_of(kOctetsOfAnEnd);
  if (request.compels) {
    const std::size_t reply = most_data(rules_.link, request.priority);
    needed += frame_of(kHeaderOfIsa) + times(rules_.reply_wait_octets) + frame_of(kHeaderOfIsa + reply);
  } else {
    needed += frame_of(kHeaderOfIsa + request.data.size());
  }
  return begin + needed <= *token_->ends + kLinkRounding;
}

std::optional<LinkObjection> IsaModel::say_under_token(const DrivenDlpdu& dlpdu) {
  const Time since = std::max(resumes_at_, silent_since_);
  if (dlpdu.begin > since + times(rules_.reply_wait_octets) + kLinkRounding)
    return LinkObjection{"answers_too_late", "who holds the token is not silent for longer than V(RR)"};
  if (token_->ends && dlpdu.end > *token_->ends + kLinkRounding)
    return LinkObjection{"longer_than_the_token", "all that it sends ends within the duration of the token"};
  return (dlpdu.octet(0) & 0xF0U) == rules_.codes.ee ? say_end(dlpdu) : say_request(dlpdu);
}

std::optional<LinkObjection> IsaModel::say_request(const DrivenDlpdu& dlpdu) {
  if (!token_->ends && token_->is_used)
    return LinkObjection{"sends_two_frames", "EE: under an ET there is one frame"};
  auto* const queue = most_urgent(to_send_, token_->least);
  if (queue == nullptr) return LinkObjection{"sends_other_data", "EE: nothing may be sent under this token"};
  const Request request = queue->front();
  Octets expected{control_with(request.compels ? rules_.codes.cd : rules_.codes.du, request.priority),
                  request.destination, address_};
  expected.insert(expected.end(), request.data.begin(), request.data.end());
  Octets said = dlpdu.octets;
  // Whether a DU has F is not said anywhere.
  if (!said.empty() && !request.compels) said[0] &= static_cast<std::uint8_t>(~kFinalOfIsa);
  if (said != expected) return LinkObjection{"sends_other_data", words_of(expected, rules_)};
  if (!fits(request, dlpdu.begin))
    return LinkObjection{"sends_without_time", "EE: what must follow does not end within the duration"};
  queue->pop_front();
  token_->is_used = true;
  if (request.compels) awaited_ = Awaited{request.destination, dlpdu.end + times(rules_.reply_wait_octets)};
  return std::nullopt;
}

std::optional<LinkObjection> IsaModel::say_end(const DrivenDlpdu& dlpdu) {
  const bool is_done = !token_->ends && token_->is_used;
  auto* const queue = most_urgent(to_send_, token_->least);
  const Time latest = dlpdu.begin + kLinkRounding + rounding_of_sums(rules_.link);
  if (!is_done && queue != nullptr && fits(queue->front(), latest))
    return LinkObjection{"data_held_back", "the most urgent that waits: it fits"};
  const std::uint8_t reason = is_done ? 2 : queue == nullptr ? 0 : 1;
  const Octets expected{static_cast<std::uint8_t>(rules_.codes.ee | kFinalOfIsa), token_->from, address_,
                        reason};
  token_.reset();
  if (dlpdu.octets == expected) return std::nullopt;
  return LinkObjection{"end_wrong", words_of(expected, rules_)};
}

std::optional<LinkObjection> IsaModel::be_silent() {
  if (awaited_) miss_reply();
  if (answer_) {
    const bool has_data = most_urgent(replies_, answer_->least) != nullptr;
    const Time begin = std::max(earliest(), has_data ? reply_since_ : kernel::kStart) + delay();
    // What comes when its time is over may be left.
    const bool is_there = has_data && reply_since_ < answer_->until;
    if (begin <= answer_->until && (is_there || !works_)) {
      const Octets expected = expected_reply();
      answer_.reset();
      return LinkObjection{"no_reply", words_of(expected, rules_)};
    }
    answer_.reset();
    return std::nullopt;
  }
  const auto token = std::exchange(token_, std::nullopt);
  // An EE that would begin as late as it may has no place any more.
  if (!token || (token->ends && earliest() + delay() + frame_of(kOctetsOfAnEnd) > *token->ends))
    return std::nullopt;
  return LinkObjection{"token_not_returned", "EE"};
}

}  // namespace fieldproof::conformance

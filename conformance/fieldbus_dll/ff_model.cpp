#include "conformance/fieldbus_dll/ff_model.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfDlpdu;
using fieldbus_dll::FfRequest;
using fieldbus_dll::FfType;
using fieldbus_dll::Priority;
using kernel::Time;

constexpr unsigned kFinalUse = 0x04;
constexpr unsigned kLongUse = 0x08;

std::size_t number_of(Priority priority) {
  return static_cast<std::size_t>(priority);
}

std::uint8_t control_of(unsigned code, Priority priority, FfAddress address) {
  return static_cast<std::uint8_t>(code | number_of(priority) |
                                   (fieldbus_dll::is_long(address) ? kLongUse : 0U));
}

std::string words_of_any(const std::vector<Octets>& all, const fieldbus_dll::FfRules& rules) {
  std::string text;
  for (const Octets& one : all) text += (text.empty() ? "" : ", or ") + words_of(one, rules);
  return text;
}

}  // namespace

FfModel::FfModel(const fieldbus_dll::FfConfiguration& configuration, bool is_live)
    : configuration_(configuration), is_live_(is_live) {
  for (const FfAddress address : configuration.published) buffers_[address] = {};
}

void FfModel::set_supply(bool is_on) {
  has_supply_ = is_on;
  if (is_on) return;
  is_live_ = false;
  queues_ = {};
  for (auto& [address, buffer] : buffers_) buffer = {};
  token_.reset();
  answer_.reset();
}

// ---- the user ----

std::size_t FfModel::most_data(Priority priority) const {
  return configuration_.rules.link.most_data.at(number_of(priority) - 1);
}

bool FfModel::submit(const FfRequest& request) {
  if (number_of(request.priority) < 1 || number_of(request.priority) > 3) return false;
  if (request.data.size() > most_data(request.priority)) return false;
  queues_.at(number_of(request.priority)).push_back(request);
  return true;
}

bool FfModel::write(FfAddress address, const Octets& data) {
  const auto found = buffers_.find(address);
  if (found == buffers_.end() || data.size() > most_data(Priority::urgent)) return false;
  found->second = {data, found->second.writes + 1, true};
  // The device may have taken the buffer already, or may do so until it begins.
  if (answer_ && answer_->published == address) {
    answer_->allowed.push_back(dt3_of(address, answer_->priority));
    answer_->reason = "published_wrong";
  }
  return true;
}

// ---- what was heard ----

void FfModel::hear(const Octets& octets, Time end) {
  silent_since_ = end;
  const auto dlpdu = ff_dlpdu_of(octets, configuration_.rules);
  if (!dlpdu || !has_supply_) return;
  answer_.reset();
  if (is_of_scheduler(dlpdu->type)) token_.reset();
  const Time until = end + response_delay(configuration_.rules.link);
  if (dlpdu->type == FfType::dt1) hear_data(*dlpdu);
  if (dlpdu->type == FfType::dt3 && std::ranges::count(configuration_.subscribed, dlpdu->source) > 0)
    reports_.push_back({FfReport::Kind::published, *dlpdu});
  if (dlpdu->type == FfType::pn && dlpdu->node == configuration_.node)
    answer_ = Answer{{{configuration_.rules.codes.pr, configuration_.node}}, "dlpdu_wrong", until};
  if (!is_live_) return;
  if (dlpdu->type == FfType::cd && is_mine(dlpdu->destination)) hear_cd(*dlpdu, until);
  if (dlpdu->type == FfType::pt && dlpdu->node == configuration_.node)
    token_ = Token{dlpdu->priority, end + fieldbus_dll::octets(configuration_.rules.link, dlpdu->duration)};
}

void FfModel::hear_data(const FfDlpdu& dlpdu) {
  const bool is_for_all = dlpdu.destination == fieldbus_dll::kEverybody;
  if (!is_for_all && !is_mine(dlpdu.destination)) return;
  if (dlpdu.has_long_addresses && !configuration_.supports_long_addresses) return;
  const auto is_of_entity = [](FfAddress one) { return (one & 0xFF) == fieldbus_dll::kEntity; };
  const bool is_between_entities =
      (is_for_all || is_of_entity(dlpdu.destination)) && is_of_entity(dlpdu.source) && !dlpdu.data.empty();
  if (!is_between_entities) return reports_.push_back({FfReport::Kind::data, dlpdu});
  const bool is_activation = dlpdu.data[0] == static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation);
  if (!is_activation || is_for_all || is_live_) return;
  is_live_ = true;
  reports_.push_back(
      {FfReport::Kind::event, {}, {fieldbus_dll::FfEventKind::activated, configuration_.node}});
}

void FfModel::hear_cd(const FfDlpdu& cd, Time until) {
  const auto found = buffers_.find(cd.destination);
  const bool is_its_own = found != buffers_.end();
  answer_ = Answer{.allowed = {}, .reason = "published_wrong", .until = until, .priority = cd.priority};
  if (is_its_own) answer_->published = cd.destination;
  if (is_its_own && found->second.is_written) {
    answer_->allowed = {dt3_of(cd.destination, cd.priority)};
    return;
  }
  const std::uint8_t why = is_its_own ? 1 : 0;
  answer_->allowed = {{static_cast<std::uint8_t>(configuration_.rules.codes.sr | kFinalUse), why}};
  answer_->reason = "dlpdu_wrong";
}

Octets FfModel::dt3_of(FfAddress address, Priority priority) const {
  const Buffer& buffer = buffers_.at(address);
  Octets dt3{control_of(configuration_.rules.codes.dt3 | kFinalUse, priority, address)};
  append_address(dt3, address);
  dt3.push_back(static_cast<std::uint8_t>(buffer.writes & 0xFFU));
  dt3.insert(dt3.end(), buffer.data.begin(), buffer.data.end());
  return dt3;
}

Octets FfModel::dt1_of(const FfRequest& request) const {
  constexpr FfAddress kUser = 1;
  constexpr FfAddress kLinkOfAddress = 0xFFFF0000U;
  Octets dt1{control_of(configuration_.rules.codes.dt1, request.priority, request.destination)};
  append_address(dt1, request.destination);
  append_address(
      dt1, (request.destination & kLinkOfAddress) | fieldbus_dll::address_of(configuration_.node, kUser));
  dt1.insert(dt1.end(), request.data.begin(), request.data.end());
  return dt1;
}

// ---- what is said ----

Time FfModel::earliest() const {
  const auto& link = configuration_.rules.link;
  return silent_since_ + fieldbus_dll::octets(link, link.inter_pdu_delay_octets);
}

// Before anything was seen of it: a slot time.
kernel::Duration FfModel::delay() const {
  const auto& link = configuration_.rules.link;
  return slowest_.value_or(fieldbus_dll::octets(link, link.slot_time_octets));
}

Time FfModel::latest_of_token() const {
  return silent_since_ + response_delay(configuration_.rules.link);
}

Time FfModel::end_of(std::size_t octets, Time begin) const {
  constexpr std::size_t kCheckOctets = 2;
  return begin + frame_time(configuration_.rules.link, octets + kCheckOctets);
}

std::deque<FfRequest>* FfModel::next_to_send() {
  for (std::size_t priority = 3; priority >= number_of(token_->least); --priority)
    if (!queues_.at(priority).empty()) return &queues_.at(priority);
  return nullptr;
}

bool FfModel::fits(const FfRequest& next, Time begin) const {
  return end_of(dt1_of(next).size(), begin) <= token_->ends;
}

std::optional<LinkObjection> FfModel::say(const DrivenDlpdu& dlpdu) {
  const bool is_early = dlpdu.begin + kLinkRounding < earliest();
  if (is_early) return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  if (!answer_ && !token_)
    return LinkObjection{"speaks_unasked", "silence: nothing that it received asks for it"};
  const kernel::Duration later = std::max(dlpdu.begin - earliest(), kernel::Duration{});
  slowest_ = std::max(slowest_.value_or(later), later);
  auto objection = answer_ ? say_answer(dlpdu) : say_under_token(dlpdu);
  silent_since_ = dlpdu.end;
  return objection;
}

std::optional<LinkObjection> FfModel::say_answer(const DrivenDlpdu& dlpdu) {
  const Answer answer = *std::exchange(answer_, std::nullopt);
  if (dlpdu.begin > answer.until + kLinkRounding)
    return LinkObjection{"answers_too_late", "it begins within V(MRD) x V(ST), or is not sent"};
  if (std::ranges::count(answer.allowed, dlpdu.octets) > 0) return std::nullopt;
  return LinkObjection{answer.reason, words_of_any(answer.allowed, configuration_.rules)};
}

std::optional<LinkObjection> FfModel::say_under_token(const DrivenDlpdu& dlpdu) {
  if (dlpdu.end > token_->ends + kLinkRounding)
    return LinkObjection{"longer_than_the_token", "all that it sends ends within the duration of the token"};
  if (dlpdu.begin > latest_of_token() + kLinkRounding)
    return LinkObjection{"answers_too_late",
                         "who holds the token is not silent for longer than V(MRD) x V(ST)"};
  const auto& codes = configuration_.rules.codes;
  if (dlpdu.octets == Octets{codes.rt}) return return_token(dlpdu);
  const unsigned free = kLongUse | kFinalUse | 0x03U;
  if ((dlpdu.octet(0) & ~free) == codes.dt1) return say_data(dlpdu);
  return LinkObjection{"unexpected_dlpdu", "DT1 or RT"};
}

std::optional<LinkObjection> FfModel::say_data(const DrivenDlpdu& dlpdu) {
  std::deque<FfRequest>* const next = next_to_send();
  if (next == nullptr) return LinkObjection{"sends_other_data", "RT: nothing may be sent under this token"};
  Octets expected = dt1_of(next->front());
  const bool is_final = (dlpdu.octet(0) & kFinalUse) != 0;
  if (is_final) expected[0] |= kFinalUse;
  if (dlpdu.octets != expected)
    return LinkObjection{"sends_other_data", words_of(expected, configuration_.rules)};
  next->pop_front();
  token_->is_used = true;
  // Who needs its time between two frames returns the token a little sooner.
  const std::deque<FfRequest>* const following = next_to_send();
  const kernel::Duration gap =
      fieldbus_dll::octets(configuration_.rules.link, configuration_.rules.link.inter_pdu_delay_octets);
  const bool may_follow = following != nullptr && fits(following->front(), dlpdu.end + gap - kLinkRounding);
  const bool must_follow =
      following != nullptr &&
      fits(following->front(), dlpdu.end + gap + delay() + rounding_of_sums(configuration_.rules.link));
  if (is_final) token_.reset();
  if (!configuration_.rules.returns_with_last_data) {
    if (is_final) return LinkObjection{"returned_with_data", "no F: the token is returned by an RT"};
    return std::nullopt;
  }
  if (is_final && must_follow)
    return LinkObjection{"data_held_back", "more data: there is some, and it fits"};
  if (!is_final && !may_follow)
    return LinkObjection{"last_without_final",
                         "F: nothing else fits or is there, so this one returns the token"};
  return std::nullopt;
}

std::optional<LinkObjection> FfModel::return_token(const DrivenDlpdu& dlpdu) {
  std::deque<FfRequest>* const next = next_to_send();
  const bool is_held_back =
      next != nullptr && fits(next->front(), dlpdu.begin + rounding_of_sums(configuration_.rules.link));
  std::optional<LinkObjection> objection;
  if (is_held_back)
    objection = LinkObjection{"data_held_back", words_of(dt1_of(next->front()), configuration_.rules)};
  token_.reset();
  return objection;
}

std::optional<LinkObjection> FfModel::be_silent() {
  if (const auto answer = std::exchange(answer_, std::nullopt)) {
    if (earliest() + delay() > answer->until) return std::nullopt;
    return LinkObjection{"no_answer", words_of_any(answer->allowed, configuration_.rules)};
  }
  const auto token = std::exchange(token_, std::nullopt);
  if (!token || end_of(1, earliest() + delay()) > token->ends) return std::nullopt;
  return LinkObjection{"token_not_returned", "the token is returned, by RT or by F"};
}

}  // namespace fieldproof::conformance

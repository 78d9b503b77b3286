#include "conformance/fieldbus_dll/ff_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/link_bench.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;
using kernel::Time;

constexpr std::array kPrioritiesOfFf{Priority::urgent, Priority::normal, Priority::time_available};
constexpr unsigned kFinalUse = 0x04;
constexpr unsigned kLongUse = 0x08;
// Control octet and two short addresses.
constexpr std::size_t kHeaderOfDt1 = 5;

std::size_t number_of(Priority priority) {
  return static_cast<std::size_t>(priority);
}

std::string text_of_any(const std::vector<Octets>& all) {
  std::string text;
  for (const Octets& one : all)
    text += fmt::format("{}{:02X}", text.empty() ? "" : ", or ", fmt::join(one, " "));
  return text;
}

}  // namespace

FfModel::FfModel(const fieldbus_dll::FfConfiguration& configuration) : configuration_(configuration) {
  for (const FfAddress address : configuration.published) buffers_[address] = {};
}

// ---- the user ----

std::size_t FfModel::most_data(Priority priority) const {
  return configuration_.rules.link.most_data.at(number_of(priority) - 1);
}

bool FfModel::submit(Priority priority, const Octets& data) {
  if (data.size() > most_data(priority)) return false;
  queues_.at(number_of(priority)).push_back(data);
  return true;
}

bool FfModel::write(FfAddress address, const Octets& data) {
  const auto found = buffers_.find(address);
  if (found == buffers_.end() || data.size() > most_data(Priority::urgent)) return false;
  found->second.data = data;
  ++found->second.writes;
  // The device may have taken the buffer already, or may do so until it begins.
  if (answer_ && answer_->published == address) {
    answer_->allowed.push_back(dt3_of(address, answer_->priority));
    answer_->reason = "published_wrong";
  }
  return true;
}

// ---- what was heard ----

void FfModel::hear_dlpdu(Time end) {
  answer_.reset();
  silent_since_ = end;
}

void FfModel::hear_other(bool is_of_scheduler, Time end) {
  hear_dlpdu(end);
  if (is_of_scheduler) token_.reset();
}

void FfModel::hear_token(Priority least, unsigned duration, Time end) {
  hear_dlpdu(end);
  token_ = Token{least, end + fieldbus_dll::octets(configuration_.rules.link, duration)};
}

void FfModel::hear_probe(Time end) {
  hear_other(true, end);
  answer_ = Answer{{{configuration_.rules.codes.pr, configuration_.node}},
                   "dlpdu_wrong",
                   end + response_delay(configuration_.rules.link)};
}

void FfModel::hear_cd(FfAddress address, Priority priority, Time end) {
  hear_other(true, end);
  const auto& codes = configuration_.rules.codes;
  const Time until = end + response_delay(configuration_.rules.link);
  const auto found = buffers_.find(address);
  const bool is_its_own = found != buffers_.end();
  answer_ = Answer{.allowed = {}, .reason = "published_wrong", .until = until, .priority = priority};
  if (is_its_own) answer_->published = address;
  if (is_its_own && found->second.writes > 0) {
    answer_->allowed = {dt3_of(address, priority)};
    return;
  }
  const std::uint8_t why = is_its_own ? 1 : 0;
  answer_->allowed = {{static_cast<std::uint8_t>(codes.sr | kFinalUse), why}};
  answer_->reason = "dlpdu_wrong";
  answer_->may_be_left = true;
}

Octets FfModel::dt3_of(FfAddress address, Priority priority) const {
  const Buffer& buffer = buffers_.at(address);
  Octets dt3{
      static_cast<std::uint8_t>(configuration_.rules.codes.dt3 | kFinalUse | static_cast<unsigned>(priority)),
      static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address & 0xFFU),
      static_cast<std::uint8_t>(buffer.writes & 0xFFU)};
  dt3.insert(dt3.end(), buffer.data.begin(), buffer.data.end());
  return dt3;
}

// ---- what is said ----

Time FfModel::earliest() const {
  const auto& link = configuration_.rules.link;
  return silent_since_ + fieldbus_dll::octets(link, link.inter_pdu_delay_octets);
}

Time FfModel::latest_of_token() const {
  return silent_since_ + response_delay(configuration_.rules.link);
}

Time FfModel::end_of(std::size_t octets, Time begin) const {
  constexpr std::size_t kCheckOctets = 2;
  return begin + frame_time(configuration_.rules.link, octets + kCheckOctets);
}

std::optional<FfModel::Next> FfModel::next_to_send() const {
  for (const Priority priority : kPrioritiesOfFf) {
    const auto& queue = queues_.at(number_of(priority));
    if (priority >= token_->least && !queue.empty()) return Next{priority, queue.front()};
  }
  return std::nullopt;
}

bool FfModel::fits(const Next& next, Time begin) const {
  return end_of(kHeaderOfDt1 + next.data.size(), begin) <= token_->ends;
}

std::optional<LinkObjection> FfModel::say(const DrivenDlpdu& dlpdu) {
  const bool is_early = dlpdu.begin + kLinkRounding < earliest();
  if (is_early) return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  if (!answer_ && !token_)
    return LinkObjection{"speaks_unasked", "silence: nothing that it received asks for it"};
  auto objection = answer_ ? say_answer(dlpdu) : say_under_token(dlpdu);
  silent_since_ = dlpdu.end;
  return objection;
}

std::optional<LinkObjection> FfModel::say_answer(const DrivenDlpdu& dlpdu) {
  const Answer answer = *std::exchange(answer_, std::nullopt);
  if (dlpdu.begin > answer.until + kLinkRounding)
    return LinkObjection{"answers_too_late", "it begins within V(MRD) x V(ST), or is not sent"};
  for (const Octets& allowed : answer.allowed) {
    if (dlpdu.octets == allowed) return std::nullopt;
    Octets without_final = allowed;
    without_final[0] = static_cast<std::uint8_t>(without_final[0] & ~kFinalUse);
    if (dlpdu.octets == without_final && dlpdu.octet(0) != allowed[0]) {
      answer_ = Answer{{{configuration_.rules.codes.rt}},
                       "token_not_returned",
                       dlpdu.end + response_delay(configuration_.rules.link)};
      return std::nullopt;
    }
  }
  return LinkObjection{answer.reason, text_of_any(answer.allowed)};
}

std::optional<LinkObjection> FfModel::say_under_token(const DrivenDlpdu& dlpdu) {
  if (dlpdu.end > token_->ends + kLinkRounding)
    return LinkObjection{"longer_than_the_token", "all that it sends ends within the duration of the token"};
  if (dlpdu.begin > latest_of_token() + kLinkRounding)
    return LinkObjection{"answers_too_late",
                         "who holds the token is not silent for longer than V(MRD) x V(ST)"};
  const auto& codes = configuration_.rules.codes;
  if (dlpdu.octets == Octets{codes.rt}) return return_token(dlpdu);
  constexpr std::size_t kRi = 3;
  if (dlpdu.octet(0) == codes.ri && dlpdu.octets.size() == kRi) return std::nullopt;
  const unsigned free = kLongUse | kFinalUse | 0x03U;
  if ((dlpdu.octet(0) & ~free) == codes.dt1) return say_data(dlpdu);
  return LinkObjection{"unexpected_dlpdu", "DT1 or RT"};
}

std::optional<LinkObjection> FfModel::say_data(const DrivenDlpdu& dlpdu) {
  const auto next = next_to_send();
  if (!next) return LinkObjection{"sends_other_data", "RT: nothing may be sent under this token"};
  const auto priority = static_cast<Priority>(dlpdu.octet(0) & 0x03U);
  const Octets& octets = dlpdu.octets;
  const bool is_next =
      priority == next->priority && octets.size() >= kHeaderOfDt1 &&
      std::equal(octets.begin() + kHeaderOfDt1, octets.end(), next->data.begin(), next->data.end());
  if (!is_next) {
    return LinkObjection{"sends_other_data",
                         fmt::format("the most urgent that waits, {}: {:02X}", text_of(next->priority),
                                     fmt::join(next->data, " "))};
  }
  queues_.at(number_of(priority)).pop_front();
  if ((dlpdu.octet(0) & kFinalUse) == 0) return std::nullopt;
  // Who needs its time between two frames returns the token a little sooner.
  const auto behind = next_to_send();
  const Time again = dlpdu.end + response_delay(configuration_.rules.link);
  const bool is_held_back = behind && fits(*behind, again);
  token_.reset();
  if (!is_held_back) return std::nullopt;
  return LinkObjection{"data_held_back", "more data: there is some, and it fits"};
}

std::optional<LinkObjection> FfModel::return_token(const DrivenDlpdu& dlpdu) {
  const auto next = next_to_send();
  const bool is_held_back = next && fits(*next, dlpdu.begin);
  token_.reset();
  if (!is_held_back) return std::nullopt;
  return LinkObjection{"data_held_back", fmt::format("{:02X}", fmt::join(next->data, " "))};
}

std::optional<LinkObjection> FfModel::be_silent() {
  const auto& link = configuration_.rules.link;
  const Time slot_later = earliest() + fieldbus_dll::octets(link, link.slot_time_octets);
  if (const auto answer = std::exchange(answer_, std::nullopt)) {
    if (slot_later > answer->until || answer->may_be_left) return std::nullopt;
    return LinkObjection{"no_answer", text_of_any(answer->allowed)};
  }
  const auto token = std::exchange(token_, std::nullopt);
  if (!token || end_of(1, latest_of_token()) > token->ends) return std::nullopt;
  return LinkObjection{"token_not_returned", "the token is returned, by RT or by F"};
}

}  // namespace fieldproof::conformance

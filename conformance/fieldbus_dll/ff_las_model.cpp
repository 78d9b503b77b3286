#include "conformance/fieldbus_dll/ff_las_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/link_bench.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfEventKind;
using fieldbus_dll::kFinalBit;
using fieldbus_dll::kPriorityBits;
using fieldbus_dll::Priority;
using kernel::Duration;
using kernel::Time;

constexpr std::int64_t kMostSilentSlots = 16;
constexpr std::size_t kMostCirculations = 2;

constexpr unsigned kLongOfLas = 0x08;

bool has_las_code(const DrivenDlpdu& dlpdu, std::uint8_t code, unsigned free_bits) {
  return !dlpdu.octets.empty() && (dlpdu.octet(0) & ~free_bits) == code;
}

FfAddress address_at(const DrivenDlpdu& dlpdu, std::size_t first, std::size_t count) {
  FfAddress address = 0;
  for (std::size_t n = first; n < first + count; ++n) address = address << 8 | dlpdu.octet(n);
  return address;
}

Priority priority_said(const DrivenDlpdu& dlpdu) {
  return static_cast<Priority>(dlpdu.octet(0) & kPriorityBits);
}

unsigned grant_said(const DrivenDlpdu& pt) {
  return static_cast<unsigned>(pt.octet(2) << 8 | pt.octet(3));
}

}  // namespace

FfLasModel::FfLasModel(const fieldbus_dll::FfConfiguration& configuration) : configuration_(configuration) {
  for (const std::uint8_t node : configuration.live) nodes_.at(node).is_live = true;
}

Duration FfLasModel::times(std::int64_t octets) const {
  return fieldbus_dll::octets(rules().link, octets);
}

Time FfLasModel::due() const {
  const auto& [version, macrocycle, items] = configuration_.schedule;
  if (items.empty()) return kernel::kNever;
  const auto cycle = static_cast<std::int64_t>(items_done_ / items.size());
  return link_time_begin_ +
         (cycle * macrocycle + std::int64_t{items[items_done_ % items.size()].at}) * fieldbus_dll::kTick;
}

Time FfLasModel::silent_until() const {
  if (!is_scheduler_) return silent_since_ + claim_silence() + times(2);
  return silent_since_ + times(kMostSilentSlots * rules().link.slot_time_octets);
}

bool FfLasModel::is_open(std::uint8_t node) const {
  return nodes_.at(node).is_live && nodes_.at(node).most_misses >= misses_of_no_node();
}

bool FfLasModel::is_polled(unsigned node) const {
  const bool is_unpolled = node >= rules().first_unpolled && node < rules().first_unpolled + rules().unpolled;
  return node >= rules().first_node && node <= rules().last_node && !is_unpolled;
}

bool FfLasModel::submit(Priority priority, const Octets& data) {
  const auto number = static_cast<std::size_t>(priority);
  if (data.size() > rules().link.most_data.at(number - 1)) return false;
  queues_.at(number).push_back(data);
  return true;
}

// ---- what others say ----

void FfLasModel::hear_answer(Time end) {
  silent_since_ = end;
  if (question_) question_->is_answered = question_->is_heard = true;
}

void FfLasModel::hear_data(Time end) {
  silent_since_ = end;
  if (question_) question_->is_heard = true;
}

void FfLasModel::hear_time_request(Time end) {
  hear_data(end);
  is_asked_for_time_ = true;
}

void FfLasModel::hear_probe_response(Time end) {
  hear_answer(end);
  const std::uint8_t node = question_->node;
  expect_event(FfEventKind::node_found, node);
  nodes_.at(node) = {.is_live = true, .live_since = circulations_};
  to_activate_[node] = circulations_;
  list_changed_ = circulations_;
}

void FfLasModel::hear_noise(Time end) {
  silent_since_ = end;
  if (!question_) return;
  question_->is_noisy = true;
  are_events_certain_ = false;
}

// ---- what its user is told ----

void FfLasModel::expect_event(FfEventKind kind, std::uint8_t node) {
  if (are_events_certain_) events_.push_back({kind, node});
}

// Of what was not answered to its end.
void FfLasModel::expect_event_of(const Question& question) {
  if (question.is_answered) return;
  switch (question.asked) {
    case Asked::compels:
      if (!question.is_heard) expect_event(FfEventKind::reply_missing, question.node);
      return;
    case Asked::passes_token:
      return expect_event(question.is_heard ? FfEventKind::token_reclaimed : FfEventKind::token_missed,
                          question.node);
    case Asked::probes:
      return;
    case Asked::transfers:
      return expect_event(FfEventKind::transfer_failed, question.node);
  }
}

// ---- who is live ----

void FfLasModel::remove(std::uint8_t node) {
  if (!nodes_.at(node).was_left_open) list_changed_ = circulations_;
  nodes_.at(node) = {};
  to_activate_.erase(node);
}

void FfLasModel::show_live(std::uint8_t node) {
  unsigned& misses = nodes_.at(node).most_misses;
  misses = std::min(misses, misses_of_no_node() - 1);
}

void FfLasModel::count_token(const Question& token) {
  Node& node = nodes_.at(token.node);
  const bool is_missed = !token.is_heard && !token.is_noisy;
  node.fewest_misses = is_missed ? node.fewest_misses + 1 : 0;
  node.most_misses = token.is_heard ? 0 : node.most_misses + 1;
  if (node.fewest_misses < misses_of_no_node()) return;
  remove(token.node);
  expect_event(FfEventKind::node_removed, token.node);
}

FfLasModel::Found FfLasModel::pass_over(unsigned first, unsigned behind_last) {
  for (unsigned n = first; n < behind_last; ++n) {
    const auto node = static_cast<std::uint8_t>(n);
    if (nodes_.at(node).live_since == circulations_) continue;
    if (is_surely_live(node)) return LinkObjection{"order_wrong", fmt::format("a PT for {:02X}", node)};
    if (is_open(node)) remove(node);
  }
  return std::nullopt;
}

// ---- what it says ----

FfLasModel::Found FfLasModel::close_question(Time now) {
  free_since_ = free_latest_ = silent_since_ + times(rules().link.inter_pdu_delay_octets);
  if (!question_) return std::nullopt;
  const Question question = *std::exchange(question_, std::nullopt);
  if (!question.is_answered) {
    const Time is_late = silent_since_ + response_delay(rules().link);
    const Time over = question.token_ends;
    free_since_ = std::max(free_since_, std::min(is_late, over));
    const bool has_end = over != kernel::kNever;
    const Time taken_back = has_end ? over + times(rules().link.slot_time_octets) : over;
    free_latest_ = std::max(free_latest_, std::min(is_late, taken_back));
  }
  expect_event_of(question);
  if (question.asked == Asked::passes_token) count_token(question);
  if (now + kLinkRounding >= free_since_) return std::nullopt;
  return LinkObjection{"does_not_wait", "an answer, or silence for V(MRD) x V(ST), or the end of the token"};
}

// V(MSO) and V(MID) before what is due next, with an octet for rounding.
bool FfLasModel::has_time_for_td() const {
  constexpr std::size_t kOctetsOfTd = 9;  // with its check
  const fieldbus_dll::LinkRules& link = rules().link;
  const std::int64_t free = rules().scheduling_overhead_octets + 2 * link.inter_pdu_delay_octets + 1;
  return silent_since_ + times(free) + frame_time(link, kOctetsOfTd) <= due();
}

FfLasModel::Found FfLasModel::say(const DrivenDlpdu& dlpdu) {
  const Duration gap = times(rules().link.inter_pdu_delay_octets);
  if (!is_scheduler_) {
    Found in_standby = say_in_standby(dlpdu);
    silent_since_ = dlpdu.end;
    return in_standby;
  }
  if (dlpdu.begin + kLinkRounding < silent_since_ + gap)
    return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  if (dlpdu.begin >= silent_until())
    return LinkObjection{"line_left_silent", "silence for less than V(ST) x 16"};
  Found found;
  const bool is_asked = std::exchange(is_asked_for_time_, false);
  if (is_asked && has_las_code(dlpdu, rules().codes.td, 0)) {
    found = say_time(dlpdu, true);
  } else if (is_asked && has_time_for_td()) {
    found = LinkObjection{"time_request_ignored", "a TD: it was asked for the time"};
  } else {
    found = close_question(dlpdu.begin);
    if (!found) found = say_dlpdu(dlpdu);
  }
  silent_since_ = dlpdu.end;
  return found;
}

FfLasModel::Found FfLasModel::say_dlpdu(const DrivenDlpdu& dlpdu) {
  const auto& codes = rules().codes;
  if (dlpdu.begin > time_told_ + rules().time_distribution_period)
    return LinkObjection{"time_not_told", "a TD once in V(TDP)"};
  if (has_las_code(dlpdu, codes.dt3, kLongOfLas | kFinalBit | kPriorityBits)) return say_own_buffer(dlpdu);
  if (Found missed = pass_own_items(dlpdu)) return missed;
  if (has_las_code(dlpdu, codes.cd, kLongOfLas | kFinalBit | kPriorityBits)) return say_cd(dlpdu);
  if (dlpdu.begin > due()) return LinkObjection{"compelled_late", "the CD that is due, before all else"};
  const bool has_priority = (dlpdu.octet(0) & kPriorityBits) != 0;
  if (has_priority && has_las_code(dlpdu, codes.pt, kFinalBit | kPriorityBits)) return say_token(dlpdu);
  if (has_las_code(dlpdu, codes.pn, 0)) return say_probe(dlpdu);
  if (has_las_code(dlpdu, codes.td, 0)) return say_time(dlpdu, false);
  if (has_las_code(dlpdu, codes.dt1, kLongOfLas | kFinalBit | kPriorityBits)) return say_data(dlpdu);
  if (has_las_code(dlpdu, codes.tl, 0)) return say_transfer(dlpdu);
  if (has_las_code(dlpdu, codes.idle, 0)) return std::nullopt;
  return LinkObjection{"unexpected_dlpdu", "CD, PT, PN, TD, DT1 or IDLE"};
}

FfLasModel::Found FfLasModel::say_cd(const DrivenDlpdu& cd) {
  if (configuration_.schedule.items.empty()) return LinkObjection{"compelled_wrong", "no CD: nothing is due"};
  const auto& item = configuration_.schedule.items[items_done_ % configuration_.schedule.items.size()];
  const std::size_t octets = (cd.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  const FfAddress address = address_at(cd, 1, octets);
  if (address != item.address || priority_said(cd) != item.priority)
    return LinkObjection{"compelled_wrong", fmt::format("a CD for {:04X}", item.address)};
  const Time latest = std::max(due(), free_latest_) + times(rules().scheduling_overhead_octets);
  if (cd.begin + kLinkRounding < due())
    return LinkObjection{"compelled_early", fmt::format("not before {}", kernel::describe(due()))};
  if (cd.begin > latest + kLinkRounding)
    return LinkObjection{"compelled_late", fmt::format("until {}", kernel::describe(latest))};
  ++items_done_;
  question_ = Question{.node = fieldbus_dll::node_of(item.address), .asked = Asked::compels};
  return std::nullopt;
}

// ---- the token ----

FfLasModel::Found FfLasModel::say_token(const DrivenDlpdu& pt) {
  const std::uint8_t node = pt.octet(1);
  if (!nodes_.at(node).is_live)
    return LinkObjection{"token_for_removed", fmt::format("no PT for {:02X}: it is not live", node)};
  const bool begins = (pt.octet(0) & kFinalBit) != 0;
  Found found = begins ? begin_circulation(pt) : go_on(pt);
  if (!found) found = check_grant(pt);
  show_live(node);
  last_token_ = node;
  probes_ = 0;
  question_ =
      Question{.node = node, .asked = Asked::passes_token, .token_ends = pt.end + times(grant_said(pt))};
  return found;
}

FfLasModel::Found FfLasModel::check_grant(const DrivenDlpdu& pt) const {
  const unsigned grant = grant_said(pt);
  if (grant < rules().least_token_octets)
    return LinkObjection{"token_too_short", fmt::format("{} octets at least", rules().least_token_octets)};
  if (grant > rules().token_holding_octets)
    return LinkObjection{"token_too_long", fmt::format("{} octets at most", rules().token_holding_octets)};
  // V(MSO) and V(MID) are kept free.
  const std::int64_t free = rules().scheduling_overhead_octets + rules().link.inter_pdu_delay_octets;
  const bool is_cut = grant < rules().token_holding_octets && due() != kernel::kNever;
  if (is_cut && pt.end + times(grant + free + 2) < due())
    return LinkObjection{"token_shorter_than_the_time", "all the time that is left before the next item"};
  if (pt.end + times(grant) > due())
    return LinkObjection{"token_over_due",
                         fmt::format("a token that ends before {}", kernel::describe(due()))};
  return std::nullopt;
}

bool FfLasModel::has_to_probe() const {
  for (unsigned node = rules().first_node; node <= rules().last_node; ++node) {
    if (is_polled(node) && node != configuration_.node && !nodes_.at(node).is_live) return true;
  }
  return false;
}

FfLasModel::Found FfLasModel::begin_circulation(const DrivenDlpdu& pt) {
  if (last_token_) {
    if (auto left_out = pass_over(*last_token_ + 1U, kNodes)) return left_out;
    if (probes_ == 0 && has_to_probe()) return LinkObjection{"no_probe", "a PN between two circulations"};
  }
  ++circulations_;
  const bool is_first = std::exchange(is_first_circulation_, false);
  if (auto left_out = pass_over(0, pt.octet(1))) return left_out;
  const Priority said = priority_said(pt);
  std::vector<Priority> all{said};
  if (is_first) all = {Priority::urgent};
  if (priority_ && circulation_begin_) all = priorities_behind(pt.begin - *circulation_begin_);
  circulation_begin_ = pt.begin;
  priority_ = said;
  if (std::ranges::find(all, said) == all.end())
    return LinkObjection{"priority_wrong", fmt::format("a token with priority {}", text_of(all.front()))};
  return check_told();
}

// Both, where the rotation is V(TTRT) to an octet.
std::vector<Priority> FfLasModel::priorities_behind(Duration rotation) const {
  const Duration target = rules().target_rotation;
  std::vector<Priority> all;
  if (!rules().steers_by_three_steps) {
    if (rotation > target - times(1)) all.push_back(Priority::urgent);
    if (rotation < target + times(1)) all.push_back(Priority::time_available);
    return all;
  }
  if (rotation > target - times(1))
    all.push_back(*priority_ == Priority::time_available ? Priority::normal : Priority::urgent);
  if (rotation < target + times(1))
    all.push_back(*priority_ == Priority::urgent ? Priority::normal : Priority::time_available);
  return all;
}

FfLasModel::Found FfLasModel::check_told() const {
  for (const auto& [node, since] : to_activate_) {
    if (circulations_ - since > kMostCirculations)
      return LinkObjection{"not_activated", fmt::format("an activation for {:02X}", node)};
  }
  if (list_changed_ && circulations_ - *list_changed_ > kMostCirculations)
    return LinkObjection{"live_list_not_told", "the live list for everybody: it has changed"};
  return std::nullopt;
}

FfLasModel::Found FfLasModel::go_on(const DrivenDlpdu& pt) {
  const std::uint8_t node = pt.octet(1);
  if (!last_token_ || node <= *last_token_)
    return LinkObjection{"begin_not_marked", "the first token of a circulation marked"};
  if (auto left_out = pass_over(*last_token_ + 1U, node)) return left_out;
  if (!priority_ || priority_said(pt) == *priority_) return std::nullopt;
  return LinkObjection{"priority_wrong", fmt::format("a token with priority {}, as all of this circulation",
                                                     text_of(*priority_))};
}

// Ascending from the last one, and anew from the first; who may have been removed may be passed over.
bool FfLasModel::is_next_to_probe(std::uint8_t node) const {
  const unsigned count = rules().last_node - rules().first_node + 1U;
  const unsigned last = last_probe_.value_or(rules().last_node);
  for (unsigned n = 1; n <= count; ++n) {
    const unsigned next = rules().first_node + (last - rules().first_node + n) % count;
    const bool may_be_passed = !is_polled(next) || next == configuration_.node || nodes_.at(next).is_live;
    if (next == node) return true;
    if (!may_be_passed) return false;
  }
  return false;
}

FfLasModel::Found FfLasModel::say_probe(const DrivenDlpdu& pn) {
  const std::uint8_t node = pn.octet(1);
  if (!is_polled(node)) return LinkObjection{"probes_unpolled", "a PN for an address that may be polled"};
  if (node == configuration_.node || is_surely_live(node))
    return LinkObjection{"probes_live_node", "a PN for a node that is not live"};
  if (is_open(node)) remove(node);
  const bool is_next = is_next_to_probe(node);
  last_probe_ = node;
  // Of a circulation without a token the priority is nobody's to see.
  if (!last_token_) is_first_circulation_ = false;
  bool is_one_too_many = false;
  if (++probes_ > 1) {
    is_one_too_many = pass_over(0, kNodes).has_value();
    // A circulation without a token begins at an instant that nobody sees.
    last_token_.reset();
    circulation_begin_.reset();
  }
  question_ = Question{.node = node, .asked = Asked::probes};
  if (is_one_too_many) return LinkObjection{"second_probe", "tokens between two PNs: nodes are live"};
  if (is_next) return std::nullopt;
  return LinkObjection{"probes_out_of_order", "the next address, ascending"};
}

// ---- time and data ----

FfLasModel::Found FfLasModel::say_time(const DrivenDlpdu& td, bool is_answer) {
  const Duration period = rules().time_distribution_period * 9 / 10;
  if (!is_answer && distributed_ && td.begin + times(1) < *distributed_ + period)
    return LinkObjection{"time_told_too_often", "a TD when 0.9 x V(TDP) have passed, or for who asks"};
  if (!is_answer) distributed_ = td.begin;
  std::uint64_t ticks = 0;
  for (std::size_t n = 1; n <= 6; ++n) ticks = ticks << 8 | td.octet(n);
  const auto last = std::exchange(told_, Reported{ticks, td.end});
  time_told_ = td.begin;
  if (!last) return std::nullopt;
  const auto said = static_cast<std::int64_t>(ticks - last->ticks);
  const std::int64_t passed = (td.end - last->end) / fieldbus_dll::kTick;
  if (said >= passed - 1 && said <= passed + 2) return std::nullopt;
  return LinkObjection{"time_wrong", fmt::format("{} ticks more than before", passed)};
}

FfLasModel::Found FfLasModel::say_data(const DrivenDlpdu& dt1) {
  const std::size_t octets = (dt1.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  const FfAddress to = address_at(dt1, 1, octets);
  const FfAddress from = address_at(dt1, 1 + octets, octets);
  const std::size_t header = std::min(dt1.octets.size(), 1 + 2 * octets);
  const Octets data(dt1.octets.begin() + static_cast<std::ptrdiff_t>(header), dt1.octets.end());
  if (from != fieldbus_dll::address_of(configuration_.node, fieldbus_dll::kEntity))
    return say_of_user(dt1, data);
  const auto kind = static_cast<fieldbus_dll::SpduKind>(data.empty() ? 0 : data.front());
  if (kind == fieldbus_dll::SpduKind::activation) return say_activation(to);
  if (kind == fieldbus_dll::SpduKind::live_list) return say_live_list(data);
  return LinkObjection{"unexpected_dlpdu", "an activation or the live list"};
}

FfLasModel::Found FfLasModel::say_activation(FfAddress to) {
  const std::uint8_t node = fieldbus_dll::node_of(to);
  to_activate_.erase(node);
  if (nodes_.at(node).is_live) return std::nullopt;
  return LinkObjection{"unexpected_dlpdu", fmt::format("no activation for {:02X}: it is not live", node)};
}

FfLasModel::Found FfLasModel::say_live_list(const Octets& list) {
  for (unsigned n = 0; n < kNodes; ++n) {
    const auto node = static_cast<std::uint8_t>(n);
    const std::size_t octet = 2U + n / 8U;
    const bool is_told = octet < list.size() && (list[octet] >> (7 - n % 8) & 1) != 0;
    if (node == configuration_.node) continue;
    if (is_open(node)) {
      is_told ? show_live(node) : remove(node);
    } else if (is_told != nodes_.at(node).is_live) {
      return LinkObjection{"live_list_wrong",
                           fmt::format("{:02X} is {}live", node, nodes_.at(node).is_live ? "" : "not ")};
    }
  }
  list_changed_.reset();
  return std::nullopt;
}

FfLasModel::Found FfLasModel::say_of_user(const DrivenDlpdu& dt1, const Octets& data) {
  for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
    auto& queue = queues_.at(static_cast<std::size_t>(priority));
    if (queue.empty()) continue;
    const Octets next = queue.front();
    queue.pop_front();
    if (priority_said(dt1) == priority && data == next) return std::nullopt;
    return LinkObjection{"sends_other_data", fmt::format("the most urgent that waits, {}: {:02X}",
                                                         text_of(priority), fmt::join(next, " "))};
  }
  return LinkObjection{"sends_other_data", "no data: its user has submitted none"};
}

FfLasModel::Found FfLasModel::end() const {
  if (queues_.at(static_cast<std::size_t>(Priority::urgent)).empty()) return std::nullopt;
  return LinkObjection{"data_not_sent", "urgent data of its user, in its turn"};
}

}  // namespace fieldproof::conformance

#include "conformance/fieldbus_dll/ff_las_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/ff_las_octets.hpp"
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
constexpr std::int64_t kLeastSilentSlots = 8;
constexpr std::size_t kOctetsOfCheck = 2;
constexpr std::size_t kOctetsOfProbeResponse = 2 + kOctetsOfCheck;
constexpr std::size_t kOctetsAroundData = 5 + kOctetsOfCheck;
constexpr std::size_t kOctetsOfIdle = 1 + kOctetsOfCheck;
constexpr std::size_t kOctetsOfTransfer = 4 + kOctetsOfCheck;
constexpr std::size_t kOctetsOfTime = 7 + kOctetsOfCheck;

}  // namespace

FfLasModel::FfLasModel(const fieldbus_dll::FfConfiguration& configuration) : configuration_(configuration) {
  for (const std::uint8_t node : configuration.live) nodes_.at(node).is_live = true;
}

Duration FfLasModel::times(std::int64_t octets) const {
  return fieldbus_dll::octets(rules().link, octets);
}

Time FfLasModel::item_at(std::size_t number) const {
  const auto& [version, macrocycle, items] = configuration_.schedule;
  const auto cycle = static_cast<std::int64_t>(number / items.size());
  return link_time_begin_ +
         (cycle * macrocycle + std::int64_t{items[number % items.size()].at}) * fieldbus_dll::kTick;
}

Time FfLasModel::due() const {
  return configuration_.schedule.items.empty() ? kernel::kNever : item_at(items_done_);
}

Time FfLasModel::silent_until() const {
  if (!is_scheduler_) return silent_since_ + claim_silence() + times(2);
  const Time most = silent_since_ + times(kMostSilentSlots * rules().link.slot_time_octets);
  // An item that leaves an IDLE no time when one is due is what ends the silence.
  const Time idle = silent_since_ + times(kLeastSilentSlots * rules().link.slot_time_octets);
  if (leaves_time(idle + frame_time(rules().link, kOctetsOfIdle), 1)) return most;
  return std::max(most, next_said_item() + times(rules().scheduling_overhead_octets + 1));
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
  ++fewest_changes_;
  ++most_changes_;
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
  ++most_changes_;
  if (!nodes_.at(node).was_left_open) {
    ++fewest_changes_;
    list_changed_ = circulations_;
  }
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

// An own buffer that was never written has nothing to say.
Time FfLasModel::next_said_item() const {
  const auto& [version, macrocycle, items] = configuration_.schedule;
  const auto is_said = [&](const fieldbus_dll::FfScheduleItem& item) {
    const auto own = own_.find(item.address);
    return fieldbus_dll::node_of(item.address) != configuration_.node ||
           (own != own_.end() && own->second.since != kernel::kNever);
  };
  for (std::size_t n = 0; n < items.size(); ++n) {
    if (is_said(items[(items_done_ + n) % items.size()])) return item_at(items_done_ + n);
  }
  return kernel::kNever;
}

bool FfLasModel::leaves_time(Time end, std::int64_t spare) const {
  const Time next = next_said_item();
  const std::int64_t free =
      rules().scheduling_overhead_octets + std::int64_t{rules().link.inter_pdu_delay_octets} + spare;
  return next == kernel::kNever || end + times(free) <= next + kLinkRounding;
}

// An octet for rounding.
bool FfLasModel::has_time_for_td() const {
  const Time begin = silent_since_ + times(rules().link.inter_pdu_delay_octets);
  return leaves_time(begin + frame_time(rules().link, kOctetsOfTime), 1);
}

Duration FfLasModel::time_of(const DrivenDlpdu& dlpdu) const {
  const auto& codes = rules().codes;
  const Duration frame = dlpdu.end - dlpdu.begin;
  const Duration answer = response_delay(rules().link);
  if (has_las_code(dlpdu, codes.pn, 0))
    return frame + answer + frame_time(rules().link, kOctetsOfProbeResponse);
  if (has_las_code(dlpdu, codes.tl, 0)) return frame + answer;
  return frame;
}

// TD, then what its entity sends, then a TL, then the circulation: what was there when the line became free.
FfLasModel::Found FfLasModel::check_order(const DrivenDlpdu& dlpdu) const {
  const auto& codes = rules().codes;
  if (!leaves_time(dlpdu.begin + time_of(dlpdu), 0))
    return LinkObjection{"over_what_is_due", "all but a CD ends V(MSO) and V(MID) before the next item"};
  const auto has_time = [&](std::size_t octets, Duration more) {
    return leaves_time(dlpdu.begin + frame_time(rules().link, octets) + more, 1);
  };
  if (has_las_code(dlpdu, codes.td, 0)) return std::nullopt;
  if (td_due_ <= silent_since_ && has_time(kOctetsOfTime, {}))
    return LinkObjection{"time_not_told", "a TD, before all else that is not due: its time has come"};
  const bool is_of_entity = has_las_code(dlpdu, codes.dt1, kLongOfLas | kFinalBit | kPriorityBits) &&
                            source_of_dt1(dlpdu) == fieldbus_dll::address_of(configuration_.node);
  if (is_of_entity || has_las_code(dlpdu, codes.tl, 0)) return std::nullopt;
  if (heir_ && ordered_ <= silent_since_ && has_time(kOctetsOfTransfer, response_delay(rules().link)))
    return LinkObjection{"not_transferred", "the TL that was ordered, before the circulation goes on"};
  return std::nullopt;
}

// What is sent is all that is urgent and has time within V(DTHT).
FfLasModel::Found FfLasModel::check_own_turn(const DrivenDlpdu& next) const {
  const auto& queue = queues_.at(static_cast<std::size_t>(Priority::urgent));
  if (!own_turn_ || own_turn_->is_interrupted || queue.empty()) return std::nullopt;
  const Time end = next.begin + frame_time(rules().link, kOctetsAroundData + queue.front().size());
  const Time over = turn_since_ + times(rules().token_holding_octets);
  if (end + times(2) > over || !leaves_time(end, 2)) return std::nullopt;
  return LinkObjection{"data_not_sent", "more urgent data of its user: they have time within V(DTHT)"};
}

bool FfLasModel::is_behind_own_turn(const DrivenDlpdu& next) const {
  const auto& codes = rules().codes;
  const bool is_past_last = !last_token_ || (probes_ + idles_ == 0 && configuration_.node > *last_token_);
  if (!has_las_code(next, codes.pt, kFinalBit | kPriorityBits)) return is_past_last;
  const bool is_before_next = configuration_.node < next.octet(1);
  const bool begins = (next.octet(0) & kFinalBit) != 0;
  return begins ? is_past_last || is_before_next : is_past_last && is_before_next;
}

void FfLasModel::note_own_turn(const DrivenDlpdu& next) {
  const auto& codes = rules().codes;
  const auto& queue = queues_.at(static_cast<std::size_t>(Priority::urgent));
  has_time_in_turn_ =
      has_time_in_turn_ && !queue.empty() &&
      leaves_time(next.begin + frame_time(rules().link, kOctetsAroundData + queue.front().size()), 2);
  const bool ends_turn = has_las_code(next, codes.pt, kFinalBit | kPriorityBits) ||
                         has_las_code(next, codes.pn, 0) ||
                         (has_las_code(next, codes.idle, 0) && !has_to_probe());
  if (!ends_turn) return;
  if (has_time_in_turn_ && is_behind_own_turn(next)) is_data_owed_ = true;
  has_time_in_turn_ = true;
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
    if (!leaves_time(dlpdu.end, 0))
      found = LinkObjection{"over_what_is_due",
                            "no answer to a CT that ends less than V(MSO) and V(MID) before "
                            "the next item"};
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
  note_own_turn(dlpdu);
  if (dlpdu.begin > time_told_ + rules().time_distribution_period)
    return LinkObjection{"time_not_told", "a TD once in V(TDP)"};
  if (has_las_code(dlpdu, codes.dt3, kLongOfLas | kFinalBit | kPriorityBits)) return say_own_buffer(dlpdu);
  if (Found missed = pass_own_items(dlpdu)) return missed;
  if (has_las_code(dlpdu, codes.cd, kLongOfLas | kFinalBit | kPriorityBits)) return say_cd(dlpdu);
  if (dlpdu.begin > due()) return LinkObjection{"compelled_late", "the CD that is due, before all else"};
  if (has_las_code(dlpdu, codes.idle, 0)) return say_idle(dlpdu);
  if (Found other = check_order(dlpdu)) return other;
  const bool has_priority = (dlpdu.octet(0) & kPriorityBits) != 0;
  if (has_priority && has_las_code(dlpdu, codes.pt, kFinalBit | kPriorityBits)) return say_token(dlpdu);
  if (has_las_code(dlpdu, codes.pn, 0)) return say_probe(dlpdu);
  if (has_las_code(dlpdu, codes.td, 0)) return say_time(dlpdu, false);
  if (has_las_code(dlpdu, codes.dt1, kLongOfLas | kFinalBit | kPriorityBits)) return say_data(dlpdu);
  if (has_las_code(dlpdu, codes.tl, 0)) return say_transfer(dlpdu);
  return LinkObjection{"unexpected_dlpdu", "CD, PT, PN, TD, DT1, TL or IDLE"};
}

// In the place of a probe whenever there is nobody to probe.
FfLasModel::Found FfLasModel::say_idle(const DrivenDlpdu& idle) {
  ++idles_;
  if (!has_to_probe()) own_turn_.reset();
  const Time earliest = silent_since_ + times(kLeastSilentSlots * rules().link.slot_time_octets);
  if (!has_to_probe() || idle.begin + kLinkRounding >= earliest) return std::nullopt;
  return LinkObjection{"idle_early", "silence for V(ST) x 8 before an IDLE: nodes are to be probed"};
}

FfLasModel::Found FfLasModel::say_cd(const DrivenDlpdu& cd) {
  if (configuration_.schedule.items.empty()) return LinkObjection{"compelled_wrong", "no CD: nothing is due"};
  const auto& item = configuration_.schedule.items[items_done_ % configuration_.schedule.items.size()];
  const std::size_t octets = (cd.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  const FfAddress address = address_at(cd, 1, octets);
  interrupt_own_turn();
  if (address != item.address || priority_said(cd) != item.priority || (cd.octet(0) & kFinalBit) != 0)
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

}  // namespace fieldproof::conformance

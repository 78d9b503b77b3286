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
constexpr std::int64_t kLeastSilentSlots = 8;
constexpr std::size_t kOctetsOfCheck = 2;
constexpr std::size_t kOctetsOfProbeResponse = 2 + kOctetsOfCheck;
constexpr std::size_t kOctetsAroundData = 5 + kOctetsOfCheck;
constexpr std::size_t kOctetsOfTransfer = 4 + kOctetsOfCheck;
constexpr std::size_t kOctetsOfTime = 7 + kOctetsOfCheck;
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

FfAddress source_of_dt1(const DrivenDlpdu& dt1) {
  const std::size_t octets = (dt1.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  return address_at(dt1, 1 + octets, octets);
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
  const Time over = own_turn_->begin + times(rules().token_holding_octets);
  if (end + times(2) > over || !leaves_time(end, 2)) return std::nullopt;
  return LinkObjection{"data_not_sent", "more urgent data of its user: they have time within V(DTHT)"};
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

// ---- the token ----

FfLasModel::Found FfLasModel::say_token(const DrivenDlpdu& pt) {
  const std::uint8_t node = pt.octet(1);
  if (!nodes_.at(node).is_live)
    return LinkObjection{"token_for_removed", fmt::format("no PT for {:02X}: it is not live", node)};
  const bool begins = (pt.octet(0) & kFinalBit) != 0;
  Found found = check_own_turn(pt);
  if (!found) found = begins ? begin_circulation(pt) : go_on(pt);
  own_turn_.reset();
  if (!found) found = check_grant(pt);
  show_live(node);
  last_token_ = node;
  probes_ = idles_ = 0;
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
  if (!leaves_time(pt.end + times(grant), 0))
    return LinkObjection{"token_over_due", fmt::format("a token that ends V(MSO) and V(MID) before {}",
                                                       kernel::describe(next_said_item()))};
  return std::nullopt;
}

bool FfLasModel::has_to_probe() const {
  for (unsigned node = rules().first_node; node <= rules().last_node; ++node) {
    if (is_polled(node) && node != configuration_.node && !nodes_.at(node).is_live) return true;
  }
  return false;
}

bool FfLasModel::may_have_to_probe() const {
  if (has_to_probe()) return true;
  for (unsigned node = rules().first_node; node <= rules().last_node; ++node) {
    if (is_polled(node) && is_open(static_cast<std::uint8_t>(node))) return true;
  }
  return false;
}

FfLasModel::Found FfLasModel::begin_circulation(const DrivenDlpdu& pt) {
  if (last_token_) {
    if (auto left_out = pass_over(*last_token_ + 1U, kNodes)) return left_out;
    if (probes_ == 0 && has_to_probe()) return LinkObjection{"no_probe", "a PN between two circulations"};
    if (idles_ + probes_ == 0 && !may_have_to_probe())
      return LinkObjection{"no_probe", "an IDLE between two circulations: there is no node to probe"};
  }
  ++circulations_;
  const bool is_first = std::exchange(is_first_circulation_, false);
  if (auto left_out = pass_over(0, pt.octet(1))) return left_out;
  const Priority said = priority_said(pt);
  std::vector<Priority> all{said};
  if (is_first) all = {Priority::urgent};
  if (priority_ && circulation_begin_) all = priorities_behind(pt.begin - *circulation_begin_);
  const bool is_admitted = !own_turn_ || own_turn_->lowest >= std::min(said, least_before_token(is_first));
  circulation_begin_ = pt.begin;
  priority_ = said;
  if (!is_admitted)
    return LinkObjection{"sends_other_data",
                         "data of the priority of its circulation at least, in its own turn"};
  if (std::ranges::find(all, said) == all.end())
    return LinkObjection{"priority_wrong", fmt::format("a token with priority {}", text_of(all.front()))};
  return check_told();
}

// Before the first token a turn has the priority of the circulation before, or what its rotation leads to so
// far.
FfLasModel::Priority FfLasModel::least_before_token(bool is_first) const {
  if (is_first) return Priority::urgent;
  const bool is_step = rules().steers_by_three_steps && priority_ == Priority::urgent;
  return is_step ? Priority::normal : Priority::time_available;
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
  if (Found cut = check_own_turn(pn)) return cut;
  own_turn_.reset();
  is_item_in_turn_ = false;
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
  if (!is_answer) {
    distributed_ = td.begin;
    td_due_ = td.begin + period;
  }
  std::uint64_t ticks = 0;
  for (std::size_t n = 1; n <= 6; ++n) ticks = ticks << 8 | td.octet(n);
  const auto last = std::exchange(told_, Reported{ticks, td.end});
  time_told_ = td.begin;
  // Whatever its link time begins with: it is the same with each supply.
  const auto ahead = static_cast<std::int64_t>(ticks) - (td.end - link_time_begin_) / fieldbus_dll::kTick;
  if (std::exchange(is_new_to_link_time_, false)) {
    if (!first_ticks_) first_ticks_ = ahead;
    if (std::abs(ahead - *first_ticks_) > 2)
      return LinkObjection{"time_wrong", "a link time that begins anew with the supply"};
  }
  if (!last) return std::nullopt;
  const auto said = static_cast<std::int64_t>(ticks - last->ticks);
  const std::int64_t passed = (td.end - last->end) / fieldbus_dll::kTick;
  if (said >= passed - 1 && said <= passed + 2) return std::nullopt;
  return LinkObjection{"time_wrong", fmt::format("{} ticks more than before", passed)};
}

FfLasModel::Found FfLasModel::say_data(const DrivenDlpdu& dt1) {
  const std::size_t octets = (dt1.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  const std::size_t header = std::min(dt1.octets.size(), 1 + 2 * octets);
  const Octets data(dt1.octets.begin() + static_cast<std::ptrdiff_t>(header), dt1.octets.end());
  if (source_of_dt1(dt1) != fieldbus_dll::address_of(configuration_.node, fieldbus_dll::kEntity))
    return say_of_user(dt1, data);
  const auto kind = static_cast<fieldbus_dll::SpduKind>(data.empty() ? 0 : data.front());
  if (kind == fieldbus_dll::SpduKind::activation) return say_activation(dt1);
  if (kind == fieldbus_dll::SpduKind::live_list) return say_live_list(data);
  return LinkObjection{"unexpected_dlpdu", "an activation or the live list"};
}

FfLasModel::Found FfLasModel::say_activation(const DrivenDlpdu& dt1) {
  const auto activation = [&](std::uint8_t node) {
    return octets_of({.type = fieldbus_dll::FfType::dt1,
                      .priority = Priority::normal,
                      .destination = fieldbus_dll::address_of(node),
                      .source = fieldbus_dll::address_of(configuration_.node),
                      .data = {static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation)}},
                     rules());
  };
  const std::uint8_t node = dt1.octet(1);
  if (to_activate_.erase(node) == 0)
    return LinkObjection{"unexpected_dlpdu", fmt::format("no activation for {:02X}: it was not found", node)};
  if (dt1.octets == activation(node)) return std::nullopt;
  return LinkObjection{"not_activated", words_of(activation(node), rules())};
}

FfLasModel::Found FfLasModel::say_live_list(const Octets& list) {
  for (unsigned n = 0; n < kNodes; ++n) {
    const auto node = static_cast<std::uint8_t>(n);
    const std::size_t octet = 2U + n / 8U;
    const bool is_told = octet < list.size() && (list[octet] >> (7 - n % 8) & 1) != 0;
    if (node == configuration_.node) {
      if (!is_told)
        return LinkObjection{"live_list_wrong", fmt::format("{:02X}, which sends it, is live", node)};
    } else if (is_open(node)) {
      is_told ? show_live(node) : remove(node);
    } else if (is_told != nodes_.at(node).is_live) {
      return LinkObjection{"live_list_wrong",
                           fmt::format("{:02X} is {}live", node, nodes_.at(node).is_live ? "" : "not ")};
    }
  }
  list_changed_.reset();
  return check_revision(list.size() > 1 ? list[1] : std::uint8_t{0});
}

// One more for each change since the last one, also with each supply.
FfLasModel::Found FfLasModel::check_revision(std::uint8_t said) {
  const bool is_first = !revision_;
  const unsigned fewest = std::exchange(fewest_changes_, 0);
  const unsigned most = std::exchange(most_changes_, 0);
  std::optional<std::uint8_t> base = std::exchange(revision_, said);
  if (is_first && fewest == most) {
    if (!first_revision_) first_revision_ = static_cast<std::uint8_t>(said - fewest);
    base = first_revision_;
  }
  if (!base) return std::nullopt;
  const auto changes = static_cast<std::uint8_t>(said - *base);
  if (changes >= fewest && changes <= most) return std::nullopt;
  return LinkObjection{"live_list_wrong",
                       fmt::format("revision {}: {} more than {}, one for each change",
                                   static_cast<std::uint8_t>(*base + fewest), fewest, *base)};
}

FfLasModel::Found FfLasModel::say_of_user(const DrivenDlpdu& dt1, const Octets& data) {
  if (!own_turn_)
    own_turn_ = OwnTurn{.begin = dt1.begin, .lowest = Priority::urgent, .is_interrupted = is_item_in_turn_};
  own_turn_->lowest = std::min(own_turn_->lowest, priority_said(dt1));
  if (dt1.end > own_turn_->begin + times(rules().token_holding_octets) + kLinkRounding)
    return LinkObjection{"own_turn_too_long", "its own turn ends within V(DTHT)"};
  if ((dt1.octet(0) & kFinalBit) != 0)
    return LinkObjection{"sends_other_data", "a DT1 without F: it has no token to return"};
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

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "conformance/fieldbus_dll/ff_las_model.hpp"
#include "conformance/fieldbus_dll/ff_las_octets.hpp"
#include "conformance/fieldbus_dll/link_bench.hpp"

// Of the model of a scheduler: tokens, circulations and probes.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::kFinalBit;
using fieldbus_dll::Priority;
using kernel::Duration;
using kernel::Time;

constexpr std::size_t kMostCirculations = 2;

}  // namespace

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
  turn_since_ = pn.end;
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

}  // namespace fieldproof::conformance

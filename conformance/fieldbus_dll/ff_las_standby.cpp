#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/ff_las_model.hpp"
#include "conformance/fieldbus_dll/link_bench.hpp"

// Of the model of a scheduler: who has the link, what it learns while another has it, and what its own user
// wants of it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfDlpdu;
using fieldbus_dll::FfEventKind;
using fieldbus_dll::FfType;
using kernel::Time;

constexpr std::size_t kLiveListOctets = 34;

fieldbus_dll::FfAddress own_address_in(const DrivenDlpdu& dt3) {
  return static_cast<fieldbus_dll::FfAddress>(dt3.octet(1) << 8 | dt3.octet(2));
}

}  // namespace

kernel::Duration FfLasModel::claim_silence() const {
  return times(std::int64_t{configuration_.node} * rules().link.slot_time_octets +
               rules().claim_delay_octets);
}

std::uint64_t FfLasModel::ticks_at(Time now) const {
  return static_cast<std::uint64_t>((now - link_time_begin_) / fieldbus_dll::kTick);
}

// ---- who has the link ----

void FfLasModel::leave() {
  const bool has_transferred = question_ && question_->asked == Asked::transfers;
  has_transferred ? expect_event(FfEventKind::transferred, question_->node)
                  : expect_event(FfEventKind::left, configuration_.node);
  is_scheduler_ = false;
  is_asked_for_time_ = false;
  question_.reset();
  heir_.reset();
  to_activate_.clear();
  list_changed_.reset();
  for (unsigned n = 0; n < kNodes; ++n) {
    const auto node = static_cast<std::uint8_t>(n);
    if (is_open(node)) nodes_.at(node).was_left_open = true;
  }
}

void FfLasModel::order_transfer(std::uint8_t node, Time now) {
  if (!is_scheduler_) return;
  heir_ = node;
  ordered_ = now;
}

void FfLasModel::lose_supply(Time now) {
  FfLasModel anew(configuration_);
  anew.first_revision_ = first_revision_;
  anew.first_ticks_ = first_ticks_;
  anew.silent_since_ = anew.free_since_ = anew.free_latest_ = anew.time_told_ = anew.td_due_ =
      anew.turn_since_ = now;
  anew.link_time_begin_ = now;
  *this = std::move(anew);
}

// Link time goes on; it begins a circulation, and with it what it counts.
void FfLasModel::take(Time now) {
  is_scheduler_ = true;
  owed_.reset();
  question_.reset();
  time_told_ = td_due_ = now;
  own_turn_.reset();
  turn_since_ = now;
  ++most_changes_;  // itself
  for (unsigned n = 0; n < kNodes; ++n) {
    const auto node = static_cast<std::uint8_t>(n);
    nodes_.at(node).fewest_misses = 0;
    if (!is_open(node)) nodes_.at(node).most_misses = 0;
  }
  last_token_.reset();
  circulation_begin_.reset();
  priority_.reset();
  probes_ = idles_ = 0;
  is_first_circulation_ = true;
  const auto& schedule = configuration_.schedule;
  items_done_ = ticks_at(now) / schedule.macrocycle * schedule.items.size();
  while (due() < now) ++items_done_;
}

void FfLasModel::hear_scheduler(const Octets& octets, Time end) {
  silent_since_ = end;
  owed_.reset();
  const auto dlpdu = ff_dlpdu_of(octets, rules());
  if (!dlpdu) return;
  if (dlpdu->type == FfType::tl && dlpdu->node == configuration_.node) {
    if (dlpdu->schedule_version != configuration_.schedule.version) return;
    take(end);
    expect_event(FfEventKind::taken, configuration_.node);
    return;
  }
  if (is_scheduler_) leave();
  learn(*dlpdu, end);
}

void FfLasModel::learn(const FfDlpdu& dlpdu, Time end) {
  if (dlpdu.type == FfType::pt && !nodes_.at(dlpdu.node).is_live) ++most_changes_;
  if (dlpdu.type == FfType::pt) nodes_.at(dlpdu.node) = {.is_live = true};
  if (dlpdu.type == FfType::pn && dlpdu.node == configuration_.node)
    owed_ = Octets{rules().codes.pr, configuration_.node};
  if (dlpdu.type == FfType::cd) owe_buffer(dlpdu);
  if (dlpdu.type == FfType::td) {
    is_new_to_link_time_ = false;
    told_ = Reported{dlpdu.link_time, end};
    link_time_begin_ = end - static_cast<std::int64_t>(dlpdu.link_time) * fieldbus_dll::kTick;
  }
  const bool is_list = dlpdu.type == FfType::dt1 && dlpdu.destination == fieldbus_dll::kEverybody &&
                       dlpdu.data.size() == kLiveListOctets;
  if (is_list) {
    revision_ = dlpdu.data[1];
    fewest_changes_ = most_changes_ = 0;
  }
  for (unsigned n = 0; is_list && n < kNodes; ++n)
    nodes_.at(n) = {.is_live = (dlpdu.data[2U + n / 8U] >> (7 - n % 8) & 1) != 0};
}

// Who was the scheduler is live.
void FfLasModel::owe_buffer(const FfDlpdu& cd) {
  if (fieldbus_dll::node_of(cd.destination) != configuration_.node) return;
  const OwnBuffer& own = own_[cd.destination];
  FfDlpdu answer{.type = FfType::dt3,
                 .priority = cd.priority,
                 .has_long_addresses = fieldbus_dll::is_long(cd.destination),
                 .is_final = true,
                 .source = cd.destination,
                 .writes = static_cast<std::uint8_t>(own.writes),
                 .data = own.data};
  const bool is_published = std::ranges::count(configuration_.published, cd.destination) > 0;
  if (own.since == kernel::kNever)
    answer = {.type = FfType::sr,
              .is_final = true,
              .status = is_published ? fieldbus_dll::FfStatus::nothing_written
                                     : fieldbus_dll::FfStatus::unknown_address};
  owed_ = octets_of(answer, rules());
}

FfLasModel::Found FfLasModel::say_in_standby(const DrivenDlpdu& dlpdu) {
  const auto& codes = rules().codes;
  if (const auto owed = std::exchange(owed_, std::nullopt)) {
    if (dlpdu.begin + kLinkRounding < silent_since_ + times(rules().link.inter_pdu_delay_octets))
      return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
    if (dlpdu.octets == *owed) return std::nullopt;
    return LinkObjection{"not_a_device", "what a device answers: " + words_of(*owed, rules())};
  }
  if (dlpdu.octets != Octets{codes.cl, configuration_.node})
    return LinkObjection{"two_schedulers", "silence, and then a CL: another is the scheduler"};
  const Time earliest = silent_since_ + claim_silence() - times(rules().claim_delay_octets);
  const Time latest = silent_since_ + claim_silence() + times(1);
  if (dlpdu.begin + kLinkRounding < earliest)
    return LinkObjection{"claim_early", "silence for V(ST) x V(TN) before a claim"};
  if (dlpdu.begin > latest + kLinkRounding)
    return LinkObjection{"claim_late", "a claim within V(MICD) after V(ST) x V(TN)"};
  take(dlpdu.begin);
  expect_event(FfEventKind::claimed, configuration_.node);
  return std::nullopt;
}

FfLasModel::Found FfLasModel::say_transfer(const DrivenDlpdu& tl) {
  if (!heir_) return LinkObjection{"unexpected_dlpdu", "no TL: its user has not ordered one"};
  const std::uint8_t heir = *std::exchange(heir_, std::nullopt);
  const auto version = configuration_.schedule.version;
  const Octets right{rules().codes.tl, heir, static_cast<std::uint8_t>(version >> 8),
                     static_cast<std::uint8_t>(version)};
  if (tl.octets != right) return LinkObjection{"not_transferred", fmt::format("a TL for {:02X}", heir)};
  question_ = Question{.node = heir, .asked = Asked::transfers};
  own_turn_.reset();
  return std::nullopt;
}

// ---- its own buffer ----

bool FfLasModel::write(fieldbus_dll::FfAddress address, const Octets& data, Time now) {
  constexpr std::size_t kUrgentMost = 2;
  if (data.size() > rules().link.most_data.at(kUrgentMost)) return false;
  OwnBuffer& own = own_[address];
  own = {data, own.writes + 1, std::min(own.since, now)};
  return true;
}

const fieldbus_dll::FfScheduleItem* FfLasModel::next_item() const {
  const auto& items = configuration_.schedule.items;
  return items.empty() ? nullptr : &items[items_done_ % items.size()];
}

bool FfLasModel::is_own_item_next() const {
  const fieldbus_dll::FfScheduleItem* const item = next_item();
  return item != nullptr && fieldbus_dll::node_of(item->address) == configuration_.node;
}

// What was not written when it was due is not published.
FfLasModel::Found FfLasModel::pass_own_items(const DrivenDlpdu& dlpdu) {
  while (is_own_item_next() && due() <= dlpdu.begin) {
    if (own_[next_item()->address].since <= due())
      return LinkObjection{"own_buffer_not_published", "a DT3 of its own buffer"};
    ++items_done_;
  }
  return std::nullopt;
}

void FfLasModel::interrupt_own_turn() {
  if (own_turn_) own_turn_->is_interrupted = true;
}

FfLasModel::Found FfLasModel::say_own_buffer(const DrivenDlpdu& dt3) {
  interrupt_own_turn();
  // Those in front of it that were not written are passed over.
  while (is_own_item_next() && own_[next_item()->address].since > due() && due() <= dt3.begin &&
         next_item()->address != own_address_in(dt3))
    ++items_done_;
  if (!is_own_item_next() || own_[next_item()->address].since == kernel::kNever)
    return LinkObjection{"unexpected_dlpdu", "no DT3: none of its own buffers is due"};
  const fieldbus_dll::FfScheduleItem& item = *next_item();
  const OwnBuffer& own = own_[item.address];
  const FfDlpdu right{.type = FfType::dt3,
                      .priority = item.priority,
                      .has_long_addresses = fieldbus_dll::is_long(item.address),
                      .source = item.address,
                      .writes = static_cast<std::uint8_t>(own.writes),
                      .data = own.data};
  const Time latest = std::max(due(), free_latest_) + times(rules().scheduling_overhead_octets);
  if (dt3.begin + kLinkRounding < due())
    return LinkObjection{"compelled_early", fmt::format("not before {}", kernel::describe(due()))};
  if (dt3.begin > latest + kLinkRounding)
    return LinkObjection{"compelled_late", fmt::format("until {}", kernel::describe(latest))};
  ++items_done_;
  if (dt3.octets == octets_of(right, rules())) return std::nullopt;
  return LinkObjection{"own_buffer_wrong", words_of(octets_of(right, rules()), rules())};
}

}  // namespace fieldproof::conformance

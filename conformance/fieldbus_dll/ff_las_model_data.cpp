#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "conformance/fieldbus_dll/ff_las_model.hpp"
#include "conformance/fieldbus_dll/ff_las_octets.hpp"
#include "conformance/fieldbus_dll/link_bench.hpp"

// Of the model of a scheduler: link time, what its entity sends others, data of its user.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::kFinalBit;
using fieldbus_dll::Priority;
using kernel::Duration;

}  // namespace

FfLasModel::Found FfLasModel::say_time(const DrivenDlpdu& td, bool is_answer) {
  const Duration period = rules().time_distribution_period * 9 / 10;
  if (!is_answer && td.begin + times(1) < td_due_)
    return LinkObjection{"time_told_too_often", "a TD when 0.9 x V(TDP) have passed, or for who asks"};
  if (!is_answer) td_due_ = td.begin + period;
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
  if (!own_turn_) own_turn_ = OwnTurn{.begin = dt1.begin, .lowest = Priority::urgent};
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
    is_data_owed_ = false;
    if (priority_said(dt1) == priority && data == next) return std::nullopt;
    return LinkObjection{"sends_other_data", fmt::format("the most urgent that waits, {}: {:02X}",
                                                         text_of(priority), fmt::join(next, " "))};
  }
  return LinkObjection{"sends_other_data", "no data: its user has submitted none"};
}

bool FfLasModel::has_urgent_data() const {
  return !queues_.at(static_cast<std::size_t>(Priority::urgent)).empty();
}

FfLasModel::Found FfLasModel::end() const {
  if (!has_urgent_data() || !is_data_owed_) return std::nullopt;
  return LinkObjection{"data_not_sent", "urgent data of its user, in its turn"};
}

}  // namespace fieldproof::conformance

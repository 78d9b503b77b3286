#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/link_bench.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;
using kernel::Time;

constexpr std::array kPrioritiesOfIsaLas{Priority::urgent, Priority::normal, Priority::time_available};
constexpr std::uint8_t kFinalOfDu = 0x04;
constexpr std::size_t kHeaderAndCheck = 5;

}  // namespace

bool IsaLasAcceptor::submit(Priority priority, std::uint8_t destination, const Octets& data, Time now) {
  const auto number = static_cast<std::size_t>(priority);
  if (data.size() > rules().link.most_data.at(number - 1)) return false;
  queues_.at(number).push_back({priority, destination, data});
  submitted_ = now;
  return true;
}

void IsaLasAcceptor::order_transfer(std::uint8_t heir) {
  if (!is_standby_) ordered_ = heir;
}

// ---- what others said ----

void IsaLasAcceptor::hear_return(Time end) {
  silent_since_ = end;
  out_.reset();
}

void IsaLasAcceptor::hear_data(Time end) {
  silent_since_ = end;
  if (out_) out_->may_from = out_->must_by = out_->over ? std::max(*out_->over, end) : end + reply_wait();
}

void IsaLasAcceptor::hear_cd(Time end) {
  hear_data(end);
  if (out_ && !out_->over) out_->may_from = out_->must_by = end + 2 * reply_wait();
}

void IsaLasAcceptor::hear_other(Time end) {
  silent_since_ = end;
  if (!out_) return;
  out_->may_from = std::max(out_->may_from, end);
  out_->must_by = std::max({out_->must_by, end + reply_wait(), out_->over.value_or(end)});
}

void IsaLasAcceptor::hear_heir(Time end) {
  silent_since_ = end;
  out_.reset();
  is_standby_ = true;
}

void IsaLasAcceptor::hear_scheduler(std::uint8_t address, Time end) {
  hear_other(end);
  if (address > configuration_.address) return;
  out_.reset();
  ordered_.reset();
  is_standby_ = true;
}

void IsaLasAcceptor::hear_transfer(Time end) {
  silent_since_ = begin_ = end;
  out_.reset();
  next_ = 0;
  is_standby_ = has_shown_itself_ = false;
  may_show_itself_ = true;
}

// ---- until when it must have said something ----

Time IsaLasAcceptor::free_by() const {
  const Time silent = silent_since_ + times(rules().link.inter_pdu_delay_octets);
  return out_ ? std::max(out_->must_by, silent) : silent;
}

const IsaLasAcceptor::Request* IsaLasAcceptor::most_urgent() const {
  for (const Priority priority : kPrioritiesOfIsaLas) {
    const auto& queue = queues_.at(static_cast<std::size_t>(priority));
    if (!queue.empty()) return &queue.front();
  }
  return nullptr;
}

// With all that a station may count besides: its delay, and a return as if it held a token.
bool IsaLasAcceptor::surely_fits(const Request& request, Time from) const {
  const std::int64_t around = 4 * std::int64_t{rules().link.inter_pdu_delay_octets};
  const kernel::Duration frame = frame_time(rules().link, kHeaderAndCheck + request.data.size());
  return from + slot() + frame + times(around) <= due();
}

Time IsaLasAcceptor::silent_until() const {
  if (is_standby_) return kernel::kNever;
  Time wanted = due();
  if (const Request* const request = most_urgent()) {
    const Time from = std::max(free_by(), submitted_);
    if (surely_fits(*request, from)) wanted = std::min(wanted, from);
  }
  if (ordered_) wanted = silent_since_;
  if (!has_shown_itself_) wanted = std::min(wanted, silent_since_ + reply_wait() - slot());
  return std::max(wanted, free_by()) + slot() + kLinkRounding;
}

// ---- what it says ----

IsaLasAcceptor::Found IsaLasAcceptor::say(const DrivenDlpdu& dlpdu) {
  const Time begin = dlpdu.begin + kLinkRounding;
  if (is_standby_) return LinkObjection{"speaks_unasked", "silence: another is the scheduler"};
  if (out_ && begin < out_->may_from) {
    return LinkObjection{out_->heir ? "talks_into_transfer" : "talks_into_token",
                         out_->heir ? "silence: the heir may show itself" : "silence: a token is out"};
  }
  if (begin < silent_since_ + times(rules().link.inter_pdu_delay_octets))
    return LinkObjection{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  out_.reset();
  Found objection = say_dlpdu(dlpdu);
  silent_since_ = dlpdu.end;
  has_shown_itself_ = true;
  return objection;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_dlpdu(const DrivenDlpdu& dlpdu) {
  const unsigned code = dlpdu.octet(0) & 0xF0U;
  if (code == rules().codes.tl) return say_transfer(dlpdu);
  const bool may_show_itself = std::exchange(may_show_itself_, false);
  if (code == rules().codes.du) return say_data(dlpdu, may_show_itself);
  return say_delegation(dlpdu);
}

Octets IsaLasAcceptor::delegation() const {
  const bool is_sequence = item().type == IsaType::es;
  const std::uint8_t code = is_sequence ? rules().codes.es : rules().codes.et;
  Octets octets{static_cast<std::uint8_t>(code | static_cast<unsigned>(item().least)), item().node,
                configuration_.address};
  if (!is_sequence) return octets;
  octets.push_back(static_cast<std::uint8_t>(item().duration >> 8));
  octets.push_back(static_cast<std::uint8_t>(item().duration & 0xFF));
  return octets;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_delegation(const DrivenDlpdu& dlpdu) {
  const Octets expected = delegation();
  if (dlpdu.octets != expected)
    return LinkObjection{"delegation_wrong", fmt::format("{:02X}", fmt::join(expected, " "))};
  if (dlpdu.begin + slot() + kLinkRounding < due())
    return LinkObjection{"delegation_early", "each item within V(ST) of its time"};
  out_ = Out{dlpdu.end + reply_wait(), dlpdu.end + reply_wait(), {}, {}};
  if (item().type == IsaType::es)
    out_->over = dlpdu.end + times(std::int64_t{item().duration} + rules().supervision_margin_octets);
  if (++next_ < configuration_.schedule.items.size()) return std::nullopt;
  next_ = 0;
  begin_ += configuration_.schedule.period;
  return std::nullopt;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_transfer(const DrivenDlpdu& tl) {
  const auto heir = std::exchange(ordered_, std::nullopt);
  if (!heir) return LinkObjection{"transfer_unasked", "no TL that its user has not ordered"};
  const std::uint16_t version = configuration_.schedule.version;
  const Octets expected{rules().codes.tl, *heir, configuration_.address,
                        static_cast<std::uint8_t>(version >> 8), static_cast<std::uint8_t>(version & 0xFF)};
  if (tl.octets != expected)
    return LinkObjection{"transfer_wrong", fmt::format("{:02X}", fmt::join(expected, " "))};
  out_ = Out{tl.end + reply_wait(), tl.end + reply_wait(), {}, heir};
  return std::nullopt;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_data(const DrivenDlpdu& du, bool may_show_itself) {
  Octets said = du.octets;
  if (!said.empty()) said[0] &= static_cast<std::uint8_t>(~kFinalOfDu);
  const bool is_empty = said.size() == kHeaderAndCheck - 2;
  if (may_show_itself && is_empty && du.octet(1) == rules().everybody) return std::nullopt;
  const Request* const request = most_urgent();
  if (request == nullptr) return LinkObjection{"sends_other_data", "nothing: its user has submitted nothing"};
  Octets expected{static_cast<std::uint8_t>(rules().codes.du | static_cast<unsigned>(request->priority)),
                  request->destination, configuration_.address};
  expected.insert(expected.end(), request->data.begin(), request->data.end());
  if (said != expected)
    return LinkObjection{"sends_other_data", fmt::format("{:02X}", fmt::join(expected, " "))};
  if (du.end > due() + kLinkRounding)
    return LinkObjection{"own_data_over_due", "data of its user that ends before the next item is due"};
  queues_.at(static_cast<std::size_t>(request->priority)).pop_front();
  return std::nullopt;
}

}  // namespace fieldproof::conformance

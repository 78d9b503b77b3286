#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/link_bench.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaDlpdu;
using fieldbus_dll::IsaEventKind;
using fieldbus_dll::IsaService;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;
using kernel::Time;

constexpr std::array kPrioritiesOfIsaLas{Priority::urgent, Priority::normal, Priority::time_available};
constexpr std::uint8_t kFinalOfData = 0x04;
constexpr std::size_t kHeaderOfData = 3;
constexpr std::size_t kOctetsOfEnd = 4;

std::string hex(const Octets& octets) {
  return fmt::format("{:02X}", fmt::join(octets, " "));
}

Octets header_of(std::uint8_t code, Priority priority, std::uint8_t destination, std::uint8_t source) {
  return {static_cast<std::uint8_t>(code | static_cast<unsigned>(priority)), destination, source};
}

}  // namespace

// ---- the user ----

bool IsaLasAcceptor::submit(IsaService service, Priority priority, std::uint8_t destination,
                            const Octets& data, Time now) {
  const auto number = static_cast<std::size_t>(priority);
  if (data.size() > rules().link.most_data.at(number - 1)) return false;
  (service == IsaService::reply_data ? replies_ : to_send_)
      .at(number)
      .push_back({service == IsaService::compel, priority, destination, data});
  submitted_ = now;
  return true;
}

void IsaLasAcceptor::order_transfer(std::uint8_t heir, Time now) {
  if (is_standby_) return;
  ordered_ = heir;
  ordered_at_ = now;
}

std::vector<IsaReport> IsaLasAcceptor::take_reports(const std::vector<IsaReport>& actual) {
  std::vector<IsaReport> right;
  for (const Due& due : std::exchange(reports_, {})) {
    const bool is_other = due.other && right.size() < actual.size() && actual[right.size()] == *due.other;
    right.push_back(is_other ? *due.other : due.report);
  }
  return right;
}

// ---- what others said ----

void IsaLasAcceptor::hear(const Octets& octets, Time end) {
  const auto dlpdu = fieldbus_dll::isa_dlpdu_of(octets, rules());
  if (!dlpdu) return hear_noise(end);
  const bool is_for_it = dlpdu->destination == configuration_.address;
  if (dlpdu->type == IsaType::tl && is_for_it) return hear_transfer(dlpdu->source, end);
  silent_since_ = end;
  owed_.reset();
  hear_as_scheduler(*dlpdu, end);
  if (const auto awaited = std::exchange(awaited_, std::nullopt)) {
    const bool is_reply = dlpdu->type == IsaType::dt && is_for_it && dlpdu->source == awaited->node;
    if (!is_reply) return report(IsaEventKind::token_dropped, dlpdu->source);
  } else if (dlpdu->type == IsaType::cd && is_for_it) {
    owed_ = Reply{dlpdu->source, end + times(rules().reply_forming_octets), dlpdu->priority};
  }
  const bool is_data = dlpdu->type == IsaType::du || dlpdu->type == IsaType::dt;
  const bool is_to_all = dlpdu->type == IsaType::du && dlpdu->destination == rules().everybody;
  if (is_data && (is_for_it || is_to_all)) reports_.push_back({{*dlpdu}});
}

void IsaLasAcceptor::hear_as_scheduler(const IsaDlpdu& dlpdu, Time end) {
  if (is_standby_) return;
  const bool is_from_out = out_ && out_->node == dlpdu.source;
  if (is_from_out && out_->is_transfer) {
    report(IsaEventKind::transferred, dlpdu.source);
    out_.reset();
    ordered_.reset();
    is_standby_ = true;
  } else if (is_of_scheduler(dlpdu.type)) {
    report(IsaEventKind::second_scheduler, dlpdu.source);
    hear_other(end);
    if (dlpdu.source > configuration_.address) return;
    report(IsaEventKind::scheduler_left, dlpdu.source);
    out_.reset();
    ordered_.reset();
    is_standby_ = true;
  } else if (is_from_out) {
    hear_holder(dlpdu.type, end);
  } else {
    hear_other(end);
  }
}

void IsaLasAcceptor::hear_holder(IsaType type, Time end) {
  if (type == IsaType::ee) return out_.reset();
  const bool is_second = std::exchange(out_->is_used, true);
  if (out_->over) {
    out_->may_from = out_->must_by = std::max(*out_->over, end);
    return;
  }
  if (is_second) report(IsaEventKind::token_overrun, out_->node);
  out_->may_from = out_->must_by = end + (type == IsaType::cd ? 2 : 1) * reply_wait();
}

void IsaLasAcceptor::hear_other(Time end) {
  if (!out_) return;
  out_->may_from = std::max(out_->may_from, end);
  out_->must_by = std::max({out_->must_by, end + reply_wait(), out_->over.value_or(end)});
  out_->is_unsure = true;
}

void IsaLasAcceptor::hear_noise(Time end) {
  silent_since_ = end;
  hear_other(end);
}

void IsaLasAcceptor::hear_transfer(std::uint8_t from, Time end) {
  if (awaited_) report(IsaEventKind::token_dropped, from);
  report(IsaEventKind::scheduler_taken, from);
  silent_since_ = begin_ = end;
  out_.reset();
  awaited_.reset();
  owed_.reset();
  next_ = 0;
  is_standby_ = has_shown_itself_ = false;
  may_show_itself_ = true;
}

// ---- until when it must have said something ----

Time IsaLasAcceptor::free_by() const {
  const Time silent = silent_since_ + times(rules().link.inter_pdu_delay_octets);
  return std::max({silent, out_ ? out_->must_by : silent, awaited_ ? awaited_->until : silent});
}

IsaLasAcceptor::Request* IsaLasAcceptor::most_urgent(Queues& queues, Priority least) {
  for (const Priority priority : kPrioritiesOfIsaLas) {
    auto& queue = queues.at(static_cast<std::size_t>(priority));
    if (priority >= least && !queue.empty()) return &queue.front();
  }
  return nullptr;
}

kernel::Duration IsaLasAcceptor::frame_of(std::size_t octets) const {
  return fieldbus_dll::frame_time(rules().link, octets + 2);
}

// As under a token: its return, and a reply, belong to it.
kernel::Duration IsaLasAcceptor::needed_for(const Request& request) const {
  const kernel::Duration end = times(rules().link.inter_pdu_delay_octets) + frame_of(kOctetsOfEnd);
  if (!request.compels) return frame_of(kHeaderOfData + request.data.size()) + end;
  const std::size_t longest = rules().link.most_data.at(static_cast<std::size_t>(request.priority) - 1);
  return frame_of(kHeaderOfData) + reply_wait() + frame_of(kHeaderOfData + longest) + end;
}

Time IsaLasAcceptor::silent_until() const {
  if (owed_) return owed_->until + kLinkRounding;
  if (is_standby_) return kernel::kNever;
  Time wanted = due();
  Queues queues = to_send_;
  if (const Request* const request = most_urgent(queues, Priority::time_available)) {
    const Time from = std::max(free_by(), submitted_);
    if (from + slot() + needed_for(*request) <= due()) wanted = std::min(wanted, from);
  }
  if (ordered_) wanted = std::max(silent_since_, ordered_at_);
  if (!has_shown_itself_) wanted = std::min(wanted, silent_since_ + reply_wait() - slot());
  return std::max(wanted, free_by()) + slot() + kLinkRounding;
}

LinkObjection IsaLasAcceptor::silence() const {
  if (owed_) return {"no_reply", "a DT within V(FD) after a CD for it"};
  if (ordered_)
    return {"line_left_silent", fmt::format("the TL to {:02X} that its user has ordered", *ordered_)};
  if (!has_shown_itself_) return {"line_left_silent", "something within V(RR) after it was handed the link"};
  Queues queues = to_send_;
  const bool is_over = due() + slot() < silent_until();
  if (const Request* const request = most_urgent(queues, Priority::time_available); request && !is_over)
    return {"line_left_silent", "the data of its user, or the item that is due: " + hex(delegation())};
  return {"line_left_silent",
          fmt::format("{}, which is due {} ms after its supply", hex(delegation()),
                      static_cast<double>((due() - kernel::kStart) / kernel::kMicrosecond) / 1000)};
}

// ---- what it says ----

IsaLasAcceptor::Found IsaLasAcceptor::say(const DrivenDlpdu& dlpdu) {
  const Time begin = dlpdu.begin + kLinkRounding;
  const bool is_early = begin < silent_since_ + times(rules().link.inter_pdu_delay_octets);
  const LinkObjection early{"answers_too_early", "V(MID) of silence in front of each DLPDU"};
  if (owed_ && is_early) return early;
  if (owed_) return say_reply(dlpdu);
  if (is_standby_) return LinkObjection{"speaks_unasked", "silence: another is the scheduler"};
  if (out_ && begin < out_->may_from) {
    return LinkObjection{out_->is_transfer ? "talks_into_transfer" : "talks_into_token",
                         out_->is_transfer ? "silence: the heir may show itself" : "silence: a token is out"};
  }
  if (awaited_ && begin < awaited_->until)
    return LinkObjection{"talks_into_reply", "silence: its CD may be answered"};
  if (is_early) return early;
  end_wait();
  Found objection = say_dlpdu(dlpdu);
  silent_since_ = dlpdu.end;
  has_shown_itself_ = true;
  return objection;
}

// For what it has awaited in vain.
void IsaLasAcceptor::end_wait() {
  if (const auto awaited = std::exchange(awaited_, std::nullopt))
    report(IsaEventKind::reply_missing, awaited->node);
  const auto out = std::exchange(out_, std::nullopt);
  if (!out) return;
  if (out->is_transfer) return report(IsaEventKind::transfer_failed, out->node);
  const bool is_overrun = out->over && out->is_used;
  const IsaReport overrun{{}, {IsaEventKind::token_overrun, out->node}};
  const IsaReport reclaimed{{}, {IsaEventKind::token_reclaimed, out->node}};
  Due due{is_overrun ? overrun : reclaimed};
  if (out->over && out->is_unsure) due.other = is_overrun ? reclaimed : overrun;
  reports_.push_back(due);
}

IsaLasAcceptor::Found IsaLasAcceptor::say_reply(const DrivenDlpdu& dlpdu) {
  const Reply owed = *std::exchange(owed_, std::nullopt);
  silent_since_ = dlpdu.end;
  if (out_ && !out_->over) {
    out_->may_from = dlpdu.end + reply_wait();
    out_->must_by = std::max(out_->must_by, dlpdu.end + reply_wait());
  }
  Request* const request = most_urgent(replies_, owed.least);
  const Priority priority = request != nullptr ? request->priority : owed.least;
  Octets expected = header_of(static_cast<std::uint8_t>(rules().codes.dt | kFinalOfData), priority, owed.node,
                              configuration_.address);
  if (request != nullptr) {
    expected.insert(expected.end(), request->data.begin(), request->data.end());
    replies_.at(static_cast<std::size_t>(priority)).pop_front();
  }
  if (dlpdu.octets != expected) return LinkObjection{"reply_wrong", hex(expected)};
  return std::nullopt;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_dlpdu(const DrivenDlpdu& dlpdu) {
  const unsigned code = dlpdu.octet(0) & 0xF0U;
  if (code == rules().codes.tl) return say_transfer(dlpdu);
  const bool may_show_itself = std::exchange(may_show_itself_, false);
  if (code == rules().codes.du || code == rules().codes.cd) return say_request(dlpdu, may_show_itself);
  return say_delegation(dlpdu);
}

Octets IsaLasAcceptor::delegation() const {
  const bool is_sequence = item().type == IsaType::es;
  Octets octets = header_of(is_sequence ? rules().codes.es : rules().codes.et, item().least, item().node,
                            configuration_.address);
  if (!is_sequence) return octets;
  octets.push_back(static_cast<std::uint8_t>(item().duration >> 8));
  octets.push_back(static_cast<std::uint8_t>(item().duration & 0xFF));
  return octets;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_delegation(const DrivenDlpdu& dlpdu) {
  const Octets expected = delegation();
  if (dlpdu.octets != expected) return LinkObjection{"delegation_wrong", hex(expected)};
  if (dlpdu.begin + slot() + kLinkRounding < due())
    return LinkObjection{"delegation_early", "each item within V(ST) of its time"};
  const Time silent = dlpdu.end + reply_wait();
  out_ = Out{item().node, silent, silent};
  if (item().type == IsaType::es) {
    out_->over = dlpdu.end + times(std::int64_t{item().duration} + rules().supervision_margin_octets);
    out_->is_used = *out_->over < silent;
    out_->may_from = out_->must_by = std::min(silent, *out_->over);
  }
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
  if (tl.octets != expected) return LinkObjection{"transfer_wrong", hex(expected)};
  out_ = Out{*heir, tl.end + reply_wait(), tl.end + reply_wait()};
  out_->is_transfer = true;
  return std::nullopt;
}

IsaLasAcceptor::Found IsaLasAcceptor::say_request(const DrivenDlpdu& dlpdu, bool may_show_itself) {
  Octets said = dlpdu.octets;
  const bool is_unit_data = (dlpdu.octet(0) & 0xF0U) == rules().codes.du;
  if (is_unit_data && !said.empty()) said[0] &= static_cast<std::uint8_t>(~kFinalOfData);
  if (may_show_itself && is_unit_data && said.size() == kHeaderOfData && said[1] == rules().everybody) {
    if (fieldbus_dll::isa_dlpdu_of(dlpdu.octets, rules())) return std::nullopt;
    return LinkObjection{"sends_other_data", "a DLPDU: a DU for everybody has a priority"};
  }
  Request* const request = most_urgent(to_send_, Priority::time_available);
  if (request == nullptr) return LinkObjection{"sends_other_data", "nothing: its user has submitted nothing"};
  Octets expected = header_of(request->compels ? rules().codes.cd : rules().codes.du, request->priority,
                              request->destination, configuration_.address);
  expected.insert(expected.end(), request->data.begin(), request->data.end());
  if (said != expected) return LinkObjection{"sends_other_data", hex(expected)};
  if (dlpdu.begin + needed_for(*request) > due() + kLinkRounding)
    return LinkObjection{"own_data_over_due",
                         "data of its user that ends, with V(MID) and an EE, before the next item is due"};
  if (request->compels) awaited_ = Reply{request->destination, dlpdu.end + reply_wait()};
  to_send_.at(static_cast<std::size_t>(request->priority)).pop_front();
  return std::nullopt;
}

}  // namespace fieldproof::conformance

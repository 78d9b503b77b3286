#pragma once

#include <set>
#include <utility>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"

// Link masters that schedule, supervise or hand over otherwise.
namespace fieldproof::conformance::isa_seeded_faults {

class ScheduleShifted : public IsaLas {
 public:
  ScheduleShifted(const IsaConfiguration& configuration, int slots) : IsaLas(configuration), slots_(slots) {}

 private:
  Time due(const IsaScheduleItem& item) const override {
    return IsaLas::due(item) + slots_ * octet_times(rules().link.slot_time_octets);
  }
  int slots_;
};

class ItemsSkipped : public IsaLas {
  using IsaLas::IsaLas;
  void advance() override {
    IsaLas::advance();
    if (++passed_ == 3) IsaLas::advance();
  }
  int passed_ = 0;
};

// Each round of the schedule begins two periods after the last one.
class PeriodDoubled : public IsaLas {
  using IsaLas::IsaLas;
  void advance() override {
    IsaLas::advance();
    ++passed_;
  }
  Time due(const IsaScheduleItem& item) const override {
    const auto& schedule = configuration().schedule;
    return IsaLas::due(item) + (passed_ / static_cast<int>(schedule.items.size())) * schedule.period;
  }
  int passed_ = 0;
};

class OwnDataKept : public IsaLas {
  using IsaLas::IsaLas;
  bool submit(const IsaRequest& request, Time now) override {
    return las_state() == LasState::scheduling || IsaLas::submit(request, now);
  }
};

class OwnDataOverDue : public IsaLas {
  using IsaLas::IsaLas;
  Duration needed_for(const IsaRequest& request) const override {
    return las_state() == LasState::scheduling ? Duration{} : IsaLas::needed_for(request);
  }
};

class DelegatesUrgentOnly : public IsaLas {
  using IsaLas::IsaLas;
  Octets written(const IsaDlpdu& dlpdu) const override {
    IsaDlpdu other = dlpdu;
    other.priority = Priority::urgent;
    return IsaLas::written(other);
  }
};

class DurationSentLittleEndian : public IsaLas {
  using IsaLas::IsaLas;
  Octets written(const IsaDlpdu& dlpdu) const override {
    IsaDlpdu other = dlpdu;
    other.duration = static_cast<std::uint16_t>(other.duration << 8 | other.duration >> 8);
    return IsaLas::written(other);
  }
};

class TransferWithoutVersion : public IsaLas {
  using IsaLas::IsaLas;
  Octets written(const IsaDlpdu& dlpdu) const override {
    IsaDlpdu other = dlpdu;
    other.schedule_version = 0;
    return IsaLas::written(other);
  }
};

class WaitsOutDuration : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDlpdu other = dlpdu;
    if (las_state() == LasState::awaiting_sequence && other.type == IsaType::ee) other.type = IsaType::du;
    IsaLas::on_dlpdu(other, place);
  }
};

class ReclaimsByUcOnly : public IsaLas {
  using IsaLas::IsaLas;
  Time response_end(Time from) const override {
    return las_state() == LasState::awaiting_sequence ? kernel::kNever : IsaLas::response_end(from);
  }
};

class SingleTokenForEver : public IsaLas {
  using IsaLas::IsaLas;
  Time response_end(Time from) const override {
    return las_state() == LasState::awaiting_single ? kernel::kNever : IsaLas::response_end(from);
  }
};

// V(RR) is V(MRD) octets, not slot times.
class ReclaimsEarly : public IsaLas {
  using IsaLas::IsaLas;
  Time response_end(Time from) const override {
    return from + octet_times(rules().link.response_delay_slots);
  }
};

class ReclaimsIntoHolder : public IsaLas {
  using IsaLas::IsaLas;
  bool reclaims_while_busy() const override { return true; }
  Time may_begin() const override { return line().driven_until() + silence_before_sending(); }
};

class SupervisesOtherwise : public IsaLas {
 public:
  SupervisesOtherwise(const IsaConfiguration& configuration, bool at_all)
      : IsaLas(configuration), at_all_(at_all) {}

 private:
  Time supervision_end(const IsaScheduleItem& item, Time es_end) const override {
    return at_all_ ? IsaLas::supervision_end(item, es_end) + octet_times(16) : kernel::kNever;
  }
  bool at_all_;
};

class EndOfAnybodyTaken : public IsaLas {
  using IsaLas::IsaLas;
  bool is_from_holder(const IsaDlpdu& dlpdu) const override {
    return dlpdu.type == IsaType::ee || IsaLas::is_from_holder(dlpdu);
  }
};

class ForgetsReplyWait : public IsaLas {
  using IsaLas::IsaLas;
  Time response_end_behind_cd(Time from) const override { return response_end(from); }
};

class IgnoresTransfer : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != IsaType::tl) IsaLas::on_dlpdu(dlpdu, place);
  }
};

class TakesTransferOfOthers : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDlpdu other = dlpdu;
    if (other.type == IsaType::tl) other.destination = address();
    IsaLas::on_dlpdu(other, place);
  }
};

class DeafInStandby : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (las_state() != LasState::standby || dlpdu.type == IsaType::tl) IsaLas::on_dlpdu(dlpdu, place);
  }
};

class ShowsItselfLate : public IsaLas {
  using IsaLas::IsaLas;
  bool shows_itself() const override { return false; }
};

class ScheduleNotBegun : public IsaLas {
  using IsaLas::IsaLas;
  Time due(const IsaScheduleItem&) const override { return kernel::kNever; }
};

class NeverRetakes : public IsaLas {
  using IsaLas::IsaLas;
  bool retakes() const override { return false; }
};

class KeepsScheduleBehindTransfer : public IsaLas {
  using IsaLas::IsaLas;
  void on_transferred(Time) override { enter_las(LasState::scheduling); }
};

class Yields : public IsaLas {
 public:
  Yields(const IsaConfiguration& configuration, bool always) : IsaLas(configuration), always_(always) {}

 private:
  bool yields_to(const IsaDlpdu&) const override { return always_; }
  bool always_;
};

// What sequences find, since several things come together.
class IsaEachEventOnce : public IsaLas {
  using IsaLas::IsaLas;
  void tell(IsaEventKind kind, std::uint8_t node, Time now) override {
    if (told_.insert(kind).second) IsaLas::tell(kind, node, now);
  }
  std::set<IsaEventKind> told_;
};

class OverrunTold : public IsaLas {
  using IsaLas::IsaLas;
  void tell(IsaEventKind kind, std::uint8_t node, Time now) override {
    IsaLas::tell(kind == IsaEventKind::token_reclaimed ? IsaEventKind::token_overrun : kind, node, now);
  }
};

class OrderRefusedInStandby : public IsaLas {
  using IsaLas::IsaLas;
  bool order_transfer(std::uint8_t node, Time now) override {
    return las_state() != LasState::standby && IsaLas::order_transfer(node, now);
  }
};

class FirstOrderStays : public IsaLas {
  using IsaLas::IsaLas;
  bool order_transfer(std::uint8_t node, Time now) override {
    if (las_state() == LasState::standby) return true;
    return std::exchange(is_ordered_, true) || IsaLas::order_transfer(node, now);
  }
  Time put_on_line(const Octets& octets, Time now) override {
    if (octets.front() == rules().codes.tl) is_ordered_ = false;
    return IsaLas::put_on_line(octets, now);
  }
  void tell(IsaEventKind kind, std::uint8_t node, Time now) override {
    if (kind == IsaEventKind::scheduler_left) is_ordered_ = false;
    IsaLas::tell(kind, node, now);
  }
  void stop(Time now) override {
    is_ordered_ = false;
    IsaLas::stop(now);
  }
  bool is_ordered_ = false;
};

class OwnDataWithoutReturn : public IsaLas {
  using IsaLas::IsaLas;
  Duration needed_for(const IsaRequest& request) const override {
    const Duration needed = IsaLas::needed_for(request);
    if (las_state() != LasState::scheduling) return needed;
    return needed - silence_before_sending() - frame_time(rules().link, octets_on_line(IsaType::ee));
  }
};

class TransferIgnoredByScheduler : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (las_state() == LasState::standby || dlpdu.type != IsaType::tl) IsaLas::on_dlpdu(dlpdu, place);
  }
};

class SchedulerNeverReplies : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDlpdu other = dlpdu;
    if (las_state() != LasState::standby && other.type == IsaType::cd) other.destination = other.source;
    IsaLas::on_dlpdu(other, place);
  }
};

class EndWithAReasonIgnored : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    IsaDlpdu other = dlpdu;
    if (other.type == IsaType::ee && other.reason != EndReason::nothing_to_send)
      other.source = other.destination;
    IsaLas::on_dlpdu(other, place);
  }
};

class SignedAddresses : public IsaLas {
  using IsaLas::IsaLas;
  bool yields_to(const IsaDlpdu& other) const override {
    return static_cast<std::int8_t>(other.source) < static_cast<std::int8_t>(address());
  }
};

class StandbyAfterSupply : public IsaLas {
  using IsaLas::IsaLas;
  bool start(Time now) override {
    return std::exchange(had_supply_, true) ? IsaDle::start(now) : IsaLas::start(now);
  }
  bool had_supply_ = false;
};

// Schedules that are not as they were given, or are not run to their end.
class OtherSchedule : public IsaLas {
 public:
  OtherSchedule(const IsaConfiguration& configuration, void (*change)(fieldbus_dll::IsaSchedule&))
      : IsaLas(changed(configuration, change)) {}

 private:
  static IsaConfiguration changed(IsaConfiguration configuration,
                                  void (*change)(fieldbus_dll::IsaSchedule&)) {
    change(configuration.schedule);
    return configuration;
  }
};

class ClockOf32Bits : public IsaLas {
  using IsaLas::IsaLas;
  Time due(const IsaScheduleItem& item) const override {
    const Time due = IsaLas::due(item);
    return (due - kernel::kStart) / kernel::kMicrosecond < 0x1'0000'0000 ? due : kernel::kNever;
  }
};

class ItemsIn32Bits : public IsaLas {
  using IsaLas::IsaLas;
  Time due(const IsaScheduleItem& item) const override {
    return IsaLas::due(item) - item.at / kOf32Bits * kOf32Bits;
  }
  static constexpr kernel::Duration kOf32Bits = (std::int64_t{1} << 32) * kernel::kNanosecond;
};

class DurationOf15Bits : public IsaLas {
  using IsaLas::IsaLas;
  Octets written(const IsaDlpdu& dlpdu) const override {
    Octets octets = IsaLas::written(dlpdu);
    if (dlpdu.type == IsaType::es) octets.at(3) &= 0x7FU;
    return octets;
  }
};

// The sign of life of who was handed the link has no priority, and is no DLPDU so.
class ShowsItselfAsNothing : public IsaLas {
  using IsaLas::IsaLas;
  Octets written(const IsaDlpdu& dlpdu) const override {
    Octets octets = IsaLas::written(dlpdu);
    if (dlpdu.type == IsaType::du && dlpdu.data.empty() && dlpdu.destination == rules().everybody)
      octets.at(0) &= 0xF0U;
    return octets;
  }
};

// Another scheduler ends its wait for a reply, and it says nothing of that.
class SchedulerForReplyUntold : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    is_of_other_ = dlpdu.destination != address() &&
                   (dlpdu.type == IsaType::et || dlpdu.type == IsaType::es || dlpdu.type == IsaType::tl);
    IsaLas::on_dlpdu(dlpdu, place);
    is_of_other_ = false;
  }
  void tell(fieldbus_dll::IsaEventKind kind, std::uint8_t node, Time now) override {
    if (kind != fieldbus_dll::IsaEventKind::token_dropped || !is_of_other_) IsaLas::tell(kind, node, now);
  }
  bool is_of_other_ = false;
};

class NothingAfterItsSchedule : public IsaLas {
 public:
  NothingAfterItsSchedule(const IsaConfiguration& configuration, bool begins_again)
      : IsaLas(configuration), begins_again_(begins_again) {}

 private:
  bool is_over() const {
    return configuration().schedule.period == Duration{} && passed_ >= configuration().schedule.items.size();
  }
  void advance() override {
    ++passed_;
    IsaLas::advance();
  }
  bool submit(const IsaRequest& request, Time now) override {
    return (is_over() && begins_again_) || IsaLas::submit(request, now);
  }
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type == IsaType::tl && is_over() && !begins_again_) return;
    if (dlpdu.type == IsaType::tl) passed_ = 0;
    IsaLas::on_dlpdu(dlpdu, place);
  }
  bool begins_again_;
  std::size_t passed_ = 0;
};

class SignOfLifeFirst : public IsaLas {
  using IsaLas::IsaLas;
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override {
    has_taken_ = has_taken_ || (dlpdu.type == IsaType::tl && dlpdu.destination == address());
    IsaLas::on_dlpdu(dlpdu, place);
  }
  Time due(const IsaScheduleItem& item) const override {
    return IsaLas::due(item) + octet_times(has_taken_ ? 16 : 0);
  }
  Time put_on_line(const Octets& octets, Time now) override {
    has_taken_ = false;
    return IsaLas::put_on_line(octets, now);
  }
  bool has_taken_ = false;
};

class SignOfLifeOfAnybody : public IsaLas {
  using IsaLas::IsaLas;
  bool shows_transfer(const IsaDlpdu&) const override { return true; }
};

}  // namespace fieldproof::conformance::isa_seeded_faults

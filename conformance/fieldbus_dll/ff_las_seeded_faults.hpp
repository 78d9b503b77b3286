#pragma once

#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check.hpp"

// Link masters that schedule, circulate, keep the live list, tell the time or claim otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- schedule ----

class TokenOverDue : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration) const override { return rules().token_holding_octets; }
};

class NoAllowanceForPt : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration left) const override {
    constexpr std::int64_t kPt = 9;
    return FfLas::token_grant(left + kept_free_before_cd() + octet_times(kPt));
  }
};

class CutToTheLeast : public FfLas {
  using FfLas::FfLas;
  unsigned token_grant(Duration left) const override {
    const unsigned grant = FfLas::token_grant(left);
    return grant < rules().token_holding_octets ? std::min(grant, rules().least_token_octets) : grant;
  }
};

class ScheduleInCentiseconds : public FfLas {
  using FfLas::FfLas;
  Time due(const FfScheduleItem& item) const override {
    constexpr Duration kStep = 10 * kernel::kMillisecond;
    const Duration at = FfLas::due(item) - kernel::kStart;
    return kernel::kStart + (at + kStep - kernel::kPicosecond) / kStep * kStep;
  }
};

class ItemSkipped : public FfLas {
  using FfLas::FfLas;
  void advance() override {
    FfLas::advance();
    if (++passed_ == 4) FfLas::advance();
  }
  int passed_ = 0;
};

class AnswerTimeFromBegin : public FfLas {
  using FfLas::FfLas;
  Time answer_awaited_until(const Place& question) const override {
    return question.begin + response_delay(rules().link);
  }
};

class AnswerTimeDoubled : public FfLas {
  using FfLas::FfLas;
  Time answer_awaited_until(const Place& question) const override {
    return question.end + 2 * response_delay(rules().link);
  }
};

class LineLeftSilent : public FfLas {
  using FfLas::FfLas;
  Duration longest_silence() const override { return octet_times(100'000); }
};

class ScheduleNotBegunBehindTl : public FfLas {
  using FfLas::FfLas;
  Time due(const FfScheduleItem&) const override { return kernel::kNever; }
};

// ---- circulation ----

class SaysOtherwise : public FfLas {
 public:
  using Change = void (*)(FfDlpdu&);
  SaysOtherwise(const FfConfiguration& configuration, FfType type, Change change)
      : FfLas(configuration), type_(type), change_(change) {}

 private:
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (other.type == type_ && is_scheduler()) change_(other);
    return FfLas::written(other);
  }
  FfType type_;
  Change change_;
};

class FirstProbeLeftOut : public FfLas {
  using FfLas::FfLas;
  std::uint8_t next_probe(std::uint8_t last) const override {
    const std::uint8_t next = FfLas::next_probe(last);
    return std::exchange(has_probed_, true) ? next : FfLas::next_probe(next);
  }
  mutable bool has_probed_ = false;
};

class RefusesItsLastInstant : public FfLas {
  using FfLas::FfLas;
  bool start(kernel::Time now) override {
    const auto& [version, macrocycle, items] = configuration().schedule;
    const auto is_last = [&](const fieldbus_dll::FfScheduleItem& item) { return item.at + 1 == macrocycle; };
    return std::ranges::none_of(items, is_last) && FfLas::start(now);
  }
};

class ProbesOtherwise : public FfLas {
 public:
  ProbesOtherwise(const FfConfiguration& configuration, int step, bool live_ones_too)
      : FfLas(configuration), step_(step), live_ones_too_(live_ones_too) {}

 private:
  std::uint8_t next_probe(std::uint8_t last) const override {
    const int first = rules().first_node;
    const int count = rules().last_node - first + 1;
    int node = last;
    for (int n = 0; n < count; ++n) {
      node = first + (node - first + step_ + count) % count;
      if (!is_left_out(static_cast<unsigned>(node))) return static_cast<std::uint8_t>(node);
    }
    return this->node();  // all are live
  }
  bool is_left_out(unsigned node) const {
    const bool is_unpolled =
        node >= rules().first_unpolled && node < rules().first_unpolled + rules().unpolled;
    return is_unpolled || node == this->node() || (live()[node] && !live_ones_too_);
  }
  int step_;
  bool live_ones_too_;
};

class ProbesUnpolled : public FfLas {
  using FfLas::FfLas;
  std::uint8_t next_probe(std::uint8_t last) const override {
    std::uint8_t node = last;
    do {
      node = node == rules().last_node ? rules().first_node : static_cast<std::uint8_t>(node + 1);
    } while (live()[node] && node != last);
    return live()[node] ? this->node() : node;
  }
};

class NoProbeWhenBusy : public FfLas {
  using FfLas::FfLas;
  bool probes_now() const override { return rotation() < octet_times(250); }
};

class SteersTheWrongWay : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration rotation) const override { return !FfLas::is_too_slow(rotation); }
};

class StepsToTheExtreme : public FfLas {
  using FfLas::FfLas;
  Priority next_priority(Priority, bool is_too_slow) const override {
    return is_too_slow ? Priority::urgent : Priority::time_available;
  }
};

class RotationCountedTwice : public FfLas {
  using FfLas::FfLas;
  Duration rotation_of(Time last, Time now) const override { return 2 * FfLas::rotation_of(last, now); }
};

class StepsBackToTheExtreme : public FfLas {
  using FfLas::FfLas;
  Priority next_priority(Priority now, bool is_too_slow) const override {
    return is_too_slow ? Priority::urgent : FfLas::next_priority(now, is_too_slow);
  }
};

class HolderNeverStopped : public FfLas {
  using FfLas::FfLas;
  Time holder_until(Time, unsigned) const override { return kernel::kNever; }
};

class ReturnOfAnybodyTaken : public FfLas {
  using FfLas::FfLas;
  bool is_from_awaited(const FfDlpdu&) const override { return true; }
};

class TargetIgnored : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration) const override { return false; }
};

class EqualRotationIsFast : public FfLas {
  using FfLas::FfLas;
  bool is_too_slow(Duration rotation) const override { return rotation > rules().target_rotation; }
};

// ---- live list ----

// Says IDLE in place of some DLPDUs.
class IdlesInPlaceOf : public FfLas {
 public:
  using Is = bool (*)(const FfDlpdu&, const FfConfiguration&);
  IdlesInPlaceOf(const FfConfiguration& configuration, Is is) : FfLas(configuration), is_(is) {}

 private:
  Octets written(const FfDlpdu& dlpdu) const override {
    return FfLas::written(is_(dlpdu, configuration()) ? FfDlpdu{.type = FfType::idle} : dlpdu);
  }
  Is is_;
};

class LiveListReversed : public FfLas {
  using FfLas::FfLas;
  Octets live_list() const override {
    Octets list = FfLas::live_list();
    for (std::size_t n = 2; n < list.size(); ++n)
      list[n] = static_cast<std::uint8_t>(line::reflect(list[n], 8));
    return list;
  }
};

class IdlesEarly : public FfLas {
  using FfLas::FfLas;
  kernel::Duration longest_silence() const override { return FfLas::longest_silence() * 5 / 8; }
};

// A DT1 of its own entity.
inline bool is_of_entity(const FfDlpdu& dt1) {
  return (dt1.source & 0xFFU) == fieldbus_dll::kEntity;
}

class LiveListUnnumbered : public FfLas {
  using FfLas::FfLas;
  Octets live_list() const override { return fieldbus_dll::live_list_spdu(0, live()); }
};

class NotInItsLiveList : public FfLas {
  using FfLas::FfLas;
  Octets live_list() const override {
    Octets list = FfLas::live_list();
    list[2U + node() / 8U] &= static_cast<std::uint8_t>(~(0x80U >> node() % 8));
    return list;
  }
};

class LiveListCut : public FfLas {
  using FfLas::FfLas;
  Octets live_list() const override {
    Octets list = FfLas::live_list();
    list.resize(6);
    return list;
  }
};

class RemovesBehind : public FfLas {
 public:
  RemovesBehind(const FfConfiguration& configuration, unsigned misses)
      : FfLas(configuration), misses_(misses) {}

 private:
  bool is_missed_too_often(unsigned misses) const override { return misses >= misses_; }
  unsigned misses_;
};

class MissesNotForgotten : public FfLas {
  using FfLas::FfLas;
  void on_token_used(std::uint8_t) override {}
};

class ProbeResponseOfAnybodyTaken : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    if (other.type == FfType::pr) other.node = awaited();
    FfLas::on_dlpdu(other, place);
  }
};

// ---- time ----

class TimeToldAtFullPeriod : public FfLas {
  using FfLas::FfLas;
  Duration time_distributed_every() const override { return rules().time_distribution_period; }
};

class TimeAtHalfSpeed : public FfLas {
  using FfLas::FfLas;
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    other.link_time /= 2;
    return FfLas::written(other);
  }
};

class CtIgnored : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != FfType::ct) FfLas::on_dlpdu(dlpdu, place);
  }
};

// ---- who is the scheduler ----

class ClaimsOtherwise : public FfLas {
 public:
  // After so many slot times, and those of its node where `by_node` is set.
  ClaimsOtherwise(const FfConfiguration& configuration, int slots, bool by_node)
      : FfLas(configuration), slots_(slots), by_node_(by_node) {}

 private:
  Duration claim_silence() const override {
    const Duration base = by_node_ ? FfLas::claim_silence() : Duration{};
    return base + octet_times(std::int64_t{slots_} * rules().link.slot_time_octets);
  }
  int slots_;
  bool by_node_;
};

class FramesDoNotSaveTheLink : public FfLas {
  using FfLas::FfLas;
  Time silent_for_claim_since() const override { return line().driven_until(); }
};

class NoiseDoesNotSaveTheLink : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    last_frame_ = place.end;
    FfLas::on_dlpdu(dlpdu, place);
  }
  Time silent_for_claim_since() const override { return std::max(last_frame_, line().driven_until()); }
  Time last_frame_ = kernel::kStart;
};

class TransferIgnored : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != FfType::tl) FfLas::on_dlpdu(dlpdu, place);
  }
};

class TakesTransferOfOthers : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    if (other.type == FfType::tl) other.node = node();
    FfLas::on_dlpdu(other, place);
  }
};

class TransferNotChecked : public FfLas {
  using FfLas::FfLas;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    for (line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate)) {
      const bool is_tl = frame.octets.size() == 6 && frame.octets[0] == rules().codes.tl;
      if (frame.end != line::FrameEnd::whole || !is_tl) continue;
      frame.octets.resize(4);
      return {{frame.octets, reception.start, reception.end()}};
    }
    return FfLas::heard_in(reception);
  }
};

class ScheduleVersionIgnored : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    if (other.type == FfType::tl) other.schedule_version = configuration().schedule.version;
    FfLas::on_dlpdu(other, place);
  }
};

class OrderIgnored : public FfLas {
  using FfLas::FfLas;
  bool order_transfer(std::uint8_t, Time) override { return true; }
};

class StaysBehindTransfer : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (las_state() != fieldbus_dll::FfLasState::transferring) FfLas::on_dlpdu(dlpdu, place);
  }
  bool leaves_to(const FfDlpdu&) const override { return false; }
};

class NeverRetakes : public FfLas {
  using FfLas::FfLas;
  bool retakes() const override { return false; }
};

class ScheduleFromTheClaim : public FfLas {
  using FfLas::FfLas;
  Time put_on_line(const Octets& octets, Time now) override {
    if (octets[0] == rules().codes.cl) claimed_ = now;
    return FfLas::put_on_line(octets, now);
  }
  Time due(const FfScheduleItem& item) const override {
    const Duration macrocycle = configuration().schedule.macrocycle * fieldbus_dll::kTick;
    return FfLas::due(item) + (claimed_ - kernel::kStart) % macrocycle;
  }
  Time claimed_ = kernel::kStart;
};

class ToldLiveListIgnored : public FfLas {
  using FfLas::FfLas;
  void on_spdu(const FfDlpdu& dlpdu, Time now) override { FfStation::on_spdu(dlpdu, now); }
};

class DeafInStandby : public FfLas {
  using FfLas::FfLas;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_of_a_device =
        dlpdu.type == FfType::pn || dlpdu.type == FfType::pt || dlpdu.type == FfType::cd;
    if (is_scheduler() || !is_of_a_device) FfLas::on_dlpdu(dlpdu, place);
  }
};

class OwnDataKept : public FfLas {
  using FfLas::FfLas;
  std::optional<Priority> next_to_send(const Queues& queues, Priority least) const override {
    if (is_scheduler()) return std::nullopt;
    return FfLas::next_to_send(queues, least);
  }
};

class NeverLeaves : public FfLas {
  using FfLas::FfLas;
  bool leaves_to(const FfDlpdu&) const override { return false; }
};

class StaysBehindClaim : public FfLas {
  using FfLas::FfLas;
  bool leaves_to(const FfDlpdu& dlpdu) const override {
    return dlpdu.type != FfType::cl && FfLas::leaves_to(dlpdu);
  }
};

// ---- supply ----

class LiveListOutlastsSupply : public FfLas {
  using FfLas::FfLas;
  void stop(Time now) override { FfStation::stop(now); }
};

class BeginsOnce : public FfLas {
  using FfLas::FfLas;
  bool start(Time now) override {
    return std::exchange(has_begun_, true) ? FfStation::start(now) : FfLas::start(now);
  }
  bool has_begun_ = false;
};

}  // namespace fieldproof::conformance::ff_seeded_faults

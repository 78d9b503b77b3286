#pragma once

#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"

// Link masters that claim, hand over or lose the link otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

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

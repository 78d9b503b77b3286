#pragma once

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/frame_check.hpp"

// Link masters that keep the live list, or tell the time, otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

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

}  // namespace fieldproof::conformance::ff_seeded_faults

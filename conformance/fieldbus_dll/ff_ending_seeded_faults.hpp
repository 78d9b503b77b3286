#pragma once

#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"

// Basic devices that end a wait, a token or their own work at another time, or because of something else.
namespace fieldproof::conformance::ff_seeded_faults {

// How long it waits for a line that others keep busy.
class AnswersUntil : public FfStation {
 public:
  using Wait = Duration (*)(const fieldbus_dll::LinkRules& link);
  AnswersUntil(const FfConfiguration& configuration, Wait wait) : FfStation(configuration), wait_(wait) {}

 private:
  Time answer_until(const Place& place) const override { return place.end + wait_(rules().link); }
  Wait wait_;
};

class NoDlpduIsTakenForOne : public FfStation {
  using FfStation::FfStation;
  std::optional<FfDlpdu> understood(HeardOctets octets) const override {
    return FfStation::understood(octets).value_or(FfDlpdu{.type = FfType::pn});
  }
};

class WrongCheckIsTakenForOne : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = FfStation::heard_in(reception);
    const Octets probe_of_nobody{rules().codes.pn, 0};
    if (all.empty()) all.push_back({probe_of_nobody, reception.start, reception.end()});
    return all;
  }
};

// What it takes a type of DLPDU for; nothing: it leaves it.
class TakesTypeFor : public FfStation {
 public:
  TakesTypeFor(const FfConfiguration& configuration, FfType type, std::optional<FfType> other)
      : FfStation(configuration), type_(type), other_(other) {}

 private:
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != type_) return FfStation::on_dlpdu(dlpdu, place);
    if (!other_) return;
    FfDlpdu other = dlpdu;
    other.type = *other_;
    FfStation::on_dlpdu(other, place);
  }
  FfType type_;
  std::optional<FfType> other_;
};

class HalfABitIntoWhatFollows : public FfStation {
  using FfStation::FfStation;
  bool fits(const FfDlpdu& dlpdu, Time begin) const override {
    return FfStation::fits(dlpdu, begin - octet_times(1) / 16);
  }
};

class ReturnsWhateverIsLeft : public FfStation {
  using FfStation::FfStation;
  bool fits(const FfDlpdu& dlpdu, Time begin) const override {
    return dlpdu.type == FfType::rt || FfStation::fits(dlpdu, begin);
  }
};

class QueueOf128 : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    if (!FfStation::submit(request, now)) return false;
    auto& queue = queues().queue(request.priority);
    if (queue.size() > 128) queue.pop_back();
    return true;
  }
};

class Takes256 : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    if (++heard_ > 256) return {};
    return FfStation::heard_in(reception);
  }
  unsigned heard_ = 0;
};

class ForgetsInSilence : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    if (reception.start - heard_ > 10 * kernel::kSecond) enter(fieldbus_dll::FfState::stopped);
    heard_ = reception.end();
    if (state() == fieldbus_dll::FfState::stopped) return {};
    return FfStation::heard_in(reception);
  }
  Time heard_ = kernel::kStart;
};

}  // namespace fieldproof::conformance::ff_seeded_faults

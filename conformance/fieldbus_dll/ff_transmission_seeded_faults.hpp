#pragma once

#include <algorithm>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"

// Basic devices that are wrong in what surrounds a frame: what is on the line in front of it, while they send
// and while their user asks, and what a setting says once only.
namespace fieldproof::conformance::ff_seeded_faults {

// A receiver that counts half bits in pairs from where the transmission begins.
class FindsPairsOnly : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    const auto frames = line::delimited_frames_in(reception, rules().link.bit_rate);
    const bool has_odd = std::ranges::any_of(frames, [](const auto& one) { return one.half_bit % 2 != 0; });
    return has_odd ? std::vector<Arrived>{} : FfStation::heard_in(reception);
  }
};

class DeafBehindNoSymbol : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kLongestRun = 2;
    const bool begins_with_none = reception.levels.end_of_run(0) * std::size_t(2 * rules().link.bit_rate) >
                                  kLongestRun * static_cast<std::size_t>(reception.rate);
    return begins_with_none ? std::vector<Arrived>{} : FfStation::heard_in(reception);
  }
};

class DeafBehindACutFrame : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    const auto frames = line::delimited_frames_in(reception, rules().link.bit_rate);
    const bool is_cut = !frames.empty() && frames.front().end == line::FrameEnd::code_violation;
    return is_cut ? std::vector<Arrived>{} : FfStation::heard_in(reception);
  }
};

class NodeFfIsNobody : public FfStation {
  using FfStation::FfStation;
  bool is_mine(std::uint8_t node) const override { return node != 0xFF && FfStation::is_mine(node); }
};

// A watchdog that counts how long the line is busy.
class RestartsOnALongJabber : public FfStation {
  using FfStation::FfStation;
  void on_activity(segment::PortIndex port, bool begins, Time now) override {
    FfStation::on_activity(port, begins, now);
    if (begins) {
      since_ = now;
    } else if (now - since_ > kernel::kSecond && state() != fieldbus_dll::FfState::stopped) {
      stop(now);
      start(now);
    }
  }
  Time since_ = kernel::kStart;
};

// Its receiver stays on while it sends.
class ReceivesWhileSending : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    fieldbus_dll::LineEnd other(rules().link);
    return other.receive(reception);
  }
};

class TakesOthersForItsEcho : public FfStation {
  using FfStation::FfStation;
  void on_activity(segment::PortIndex port, bool begins, Time now) override {
    if (begins) is_echo_ = line().is_driving(now);
    if (!is_echo_) FfStation::on_activity(port, begins, now);
  }
  bool is_echo_ = false;
};

class RefusesOnABusyLine : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    return line().silent_since() != kernel::kNever && FfStation::submit(request, now);
  }
};

class ShortRequestsTaken : public FfStation {
  using FfStation::FfStation;
  bool ask(const Octets& request, Time) override { return !request.empty() && request.front() == 1; }
};

class LongDt3Unsupported : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    const bool is_left =
        dlpdu.type == FfType::dt3 && dlpdu.has_long_addresses && !configuration().supports_long_addresses;
    if (!is_left) FfStation::on_dlpdu(dlpdu, place);
  }
};

class RefusesOnce : public FfStation {
  using FfStation::FfStation;
  bool start(Time now) override {
    const bool is_started = FfStation::start(now);
    has_refused_ = true;
    return is_started;
  }
  bool are_impossible() const override { return !has_refused_ && FfStation::are_impossible(); }
  bool has_refused_ = false;
};

}  // namespace fieldproof::conformance::ff_seeded_faults

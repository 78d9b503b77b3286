#pragma once

#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"

// Basic devices that hear frames, or tell their user of them, otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- frames ----

// Frames whose check this says to be right, besides those whose check is.
class TakesOtherChecks : public FfStation {
 public:
  using FfStation::FfStation;

 private:
  virtual bool takes(const Octets& octets) const = 0;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    std::vector<Arrived> all = FfStation::heard_in(reception);
    if (!all.empty()) return all;
    for (line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate)) {
      const bool is_whole =
          frame.end == line::FrameEnd::whole && frame.octets.size() > fieldbus_dll::kCheckOctets;
      if (!is_whole || !takes(frame.octets)) continue;
      frame.octets.resize(frame.octets.size() - fieldbus_dll::kCheckOctets);
      all.push_back({std::move(frame.octets), reception.start, reception.end()});
    }
    return all;
  }
};

class MarkedTokenUnknown : public FfStation {
  using FfStation::FfStation;
  std::optional<FfDlpdu> understood(HeardOctets octets) const override {
    auto dlpdu = FfStation::understood(octets);
    if (dlpdu && dlpdu->type == FfType::pt && dlpdu->begins_circulation) dlpdu.reset();
    return dlpdu;
  }
};

class SendsOtherAddress : public FfStation {
 public:
  SendsOtherAddress(const FfConfiguration& configuration, FfAddress FfDlpdu::* field)
      : FfStation(configuration), field_(field) {}

 private:
  Octets written(const FfDlpdu& dlpdu) const override {
    constexpr FfAddress kOtherNode = 0x0100;
    FfDlpdu other = dlpdu;
    if (other.type == FfType::dt1) other.*field_ ^= kOtherNode;
    return FfStation::written(other);
  }
  FfAddress FfDlpdu::* field_;
};

class AnswersCdOffline : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type == FfType::cd && state() == fieldbus_dll::FfState::offline)
      return answer({.type = FfType::sr, .is_final = true}, place);
    FfStation::on_dlpdu(dlpdu, place);
  }
};

// Its user hears of what comes through this.
class TellsOtherwise : public FfStation, private fieldbus_dll::FfUser {
 public:
  using Tell = void (*)(fieldbus_dll::FfUser& user, FfDlpdu dlpdu, Time when);
  TellsOtherwise(const FfConfiguration& configuration, Tell how) : FfStation(configuration), tell_(how) {}

  void wire(segment::Port& line, fieldbus_dll::FfUser& user) override {
    told_ = &user;
    FfStation::wire(line, *this);
  }

 private:
  void on_data(const FfDlpdu& dlpdu, Time when) override { tell_(*told_, dlpdu, when); }
  void on_published(const FfDlpdu& dlpdu, Time when) override { tell_(*told_, dlpdu, when); }
  void on_event(const fieldbus_dll::FfEvent& event, Time when) override { told_->on_event(event, when); }

  Tell tell_;
  fieldbus_dll::FfUser* told_ = nullptr;
};

inline void tell_user(fieldbus_dll::FfUser& user, const FfDlpdu& dlpdu, Time when) {
  if (dlpdu.type == FfType::dt3) return user.on_published(dlpdu, when);
  user.on_data(dlpdu, when);
}

class TellsLiveLists : public FfStation {
  using FfStation::FfStation;
  void on_spdu(const FfDlpdu& dlpdu, Time now) override {
    FfStation::on_spdu(dlpdu, now);
    user().on_data(dlpdu, now);
  }
};

class ActivatedByAnything : public FfStation {
  using FfStation::FfStation;
  void on_spdu(const FfDlpdu& dlpdu, Time now) override {
    FfDlpdu other = dlpdu;
    other.data[0] = static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation);
    FfStation::on_spdu(other, now);
  }
};

class ActivatedByBroadcast : public FfStation {
  using FfStation::FfStation;
  void on_spdu(const FfDlpdu& dlpdu, Time now) override {
    FfDlpdu other = dlpdu;
    other.destination = fieldbus_dll::address_of(node());
    FfStation::on_spdu(other, now);
  }
};

class ActivatedByItsUsersData : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfStation::on_dlpdu(dlpdu, place);
    if (dlpdu.type == FfType::dt1 && is_mine(fieldbus_dll::node_of(dlpdu.destination)) &&
        state() == fieldbus_dll::FfState::offline)
      enter(fieldbus_dll::FfState::idle);
  }
};

class SilenceOfTheUsualLink : public FfStation {
  using FfStation::FfStation;
  Duration silence_before_sending() const override {
    return octet_times(fieldbus_dll::LinkRules{}.inter_pdu_delay_octets);
  }
};

class AnswersInTheUsualTime : public FfStation {
  using FfStation::FfStation;
  Duration silence_before_sending() const override {
    // As slowly as a usual link allows.
    return response_delay(fieldbus_dll::LinkRules{});
  }
  Time answer_until(const Place& place) const override {
    return place.end + 2 * response_delay(fieldbus_dll::LinkRules{});
  }
};

class TailIgnored : public FfStation {
  using FfStation::FfStation;
  std::optional<FfDlpdu> understood(HeardOctets octets) const override {
    auto whole = FfStation::understood(octets);
    if (whole || octets.size() < 2) return whole;
    return FfStation::understood(octets.first(octets.size() - 1));
  }
};

class TakesOtherResidue : public TakesOtherChecks {
  using TakesOtherChecks::TakesOtherChecks;
  bool takes(const Octets& octets) const override {
    Octets other = octets;
    for (std::size_t n = other.size() - fieldbus_dll::kCheckOctets; n < other.size(); ++n)
      other[n] = static_cast<std::uint8_t>(~other[n]);
    return fieldbus_dll::with_check(HeardOctets(other).first(other.size() - fieldbus_dll::kCheckOctets)) ==
           other;
  }
};

// A symbol without an edge in its middle is taken for what its first half says, and the check is left alone.
class TakesViolatedFrames : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kDelimiter = 16;
    const std::int64_t bit_rate = rules().link.bit_rate;
    const auto frames = line::delimited_frames_in(reception, bit_rate);
    if (frames.empty() || frames.front().end != line::FrameEnd::code_violation)
      return FfStation::heard_in(reception);
    line::Waveform mended{reception.start, 2 * bit_rate, line::half_bits_of(reception, bit_rate)};
    const std::size_t first = frames.front().half_bit + kDelimiter;
    for (std::size_t at = first; at + kDelimiter < mended.levels.size(); at += 2)
      mended.levels.set(at + 1, !mended.levels[at]);
    std::vector<Arrived> all;
    for (line::DelimitedFrame& frame : line::delimited_frames_in(mended, bit_rate)) {
      if (frame.octets.size() <= fieldbus_dll::kCheckOctets) continue;
      frame.octets.resize(frame.octets.size() - fieldbus_dll::kCheckOctets);
      all.push_back({frame.octets, reception.start, reception.end()});
    }
    return all;
  }
};

class FfStuckBehindViolation : public FfStation {
  using FfStation::FfStation;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    for (const line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate))
      is_stuck_ |= frame.end == line::FrameEnd::code_violation;
    return is_stuck_ ? std::vector<Arrived>{} : FfStation::heard_in(reception);
  }
  bool is_stuck_ = false;
};

class CheckOfTokensOnly : public TakesOtherChecks {
  using TakesOtherChecks::TakesOtherChecks;
  bool takes(const Octets& octets) const override { return (octets[0] & ~0x07) != rules().codes.pt; }
};

class CheckOfHighOctet : public TakesOtherChecks {
  using TakesOtherChecks::TakesOtherChecks;
  bool takes(const Octets& octets) const override {
    Octets right =
        fieldbus_dll::with_check(HeardOctets(octets).first(octets.size() - fieldbus_dll::kCheckOctets));
    right.back() = octets.back();
    return right == octets;
  }
};

// Reads another first octet than the one that came.
class ReadsControlAs : public FfStation {
 public:
  using ControlOctet = std::uint8_t (*)(std::uint8_t);
  ReadsControlAs(const FfConfiguration& configuration, ControlOctet read)
      : FfStation(configuration), read_(read) {}

 private:
  std::optional<FfDlpdu> understood(HeardOctets octets) const override {
    Octets other(octets.begin(), octets.end());
    if (!other.empty()) other[0] = read_(other[0]);
    return FfStation::understood(other);
  }
  ControlOctet read_;
};

class NoSilenceBehindOwn : public FfStation {
  using FfStation::FfStation;
  Time may_begin() const override {
    const Time since = line().silent_since();
    return since == line().driven_until() ? since + octet_times(1) : FfStation::may_begin();
  }
};

}  // namespace fieldproof::conformance::ff_seeded_faults

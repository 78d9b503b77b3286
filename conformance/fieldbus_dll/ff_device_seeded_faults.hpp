#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/ff_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check.hpp"

// Basic devices that answer, send, publish or hear otherwise.
namespace fieldproof::conformance::ff_seeded_faults {

// ---- probes ----

class NoProbeResponse : public FfStation {
  using FfStation::FfStation;
  bool answers_probe() const override { return false; }
};

// Drives so many DLPDUs and no more.
class MuteAfter : public FfStation {
 public:
  MuteAfter(const FfConfiguration& configuration, unsigned driven)
      : FfStation(configuration), left_(driven) {}

 private:
  Time put_on_line(const Octets& octets, Time now) override {
    if (left_ == 0) return now;
    --left_;
    return FfStation::put_on_line(octets, now);
  }
  unsigned left_;
};

class AnswersLate : public FfStation {
  using FfStation::FfStation;
  Duration silence_before_sending() const override { return response_delay(rules().link) + octet_times(1); }
  Time answer_until(const Place& place) const override {
    return FfStation::answer_until(place) + response_delay(rules().link);
  }
};

class AnswersForAllNodes : public FfStation {
  using FfStation::FfStation;
  bool is_mine(std::uint8_t) const override { return true; }
};

class LiveFromTheStart : public FfStation {
  using FfStation::FfStation;
  bool start(Time now) override {
    const bool has_started = FfStation::start(now);
    enter(fieldbus_dll::FfState::idle);
    return has_started;
  }
};

// ---- tokens ----

class FfPriorityInverted : public FfStation {
  using FfStation::FfStation;
  bool may_send(Priority priority, Priority least) const override { return priority <= least; }
};

class FfPriorityIgnored : public FfStation {
  using FfStation::FfStation;
  bool may_send(Priority, Priority) const override { return true; }
};

class FfFifoAcrossPriorities : public FfStation {
  using FfStation::FfStation;
  bool submit(const FfRequest& request, Time now) override {
    const bool is_taken = FfStation::submit(request, now);
    if (is_taken) order_.push_back(request.priority);
    return is_taken;
  }
  // Those that were sent are missing from the queues.
  std::optional<Priority> next_to_send(const Queues& from, Priority) const override {
    std::map<Priority, std::size_t> left;
    for (const Priority priority : Queues::kMostUrgentFirst) left[priority] = from.queue(priority).size();
    std::optional<Priority> first;
    for (auto at = order_.rbegin(); at != order_.rend(); ++at) {
      if (left[*at] == 0) continue;
      --left[*at];
      first = *at;
    }
    return first;
  }
  std::deque<Priority> order_;
};

class OneFrameAToken : public FfStation {
  using FfStation::FfStation;
  std::optional<Priority> next_to_send(const Queues& from, Priority least) const override {
    if (token() && token()->ends == used_) return std::nullopt;
    return FfStation::next_to_send(from, least);
  }
  Time put_on_line(const Octets& octets, Time now) override {
    if (token()) used_ = token()->ends;
    return FfStation::put_on_line(octets, now);
  }
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    if (dlpdu.type == FfType::dt1) other.is_final = true;
    return FfStation::written(other);
  }
  void use_token(Time now) override {
    FfStation::use_token(now);
    if (token() && token()->ends == used_) {
      drop_token();
      enter(fieldbus_dll::FfState::idle);
    }
  }
  Time used_ = kernel::kNever;
};

class NoReturnWhenEmpty : public FfStation {
  using FfStation::FfStation;
  bool returns_by_rt(bool) const override { return false; }
};

class ReturnsTwice : public FfStation {
  using FfStation::FfStation;
  bool returns_by_rt(bool) const override { return true; }
};

class NeverFinal : public FfStation {
  using FfStation::FfStation;
  Octets written(const FfDlpdu& dlpdu) const override {
    FfDlpdu other = dlpdu;
    other.is_final = false;
    return FfStation::written(other);
  }
};

class QueueLostWithToken : public FfStation {
  using FfStation::FfStation;
  void use_token(Time now) override {
    FfStation::use_token(now);
    if (!token()) queues() = {};
  }
};

// The duration of a token times this many bits.
class DurationTimes : public FfStation {
 public:
  DurationTimes(const FfConfiguration& configuration, int bits) : FfStation(configuration), bits_(bits) {}

 private:
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.end + octet_times(std::int64_t{pt.duration} * bits_) / 8;
  }
  int bits_;
};

// What it takes the duration of a token for.
class DurationReadAs : public FfStation {
 public:
  using Read = std::int64_t (*)(std::uint16_t);
  DurationReadAs(const FfConfiguration& configuration, Read read) : FfStation(configuration), read_(read) {}

 private:
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.end + octet_times(read_(pt.duration));
  }
  Read read_;
};

class FfDurationIgnored : public FfStation {
  using FfStation::FfStation;
  Time token_end(const FfDlpdu&, const Place&) const override { return kernel::kNever; }
};

class DurationFromBeginOfPt : public FfStation {
  using FfStation::FfStation;
  Time token_end(const FfDlpdu& pt, const Place& place) const override {
    return place.begin + octet_times(pt.duration);
  }
};

class FfFitIsStrict : public FfStation {
  using FfStation::FfStation;
  bool fits(const FfDlpdu& dlpdu, Time begin) const override {
    return begin + needed_for(dlpdu) < token()->ends;
  }
};

class OverheadNotCharged : public FfStation {
  using FfStation::FfStation;
  Duration needed_for(const FfDlpdu& dlpdu) const override {
    return FfStation::needed_for(dlpdu) - octet_times(octets_around(rules().link));
  }
};

class FfUrgentAsLongAsNormal : public FfStation {
  using FfStation::FfStation;
  bool is_too_long(Priority priority, std::size_t octets) const override {
    return FfStation::is_too_long(priority == Priority::urgent ? Priority::normal : priority, octets);
  }
};

// ---- publishers ----

class PublishesFirstWrite : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.data = first_.try_emplace(address, dt3.data).first->second;
    return dt3;
  }
  std::map<FfAddress, Octets> first_;
};

class PublishedNotFinal : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.is_final = false;
    return dt3;
  }
};

// The first half is that of the time before.
class BufferTorn : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    const Octets whole = dt3.data;
    const Octets& before = last_[address];
    for (std::size_t n = 0; n < std::min(before.size(), whole.size()) / 2; ++n) dt3.data[n] = before[n];
    last_[address] = whole;
    return dt3;
  }
  std::map<FfAddress, Octets> last_;
};

class CountsReads : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    ++buffer.writes;
    return FfStation::published(address, buffer);
  }
};

class CountsNothing : public FfStation {
  using FfStation::FfStation;
  FfDlpdu published(FfAddress address, Buffer& buffer) override {
    FfDlpdu dt3 = FfStation::published(address, buffer);
    dt3.writes = 0;
    return dt3;
  }
};

class CountsTo255 : public FfStation {
  using FfStation::FfStation;
  bool write(FfAddress address, const Octets& data, Time now) override {
    Buffer* const buffer = buffer_of(address);
    const bool is_full = buffer != nullptr && buffer->writes == 255;
    if (!FfStation::write(address, data, now)) return false;
    if (is_full) buffer->writes = 255;
    return true;
  }
};

class PublishesAnything : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    const bool is_mine_at_all = dlpdu.type == FfType::cd && is_mine(fieldbus_dll::node_of(dlpdu.destination));
    if (is_mine_at_all) other.destination = configuration().published.front();
    FfStation::on_dlpdu(other, place);
  }
};

class SubscribedTo : public FfStation {
 public:
  SubscribedTo(const FfConfiguration& configuration, bool all) : FfStation(configuration), all_(all) {}

 private:
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    if (dlpdu.type != FfType::dt3) return FfStation::on_dlpdu(dlpdu, place);
    if (all_) user().on_published(dlpdu, place.end);
  }
  bool all_;
};

class SubscribedWithoutLink : public FfStation {
  using FfStation::FfStation;
  void on_dlpdu(const FfDlpdu& dlpdu, const Place& place) override {
    FfDlpdu other = dlpdu;
    for (const FfAddress one : configuration().subscribed) {
      if (dlpdu.type == FfType::dt3 && (one & 0xFFFF) == (dlpdu.source & 0xFFFF)) other.source = one;
    }
    FfStation::on_dlpdu(other, place);
  }
};

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

#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "harness/line/frame_check.hpp"
#include "protocols/token_bus/token_station.hpp"

// Stations of the token bus that differ from the reference in one decision each; station_mutants.cpp names
// and describes them. A decision that is a number is changed in the rules there, without a class.
namespace fieldproof::conformance::token_seeded_faults {

using kernel::Duration;
using kernel::Time;
using token_bus::AccessState;
using token_bus::Address;
using token_bus::Frame;
using token_bus::FrameKind;
using token_bus::FrameReader;
using token_bus::Octets;
using token_bus::Reception;
using token_bus::ReceptionKind;
using token_bus::Rules;
using token_bus::StationConfiguration;
using token_bus::TokenStation;

// Stands between its station and the user of it; what is not overridden is passed on.
template <typename Station = TokenStation>
class BetweenUser : public Station, protected token_bus::StationUser {
 public:
  using Station::Station;
  void wire(segment::Port& line, token_bus::StationUser& user) override {
    user_ = &user;
    Station::wire(line, *this);
  }

 protected:
  void on_data(const Frame& frame, Time when) override { user_->on_data(frame, when); }
  void on_event(const token_bus::Event& event, Time when) override { user_->on_event(event, when); }
  token_bus::StationUser& user() { return *user_; }

 private:
  token_bus::StationUser* user_ = nullptr;
};

// ---- initialisation ----

class ClaimsLeastPairFirst : public TokenStation {
  using TokenStation::TokenStation;
  unsigned claim_bits(unsigned pass) override {
    const unsigned pairs = token_bus::contest_passes(rules()) - 1;
    return pass < pairs ? contest_bits(pairs - 1 - pass) : contest_bits(pass);
  }
};

class ClaimsInSingleSlots : public TokenStation {
  using TokenStation::TokenStation;
  unsigned claim_slots(unsigned bits) const override { return bits; }
};

class RivalIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool loses_claim() const override { return false; }
};

class ClaimsOtherNumber : public TokenStation {
 public:
  ClaimsOtherNumber(const StationConfiguration& configuration, int more)
      : TokenStation(configuration), more_(more) {}

 private:
  unsigned claim_passes() const override {
    return static_cast<unsigned>(static_cast<int>(TokenStation::claim_passes()) + more_);
  }
  int more_;
};

// ---- joining ----

class AddressesHighOctetFirst : public TokenStation {
  using TokenStation::TokenStation;
  static Address turned(Address address) { return (address & 0xFF) << 8 | address >> 8; }
  std::optional<unsigned> window_of(const Frame& solicitation) const override {
    const Address own = turned(address());
    const Address sender = turned(solicitation.source);
    const Address successor = turned(solicitation.destination);
    if (solicitation.kind == FrameKind::solicit_successor_1)
      return own < sender && own > successor ? std::optional(0U) : std::nullopt;
    if (own < sender) return 0;
    return own > successor ? std::optional(1U) : std::nullopt;
  }
};

class RangeWithItsEnds : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<unsigned> window_of(const Frame& solicitation) const override {
    if (solicitation.destination == address()) return 0;
    return TokenStation::window_of(solicitation);
  }
};

class SecondWindowAtOnce : public TokenStation {
  using TokenStation::TokenStation;
  Duration window_delay(unsigned) const override { return {}; }
};

class AnswersWithSuccessor : public TokenStation {
  using TokenStation::TokenStation;
  Address answered_with() const override { return address() + 2; }
};

class ContestNotComplemented : public TokenStation {
  using TokenStation::TokenStation;
  unsigned demand_slots(unsigned bits) const override { return bits; }
};

class ContestWithFirstPairOnly : public TokenStation {
  using TokenStation::TokenStation;
  unsigned demand_bits(unsigned) override { return contest_bits(0); }
};

class YieldsToNobody : public TokenStation {
  using TokenStation::TokenStation;
  bool yields_in_delay() const override { return false; }
};

class SuccessorIsWhoSolicited : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (frame && frame->kind == FrameKind::solicit_successor_1 && window_of(*frame)) {
      frame->kind = FrameKind::solicit_successor_2;
      frame->destination = frame->source;
    }
    return frame;
  }
};

class AnswersAsTheLostOne : public TokenStation {
  using TokenStation::TokenStation;
  bool follows(const Frame& who_follows) const override {
    return token_bus::address_of(who_follows.data) == address();
  }
};

class AlwaysJoins : public TokenStation {
  using TokenStation::TokenStation;
  void set_in_ring_desired(bool, Time) override {}
};

// ---- passing ----

class OpensNoWindow : public TokenStation {
  using TokenStation::TokenStation;
  bool opens_window(Time) override { return false; }
};

class WindowsOtherwise : public TokenStation {
 public:
  WindowsOtherwise(const StationConfiguration& configuration, FrameKind kind, unsigned windows)
      : TokenStation(configuration), kind_(kind), windows_(windows) {}

 private:
  unsigned windows_of(FrameKind kind) const override {
    return kind == kind_ ? windows_ : TokenStation::windows_of(kind);
  }
  FrameKind kind_;
  unsigned windows_;
};

class LowestAsOthers : public TokenStation {
  using TokenStation::TokenStation;
  bool is_lowest() const override { return false; }
};

class AnswerNotTaken : public TokenStation {
  using TokenStation::TokenStation;
  bool takes_successor(const Frame&) const override { return false; }
};

class ResolvesOften : public TokenStation {
 public:
  ResolvesOften(const StationConfiguration& configuration, unsigned times)
      : TokenStation(configuration), times_(times) {}

 private:
  bool resolves(unsigned passes) const override { return passes < times_; }
  unsigned times_;
};

// A frame after its token is noise for it.
class SuccessNotSeen : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    if (state() == AccessState::check_token_pass) return {};
    return TokenStation::received(wave);
  }
};

class LeavesWithExchangedNeighbours : public TokenStation {
  using TokenStation::TokenStation;
  Frame leaving_frame() const override {
    Frame frame = TokenStation::leaving_frame();
    frame.destination = successor();
    frame.data = token_bus::octets_of(predecessor(), rules());
    return frame;
  }
};

class LeavesWithoutAWord : public TokenStation {
  using TokenStation::TokenStation;
  Frame leaving_frame() const override {
    return {.kind = FrameKind::set_successor,
            .destination = address() + 2,
            .source = address(),
            .data = token_bus::octets_of(address(), rules())};
  }
};

// ---- failure ----

class StagesOtherwise : public TokenStation {
 public:
  StagesOtherwise(const StationConfiguration& configuration, unsigned tokens, unsigned who_follows,
                  bool asks_any)
      : TokenStation(configuration), tokens_(tokens), who_follows_(who_follows), asks_any_(asks_any) {}

 private:
  PassStage stage_after(unsigned attempts) const override {
    if (attempts < tokens_) return PassStage::token;
    if (attempts < tokens_ + who_follows_) return PassStage::who_follows;
    return attempts == tokens_ + who_follows_ && asks_any_ ? PassStage::solicit_any : PassStage::failed;
  }
  unsigned tokens_;
  unsigned who_follows_;
  bool asks_any_;
};

class NoiseAfterTokenOtherwise : public TokenStation {
 public:
  NoiseAfterTokenOtherwise(const StationConfiguration& configuration, bool is_success)
      : TokenStation(configuration), is_success_(is_success) {}

 private:
  NoiseAfterToken noise_after_token() const override {
    return is_success_ ? NoiseAfterToken::success : NoiseAfterToken::failure;
  }
  bool is_success_;
};

class UnexpectedFramesIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool drops_token_on(const Frame&) const override { return false; }
};

class RepeatsOtherwise : public TokenStation {
 public:
  RepeatsOtherwise(const StationConfiguration& configuration, int more)
      : TokenStation(configuration), more_(more) {}

 private:
  unsigned request_repetitions() const override {
    return static_cast<unsigned>(std::max(0, static_cast<int>(TokenStation::request_repetitions()) + more_));
  }
  int more_;
};

class ResponseNotTaken : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    if (state() == AccessState::await_ifm_response) return {};
    return TokenStation::received(wave);
  }
};

class DuplicateIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool is_duplicate(const Frame&) const override { return false; }
};

// ---- holding ----

class DataLost : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    return request.data.size() < 1'000 ? TokenStation::submit(request, now) : true;
  }
};

class FrameCutAtExpiry : public TokenStation {
  using TokenStation::TokenStation;
  line::Levels written(const Frame& frame, Time begin) const override {
    const line::Levels levels = TokenStation::written(frame, begin);
    if (frame.kind != FrameKind::data || begin >= hold_until()) return levels;
    const auto left = kernel::levels_within(hold_until() - begin, 2 * rules().phy_bit_rate);
    return levels.slice(0, std::min(levels.size(), static_cast<std::size_t>(left)));
  }
};

class ServedWithoutTime : public TokenStation {
  using TokenStation::TokenStation;
  bool may_begin(unsigned place, Time begin) const override {
    return place > 0 || TokenStation::may_begin(place, begin);
  }
};

class PrioritiesIgnored : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    token_bus::DataRequest other = request;
    other.priority = 6;
    return TokenStation::submit(other, now);
  }
};

class TimersBeginWithTheToken : public TokenStation {
  using TokenStation::TokenStation;
  void on_token_taken(Time now) override {
    for (unsigned place = 1; place < left_.size(); ++place) {
      left_.at(place) = residual(place, now);
      reload(place, now);
    }
  }
  Duration hold_time(unsigned place, Time now) override {
    return place == 0 ? TokenStation::hold_time(place, now) : left_.at(place);
  }
  std::array<Duration, token_bus::kAccessClasses> left_{};
};

class HoldOtherwise : public TokenStation {
 public:
  HoldOtherwise(const StationConfiguration& configuration, int percent)
      : TokenStation(configuration), percent_(percent) {}

 private:
  Duration hold_time(unsigned place, Time now) override {
    const Duration right = TokenStation::hold_time(place, now);
    return place == 0 ? right * percent_ / 100 : right;
  }
  int percent_;
};

// ---- reception ----

// Reads frames with a reader of its own.
template <typename Reader>
class ReadsBy : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    return Reader(rules()).read(wave);
  }
};

class CheckNotLookedAt : public FrameReader {
  using FrameReader::FrameReader;
  bool is_check_right(std::span<const std::uint8_t>) const override { return true; }
};

class CheckInOtherOrderToo : public FrameReader {
  using FrameReader::FrameReader;
  bool is_check_right(std::span<const std::uint8_t> octets) const override {
    if (FrameReader::is_check_right(octets) || octets.size() <= token_bus::kCheckOctets) return true;
    Octets other(octets.begin(), octets.end());
    std::reverse(other.end() - token_bus::kCheckOctets, other.end());
    return FrameReader::is_check_right(other);
  }
};

class ErrorBitIgnored : public FrameReader {
  using FrameReader::FrameReader;
  bool counts_error_bit() const override { return false; }
};

template <int more>
class LimitOtherwise : public FrameReader {
  using FrameReader::FrameReader;
  bool is_too_long(std::size_t octets) const override {
    return static_cast<std::int64_t>(octets) > std::int64_t{rules().most_octets} + more;
  }
};

class PartOfAnOctetTaken : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    for (Reception& one : all) {
      if (one.kind != ReceptionKind::fragment || !token_bus::has_right_check(one.octets) ||
          one.octets.empty())
        continue;
      one.kind = ReceptionKind::frame;
      one.octets.resize(one.octets.size() - token_bus::kCheckOctets);
    }
    return all;
  }
};

class NoiseNotCounted : public TokenStation {
  using TokenStation::TokenStation;
  void count(ReceptionKind kind) override {
    if (kind != ReceptionKind::non_silence) TokenStation::count(kind);
  }
};

// Octets are changed before they are taken for a frame.
class UnderstandsOtherwise : public TokenStation {
 public:
  using Change = void (*)(Octets&, const Rules&);
  UnderstandsOtherwise(const StationConfiguration& configuration, Change change)
      : TokenStation(configuration), change_(change) {}

 private:
  std::optional<Frame> understood(const Octets& octets) const override {
    Octets other = octets;
    change_(other, rules());
    return TokenStation::understood(other);
  }
  Change change_;
};

inline void unknown_is_token(Octets& octets, const Rules& rules) {
  if (!token_bus::frame_of(octets, rules)) octets[0] = 0x10;
}
inline void group_is_individual(Octets& octets, const Rules&) {
  if (octets.size() > 3) octets[3] &= 0xFE;
}
inline void longer_token_is_one(Octets& octets, const Rules&) {
  constexpr std::size_t kToken = 5;
  if (octets[0] != 0x10 || octets.size() <= kToken) return;
  octets[3] = octets[7];
  octets[4] = octets[8];
  octets.resize(kToken);
}

class FirstFrameOnly : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    all.resize(1);
    return all;
  }
};

class DataForOthersDelivered : public TokenStation {
  using TokenStation::TokenStation;
  bool is_for_me(const Frame&) const override { return true; }
};

class BroadcastNotDelivered : public TokenStation {
  using TokenStation::TokenStation;
  bool is_for_me(const Frame& frame) const override { return frame.destination == address(); }
};

class RespondsWithHighestPriority : public TokenStation {
  using TokenStation::TokenStation;
  Frame response_to(const Frame& request, const Octets& data) const override {
    Frame response = TokenStation::response_to(request, data);
    response.priority = 7;
    return response;
  }
};

// What it drives differs from the frame that it means.
class WritesOtherwise : public TokenStation {
 public:
  using Change = void (*)(Frame&, const TokenStation&);
  WritesOtherwise(const StationConfiguration& configuration, Change change)
      : TokenStation(configuration), change_(change) {}

 private:
  line::Levels written(const Frame& frame, Time begin) const override {
    Frame other = frame;
    change_(other, *this);
    return TokenStation::written(other, begin);
  }
  Change change_;
};

// What it has right, its user gets otherwise; an event may be kept from it.
class ReportsOtherwise : public BetweenUser<TokenStation> {
 public:
  struct Change {
    void (*of_data)(Frame&, const TokenStation&) = nullptr;
    bool (*of_event)(token_bus::Event&) = nullptr;  // false: it is kept
  };
  ReportsOtherwise(const StationConfiguration& configuration, Change change)
      : BetweenUser(configuration), change_(change) {}

 private:
  void on_data(const Frame& frame, Time when) override {
    Frame other = frame;
    if (change_.of_data != nullptr) change_.of_data(other, *this);
    user().on_data(other, when);
  }
  void on_event(const token_bus::Event& event, Time when) override {
    token_bus::Event other = event;
    if (change_.of_event == nullptr || change_.of_event(other)) user().on_event(other, when);
  }

  Change change_;
};

// Its octets go most significant bit first.
class MostSignificantBitFirst : public TokenStation {
  using TokenStation::TokenStation;
  line::Levels written(const Frame& frame, Time) const override {
    Octets octets = token_bus::with_check(token_bus::octets_of(frame, rules()));
    for (std::uint8_t& octet : octets) octet = static_cast<std::uint8_t>(line::reflect(octet, 8));
    token_bus::MacSymbols symbols;
    token_bus::append_framed(symbols, octets, {.preamble_octets = rules().preamble_octets});
    return token_bus::half_bits_of(symbols);
  }
};

}  // namespace fieldproof::conformance::token_seeded_faults

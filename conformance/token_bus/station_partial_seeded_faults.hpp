#pragma once

#include "conformance/token_bus/station_line_seeded_faults.hpp"
#include "conformance/token_bus/station_reception_seeded_faults.hpp"
#include "conformance/token_bus/station_vocabulary_seeded_faults.hpp"

// Stations of the token bus that are right mostly: until something was counted, while a class has time, while
// they are not alone. Like those of station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

// ---- what is counted and drawn ----

class NthTokenLost : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    constexpr unsigned kLost = 1'000;
    auto frame = TokenStation::understood(octets);
    const bool is_its_own = frame && frame->kind == FrameKind::token && frame->destination == address();
    return is_its_own && ++tokens_ == kLost ? std::nullopt : frame;
  }
  mutable unsigned tokens_ = 0;
};

class NthDatumLost : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    constexpr unsigned kLost = 300;
    return ++data_ == kLost || TokenStation::submit(request, now);
  }
  unsigned data_ = 0;
};

class EqualDataOnce : public BetweenUser<TokenStation> {
  using BetweenUser::BetweenUser;
  void on_data(const Frame& frame, Time when) override {
    const bool is_again = last_ && last_->data == frame.data && last_->action == frame.action &&
                          last_->priority == frame.priority && last_->source == frame.source;
    last_ = frame;
    if (!is_again) user().on_data(frame, when);
  }
  std::optional<Frame> last_;
};

class CountsInOctets : public TokenStation {
  using TokenStation::TokenStation;
  token_bus::Counters counters() const override {
    token_bus::Counters all = TokenStation::counters();
    for (std::uint32_t& one : all) one &= 0xFF;
    return all;
  }
};

class WindowsNotDrawn : public TokenStation {
  using TokenStation::TokenStation;
  bool opens_window(Time now) override {
    random() = kernel::Random(1);
    return TokenStation::opens_window(now);
  }
};

class LastClaimShort : public TokenStation {
  using TokenStation::TokenStation;
  unsigned claim_bits(unsigned pass) override {
    return pass + 1 == token_bus::contest_passes(rules()) ? 0 : TokenStation::claim_bits(pass);
  }
};

// ---- classes ----

class TimersBeginFull : public TokenStation {
 public:
  TimersBeginFull(const StationConfiguration& configuration, bool is_at_first)
      : TokenStation(configuration), is_full_(is_at_first) {}
  bool start(Time now) override {
    const bool is_possible = TokenStation::start(now);
    for (unsigned place = 1; is_full_ && place < token_bus::kAccessClasses; ++place) reload(place, now);
    is_full_ = true;
    return is_possible;
  }

 private:
  bool is_full_;
};

class ClassServedToItsEnd : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    const Duration left = TokenStation::hold_time(place, now);
    return place > 0 && left > Duration::zero() ? token_bus::octets(rules(), 10'000) : left;
  }
};

class TimersBeginWithEachDatum : public TokenStation {
  using TokenStation::TokenStation;
  line::Levels written(const Frame& frame, Time begin) const override {
    if (frame.kind == FrameKind::data) begun_ = {3 - frame.priority / 2, begin};
    return TokenStation::written(frame, begin);
  }
  Duration hold_time(unsigned place, Time now) override {
    if (begun_.first > 0) reload(begun_.first, begun_.second);
    begun_.first = 0;
    return TokenStation::hold_time(place, now);
  }
  mutable std::pair<unsigned, Time> begun_{0, kernel::kStart};
};

class ClassGivenUp : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    constexpr unsigned kMost = 3;
    const Duration left = TokenStation::hold_time(place, now);
    if (place > 0 && left <= Duration::zero() && !queue(place).empty()) ++late_.at(place);
    return late_.at(place) > kMost ? Duration::zero() : left;
  }
  std::array<unsigned, token_bus::kAccessClasses> late_{};
};

// ---- alone, and in the ring ----

class SolicitsBeforeItsData : public TokenStation {
  using TokenStation::TokenStation;
  void on_token_taken(Time) override {
    has_claimed_ = successor() == address() && !std::exchange(is_alone_, successor() == address());
  }
  bool may_begin(unsigned place, Time begin) const override {
    return !has_claimed_ && TokenStation::may_begin(place, begin);
  }
  bool has_claimed_ = false;
  bool is_alone_ = false;
};

class PredecessorKeptByClaim : public TokenStation {
  using TokenStation::TokenStation;
  void on_token_taken(Time) override {
    if (predecessor() != address()) before_ = predecessor();
  }
  bool follows(const Frame& who_follows) const override {
    return is_in_ring() && token_bus::address_of(who_follows.data) == before_;
  }
  Address before_ = 0;
};

// Also wants to be in the ring then.
class WantsRingAlso : public TokenStation {
 public:
  using When = bool (*)(const TokenStation&, bool has_left);
  WantsRingAlso(const StationConfiguration& configuration, When when)
      : TokenStation(configuration), when_(when) {}

 private:
  bool wants_ring() const override { return TokenStation::wants_ring() || when_(*this, has_left_); }
  Frame leaving_frame() const override {
    has_left_ = true;
    return TokenStation::leaving_frame();
  }
  When when_;
  mutable bool has_left_ = false;
};
inline bool while_alone(const TokenStation& station, bool) {
  return station.is_in_ring() && station.successor() == station.address();
}
inline bool after_leaving(const TokenStation& station, bool has_left) {
  return has_left && !station.is_in_ring();
}

class UrgentDataOnlyJoin : public TokenStation {
 public:
  explicit UrgentDataOnlyJoin(const StationConfiguration& configuration)
      : TokenStation(configuration), is_desired_(configuration.in_ring_desired), set_(is_desired_) {}
  bool start(Time now) override {
    is_desired_ = set_;
    return TokenStation::start(now);
  }
  void set_in_ring_desired(bool is_desired, Time now) override {
    is_desired_ = is_desired;
    TokenStation::set_in_ring_desired(is_desired, now);
  }

 private:
  bool wants_ring() const override { return is_desired_ || !queue(0).empty(); }
  bool is_desired_;
  bool set_;
};

class FailureDropsData : public TokenStation {
  using TokenStation::TokenStation;
  void on_pass_failed(kernel::Time now) override {
    drop_data();
    TokenStation::on_pass_failed(now);
  }
};

class OfferKept : public TokenStation {
  using TokenStation::TokenStation;
  bool forgets_offer() const override { return false; }
};

class MemberTakesOffer : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (frame && is_in_ring() && frame->kind == FrameKind::solicit_successor_1 && window_of(*frame))
      offer_ = frame->destination;
    return frame;
  }
  line::Levels written(const Frame& frame, Time begin) const override {
    Frame other = frame;
    if (offer_ && frame.kind == FrameKind::token) other.destination = *offer_;
    return TokenStation::written(other, begin);
  }
  mutable std::optional<Address> offer_;
};

class NoiseEndsItsDemand : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    const bool is_noise = !all.empty() && all.front().kind != ReceptionKind::frame;
    if (is_noise && state() == AccessState::demand_in) {
      const Frame other{.kind = FrameKind::claim_token, .destination = 0, .source = kOther};
      all.push_back({.kind = ReceptionKind::frame, .octets = token_bus::octets_of(other, rules())});
    }
    return all;
  }
  static constexpr Address kOther = 0x0020;
};

class YieldsToNoFrame : public TokenStation {
  using TokenStation::TokenStation;
  bool yields_in_delay() const override { return false; }
  std::optional<Frame> understood(const Octets& octets) const override {
    if (state() == AccessState::demand_delay) return std::nullopt;
    return TokenStation::understood(octets);
  }
};

// ---- receptions ----

class LengthLookedAtLast : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    constexpr int kNoLimit = 100'000;
    std::vector<Reception> all = TokenStation::received(wave);
    const std::vector<Reception> others = LimitOtherwise<kNoLimit>(rules()).read(wave);
    for (std::size_t n = 0; n < std::min(all.size(), others.size()); ++n) {
      if (all[n].kind == ReceptionKind::too_long && others[n].kind != ReceptionKind::frame)
        all[n] = others[n];
    }
    return all;
  }
};

inline void long_frames_unchecked(std::vector<Reception>& all, const Rules&) {
  constexpr std::size_t kLong = 2'048;
  for (Reception& one : all) {
    if (one.kind != ReceptionKind::fcs_error || one.octets.size() <= kLong) continue;
    one.kind = ReceptionKind::frame;
    one.octets.resize(one.octets.size() - token_bus::kCheckOctets);
  }
}
inline void long_preambles_lost(std::vector<Reception>& all, const Rules&) {
  constexpr std::size_t kOctets = 16;
  if (all.front().first_half_bit > kHalvesOfOctet * kOctets) all.clear();
}
inline void low_control_bits_only(Octets& octets, const Rules&) {
  const bool is_control = (octets[0] & 3U) == 0;
  if (is_control) octets[0] &= 0xF0;
}

// What ends while it is blanked puts off its claim.
class BlankedPutsOff : public TokenStation {
  using TokenStation::TokenStation;
  void on_activity(segment::PortIndex port, bool begins, Time now) override {
    TokenStation::on_activity(port, begins, now);
    if (begins || state() != AccessState::idle || now >= blanked_until_) return;
    line().begin(now + token_bus::octets(rules(), rules().response_gap_octets));
  }
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    TokenStation::receive(port, reception);
    if (reception.end() >= blanked_until_)
      blanked_until_ = reception.end() + token_bus::mac_symbols(rules(), rules().blanking_symbols);
  }
  Time blanked_until_ = kernel::kStart;
};

}  // namespace fieldproof::conformance::token_seeded_faults

#pragma once

#include <optional>
#include <vector>

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

}  // namespace fieldproof::conformance::token_seeded_faults

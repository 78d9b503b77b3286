#pragma once

#include "conformance/token_bus/station_host_seeded_faults.hpp"

// Stations of the token bus that are right at first, and go on from there where they should begin anew. Like
// those of station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

class ContestGoesOn : public TokenStation {
  using TokenStation::TokenStation;
  unsigned demand_bits(unsigned) override { return contest_bits(pass_++); }
  unsigned pass_ = 0;
};

class ClaimGoesOn : public TokenStation {
  using TokenStation::TokenStation;
  unsigned claim_bits(unsigned) override { return contest_bits(pass_++); }
  unsigned pass_ = 0;
};

class ContestsUsedUp : public TokenStation {
  using TokenStation::TokenStation;
  bool resolves(unsigned) const override { return passes_++ < token_bus::contest_passes(rules()); }
  mutable unsigned passes_ = 0;
};

class SearchGoesOn : public TokenStation {
  using TokenStation::TokenStation;
  PassStage stage_after(unsigned) const override { return TokenStation::stage_after(++attempts_); }
  void on_token_taken(Time) override { attempts_ = 0; }
  mutable unsigned attempts_ = 0;
};

class SecondNoiseIsSuccess : public TokenStation {
  using TokenStation::TokenStation;
  NoiseAfterToken noise_after_token() const override {
    return std::exchange(has_waited_, true) ? NoiseAfterToken::success : NoiseAfterToken::wait_on;
  }
  void on_token_taken(Time) override { has_waited_ = false; }
  mutable bool has_waited_ = false;
};

class RepetitionsUsedUp : public TokenStation {
  using TokenStation::TokenStation;
  unsigned request_repetitions() const override {
    return ++asked_ > rules().max_retry_limit + 1 ? 0 : rules().max_retry_limit;
  }
  mutable unsigned asked_ = 0;
};

class NeighboursKeptByClaim : public TokenStation {
  using TokenStation::TokenStation;
  bool is_alone_after_claim() const override { return false; }
};

// Does not see in one state that others begin.
class BeginsNotSeen : public TokenStation {
 public:
  BeginsNotSeen(const StationConfiguration& configuration, AccessState where)
      : TokenStation(configuration), where_(where) {}
  void on_activity(segment::PortIndex port, bool begins, Time now) override {
    if (state() != where_) TokenStation::on_activity(port, begins, now);
  }

 private:
  AccessState where_;
};

class BlanksAlways : public TokenStation {
  using TokenStation::TokenStation;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    TokenStation::receive(port, reception);
    line().blank_from(reception.end());
  }
};

// ---- what is received ----

class GroupIsSuccessor : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (frame && frame->kind == FrameKind::set_successor) frame->data[0] &= 0xFEU;
    return frame;
  }
};

class SuccessorOfAnotherTaken : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (frame && frame->kind == FrameKind::set_successor && state() == AccessState::idle)
      frame->destination = address();
    return frame;
  }
};

class MembersDoNotContend : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    const bool is_contest = frame && frame->kind == FrameKind::resolve_contention;
    return is_contest && is_in_ring() ? std::nullopt : frame;
  }
};

inline bool is_request(const std::optional<Frame>& frame) {
  return frame && frame->kind == FrameKind::data && frame->action == token_bus::Action::request_with_response;
}

class RespondsInTheRingOnly : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    return is_request(frame) && !is_in_ring() ? std::nullopt : frame;
  }
};

class RespondsForGroups : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (is_request(frame) && token_bus::is_group(frame->destination)) frame->destination = address();
    return frame;
  }
};

// ---- holding ----

class HoldBeginsWithFirstFrame : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    const Duration right = TokenStation::hold_time(place, now);
    return place == 0 ? right + token_bus::octets(rules(), rules().response_gap_octets) : right;
  }
};

class LowerClassesHeldToo : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    return std::min(TokenStation::hold_time(place, now),
                    token_bus::octets(rules(), rules().high_priority_hold_octets));
  }
};

class LeavesWithDataLeft : public TokenStation {
 public:
  explicit LeavesWithDataLeft(const StationConfiguration& configuration)
      : TokenStation(configuration), is_desired_(configuration.in_ring_desired) {}
  void set_in_ring_desired(bool is_desired, Time now) override {
    is_desired_ = is_desired;
    TokenStation::set_in_ring_desired(is_desired, now);
  }

 private:
  bool wants_ring() const override { return is_desired_; }
  bool is_desired_;
};

// ---- what is reported ----

// One event of a kind, or no data that cost it the token.
class ReportsLess : public BetweenUser<TokenStation> {
 public:
  ReportsLess(const StationConfiguration& configuration, EventKind kind, bool is_about_data)
      : BetweenUser(configuration), kind_(kind), is_about_data_(is_about_data) {}

 private:
  void on_data(const Frame& frame, Time when) override {
    if (!is_about_data_ || last_ != when) user().on_data(frame, when);
  }
  void on_event(const token_bus::Event& event, Time when) override {
    if (event.kind == kind_) last_ = when;
    if (event.kind == kind_ && !is_about_data_ && std::exchange(has_one_, true)) return;
    user().on_event(event, when);
  }
  EventKind kind_;
  bool is_about_data_;
  bool has_one_ = false;
  Time last_ = kernel::kNever;
};

}  // namespace fieldproof::conformance::token_seeded_faults

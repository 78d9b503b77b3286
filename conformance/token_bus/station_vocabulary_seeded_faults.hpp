#pragma once

#include "conformance/token_bus/station_anew_seeded_faults.hpp"

// Stations of the token bus that are wrong for some words of a vocabulary only: an address, a state, a kind
// of frame. Like those of station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

// ---- what is received ----

// What was understood is changed, or, where that gives false, is nothing.
class TakesOtherwise : public TokenStation {
 public:
  using Change = bool (*)(Frame&, const TokenStation&);
  TakesOtherwise(const StationConfiguration& configuration, Change change)
      : TokenStation(configuration), change_(change) {}

 private:
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    return frame && change_(*frame, *this) ? frame : std::nullopt;
  }
  Change change_;
};

template <FrameKind kind, unsigned bits>
bool by_few_bits(Frame& frame, const TokenStation& station) {
  constexpr Address kMask = (Address{1} << bits) - 1;
  if (frame.kind == kind && ((frame.destination ^ station.address()) & kMask) == 0)
    frame.destination = station.address();
  return true;
}
template <unsigned bits>
bool source_by_few_bits(Frame& frame, const TokenStation& station) {
  constexpr Address kMask = (Address{1} << bits) - 1;
  if (((frame.source ^ station.address()) & kMask) == 0) frame.source = station.address();
  return true;
}
inline bool token_of_a_group(Frame& frame, const TokenStation& station) {
  if (frame.kind == FrameKind::token && token_bus::is_group(frame.destination))
    frame.destination = station.address();
  return true;
}

inline bool is_response(const Frame& frame) {
  return frame.kind == FrameKind::data && frame.action == token_bus::Action::response;
}
inline bool waits_for_response(const TokenStation& station) {
  return station.state() == AccessState::await_ifm_response;
}
inline bool response_of_the_asked(Frame& frame, const TokenStation& station) {
  if (waits_for_response(station) && is_response(frame) && frame.source != station.successor())
    frame.destination = frame.source;
  return true;
}
inline bool response_to_another(Frame& frame, const TokenStation& station) {
  if (waits_for_response(station) && is_response(frame)) frame.destination = station.address();
  return true;
}
inline bool any_data_respond(Frame& frame, const TokenStation& station) {
  if (waits_for_response(station) && frame.destination == station.address())
    frame.action = token_bus::Action::response;
  return true;
}
inline bool control_responds(Frame& frame, const TokenStation& station) {
  if (waits_for_response(station) && frame.kind == FrameKind::resolve_contention)
    frame = {.kind = FrameKind::data,
             .action = token_bus::Action::response,
             .destination = station.address(),
             .source = frame.source};
  return true;
}
inline bool duplicate_in_idle(Frame& frame, const TokenStation& station) {
  return frame.source != station.address() || station.state() == AccessState::idle;
}
inline bool costly_request_unanswered(Frame& frame, const TokenStation& station) {
  if (station.state() == AccessState::await_response)
    frame.action = token_bus::Action::request_with_no_response;
  return true;
}
inline bool costly_solicitation_unanswered(Frame& frame, const TokenStation& station) {
  if (station.state() == AccessState::await_response && frame.kind == FrameKind::solicit_successor_1)
    frame.kind = FrameKind::resolve_contention;
  return true;
}

inline bool data_of_members(Frame& frame, const TokenStation& station) {
  return frame.kind != FrameKind::data || station.is_in_ring();
}
inline bool asked_responses(Frame& frame, const TokenStation& station) {
  return !is_response(frame) || waits_for_response(station);
}

// ---- what becomes of an event ----

// Something happens in it that should not: its station is like new, but for what is kept.
class BeginsAnewWith : public BetweenUser<KeptOverLoss> {
 public:
  BeginsAnewWith(const StationConfiguration& configuration, EventKind kind, Kept kept)
      : BetweenUser(configuration, kept), kind_(kind) {}

 private:
  void on_event(const token_bus::Event& event, Time when) override {
    user().on_event(event, when);
    if (event.kind != kind_) return;
    stop(when);
    start(when);
  }
  EventKind kind_;
};

class BothFailuresReported : public BetweenUser<TokenStation> {
  using BetweenUser::BetweenUser;
  void on_event(const token_bus::Event& event, Time when) override {
    if (event.kind == EventKind::faulty_transmitter)
      user().on_event({EventKind::pass_failed, address()}, when);
    user().on_event(event, when);
  }
};

class MissingResponseEndsUse : public TokenStation {
  using TokenStation::TokenStation;
  void on_token_taken(Time) override { asked_ = 0; }
  unsigned request_repetitions() const override {
    ++asked_;
    return rules().max_retry_limit;
  }
  bool may_begin(unsigned place, Time begin) const override {
    return asked_ <= rules().max_retry_limit && TokenStation::may_begin(place, begin);
  }
  mutable unsigned asked_ = 0;
};

class OfflineTakesData : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    return TokenStation::submit(request, now) || state() == AccessState::offline;
  }
};

// Once it was offline in spite of its supply, it stays so.
class OfflineForEver : public TokenStation {
  using TokenStation::TokenStation;
  void stop(Time now) override {
    is_faulty_ = state() == AccessState::offline;
    TokenStation::stop(now);
  }
  bool start(Time now) override { return is_faulty_ || TokenStation::start(now); }
  bool is_faulty_ = false;
};

// The limit is as low as the failures before have left it.
class FailuresKept : public BetweenUser<TokenStation> {
  using BetweenUser::BetweenUser;
  void on_event(const token_bus::Event& event, Time when) override {
    token_bus::Event other = event;
    if (event.kind == EventKind::pass_failed && ++failures_ >= rules().transmitter_fault_limit)
      other.kind = EventKind::faulty_transmitter;
    user().on_event(other, when);
  }
  unsigned failures_ = 0;
};

}  // namespace fieldproof::conformance::token_seeded_faults

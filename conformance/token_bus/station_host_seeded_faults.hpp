#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "conformance/token_bus/station_seeded_faults.hpp"

// Stations of the token bus that serve their user wrongly: the order of its data, what they report to it, and
// what they keep over a loss of supply. Like those of station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

using token_bus::DataRequest;
using token_bus::EventKind;

// ---- order, timers ----

class QueuesOtherwise : public TokenStation {
 public:
  using Place = std::size_t (*)(const DataRequest&, const std::deque<DataRequest>&);
  QueuesOtherwise(const StationConfiguration& configuration, Place place)
      : TokenStation(configuration), place_(place) {}

 private:
  std::size_t place_of(const DataRequest& request, const std::deque<DataRequest>& waiting) const override {
    return place_(request, waiting);
  }
  Place place_;
};

inline std::size_t in_front(const DataRequest&, const std::deque<DataRequest>&) {
  return 0;
}
inline std::size_t by_priority(const DataRequest& request, const std::deque<DataRequest>& waiting) {
  const auto lower =
      std::ranges::find_if(waiting, [&](const DataRequest& one) { return one.priority < request.priority; });
  return static_cast<std::size_t>(lower - waiting.begin());
}

class TimersBeginWithTheEnd : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    if (place == 0) return TokenStation::hold_time(place, now);
    if (place > 1) reload(place - 1, now);
    return residual(place, now);
  }
  bool opens_window(Time now) override {
    reload(token_bus::kAccessClasses - 1, now);
    return TokenStation::opens_window(now);
  }
};

class ZeroIsNoLimit : public TokenStation {
  using TokenStation::TokenStation;
  Duration hold_time(unsigned place, Time now) override {
    const Duration left = TokenStation::hold_time(place, now);
    const bool is_endless = place > 0 && rules().target_rotation_octets.at(place - 1) == 0;
    return is_endless ? token_bus::octets(rules(), 1'000) : left;
  }
};

// ---- failures ----

class FailuresNotForgiven : public TokenStation {
  using TokenStation::TokenStation;
  bool forgives_failures() const override { return false; }
};

class TokenKeptBetweenFrames : public TokenStation {
  using TokenStation::TokenStation;
  bool drops_token_on(const Frame&) const override { return state() != AccessState::use_token; }
};

// ---- events ----

class ReportsWithEachToken : public TokenStation {
 public:
  ReportsWithEachToken(const StationConfiguration& configuration, EventKind kind)
      : TokenStation(configuration), kind_(kind) {}

 private:
  void on_token_taken(Time now) override { user().on_event({kind_, predecessor()}, now); }
  EventKind kind_;
};

class ReportsWindows : public TokenStation {
 public:
  ReportsWindows(const StationConfiguration& configuration, EventKind kind, bool is_alone)
      : TokenStation(configuration), kind_(kind), is_alone_(is_alone) {}

 private:
  bool opens_window(Time now) override {
    const bool opens = TokenStation::opens_window(now);
    if (opens && (successor() == address()) == is_alone_) user().on_event({kind_, address()}, now);
    return opens;
  }
  EventKind kind_;
  bool is_alone_;
};

class NoiseReported : public TokenStation {
  using TokenStation::TokenStation;
  void count(ReceptionKind kind) override {
    TokenStation::count(kind);
    user().on_event({EventKind::unexpected_frame, predecessor()}, last_);
  }
  void on_token_taken(Time now) override { last_ = now; }
  Time last_ = kernel::kStart;
};

// ---- the ring ----

class NewSuccessorNotTaken : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    const bool is_named =
        frame && frame->kind == FrameKind::set_successor && state() != AccessState::await_response;
    return is_named ? std::nullopt : frame;
  }
};

class FirstPredecessorKept : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    if (frame && frame->kind == FrameKind::token && frame->destination == address()) {
      if (!first_) first_ = frame->source;
      frame->source = *first_;
    }
    return frame;
  }
  mutable std::optional<Address> first_;
};

class FollowsOutside : public TokenStation {
  using TokenStation::TokenStation;
  bool follows(const Frame& who_follows) const override {
    return token_bus::address_of(who_follows.data) == predecessor();
  }
};

class DuplicateInTheRingOnly : public TokenStation {
  using TokenStation::TokenStation;
  bool is_duplicate(const Frame& frame) const override {
    return is_in_ring() && TokenStation::is_duplicate(frame);
  }
};

class AnswerToAnotherTaken : public TokenStation {
  using TokenStation::TokenStation;
  bool takes_successor(const Frame&) const override { return true; }
};

// ---- the user ----

// What must be refused is accepted, and never sent.
class TakesAlso : public TokenStation {
 public:
  using Which = bool (*)(const DataRequest&, const Rules&);
  TakesAlso(const StationConfiguration& configuration, Which which)
      : TokenStation(configuration), which_(which) {}
  bool submit(const DataRequest& request, Time now) override {
    return which_(request, rules()) || TokenStation::submit(request, now);
  }

 private:
  Which which_;
};

inline bool of_any_priority(const DataRequest& request, const Rules&) {
  constexpr unsigned kHighest = 7;
  return request.priority > kHighest;
}
inline bool of_any_length(const DataRequest& request, const Rules& rules) {
  return request.data.size() > token_bus::most_data(rules);
}
inline bool asked_of_groups(const DataRequest& request, const Rules&) {
  return request.action == token_bus::Action::request_with_response &&
         token_bus::is_group(request.destination);
}

class BroadcastOnly : public TokenStation {
  using TokenStation::TokenStation;
  bool is_for_me(const Frame& frame) const override {
    return frame.destination == address() || frame.destination == token_bus::broadcast(rules());
  }
};

class EventsTwice : public BetweenUser<TokenStation> {
  using BetweenUser::BetweenUser;
  void on_event(const token_bus::Event& event, Time when) override {
    user().on_event(event, when);
    user().on_event(event, when);
  }
};

class FirstResponseKept : public TokenStation {
  using TokenStation::TokenStation;
  void set_response(const Octets& data, Time now) override {
    if (!std::exchange(has_one_, true)) TokenStation::set_response(data, now);
  }
  bool has_one_ = false;
};

class RespondsOnce : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    const bool is_asked = frame && frame->kind == FrameKind::data && frame->destination == address() &&
                          frame->action == token_bus::Action::request_with_response;
    return is_asked && std::exchange(has_responded_, true) ? std::nullopt : frame;
  }
  mutable bool has_responded_ = false;
};

class WishTakenOnce : public TokenStation {
  using TokenStation::TokenStation;
  void set_in_ring_desired(bool is_desired, Time now) override {
    if (!std::exchange(has_one_, true)) TokenStation::set_in_ring_desired(is_desired, now);
  }
  bool has_one_ = false;
};

// ---- supply ----

enum class Kept : std::uint8_t { queues, counters, ring, response, wish, silence };

class KeptOverLoss : public TokenStation {
 public:
  KeptOverLoss(const StationConfiguration& configuration, Kept kept)
      : TokenStation(configuration), kept_(kept), wish_(configuration.in_ring_desired) {}

  bool start(Time now) override {
    if (kept_ == Kept::silence && has_failed_) return true;
    if (kept_ == Kept::counters) before_ = counters();
    const bool is_possible = TokenStation::start(now);
    for (const DataRequest& one : waiting_) submit(one, now);
    waiting_.clear();
    if (kept_ == Kept::response && response_) TokenStation::set_response(*response_, now);
    if (kept_ == Kept::wish) TokenStation::set_in_ring_desired(wish_, now);
    return is_possible;
  }
  void stop(Time now) override {
    has_failed_ = true;
    for (unsigned place = 0; kept_ == Kept::queues && place < token_bus::kAccessClasses; ++place)
      waiting_.insert(waiting_.end(), queue(place).begin(), queue(place).end());
    TokenStation::stop(now);
  }
  token_bus::Counters counters() const override {
    token_bus::Counters sum = TokenStation::counters();
    for (std::size_t n = 0; n < sum.size(); ++n) sum.at(n) += before_.at(n);
    return sum;
  }
  void set_response(const Octets& data, Time now) override {
    response_ = data;
    TokenStation::set_response(data, now);
  }
  void set_in_ring_desired(bool is_desired, Time now) override {
    wish_ = is_desired;
    TokenStation::set_in_ring_desired(is_desired, now);
  }

 private:
  bool forgets_ring() const override { return kept_ != Kept::ring; }

  Kept kept_;
  std::vector<DataRequest> waiting_;
  token_bus::Counters before_{};
  std::optional<Octets> response_;
  bool wish_;
  bool has_failed_ = false;
};

}  // namespace fieldproof::conformance::token_seeded_faults

#pragma once

#include <utility>

#include "conformance/token_bus/station_partial_seeded_faults.hpp"

// Stations of the token bus that are right except in one octet of an address, for one action, or at one of
// the places where there may be noise. Like those of station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

// ---- addresses of 48 bits ----

inline void asks_by_32_bits(Frame& frame, const TokenStation&) {
  constexpr std::size_t kWritten = 4;
  if (frame.kind != FrameKind::who_follows) return;
  for (std::size_t n = kWritten; n < frame.data.size(); ++n) frame.data[n] = 0;
}
inline void data_to_40_bits(Frame& frame, const TokenStation&) {
  constexpr Address kMask = 0xFF'FFFF'FFFF;
  if (frame.kind == FrameKind::data) frame.destination &= kMask;
}
inline bool asked_of_long_groups(const DataRequest& request, const Rules& rules) {
  return rules.address_length == token_bus::AddressLength::bits_48 && asked_of_groups(request, rules);
}

// ---- actions, responses, priorities ----

inline void even_priority_asks(Frame& frame, const TokenStation&) {
  if (frame.kind == FrameKind::data && frame.action == token_bus::Action::request_with_response)
    frame.priority &= 6U;
}

class TwoResponsesOnly : public TokenStation {
  using TokenStation::TokenStation;
  void set_response(const Octets& data, Time now) override {
    constexpr unsigned kTaken = 2;
    if (++responses_ <= kTaken) TokenStation::set_response(data, now);
  }
  unsigned responses_ = 0;
};

inline std::size_t by_priority_in_the_lowest(const DataRequest& request,
                                             const std::deque<DataRequest>& waiting) {
  return request.priority < 2 ? by_priority(request, waiting) : waiting.size();
}

// ---- the ring ----

class MaintenanceSinceTheWindow : public TokenStation {
  using TokenStation::TokenStation;
  bool opens_window(Time now) override {
    const bool is_late = now > begun_ + token_bus::octets(rules(), rules().ring_maintenance_octets);
    if (!TokenStation::opens_window(now)) return false;
    begun_ = now;
    return !is_late;
  }
  Time begun_ = kernel::kStart;
};

inline bool group_answers(Frame& frame, const TokenStation& station) {
  if (station.state() == AccessState::await_response && frame.kind == FrameKind::set_successor)
    frame.data[0] &= 0xFEU;
  return true;
}

// ---- noise ----

class NoContestWhenItAsks : public TokenStation {
  using TokenStation::TokenStation;
  PassStage stage_after(unsigned attempts) const override {
    return stage_ = TokenStation::stage_after(attempts);
  }
  void on_token_taken(Time) override { stage_ = PassStage::token; }
  bool resolves(unsigned passes) const override {
    return stage_ != PassStage::who_follows && TokenStation::resolves(passes);
  }
  mutable PassStage stage_ = PassStage::token;
};

// Until it passes the token after a window.
class ContestsGoOn : public TokenStation {
  using TokenStation::TokenStation;
  bool resolves(unsigned) const override { return passes_++ < token_bus::contest_passes(rules()); }
  void on_token_taken(Time) override { has_contest_ = false; }
  line::Levels written(const Frame& frame, Time begin) const override {
    if (frame.kind == FrameKind::resolve_contention) has_contest_ = true;
    if (frame.kind == FrameKind::token && has_contest_) passes_ = 0;
    return TokenStation::written(frame, begin);
  }
  mutable unsigned passes_ = 0;
  mutable bool has_contest_ = false;
};

class NoiseForgivesNothing : public TokenStation {
  using TokenStation::TokenStation;
  NoiseAfterToken noise_after_token() const override {
    has_noise_ = true;
    return TokenStation::noise_after_token();
  }
  void on_token_taken(Time) override { has_noise_ = false; }
  bool forgives_failures() const override { return !has_noise_; }
  mutable bool has_noise_ = false;
};

// ---- supply ----

class LongFramesKept : public TokenStation {
  using TokenStation::TokenStation;
  void count(ReceptionKind kind) override {
    if (kind == ReceptionKind::too_long) ++too_long_;
    TokenStation::count(kind);
  }
  token_bus::Counters counters() const override {
    token_bus::Counters all = TokenStation::counters();
    all.back() = too_long_;  // the last kind of error
    return all;
  }
  std::uint32_t too_long_ = 0;
};

}  // namespace fieldproof::conformance::token_seeded_faults

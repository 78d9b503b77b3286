#pragma once

#include <algorithm>
#include <vector>

#include "conformance/token_bus/station_seeded_faults.hpp"

// Stations of the token bus that receive wrongly, or know addresses of 16 bits only. Like those of
// station_seeded_faults.hpp.
namespace fieldproof::conformance::token_seeded_faults {

// What is received is changed after it was read.
class HearsOtherwise : public TokenStation {
 public:
  using Change = void (*)(std::vector<Reception>&, const Rules&);
  HearsOtherwise(const StationConfiguration& configuration, Change change)
      : TokenStation(configuration), change_(change) {}

 private:
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    change_(all, rules());
    return all;
  }
  Change change_;
};

inline constexpr std::size_t kHalvesOfBit = 2;
inline constexpr std::size_t kHalvesOfOctet = 32;

inline void whole_preamble_needed(std::vector<Reception>& all, const Rules& rules) {
  if (all.front().first_half_bit < kHalvesOfOctet * rules.preamble_octets) all.clear();
}
inline void odd_front_not_found(std::vector<Reception>& all, const Rules&) {
  if (all.front().first_half_bit / kHalvesOfBit % 2 != 0) all.clear();
}
inline void two_frames_only(std::vector<Reception>& all, const Rules&) {
  all.resize(std::min<std::size_t>(all.size(), 2));
}
inline void stops_at_a_fault(std::vector<Reception>& all, const Rules&) {
  const auto faulty =
      std::ranges::find_if(all, [](const Reception& one) { return one.kind != ReceptionKind::frame; });
  if (faulty != all.end()) all.erase(faulty + 1, all.end());
}
inline void check_before_error_bit(std::vector<Reception>& all, const Rules&) {
  for (Reception& one : all) {
    if (one.kind == ReceptionKind::e_bit_error && !token_bus::has_right_check(one.octets))
      one.kind = ReceptionKind::fcs_error;
  }
}

// ---- addresses of 48 bits ----

class PassesOfShortAddresses : public TokenStation {
  using TokenStation::TokenStation;
  static constexpr unsigned kPasses = 9;
  unsigned claim_passes() const override { return kPasses; }
  bool resolves(unsigned passes) const override { return passes < kPasses; }
};

class LowPairsFirst : public TokenStation {
  using TokenStation::TokenStation;
  static constexpr unsigned kPairsOf16Bits = 8;
  unsigned demand_bits(unsigned pass) override {
    const unsigned pairs = token_bus::contest_passes(rules()) - 1;
    return pass < kPairsOf16Bits ? contest_bits(pairs - kPairsOf16Bits + pass) : contest_bits(pass);
  }
};

class RangeOfLowBits : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<unsigned> window_of(const Frame& solicitation) const override {
    constexpr Address kLow = 0xFFFF;
    Frame low = solicitation;
    low.source &= kLow;
    low.destination &= kLow;
    return TokenStation::window_of(low);
  }
};

class LengthOfShortAddresses : public TokenStation {
  using TokenStation::TokenStation;
  bool submit(const token_bus::DataRequest& request, Time now) override {
    constexpr std::size_t kMore = 8;
    const std::size_t most = token_bus::most_data(rules());
    if (request.data.size() > most && request.data.size() <= most + kMore) return true;
    return TokenStation::submit(request, now);
  }
};

inline void shorter_token_taken(std::vector<Reception>& all, const Rules&) {
  constexpr std::size_t kToken = 5;
  for (Reception& one : all) {
    Octets& octets = one.octets;
    if (one.kind != ReceptionKind::fragment || octets.size() != kToken + token_bus::kCheckOctets) continue;
    one.kind = ReceptionKind::frame;
    octets = {octets[0], octets[1], octets[2], 0, 0, 0, 0, octets[3], octets[4], 0, 0, 0, 0};
  }
}

// ---- many faults ----

class CountsToNine : public TokenStation {
  using TokenStation::TokenStation;
  void count(ReceptionKind kind) override {
    constexpr std::uint32_t kMost = 9;
    if (counters().at(static_cast<std::size_t>(kind) - 1) < kMost) TokenStation::count(kind);
  }
};

class DeafAfterManyFaults : public TokenStation {
  using TokenStation::TokenStation;
  void count(ReceptionKind kind) override {
    ++faults_;
    TokenStation::count(kind);
  }
  std::optional<Frame> understood(const Octets& octets) const override {
    constexpr unsigned kMost = 80;
    return faults_ > kMost ? std::nullopt : TokenStation::understood(octets);
  }
  unsigned faults_ = 0;
};

// Takes what it has not understood for resolve_contention when it has answered.
class FaultsAreContests : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    const bool is_faulty = !all.empty() && all.front().kind != ReceptionKind::frame;
    if (is_faulty && state() == AccessState::demand_in) {
      const Frame contest{.kind = FrameKind::resolve_contention, .destination = 0, .source = kSolicitor};
      all.push_back({.kind = ReceptionKind::frame, .octets = token_bus::octets_of(contest, rules())});
    }
    return all;
  }
  static constexpr Address kSolicitor = 0x000E;
};

// Takes the token for lost when it has not understood anybody for a while, though the line was not silent.
class ClaimsAfterFaults : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    const bool has_frame = !all.empty() && all.front().kind == ReceptionKind::frame;
    faults_ = has_frame ? 0 : faults_ + 1;
    return all;
  }
  unsigned bus_idle_slots() const override { return faults_ > 1 ? 1 : TokenStation::bus_idle_slots(); }
  mutable unsigned faults_ = 0;
};

}  // namespace fieldproof::conformance::token_seeded_faults

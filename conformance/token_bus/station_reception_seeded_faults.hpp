#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "conformance/token_bus/station_seeded_faults.hpp"
#include "harness/line/frame_check.hpp"

// Stations of the token bus that receive, or report what they received, otherwise.
namespace fieldproof::conformance::token_seeded_faults {

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

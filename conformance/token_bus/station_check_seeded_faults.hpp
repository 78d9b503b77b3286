#pragma once

#include <utility>
#include <vector>

#include "conformance/token_bus/station_seeded_faults.hpp"

// Stations of the token bus whose fault shows only in a sequence: each does with any single command what it
// should. They are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::token_seeded_faults {

class DeafAfterFault : public TokenStation {
  using TokenStation::TokenStation;
  std::vector<Reception> received(const line::Waveform& wave) const override {
    std::vector<Reception> all = TokenStation::received(wave);
    const bool has_fault = all.empty() || all.front().kind != ReceptionKind::frame;
    if (std::exchange(is_deaf_, has_fault)) all.clear();
    return all;
  }
  mutable bool is_deaf_ = false;
};

class AnswersOnce : public TokenStation {
  using TokenStation::TokenStation;
  std::optional<Frame> understood(const Octets& octets) const override {
    auto frame = TokenStation::understood(octets);
    const bool is_solicited = frame && frame->kind == FrameKind::solicit_successor_1 && window_of(*frame);
    if (is_solicited && std::exchange(has_answered_, true)) return std::nullopt;
    return frame;
  }
  mutable bool has_answered_ = false;
};

class SameResponseEmpty : public TokenStation {
  using TokenStation::TokenStation;
  Frame response_to(const Frame& request, const Octets& data) const override {
    Frame response = TokenStation::response_to(request, data);
    if (std::exchange(last_, data) == data) response.data.clear();
    return response;
  }
  mutable Octets last_{0xFF, 0xFF, 0xFF, 0xFF};
};

}  // namespace fieldproof::conformance::token_seeded_faults

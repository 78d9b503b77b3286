#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/rules.hpp"

// What arrived at the receiver of an implementation, after all faults of the line, as frames: an ear of the
// bench that knows the rules of silence and of the exclusive or by itself, by no code of the stations.
//
// Limit: it samples as the declared receiver does, the majority of three. Under disturbances that are shorter
// than a bit another receiver may hear something else.
namespace fieldproof::conformance {

struct ArrivedFrame {
  kernel::Time start{};  // of its first start bit
  kernel::Time end{};    // of its last stop bit
  std::vector<std::uint8_t> octets;
  bool is_spoilt = false;
  // A silence in it or in front of it is so near to a limit that receivers may differ about it.
  bool is_doubtful = false;

  // Five, three octets that nothing spoilt and whose exclusive or is 0.
  bool is_command() const { return is_checked(5); }
  bool is_response() const { return is_checked(3); }
  bool is_checked(std::size_t length) const;
};

class ArrivedFrames final : public segment::Tap {
 public:
  explicit ArrivedFrames(const valve_bus::Rules& rules);

  void on_wave(const line::Waveform& wave) override;
  void clear() { frames_.clear(); }
  // Since the last clear; the last one may go on.
  std::span<const ArrivedFrame> frames() const { return frames_; }

 private:
  line::CharacterReceiver receiver_;
  kernel::Duration longest_gap_;
  kernel::Duration delimiter_;
  kernel::Duration doubt_;
  std::vector<line::CharacterReceiver::Received> received_;
  std::vector<ArrivedFrame> frames_;
};

}  // namespace fieldproof::conformance

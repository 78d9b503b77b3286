#include "conformance/valve_bus/arrived_frames.hpp"

#include <functional>
#include <numeric>

namespace fieldproof::conformance {

bool ArrivedFrame::is_checked(std::size_t length) const {
  if (is_spoilt || octets.size() != length) return false;
  return std::accumulate(octets.begin(), octets.end(), 0, std::bit_xor<>()) == 0;
}

ArrivedFrames::ArrivedFrames(const valve_bus::Rules& rules)
    : receiver_(character_format(rules), rules.bit_rate),
      longest_gap_(valve_bus::longest_gap(rules)),
      delimiter_(valve_bus::delimiter(rules)) {}

void ArrivedFrames::on_wave(const line::Waveform& wave) {
  received_.clear();
  receiver_.receive(wave, received_);
  for (const line::CharacterReceiver::Received& one : received_) {
    if (frames_.empty() || one.start - frames_.back().end >= delimiter_) {
      frames_.emplace_back();
    } else if (one.start - frames_.back().end > longest_gap_) {
      frames_.back().is_spoilt = true;
    }
    ArrivedFrame& frame = frames_.back();
    frame.end = one.busy_until;
    if (!one.character.is_good()) frame.is_spoilt = true;
    frame.octets.push_back(static_cast<std::uint8_t>(one.character.data));
  }
}

}  // namespace fieldproof::conformance

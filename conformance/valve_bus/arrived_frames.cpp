#include "conformance/valve_bus/arrived_frames.hpp"

#include <functional>
#include <numeric>

namespace fieldproof::conformance {
namespace {

// Sixteenths of a bit at two start bits, and clocks that are 2 % apart over 3.5 characters.
constexpr std::int64_t kDoubtfulBits = 1;

}  // namespace

bool ArrivedFrame::is_checked(std::size_t length) const {
  if (is_spoilt || octets.size() != length) return false;
  return std::accumulate(octets.begin(), octets.end(), 0, std::bit_xor<>()) == 0;
}

ArrivedFrames::ArrivedFrames(const valve_bus::Rules& rules)
    : receiver_(character_format(rules), rules.bit_rate),
      longest_gap_(valve_bus::longest_gap(rules)),
      delimiter_(valve_bus::delimiter(rules)),
      doubt_(valve_bus::bits(rules, kDoubtfulBits)) {}

void ArrivedFrames::on_wave(const line::Waveform& wave) {
  received_.clear();
  receiver_.receive(wave, received_);
  for (const line::CharacterReceiver::Received& one : received_) {
    const kernel::Duration silence =
        frames_.empty() ? kernel::Duration::max() : one.start - frames_.back().end;
    if (silence >= delimiter_) {
      frames_.emplace_back().start = one.start;
    } else if (silence > longest_gap_) {
      frames_.back().is_spoilt = true;
    }
    ArrivedFrame& frame = frames_.back();
    for (const kernel::Duration limit : {longest_gap_, delimiter_}) {
      if (silence > limit - doubt_ && silence < limit + doubt_) frame.is_doubtful = true;
    }
    frame.end = one.busy_until;
    if (!one.character.is_good()) frame.is_spoilt = true;
    frame.octets.push_back(static_cast<std::uint8_t>(one.character.data));
  }
}

}  // namespace fieldproof::conformance

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/line/waveform.hpp"

// Octets as characters of an asynchronous line, all of a transmission in one waveform.
namespace fieldproof::line {

class OctetLine {
 public:
  explicit OctetLine(std::int64_t bit_rate, const CharacterFormat& format = {})
      : bit_rate_(bit_rate), code_(format), receiver_(format, bit_rate) {}

  // Without a gap.
  Waveform wave_of(std::span<const std::uint8_t> octets, kernel::Time start) const {
    Waveform wave{start, bit_rate_ * code_.levels_per_bit(), {}};
    for (const std::uint8_t octet : octets) code_.append(wave.levels, octet);
    return wave;
  }
  // Nothing where one of its characters is wrong.
  std::optional<std::vector<std::uint8_t>> octets_in(const Waveform& wave) {
    received_.clear();
    receiver_.receive(wave, received_);
    std::vector<std::uint8_t> octets;
    for (const CharacterReceiver::Received& one : received_) {
      if (!one.character.is_good()) return std::nullopt;
      octets.push_back(static_cast<std::uint8_t>(one.character.data));
    }
    return octets;
  }

 private:
  std::int64_t bit_rate_;
  CharacterCode code_;
  CharacterReceiver receiver_;
  std::vector<CharacterReceiver::Received> received_;
};

}  // namespace fieldproof::line

#include "conformance/valve_bus/driven_line.hpp"

#include <algorithm>

namespace fieldproof::conformance {
namespace {

// Waves that follow each other have starts that are rounded each for itself.
constexpr kernel::Duration kRoundedStart = kernel::kNanosecond;
// Of a bit.
constexpr std::int64_t kIdlePieces = 16;

}  // namespace

std::vector<std::uint8_t> Transmission::octets() const {
  std::vector<std::uint8_t> all;
  for (const DrivenCharacter& character : characters) all.push_back(character.octet());
  return all;
}

kernel::Duration Transmission::longest_gap() const {
  kernel::Duration longest{};
  for (std::size_t n = 1; n < characters.size(); ++n) {
    longest = std::max(longest, characters[n].start - characters[n - 1].busy_until);
  }
  return longest;
}

kernel::Duration DrivenLine::pause() const {
  return kernel::levels_duration(1, kIdlePieces * bit_rate_) + kRoundedStart;
}

std::vector<Transmission> DrivenLine::transmissions() {
  std::vector<Transmission> all;
  line::Waveform together;
  const auto finish = [&] {
    if (!together.levels.empty()) add(together, all.back());
    together.levels.clear();
  };
  for (const line::Waveform& wave : waves_) {
    const bool follows = !together.levels.empty() && wave.rate == together.rate &&
                         std::chrono::abs(wave.start - together.end()) <= kRoundedStart;
    if (!follows) {
      finish();
      if (all.empty() || wave.start - all.back().driver_off > pause()) {
        all.push_back({wave.start, wave.end(), {}});
      }
      together.start = wave.start;
      together.rate = wave.rate;
    }
    together.levels.append(wave.levels);
    all.back().driver_off = std::max(all.back().driver_off, wave.end());
  }
  finish();
  return all;
}

void DrivenLine::add(const line::Waveform& wave, Transmission& transmission) {
  received_.clear();
  receiver_.receive(wave, received_);
  for (const line::CharacterReceiver::Received& one : received_) {
    transmission.characters.push_back(
        {one.start, one.busy_until, one.character.data, one.character.is_good()});
  }
}

}  // namespace fieldproof::conformance

#include "conformance/valve_bus/driven_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/valve_bus/frame.hpp"

namespace fieldproof::conformance {
namespace {

// Waves that follow each other have starts that are rounded each for itself.
constexpr kernel::Duration kRoundedStart = kernel::kNanosecond;
// Of a bit.
constexpr std::int64_t kIdlePieces = 16;

std::string command_in_words(std::span<const std::uint8_t> octets, const valve_bus::Rules& rules) {
  const unsigned id = octets[0];
  const unsigned command = octets[1];
  if (command == rules.read_command) return fmt::format("read of node {}", id);
  const std::string data = fmt::format("{:02X}", fmt::join(octets.subspan(2, 2), " "));
  if (command == rules.write_command) return fmt::format("write {} to node {}", data, id);
  return fmt::format("command {} with {} to node {}", command, data, id);
}

}  // namespace

std::string octets_in_words(std::span<const std::uint8_t> octets, const valve_bus::Rules& rules) {
  const std::string text = fmt::format("{:02X}", fmt::join(octets, " "));
  if (octets.empty() || valve_bus::block_check(octets) != 0) return text;
  if (octets.size() == valve_bus::kCommandOctets) return text + ", " + command_in_words(octets, rules);
  if (octets.size() == valve_bus::kResponseOctets)
    return fmt::format("{}, response {:02X}", text, fmt::join(octets.first(2), " "));
  return text;
}

std::string characters_text(const Transmission& transmission, const valve_bus::Rules& rules) {
  if (transmission.characters.empty()) return "no character";
  if (std::ranges::all_of(transmission.characters, &DrivenCharacter::is_good))
    return octets_in_words(transmission.octets(), rules);
  std::string text;
  for (const DrivenCharacter& character : transmission.characters) {
    text +=
        fmt::format("{}{:02X}{}", text.empty() ? "" : " ", character.octet(), character.is_good ? "" : "!");
  }
  return text;
}

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

#include "fuzz/valve_line.hpp"

#include <algorithm>
#include <array>

#include "fuzz/script.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::fuzz {

using kernel::Time;
using line::Waveform;
using valve_bus::CharacterProfile;

CharacterProfile character_profile(std::uint8_t choice) {
  constexpr std::array kProfiles{CharacterProfile::ninth_bit_one, CharacterProfile::even_parity,
                                 CharacterProfile::eight_bits};
  return kProfiles.at(choice % kProfiles.size());
}

ValveLine::ValveLine(const valve_bus::Rules& rules, std::uint8_t seed)
    : rules_(rules),
      medium_(segment_, "line", segment::ContentionRule::noise, kernel::Random(seed)),
      place_of_tester_(&medium_.attach("tester/in", segment_.attach(tester_, "tester"), 0, {})),
      codec_(rules) {}

void ValveLine::pass(kernel::Duration duration) {
  segment_.run_for(duration);
  follow(segment_.now());
}

void ValveLine::drive(Waveform& wave, std::uint8_t flip) {
  if (wave.levels.empty()) return;
  flip_level(wave.levels, flip);
  wave.start = segment_.now();
  const Time end = wave.end();
  place_of_tester_->drive(wave);
  segment_.run_until(end);
}

void ValveLine::send(std::span<const std::uint8_t> octets, std::uint8_t flip) {
  const std::size_t hit = flip % std::max<std::size_t>(octets.size(), 1);
  for (std::size_t n = 0; n < octets.size(); ++n) {
    Waveform wave{segment_.now(), rules_.bit_rate, {}};
    codec_.append(wave.levels, octets.subspan(n, 1));
    drive(wave, n == hit ? flip : std::uint8_t{0});
  }
}

void ValveLine::respond(std::uint16_t data, std::uint8_t flip) {
  const auto data0 = static_cast<std::uint8_t>(data >> 8);
  const auto data1 = static_cast<std::uint8_t>(data & 0xFF);
  const std::array<std::uint8_t, 3> octets{data0, data1, static_cast<std::uint8_t>(data0 ^ data1)};
  send(octets, flip);
}

void ValveLine::octets_with_gaps(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  for (const std::uint8_t octet : input.take(choice % 8U + 1)) {
    send(std::span(&octet, 1), flip);
    if ((choice & 0xF0U) != 0) pass(bits(rules_, choice >> 3));
  }
}

void ValveLine::levels(OctetReader& input, std::int64_t rate, std::uint8_t flip) {
  Waveform wave{segment_.now(), rate, {}};
  append_levels(input, wave.levels);
  drive(wave, flip);
}

}  // namespace fieldproof::fuzz

#include "protocols/interbus/network.hpp"

#include <algorithm>

namespace fieldproof::interbus {

namespace {

constexpr unsigned kLengthCodeShift = 8;
constexpr unsigned kLengthCodeMask = 0x1F;

struct RingWalk {
  const Rules& rules;
  std::vector<RingPlace> places;

  // Stations that follow each other on one outgoing interface, which is the second one of `before` if
  // `on_branch`.
  void append(const std::vector<StationDescription>& stations, int before, bool on_branch, unsigned level) {
    for (const StationDescription& station : stations) {
      const auto place = static_cast<int>(places.size());
      places.push_back({&station, before, on_branch, level,
                        words_of_id_code(station.id_code, rules).value_or(station.words.value_or(0))});
      append(station.branch, place, true, level + 1);
      before = place;
      on_branch = false;
    }
  }
};

}  // namespace

std::vector<RingPlace> ring_order(const NetworkDescription& network) {
  RingWalk walk{network.rules, {}};
  walk.append(network.stations, -1, false, 0);
  return std::move(walk.places);
}

std::optional<unsigned> words_of_id_code(std::uint16_t id_code, const Rules& rules) {
  const unsigned code = (unsigned{id_code} >> kLengthCodeShift) & kLengthCodeMask;
  for (const LengthCode& entry : length_codes_of(rules)) {
    if (entry.code == code) return entry.words;
  }
  return std::nullopt;
}

std::optional<std::uint8_t> length_code_of(unsigned words, const Rules& rules) {
  for (const LengthCode& entry : length_codes_of(rules)) {
    if (entry.words == words) return entry.code;
  }
  return std::nullopt;
}

}  // namespace fieldproof::interbus

#include "protocols/token_bus/ring_recovery.hpp"

#include <array>
#include <cstddef>

#include "harness/kernel/check.hpp"
#include "protocols/token_bus/ring_network.hpp"
#include "protocols/token_bus/watched_ring.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

RingDescription description_of(const RecoverySettings& settings) {
  RingDescription description = RingDescription::built_in(settings.stations);
  description.rules = settings.rules;
  return description;
}

// Done to station `n`; the ring is watched from then on.
void disturb(WatchedRing& ring, Disturbance disturbance, std::size_t n) {
  switch (disturbance) {
    case Disturbance::nothing:
      break;
    case Disturbance::token_lost:
      ring.destroy_next_token();
      break;
    case Disturbance::token_doubled:
      ring.give_second_token(ring.address(n));
      break;
    case Disturbance::station_dies:
      ring.set_power(n, false);
      break;
    case Disturbance::station_comes:
      ring.set_power(n, true);
      break;
    case Disturbance::station_leaves:
      ring.set_wanted(n, false);
      break;
    case Disturbance::station_joins:
      ring.set_wanted(n, true);
      break;
  }
}

}  // namespace

std::string_view text_of(Disturbance disturbance) {
  constexpr std::array<std::string_view, kDisturbances> kTexts{
      "nothing else",    "a token is lost",  "a second token", "a station dies",
      "a station comes", "a station leaves", "a station joins"};
  return kTexts.at(static_cast<std::size_t>(disturbance));
}

RecoveryFigures recover(Disturbance disturbance, const RecoverySettings& settings) {
  FIELDPROOF_CHECK(settings.stations >= 3 && settings.stations <= 64,
                   "a ring that loses one has three or more");
  WatchedRing ring(settings);
  for (std::size_t n = 0; n < ring.size(); ++n) ring.set_power(n, true);
  const RingDescription description = description_of(settings);
  const Duration limit = RingNetwork(description, settings.seed).recovery_limit().time;
  const Duration rotation = longest_rotation(description);
  const Duration patience = 10 * limit;
  FIELDPROOF_CHECK(ring.run_until_whole(patience) != kernel::kNever, "a ring of references comes up");
  ring.figures = RecoveryFigures();
  ring.figures.limit = limit;
  for (unsigned instant = 0; instant < settings.instants; ++instant) {
    const auto n =
        static_cast<std::size_t>(ring.random().between(0, static_cast<std::int64_t>(ring.size()) - 1));
    // What comes back has gone before, in a quiet ring.
    const bool comes = disturbance == Disturbance::station_comes;
    if (comes || disturbance == Disturbance::station_joins) {
      disturb(ring, comes ? Disturbance::station_dies : Disturbance::station_leaves, n);
      ring.begin_watch();
      ring.run_until_whole(patience);
    }
    ring.run_for(Duration{ring.random().between(0, rotation.count())});
    ring.begin_watch();
    disturb(ring, disturbance, n);
    if (settings.has_bursts) ring.begin_burst();
    const Time whole = ring.run_until_whole(patience);
    const Duration after = whole == kernel::kNever ? patience : whole - ring.watched_since();
    ring.figures.whole_after.add(after);
    if (after > limit) ++ring.figures.beyond;
    if (disturbance == Disturbance::station_dies || disturbance == Disturbance::station_leaves) {
      disturb(
          ring,
          disturbance == Disturbance::station_dies ? Disturbance::station_comes : Disturbance::station_joins,
          n);
      ring.begin_watch();
      ring.run_until_whole(patience);
    }
  }
  return ring.figures;
}

Duration time_to_form(unsigned stations, const Rules& rules) {
  WatchedRing ring({.stations = stations, .rules = rules});
  const Time begin = ring.now();
  for (std::size_t n = 0; n < ring.size(); ++n) ring.set_power(n, true);
  return ring.run_until_whole(100 * kernel::kSecond) - begin;
}

}  // namespace fieldproof::token_bus

#include "protocols/interbus/station_timing.hpp"

#include <cmath>
#include <utility>

#include "protocols/interbus/cycle_frame.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;

// The way of a telegram through the ring, station by station in its order.
class Way {
 public:
  explicit Way(const NetworkDescription& network) : rules_(network.rules), places_(ring_order(network)) {}

  std::vector<Duration> arrivals() {
    arrivals_.resize(places_.size());
    Duration at{};
    while (next_ < places_.size()) at = pass(at);
    return std::move(arrivals_);
  }

 private:
  // From in front of the cable to the next station to where its own way back ends; with all after it.
  Duration pass(Duration at) {
    const std::size_t station = next_++;
    const RingPlace& place = places_[station];
    const bool is_local = place.station->is_local;
    const Duration cable{
        std::llround(place.station->cable_m * static_cast<double>(rules_.cable_delay_ps_per_m))};
    at += cable;
    arrivals_[station] = at;
    at += half_bits(is_local ? rules_.local_delay_half_bits : rules_.forward_delay_half_bits);
    for (const bool on_branch : {true, false}) {
      if (hangs_next(station, on_branch)) at = pass(at);
    }
    return at + half_bits(is_local ? rules_.local_delay_half_bits : rules_.return_delay_half_bits) + cable;
  }

  bool hangs_next(std::size_t station, bool on_branch) const {
    return next_ < places_.size() && places_[next_].before == static_cast<int>(station) &&
           places_[next_].on_branch == on_branch;
  }

  Duration half_bits(unsigned count) const { return kernel::levels_duration(count, 2 * rules_.bit_rate); }

  const Rules& rules_;
  std::vector<RingPlace> places_;
  std::size_t next_ = 0;
  std::vector<Duration> arrivals_;
};

}  // namespace

Duration sample_to_latch(const NetworkDescription& network) {
  const Rules& rules = network.rules;
  // Telegram k begins at level 13 * k + floor(k * gap), see cycle_frame.hpp.
  const auto last =
      static_cast<std::int64_t>(kLoopbackOctets + timing_input(network).user_octets + kTrailerOctets - 1);
  const std::int64_t levels =
      std::int64_t{line::kDataTelegramLevels} * (last + 1) + last * rules.telegram_gap_millibits / 1'000;
  return kernel::levels_duration(levels, rules.bit_rate);
}

std::vector<Duration> arrival_delays(const NetworkDescription& network) {
  return Way(network).arrivals();
}

}  // namespace fieldproof::interbus

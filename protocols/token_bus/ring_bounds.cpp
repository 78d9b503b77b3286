#include "protocols/token_bus/ring_bounds.hpp"

#include <algorithm>

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;

Duration with_gap(const Rules& rules, Duration transmission) {
  return octets(rules, rules.response_gap_octets) + transmission;
}

Duration on_the_line(const Rules& rules, const RingData& data) {
  const Duration request = with_gap(rules, frame_time(rules, data.octets));
  if (action_of(data.service) != Action::request_with_response) return request;
  return request + slots(rules, rules.response_wait_slots) + frame_time(rules, kResponseOctets);
}

// In a round that takes so long.
std::optional<std::int64_t> data_in(const Rules& rules, const RingData& data, Duration round) {
  if (data.is_under_each_token()) return 1;
  if (data.load != 0 || data.every < 2 * round + slots(rules, 1)) return std::nullopt;
  return 2;
}

// Nothing where one of the flows may have any number of data.
template <typename Holds>
std::optional<Duration> sum_of(const RingDescription& ring, Duration round, Holds holds) {
  Duration sum{};
  for (const RingData& data : ring.data) {
    if (!holds(data)) continue;
    const auto count = data_in(ring.rules, data, round);
    if (!count) return std::nullopt;
    sum += *count * on_the_line(ring.rules, data);
  }
  return sum;
}

template <typename Holds>
Duration longest_of(const RingDescription& ring, Holds holds) {
  Duration longest{};
  for (const RingData& data : ring.data) {
    if (holds(data)) longest = std::max(longest, on_the_line(ring.rules, data));
  }
  return longest;
}

Duration target_of(const Rules& rules, RingService service) {
  return octets(rules, rules.target_rotation_octets.at(static_cast<std::size_t>(service) - 1));
}

Duration hold_of(const RingDescription& ring, Address station, Duration round) {
  const auto is_its = [&](const RingData& data) {
    return data.from == station && data.service == RingService::urgent;
  };
  const Duration longest = longest_of(ring, is_its);
  if (longest == Duration{}) return longest;
  const Duration by_time = octets(ring.rules, ring.rules.high_priority_hold_octets) + longest;
  return std::min(by_time, sum_of(ring, round, is_its).value_or(by_time));
}

Duration passes_of(const RingDescription& ring) {
  const Rules& rules = ring.rules;
  const auto stations = static_cast<std::int64_t>(ring.stations.size());
  // A window is closed when its slot times are over; the lowest opens two.
  const Duration window = with_gap(rules, frame_time(rules, 0)) + slots(rules, 1);
  return stations * (with_gap(rules, frame_time(rules, 0)) + path_delay(ring) + window) + slots(rules, 1);
}

// A lower class as far as its timers let it.
struct ByTimer {
  Duration target{};
  Duration longest{};

  void add(const RingDescription& ring, RingService service) {
    target = std::max(target, target_of(ring.rules, service));
    longest =
        std::max(longest, longest_of(ring, [&](const RingData& data) { return data.service == service; }));
  }
  // Of a round that takes `urgent` besides, and of it `least` at the station that sends last.
  Duration round(Duration urgent, Duration least) const {
    return std::max(urgent, target + longest + urgent - least);
  }
};

// The most that a round takes, where none before it took more than `round`.
Duration round_after(const RingDescription& ring, Duration round) {
  Duration urgent = passes_of(ring);
  Duration least = Duration::max();
  for (const Address station : ring.stations) {
    const Duration hold = hold_of(ring, station, round);
    urgent += hold;
    least = std::min(least, hold);
  }
  ByTimer all;
  ByTimer uncounted;
  bool is_counted = true;
  Duration counted{};
  for (const RingService service : kRingServices) {
    const auto is_its = [&](const RingData& data) { return data.service == service; };
    if (service == RingService::urgent || longest_of(ring, is_its) == Duration{}) continue;
    all.add(ring, service);
    if (const auto sum = sum_of(ring, round, is_its)) {
      counted += *sum;
    } else {
      is_counted = false;
      uncounted.add(ring, service);
    }
  }
  const Duration by_count = counted + (is_counted ? urgent : uncounted.round(urgent, least));
  return std::min(by_count, all.round(urgent, least));
}

std::optional<Duration> access_of(const RingDescription& ring, RingService service, Duration round) {
  const Rules& rules = ring.rules;
  const bool is_urgent = service == RingService::urgent;
  const Duration time =
      is_urgent ? octets(rules, rules.high_priority_hold_octets) : target_of(rules, service) - round;
  Duration most{};
  for (const Address station : ring.stations) {
    const auto sum = sum_of(
        ring, round, [&](const RingData& data) { return data.from == station && data.service == service; });
    if (!sum || *sum > time) return std::nullopt;
    most = std::max(most, *sum);
  }
  return round + most;
}

}  // namespace

Duration longest_disturbed_rotation(const RingDescription& ring) {
  const Duration token = slots(ring.rules, 1) + with_gap(ring.rules, frame_time(ring.rules, 0));
  const auto is_confirmed = [](const RingData& data) { return data.service == RingService::confirmed; };
  return longest_rotation(ring) + std::max(token, longest_of(ring, is_confirmed));
}

Duration least_rotation(const RingDescription& ring) {
  return static_cast<std::int64_t>(ring.stations.size()) * with_gap(ring.rules, frame_time(ring.rules, 0));
}

RingBounds bounds_of(const RingDescription& ring) {
  RingBounds bounds;
  // Each round bounds the next one; it grows by a datum at least, until the timers end it.
  for (Duration next = round_after(ring, {}); next != bounds.rotation;) {
    bounds.rotation = next;
    next = std::max(next, round_after(ring, next));
  }
  for (const RingService service : kRingServices)
    bounds.access[static_cast<std::size_t>(service)] = access_of(ring, service, bounds.rotation);
  return bounds;
}

}  // namespace fieldproof::token_bus

#include "protocols/token_bus/ring_line.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace fieldproof::token_bus {

RingLine::RingLine(segment::Segment& segment, const RingDescription& ring, const std::string& name,
                   const kernel::Random& random)
    : ring_(ring) {
  const std::size_t count = ring.repeaters_m.size() + 1;
  for (std::size_t n = 0; n < count; ++n) {
    const std::string its_name = n == 0 ? name : fmt::format("{}, segment {}", name, n + 1);
    media_.emplace_back(segment, its_name, segment::ContentionRule::noise, random);
    stretches_.push_back({cable_delay(ring, n == 0 ? 0 : ring.repeaters_m[n - 1]),
                          cable_delay(ring, n + 1 == count ? ring.cable_m : ring.repeaters_m[n]),
                          &media_.back()});
  }
  std::vector<std::pair<segment::MediumPort*, segment::MediumPort*>> ends;
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const Stretch& left = stretches_[n];
    ends.emplace_back(
        &media_[n].listen(fmt::format("{}, repeater {}, left", name, n + 1), left.end - left.begin),
        &media_[n + 1].listen(fmt::format("{}, repeater {}, right", name, n + 1), {}));
    repeaters_.emplace_back(ring.rules, ring.cable, *ends.back().first, *ends.back().second);
  }
  for (std::size_t n = 0; n < ends.size(); ++n) {
    connect(n, *ends[n].first, stretches_[n].end, true, false);
    connect(n + 1, *ends[n].second, stretches_[n].end, false, true);
  }
}

// Lets the repeaters at the ends of a stretch hear what a place on it drives.
void RingLine::connect(std::size_t stretch, segment::MediumPort& place, kernel::Duration at, bool is_of_left,
                       bool is_of_right) {
  const Stretch& on = stretches_[stretch];
  if (is_of_left && stretch > 0) repeaters_[stretch - 1].hear(Repeater::Side::right, place, at - on.begin);
  if (is_of_right && stretch < repeaters_.size())
    repeaters_[stretch].hear(Repeater::Side::left, place, on.end - at);
}

segment::MediumPort& RingLine::attach(const std::string& name, std::size_t station, segment::PortIndex port,
                                      std::size_t index) {
  const double at_m = position_m(ring_, index);
  const auto before = std::ranges::count_if(ring_.repeaters_m, [&](double one) { return one <= at_m; });
  const auto stretch = static_cast<std::size_t>(before);
  const kernel::Duration at = cable_delay(ring_, at_m);
  segment::MediumPort& place = media_[stretch].attach(name, station, port, at - stretches_[stretch].begin);
  connect(stretch, place, at, true, true);
  return place;
}

}  // namespace fieldproof::token_bus

#include "protocols/token_bus/ring_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace fieldproof::token_bus {

RingLine::RingLine(segment::Segment& segment, const RingDescription& ring, Channel channel,
                   const std::string& name, const kernel::Random& random)
    : ring_(ring), channel_(channel), borders_(borders()) {
  kernel::Duration begin{};
  for (std::size_t n = 0; n <= borders_.size(); ++n) {
    media_.emplace_back(segment, n == 0 ? name : fmt::format("{}, segment {}", name, n + 1),
                        segment::ContentionRule::noise, random);
    const kernel::Duration end = n < borders_.size() ? borders_[n].at : cable_delay(ring, ring.cable_m);
    stretches_.push_back({begin, end, &media_.back()});
    begin = end;
  }
  for (std::size_t n = 0; n < borders_.size(); ++n)
    divide(n, borders_[n],
           fmt::format("{}, {} {}", name, borders_[n].is_repeater ? "repeater" : "joint", n + 1));
}

std::vector<RingLine::Border> RingLine::borders() const {
  std::vector<Border> all;
  for (const double at_m : ring_.repeaters_m) {
    std::size_t before = 0;
    while (before < ring_.stations.size() && position_m(ring_, before) < at_m) ++before;
    all.push_back({before, cable_delay(ring_, at_m), true});
  }
  for (const RingCut& cut : ring_.cuts) {
    const std::size_t before = stations_before(ring_, cut);
    const auto is_there = [&](const Border& one) {
      return !one.is_repeater && one.stations_before == before;
    };
    if (cut.channel != channel_ || std::ranges::any_of(all, is_there)) continue;
    const double middle_m = (position_m(ring_, before - 1) + position_m(ring_, before)) / 2;
    all.push_back({before, cable_delay(ring_, middle_m), false});
  }
  std::ranges::stable_sort(all, {},
                           [](const Border& one) { return std::tuple(one.stations_before, one.at); });
  return all;
}

void RingLine::divide(std::size_t stretch, const Border& border, const std::string& name) {
  const Stretch& left = stretches_[stretch];
  segment::MediumPort& of_left = left.medium->listen(name + ", left", border.at - left.begin);
  segment::MediumPort& of_right = stretches_[stretch + 1].medium->listen(name + ", right", {});
  if (border.is_repeater) {
    dividers_.push_back(std::make_unique<Repeater>(ring_.rules, ring_.cable, of_left, of_right));
  } else {
    auto joint = std::make_unique<Joint>(of_left, of_right);
    joints_.push_back({border.stations_before, joint.get()});
    dividers_.push_back(std::move(joint));
  }
  // What it drives to its left the one before it hears, and the other way round.
  connect_left(stretch, of_left, border.at);
  if (stretch > 0) dividers_[stretch]->hear(Divider::Side::left, *last_right_, border.at - left.begin);
  last_right_ = &of_right;
}

void RingLine::connect_left(std::size_t stretch, segment::MediumPort& place, kernel::Duration at) {
  if (stretch > 0) dividers_[stretch - 1]->hear(Divider::Side::right, place, at - stretches_[stretch].begin);
}

void RingLine::connect_right(std::size_t stretch, segment::MediumPort& place, kernel::Duration at) {
  if (stretch < dividers_.size())
    dividers_[stretch]->hear(Divider::Side::left, place, stretches_[stretch].end - at);
}

segment::MediumPort& RingLine::attach(const std::string& name, std::size_t station, segment::PortIndex port,
                                      std::size_t index) {
  const auto before =
      std::ranges::count_if(borders_, [&](const Border& one) { return one.stations_before <= index; });
  const auto stretch = static_cast<std::size_t>(before);
  const kernel::Duration at = cable_delay(ring_, position_m(ring_, index));
  segment::MediumPort& place =
      stretches_[stretch].medium->attach(name, station, port, at - stretches_[stretch].begin);
  connect_left(stretch, place, at);
  connect_right(stretch, place, at);
  return place;
}

void RingLine::begin_cuts(std::optional<kernel::Time> from) {
  for (const Jointed& one : joints_) {
    std::vector<Joint::Cut> cuts;
    for (const RingCut& cut : ring_.cuts) {
      if (from && cut.channel == channel_ && stations_before(ring_, cut) == one.stations_before)
        cuts.push_back({*from + cut.at, *from + cut.at + cut.lasts});
    }
    one.joint->set_cuts(std::move(cuts));
  }
}

}  // namespace fieldproof::token_bus

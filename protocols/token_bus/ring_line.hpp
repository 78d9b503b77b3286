#pragma once

#include <deque>
#include <string>

#include "protocols/token_bus/repeater.hpp"
#include "protocols/token_bus/ring_description.hpp"

// The line of a ring, or one of two: its segments, the repeaters between them, the places of the stations.
namespace fieldproof::token_bus {

class RingLine {
 public:
  RingLine(segment::Segment& segment, const RingDescription& ring, const std::string& name,
           const kernel::Random& random);

  // The place of the station number `index` of the ring, which `station` of the segment hears as `port`.
  segment::MediumPort& attach(const std::string& name, std::size_t station, segment::PortIndex port,
                              std::size_t index);

 private:
  struct Stretch {
    kernel::Duration begin;
    kernel::Duration end;
    segment::Medium* medium;
  };

  void connect(std::size_t stretch, segment::MediumPort& place, kernel::Duration at, bool is_of_left,
               bool is_of_right);

  const RingDescription& ring_;
  std::deque<segment::Medium> media_;
  std::vector<Stretch> stretches_;
  std::deque<Repeater> repeaters_;
};

}  // namespace fieldproof::token_bus

#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "protocols/token_bus/repeater.hpp"
#include "protocols/token_bus/ring_description.hpp"

// The line of a ring, or one of two: its segments, the repeaters between them, where it is cut, the places of
// the stations.
namespace fieldproof::token_bus {

class RingLine {
 public:
  // The ring stays.
  RingLine(segment::Segment& segment, const RingDescription& ring, Channel channel, const std::string& name,
           const kernel::Random& random);

  // The place of the station number `index` of the ring, which `station` of the segment hears as `port`.
  segment::MediumPort& attach(const std::string& name, std::size_t station, segment::PortIndex port,
                              std::size_t index);
  // The times of cuts count from then; none are where there is none.
  void begin_cuts(std::optional<kernel::Time> from);

 private:
  // Between two segments.
  struct Border {
    std::size_t stations_before;
    kernel::Duration at;
    bool is_repeater;
  };
  struct Stretch {
    kernel::Duration begin;
    kernel::Duration end;
    segment::Medium* medium;
  };

  std::vector<Border> borders() const;
  void divide(std::size_t stretch, const Border& border, const std::string& name);
  // Lets what stands at the ends of a stretch hear a place on it.
  void connect_left(std::size_t stretch, segment::MediumPort& place, kernel::Duration at);
  void connect_right(std::size_t stretch, segment::MediumPort& place, kernel::Duration at);

  const RingDescription& ring_;
  Channel channel_;
  std::vector<Border> borders_;
  std::deque<segment::Medium> media_;
  std::vector<Stretch> stretches_;
  std::vector<std::unique_ptr<Divider>> dividers_;
  segment::MediumPort* last_right_ = nullptr;  // of the divider that was built last
  struct Jointed {
    std::size_t stations_before;
    Joint* joint;
  };
  std::vector<Jointed> joints_;
};

}  // namespace fieldproof::token_bus

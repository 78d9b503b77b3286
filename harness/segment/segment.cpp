#include "harness/segment/segment.hpp"

#include <algorithm>

namespace fieldproof::segment {

Segment::Seat::Seat(Segment& segment, Station& station)
    : segment_(segment), station_(station), slot_(segment.scheduler_.add(*this)) {}

void Segment::Seat::refresh() {
  const kernel::Time wanted = std::max(station_.next_time(), segment_.now());
  if (wanted >= armed_) return;
  armed_ = wanted;
  segment_.scheduler_.arm(slot_, wanted);
}

void Segment::Seat::on_time(kernel::Time now) {
  armed_ = kernel::kNever;
  if (station_.next_time() <= now) station_.on_time(now);
  refresh();
}

std::size_t Segment::attach(Station& station, std::string name) {
  trace_.add_channel(std::move(name));
  seats_.emplace_back(*this, station);
  seats_.back().refresh();
  return seats_.size() - 1;
}

Link& Segment::connect(std::string name, std::size_t receiver, PortIndex port, kernel::Duration delay) {
  return links_.emplace_back(*this, std::move(name), receiver, port, delay);
}

}  // namespace fieldproof::segment

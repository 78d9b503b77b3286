#include "harness/segment/segment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/kernel/error.hpp"

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

void Segment::refuse_past(const std::string& line, const line::Waveform& wave) const {
  throw kernel::Error(kernel::ErrorKind::implementation,
                      fmt::format("{} is driven at {} when it is {} already; a station drives now or later",
                                  line, kernel::describe(wave.start), kernel::describe(now())));
}

}  // namespace fieldproof::segment

#include "harness/segment/segment.hpp"

#include <algorithm>

#include "harness/kernel/error.hpp"
#include "harness/segment/stop.hpp"

namespace fieldproof::segment {
namespace {

// At one instant: no station has so much to do without time passing.
constexpr unsigned kMostCalls = 100'000;

}  // namespace

Segment::Seat::Seat(Segment& segment, Station& station, trace::Channel name)
    : segment_(segment), station_(station), slot_(segment.scheduler_.add(*this)), name_(name) {}

void Segment::Seat::refresh() {
  const kernel::Time wanted = std::max(station_.next_time(), segment_.now());
  if (wanted >= armed_) return;
  armed_ = wanted;
  segment_.scheduler_.arm(slot_, wanted);
}

void Segment::Seat::on_time(kernel::Time now) {
  give_up_if_stopped();
  armed_ = kernel::kNever;
  calls_ = now == called_at_ ? calls_ + 1 : 1;
  called_at_ = now;
  if (calls_ > kMostCalls) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        "the station \"" + segment_.trace_.channel_name(name_) +
                            "\" asks for the same instant, " + kernel::describe(now) +
                            ", for ever: next_time must move on after on_time");
  }
  if (station_.next_time() <= now) station_.on_time(now);
  refresh();
}

std::size_t Segment::attach(Station& station, std::string name) {
  seats_.emplace_back(*this, station, trace_.add_channel(std::move(name)));
  seats_.back().refresh();
  return seats_.size() - 1;
}

Link& Segment::connect(std::string name, std::size_t receiver, PortIndex port, kernel::Duration delay) {
  return links_.emplace_back(*this, std::move(name), receiver, port, delay);
}

}  // namespace fieldproof::segment

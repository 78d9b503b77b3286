#include "protocols/fieldbus_dll/ff_link.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

class LosingFrames final : public fault::Channel {
 public:
  LosingFrames(double probability, const kernel::Random& random)
      : probability_(probability), random_(random) {}
  bool pass(const line::Waveform&, line::Waveforms&) override { return random_.chance(probability_); }

 private:
  double probability_;
  kernel::Random random_;
};

}  // namespace

FfDisturb losing_frames(double probability, const kernel::Random& random) {
  return [probability, random](segment::Segment&, const segment::MediumPort& place) {
    return std::make_unique<LosingFrames>(probability, random.split(place.name()));
  };
}

void FfLink::MortalPort::drive(line::Waveform& wave) {
  if (is_dead_) {
    wave.levels.clear();
  } else {
    line_.drive(wave);
  }
}

void FfLink::Ear::on_wave(const line::Waveform& wave) {
  if (!link_.listener_) return;
  for (const Arrived& arrived : LineEnd(link_.rules_.link).receive(wave)) {
    if (const auto dlpdu = ff_dlpdu_of(arrived.octets, link_.rules_))
      link_.listener_({*dlpdu, node_, wave.start, wave.end()});
  }
}

FfLink::FfLink(const FfRules& rules, const kernel::Random& random, FfDisturb disturb)
    : rules_(rules),
      line_(segment_, "line", segment::ContentionRule::noise, random),
      disturb_(std::move(disturb)) {}

FfLas& FfLink::add_master(const FfConfiguration& configuration, FfUser& user) {
  FfLas& station = masters_.emplace_back(configuration);
  seat(station, user);
  return station;
}

FfStation& FfLink::add_device(const FfConfiguration& configuration, FfUser& user) {
  FfStation& station = devices_.emplace_back(configuration);
  seat(station, user);
  return station;
}

void FfLink::seat(FfStation& station, FfUser& user) {
  const std::size_t number = segment_.attach(station, "station");
  segment::MediumPort& place = line_.attach("station/in" + std::to_string(number), number, 0, {});
  place.sense_activity();
  if (disturb_) {
    channels_.push_back(disturb_(segment_, place));
    place.set_channel(channels_.back().get());
  }
  Seat& seat = seats_.emplace_back(*this, station, number, place);
  place.tap_driven(seat.ear);
  station.wire(seat.port, user);
  const bool has_started = station.start(segment_.now());
  FIELDPROOF_CHECK(has_started, "a station of a simulation has impossible rules");
  segment_.refresh(number);
}

FfLink::Seat& FfLink::seat_of(std::uint8_t node) {
  const auto found =
      std::ranges::find_if(seats_, [node](const Seat& seat) { return seat.station.node() == node; });
  FIELDPROOF_CHECK(found != seats_.end(), "no station of the link has this node");
  return *found;
}

bool FfLink::submit(std::uint8_t node, const FfRequest& request) {
  const Seat& seat = seat_of(node);
  const bool is_taken = seat.station.submit(request, now());
  segment_.refresh(seat.number);
  return is_taken;
}

bool FfLink::write(std::uint8_t node, FfAddress address, const Octets& data) {
  const Seat& seat = seat_of(node);
  const bool is_taken = seat.station.write(address, data, now());
  segment_.refresh(seat.number);
  return is_taken;
}

void FfLink::kill(std::uint8_t node) {
  seat_of(node).port.die();
}

}  // namespace fieldproof::fieldbus_dll

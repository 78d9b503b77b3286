#include "emc/burst_clamp.hpp"

#include <memory>
#include <utility>

#include "emc/framing.hpp"

namespace fieldproof::emc {
namespace {

struct FramingOf {
  std::shared_ptr<const Framing> operator()(std::monostate) const { return nullptr; }
  std::shared_ptr<const Framing> operator()(const line::TelegramLayout& layout) const {
    return std::make_shared<TelegramFraming>(layout);
  }
  std::shared_ptr<const Framing> operator()(const line::CharacterFormat& format) const {
    return std::make_shared<CharacterFraming>(format);
  }
};

}  // namespace

BurstReceiver burst_receiver_of(const network::Place& place) {
  return {place.level_rate, std::visit(FramingOf{}, place.units), place.sampling, true,
          place.has_whole_units};
}

BurstClamp::BurstClamp(const BurstSettings& bursts, WrongOutput wrong, const kernel::Random& random,
                       kernel::Duration recovery)
    : bursts_(bursts),
      wrong_(std::move(wrong)),
      random_(random),
      recovery_(recovery),
      schedule_(bursts_, random_) {}

void BurstClamp::couple(network::Network& network, kernel::Time on, kernel::Time off) {
  bursts_.on = on;
  bursts_.off = off;
  // Equal streams: all receivers of a run, and whoever asks for its phases, see the same pulses.
  schedule_ = BurstSchedule(bursts_, random_);
  channels_.clear();
  for (const network::Place& place : network.places()) {
    if (!place.is_exposed) continue;
    channels_.emplace_back(BurstSchedule(bursts_, random_), wrong_, burst_receiver_of(place),
                           network.segment().trace(), place.trace_channel);
    place.receiver->set_channel(&channels_.back());
  }
}

measure::Phase BurstClamp::phase_during(kernel::Time from, kernel::Time to) {
  const BurstTiming& timing = schedule_.timing();
  const kernel::Duration burst = timing.pulses * timing.pitch + 2 * timing.jitter;
  bool is_recovery = false;
  for (kernel::Time pulse = schedule_.first_from(from - recovery_ - burst); pulse != kernel::kNever;) {
    const BurstSchedule::Window window = schedule_.window_of(pulse);
    if (window.from >= to) break;
    if (window.to > from) return measure::Phase::burst;
    is_recovery = is_recovery || window.to + recovery_ > from;
    pulse = schedule_.first_from(window.to + timing.jitter);
  }
  return is_recovery ? measure::Phase::recovery : measure::Phase::quiet;
}

std::optional<measure::Span> BurstClamp::burst_after(kernel::Time after) {
  const BurstTiming& timing = schedule_.timing();
  // A burst that has begun before may have its last pulses, or only its last pitch, still to come.
  const kernel::Duration burst = timing.pulses * timing.pitch + 2 * timing.jitter;
  for (kernel::Time pulse = schedule_.first_from(after - burst); pulse != kernel::kNever;) {
    const BurstSchedule::Window window = schedule_.window_of(pulse);
    if (window.to > after) return measure::Span{window.from, window.to};
    pulse = schedule_.first_from(window.to + timing.jitter);
  }
  return std::nullopt;
}

std::uint64_t BurstClamp::bursts_between(kernel::Time from, kernel::Time to) {
  std::uint64_t bursts = 0;
  for (kernel::Time pulse = schedule_.first_from(from); pulse < to;
       pulse = schedule_.first_from(schedule_.window_of(pulse).to + schedule_.timing().jitter)) {
    ++bursts;
  }
  return bursts;
}

}  // namespace fieldproof::emc

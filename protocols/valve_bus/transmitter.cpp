#include "protocols/valve_bus/transmitter.hpp"

#include <algorithm>

namespace fieldproof::valve_bus {

// What follows without a gap has instants that are rounded, each for itself.
kernel::Time Transmitter::behind_the_last(kernel::Time start) const {
  return start < driven_until_ && driven_until_ - start <= kernel::kNanosecond ? driven_until_ : start;
}

kernel::Time Transmitter::drive_idle(segment::Port& line, kernel::Time from, kernel::Time to) {
  constexpr std::int64_t kFiner = 16;  // the driver comes and goes between bits, too
  line::Waveform idle;
  idle.start = from;
  idle.rate = rules_.bit_rate * kFiner;
  const kernel::Duration half = kernel::levels_duration(1, 2 * idle.rate);
  auto count = static_cast<std::size_t>(kernel::levels_within(to - from + half, idle.rate));
  // The nearest sixteenth, but not into what follows.
  if (kernel::level_time(from, static_cast<std::int64_t>(count), idle.rate) > to + kernel::kNanosecond)
    --count;
  idle.levels.append_idle(count);
  const kernel::Time end = idle.end();
  if (count > 0) line.drive(idle);
  return std::max(to, end);
}

void Transmitter::drive(segment::Port& line, const iut::Transmission& transmission) {
  const kernel::Time driver_on = behind_the_last(transmission.driver_on);
  const kernel::Time start = drive_idle(line, driver_on, std::max(driver_on, transmission.start));
  const kernel::Time driven = codec_.drive_characters(line, transmission.characters, start);
  driven_until_ = drive_idle(line, driven, std::max(driven, transmission.driver_off));
}

void Transmitter::drive(segment::Port& line, line::Waveform& wave) {
  wave.start = behind_the_last(wave.start);
  driven_until_ = wave.end();
  line.drive(wave);
}

}  // namespace fieldproof::valve_bus

#include "conformance/comparison/twin_line.hpp"

namespace fieldproof::conformance {

void TwinLine::on_wave(const line::Waveform& wave) {
  run_until(wave.end());
  segment_.deliver(seat_, 0, wave);
}

void TwinLine::drive(line::Waveform& wave) {
  driven_.on_wave(wave);
  wave.levels.clear();  // as a port promises
}

void TwinLine::run_until(kernel::Time now) {
  if (now > segment_.now()) segment_.run_until(now);
}

}  // namespace fieldproof::conformance

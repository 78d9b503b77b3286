#include "protocols/token_bus/service_units.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::token_bus {

void ServiceInput::add(line::Waveform wave) {
  if (wave.levels.empty()) return;
  waves_.push_back(std::move(wave));
  if (waves_.size() == 1) begin_wave();
}

void ServiceInput::begin_wave() {
  taken_ = 0;
  if (waves_.empty()) return;
  const line::Waveform& wave = waves_.front();
  front_ = {wave.start, wave.time_of(kUnitLevels), wave.rate};
}

void ServiceInput::pop() {
  if (++taken_ < units_in(levels())) {
    front_ = {front_.end, waves_.front().time_of((taken_ + 1) * kUnitLevels), front_.rate};
    return;
  }
  waves_.pop_front();
  begin_wave();
}

kernel::Time ServiceInput::end_of_piece(std::size_t units) const {
  return waves_.front().time_of(kUnitLevels * std::min(taken_ + units, units_in(levels())));
}

void ServiceOutput::append(kernel::Time begin, std::int64_t rate, std::uint64_t levels, unsigned count) {
  const kernel::Time before = waves_.empty() ? driven_until_ : waves_.back().end();
  const bool follows =
      !waves_.empty() && waves_.back().rate == rate && begin < before + kernel::levels_duration(1, rate);
  if (!follows) waves_.push_back({std::max(begin, before), rate, {}});
  waves_.back().levels.append(levels, count);
}

void ServiceOutput::drive(kernel::Time now) {
  for (line::Waveform& wave : waves_) {
    wave.start = std::max({wave.start, now, driven_until_});
    driven_until_ = wave.end();
    port_->drive(wave);
  }
  waves_.clear();
}

}  // namespace fieldproof::token_bus

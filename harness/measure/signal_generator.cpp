#include "harness/measure/signal_generator.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

constexpr std::int64_t kMillion = 1'000'000;

// `millionths` of a period, rounded once.
kernel::Duration part_of_periods(Frequency frequency, std::int64_t millionths) {
  return kernel::levels_duration(1'000 * millionths, frequency.millihertz() * kMillion);
}

}  // namespace

kernel::Duration SquareWave::high() const {
  return part_of_periods(frequency, duty_ppm);
}

SignalGenerator::SignalGenerator(const SquareWave& wave) : wave_(wave) {
  FIELDPROOF_CHECK(wave.duty_ppm > 0 && wave.duty_ppm < kMillion, "a square wave has a pulse and a pause");
  FIELDPROOF_CHECK(wave.high() > kernel::Duration::zero() && wave.high() < wave.period(),
                   "a pulse and a pause last at least a picosecond");
}

void SignalGenerator::trigger(kernel::Time at, std::int64_t periods) {
  FIELDPROOF_CHECK(periods > 0, "a train has at least one period");
  const kernel::Time first = at + wave_.phase;
  FIELDPROOF_CHECK(edges_.empty() || first > edges_.back(), "a train begins after the one before it");
  for (std::int64_t k = 0; k < periods; ++k) {
    edges_.push_back(first + wave_.frequency.periods(k));
    edges_.push_back(first + part_of_periods(wave_.frequency, k * kMillion + wave_.duty_ppm));
  }
  train_ends_.push_back(edges_.size());
}

bool SignalGenerator::is_train_end(std::uint64_t number) const {
  return std::binary_search(train_ends_.begin(), train_ends_.end(), number);
}

std::uint64_t SignalGenerator::edges_until(kernel::Time when) const {
  return static_cast<std::uint64_t>(std::upper_bound(edges_.begin(), edges_.end(), when) - edges_.begin());
}

}  // namespace fieldproof::measure

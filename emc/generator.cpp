#include "emc/generator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

constexpr kernel::Duration kPeriod = 300 * kernel::kMillisecond;
constexpr double kTolerance = 0.2;
constexpr std::int64_t kJitterPerMille = 10;

struct Nominal {
  kernel::Duration pitch;
  kernel::Duration duration;
};

Nominal nominal_of(Repetition repetition) {
  switch (repetition) {
    case Repetition::khz_5:
      return {200 * kernel::kMicrosecond, 15 * kernel::kMillisecond};
    case Repetition::khz_100:
      return {10 * kernel::kMicrosecond, 750 * kernel::kMicrosecond};
    case Repetition::khz_2_5_edition_1:
      return {400 * kernel::kMicrosecond, 15 * kernel::kMillisecond};
  }
  return {};
}

// Uniform within the tolerance on both sides of 1.
double factor(kernel::Random& random) {
  return 1 - kTolerance + 2 * kTolerance * random.uniform();
}

// Of what is not negative.
kernel::Duration scaled(kernel::Duration duration, double by) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): std::llround is a call, for each pulse
  return kernel::Duration{static_cast<std::int64_t>(static_cast<double>(duration.count()) * by + 0.5)};
}

std::int64_t floor_quotient(kernel::Duration a, kernel::Duration b) {
  const std::int64_t quotient = a / b;
  return a.count() % b.count() < 0 ? quotient - 1 : quotient;
}

std::int64_t pulses_within(kernel::Duration duration, kernel::Duration pitch) {
  return (duration + pitch - kernel::kPicosecond) / pitch;
}

BurstTiming draw(const BurstSettings& settings, kernel::Random random) {
  const Nominal nominal = nominal_of(settings.repetition);
  BurstTiming timing{};
  timing.pitch = nominal.pitch;
  timing.pulses = pulses_within(nominal.duration, nominal.pitch);
  timing.period = kPeriod;
  timing.sweep_steps = 1;
  timing.phase = settings.first_burst.value_or(kernel::Duration::zero());
  if (settings.clock == GeneratorClock::commensurable_with_the_line_to_show_the_artefact) return timing;
  if (settings.tolerances != Tolerances::none) timing.pitch = scaled(nominal.pitch, 1 / factor(random));
  if (settings.tolerances == Tolerances::rate_duration_and_period) {
    timing.pulses = pulses_within(scaled(nominal.duration, factor(random)), timing.pitch);
    timing.period = scaled(kPeriod, factor(random));
  }
  if (settings.has_jitter || settings.tolerances == Tolerances::none) {
    timing.jitter = timing.pitch * kJitterPerMille / 1000;
  }
  timing.phase =
      settings.first_burst.value_or(kernel::Duration{random.between(0, timing.period.count() - 1)});
  if (settings.phase == BurstPhase::swept) {
    timing.sweep_steps = std::max(1U, settings.sweep_steps);
    timing.sweep = timing.pitch / timing.sweep_steps;
  }
  return timing;
}

}  // namespace

std::string_view text_of(Repetition repetition) {
  constexpr std::array<std::string_view, 3> kTexts{"5 kHz", "100 kHz", "2.5 kHz"};
  return kTexts.at(static_cast<std::size_t>(repetition));
}

std::string_view word_of(Repetition repetition) {
  constexpr std::array<std::string_view, 3> kWords{"5kHz", "100kHz", "2.5kHz"};
  return kWords.at(static_cast<std::size_t>(repetition));
}

std::string_view text_of(Polarity polarity) {
  return polarity == Polarity::positive ? "+" : "-";
}

Level Level::standard(PortKind port, unsigned number) {
  if (number < 1 || number > 4) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("there is no level {}; IEC 61000-4-4 has the levels 1 to 4, and level X "
                                    "with a voltage of your own.",
                                    number));
  }
  const double first = port == PortKind::signal ? 250 : 500;
  return {number, first * static_cast<double>(1U << (number - 1))};
}

Level Level::free(double open_circuit_volts) {
  if (!(open_circuit_volts >= kLeastVolts && open_circuit_volts <= kMostVolts)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("level X cannot have {} V; it takes {} V to {} V.", open_circuit_volts,
                                    kLeastVolts, kMostVolts));
  }
  return {0, open_circuit_volts};
}

std::string Level::text() const {
  return number_ == 0 ? fmt::format("X ({} V)", volts_) : fmt::format("{} ({} V)", number_, volts_);
}

BurstSchedule::BurstSchedule(const BurstSettings& settings, const kernel::Random& random)
    : timing_(draw(settings, random.split("burst timing"))),
      first_number_(settings.first_burst ? 0 : -1),
      origin_(settings.on),
      on_(settings.first_burst ? settings.on - timing_.jitter : settings.on),
      off_(settings.off),
      jitter_(random.split("pulse jitter")) {}

kernel::Time BurstSchedule::burst_begin(std::int64_t burst) const {
  const std::int64_t step = burst < 0 ? timing_.sweep_steps - 1 : burst % timing_.sweep_steps;
  return origin_ + timing_.phase + burst * timing_.period + step * timing_.sweep;
}

std::int64_t BurstSchedule::burst_before(kernel::Time time) const {
  // A burst that runs when the generator is switched on has number -1; there is none before it.
  const kernel::Duration behind =
      time - origin_ - timing_.phase - timing_.sweep * timing_.sweep_steps - timing_.jitter;
  return std::max(first_number_, floor_quotient(behind, timing_.period));
}

void BurstSchedule::begin_burst(std::int64_t burst) {
  burst_ = burst;
  begin_ = burst_begin(burst);
  number_ = 0;
}

kernel::Time BurstSchedule::pulse_here() const {
  const kernel::Time place = begin_ + number_ * timing_.pitch;
  if (timing_.jitter == kernel::Duration::zero()) return place;
  const auto name = static_cast<std::uint64_t>((burst_ + 1) * timing_.pulses + number_);
  const std::int64_t most = timing_.jitter.count();
  return place + kernel::Duration{jitter_[name].between(-most, most)};
}

void BurstSchedule::step() {
  if (++number_ >= timing_.pulses) begin_burst(burst_ + 1);
}

// To the first pulse from `wanted` on or, because pulses stray, to one shortly before it.
void BurstSchedule::jump_to(kernel::Time wanted) {
  begin_burst(burst_before(wanted));
  const kernel::Duration behind = wanted - begin_ - timing_.jitter;
  number_ = std::max<std::int64_t>(0, floor_quotient(behind, timing_.pitch));
  if (number_ >= timing_.pulses) begin_burst(burst_ + 1);
}

void BurstSchedule::seek(kernel::Time from) {
  constexpr std::int64_t kNear = 16;  // steps that cost less than a jump
  const kernel::Time wanted = std::max(from, on_);
  known_from_ = from;
  if (wanted >= off_) {
    next_ = kernel::kNever;
    is_drawn_ = true;
    return;
  }
  if (wanted <= next_ || wanted - next_ > kNear * timing_.pitch) {
    jump_to(wanted);
  } else if (is_drawn_) {
    step();
  }
  is_drawn_ = false;
  // Pulses that come too early however they stray are not drawn.
  while (begin_ + number_ * timing_.pitch < wanted - timing_.jitter) step();
  next_ = std::max(wanted, begin_ + number_ * timing_.pitch - timing_.jitter);
}

// The first pulse that is wanted and not too early.
void BurstSchedule::draw_pulse() {
  const kernel::Time wanted = std::max(known_from_, on_);
  kernel::Time at = pulse_here();
  for (; at < wanted; at = pulse_here()) step();
  next_ = at < off_ ? at : kernel::kNever;
  is_drawn_ = true;
}

BurstSchedule::Window BurstSchedule::window_of(kernel::Time pulse) const {
  const std::int64_t burst = burst_before(pulse + 2 * timing_.jitter + timing_.sweep * timing_.sweep_steps);
  const kernel::Time begin = burst_begin(burst);
  return {begin - timing_.jitter, begin + timing_.pulses * timing_.pitch};
}

}  // namespace fieldproof::emc

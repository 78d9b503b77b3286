#include "emc/generator.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kPicosecond;
using kernel::kSecond;
using kernel::kStart;

std::vector<kernel::Time> pulses_of(BurstSchedule& schedule, kernel::Time from, kernel::Time to) {
  std::vector<kernel::Time> pulses;
  for (kernel::Time at = schedule.first_from(from); at < to; at = schedule.first_from(at + kPicosecond)) {
    pulses.push_back(at);
  }
  return pulses;
}

BurstSettings nominal(Repetition repetition) {
  BurstSettings settings;
  settings.repetition = repetition;
  settings.tolerances = Tolerances::none;
  return settings;
}

TEST(LevelTest, AreThoseOfTheStandard) {
  const std::vector<double> signal{250, 500, 1000, 2000};
  for (unsigned n = 1; n <= 4; ++n) {
    EXPECT_EQ(Level::standard(PortKind::signal, n).open_circuit_volts(), signal.at(n - 1));
    EXPECT_EQ(Level::standard(PortKind::power, n).open_circuit_volts(), 2 * signal.at(n - 1));
  }
  EXPECT_EQ(Level::standard(PortKind::power, 4).text(), "4 (4000 V)");
  EXPECT_EQ(Level::free(4500).text(), "X (4500 V)");
}

TEST(LevelTest, RefusesWhatIsNoLevel) {
  for (const unsigned number : {0U, 5U}) {
    EXPECT_THROW(Level::standard(PortKind::signal, number), kernel::Error);
  }
  EXPECT_EQ(Level::free(1).open_circuit_volts(), 1);
  EXPECT_EQ(Level::free(10'000).open_circuit_volts(), 10'000);
  for (const double volts : {0.99, 10'000.1, -500.0, 0.0 / 0.0 * 1.0}) {
    EXPECT_THROW(Level::free(volts), kernel::Error);
  }
}

// 200 bursts of 75 pulses in a minute, at either polarity, wherever the bursts lie.
TEST(BurstScheduleTest, FifteenThousandPulsesPerMinuteAndPolarity) {
  for (const Repetition repetition : {Repetition::khz_5, Repetition::khz_100}) {
    for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        BurstSettings settings = nominal(repetition);
        settings.polarity = polarity;
        BurstSchedule schedule(settings, kernel::Random(seed));
        EXPECT_EQ(schedule.timing().pulses, 75);
        const auto count = static_cast<double>(pulses_of(schedule, kStart, kStart + 60 * kSecond).size());
        // A pulse at either end may stray over it.
        EXPECT_NEAR(count, 15'000, 1) << text_of(repetition) << text_of(polarity);
      }
    }
  }
}

// Also when the rate is drawn.
TEST(BurstScheduleTest, TheDrawnRateAloneChangesNoCount) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    BurstSettings settings;
    settings.tolerances = Tolerances::rate;
    BurstSchedule schedule(settings, kernel::Random(seed));
    EXPECT_NE(schedule.timing().pitch, 200 * kMicrosecond);
    EXPECT_EQ(schedule.timing().period, 300 * kMillisecond);
    const auto count = static_cast<double>(pulses_of(schedule, kStart, kStart + 60 * kSecond).size());
    EXPECT_NEAR(count, 15'000, 1);
  }
}

// Half as many pulses fit into the 15 ms.
TEST(BurstScheduleTest, EditionOneHasItsSlowRate) {
  BurstSchedule schedule(nominal(Repetition::khz_2_5_edition_1), kernel::Random(1));
  EXPECT_EQ(schedule.timing().pulses, 38);
  EXPECT_EQ(schedule.timing().pitch, 400 * kMicrosecond);
}

TEST(BurstScheduleTest, BurstsLastAsLongAsTheStandardSays) {
  for (const auto& [repetition, duration] :
       {std::pair{Repetition::khz_5, 15 * kMillisecond}, {Repetition::khz_100, 750 * kMicrosecond}}) {
    BurstSchedule schedule(nominal(repetition), kernel::Random(7));
    const BurstTiming& timing = schedule.timing();
    const kernel::Time first = schedule.first_from(kStart + timing.phase - timing.jitter);
    const kernel::Time next = schedule.first_from(first + 100 * kMillisecond);
    EXPECT_LE(abs(next - first - 300 * kMillisecond), 2 * timing.jitter);
    const auto pulses = pulses_of(schedule, first, next);
    ASSERT_EQ(pulses.size(), 75U);
    EXPECT_LE(abs(pulses.back() - first + timing.pitch - duration), 2 * timing.jitter);
    const BurstSchedule::Window window = schedule.window_of(pulses.at(40));
    EXPECT_EQ(window.to - window.from, duration + timing.jitter);
    EXPECT_LE(window.from, first);
    EXPECT_GT(window.to, pulses.back());
    EXPECT_EQ(schedule.window_of(first).from, window.from);
    EXPECT_EQ(schedule.window_of(pulses.back()).from, window.from);
  }
}

TEST(BurstScheduleTest, TolerancesAreDrawnWithinTwentyPercentAndReachBothEnds) {
  double lowest = 2;
  double highest = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const BurstSchedule schedule({}, kernel::Random(seed));
    const BurstTiming& timing = schedule.timing();
    const auto of = [](kernel::Duration a, kernel::Duration b) {
      return static_cast<double>(a.count()) / static_cast<double>(b.count());
    };
    const double rate = of(200 * kMicrosecond, timing.pitch);
    const double period = of(timing.period, 300 * kMillisecond);
    const double duration = of(timing.pulses * timing.pitch, 15 * kMillisecond);
    for (const double part : {rate, period}) {
      EXPECT_GE(part, 0.8 - 1e-9);
      EXPECT_LE(part, 1.2 + 1e-9);
    }
    // Whole pulses: the last one may begin just before the end of the burst.
    EXPECT_GE(duration, 0.8);
    EXPECT_LE(duration, 1.2 + of(timing.pitch, 15 * kMillisecond));
    EXPECT_LT(timing.phase, timing.period);
    lowest = std::min(lowest, rate);
    highest = std::max(highest, rate);
  }
  EXPECT_LT(lowest, 0.801);
  EXPECT_GT(highest, 1.199);
}

TEST(BurstScheduleTest, PulsesStrayByOnePercentOfThePitch) {
  BurstSchedule schedule(nominal(Repetition::khz_5), kernel::Random(3));
  const BurstTiming& timing = schedule.timing();
  EXPECT_EQ(timing.jitter, 2 * kMicrosecond);
  const kernel::Time begin = kStart + timing.phase;
  kernel::Duration farthest{};
  for (std::int64_t burst = 0; burst < 20; ++burst) {
    for (std::int64_t n = 0; n < 75; ++n) {
      const kernel::Time place = begin + burst * timing.period + n * timing.pitch;
      const kernel::Time pulse = schedule.first_from(place - timing.jitter);
      ASSERT_LE(abs(pulse - place), timing.jitter);
      farthest = std::max(farthest, abs(pulse - place));
    }
  }
  EXPECT_GT(farthest, timing.jitter * 99 / 100);
}

// Consecutive bursts begin at sixteen evenly spaced places of the pitch.
TEST(BurstScheduleTest, ASweepWalksThroughThePitch) {
  BurstSettings settings = nominal(Repetition::khz_5);
  settings.phase = BurstPhase::swept;
  settings.sweep_steps = 16;
  BurstSchedule schedule(settings, kernel::Random(4));
  const BurstTiming& timing = schedule.timing();
  EXPECT_EQ(timing.sweep, 12'500 * kernel::kNanosecond);
  for (std::int64_t burst = 0; burst < 40; ++burst) {
    const kernel::Time place = kStart + timing.phase + burst * timing.period + (burst % 16) * timing.sweep;
    EXPECT_LE(abs(schedule.first_from(place - timing.jitter) - place), timing.jitter);
  }
  EXPECT_EQ(pulses_of(schedule, kStart, kStart + 60 * kSecond).size() / 100, 150U);
}

TEST(BurstScheduleTest, OnAndOffBoundThePulses) {
  BurstSettings settings;
  settings.on = kStart + kSecond;
  settings.off = kStart + 3 * kSecond;
  BurstSchedule schedule(settings, kernel::Random(5));
  const auto pulses = pulses_of(schedule, kStart, kernel::kNever);
  ASSERT_FALSE(pulses.empty());
  EXPECT_GE(pulses.front(), settings.on);
  EXPECT_LT(pulses.back(), settings.off);
  EXPECT_LT(pulses.front(), settings.on + 400 * kMillisecond);
  EXPECT_FALSE(schedule.has_pulse_in(kStart, settings.on));
  EXPECT_EQ(schedule.first_from(settings.off), kernel::kNever);
  // The last pulse belongs in, an instant that is switched off before it leaves it out.
  settings.off = pulses.back();
  EXPECT_EQ(pulses_of(schedule, kStart, kernel::kNever).size(), pulses.size());
  BurstSchedule shorter(settings, kernel::Random(5));
  EXPECT_EQ(pulses_of(shorter, kStart, kernel::kNever).size(), pulses.size() - 1);
}

TEST(BurstScheduleTest, OnlyTheArtefactHasNoPhaseAndNoJitter) {
  BurstSettings settings;
  settings.clock = GeneratorClock::commensurable_with_the_line_to_show_the_artefact;
  BurstSchedule schedule(settings, kernel::Random(6));
  for (const kernel::Time pulse : pulses_of(schedule, kStart, kStart + kSecond)) {
    EXPECT_EQ((pulse - kStart) % (200 * kMicrosecond), kernel::Duration::zero());
  }
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const Tolerances tolerances :
         {Tolerances::none, Tolerances::rate, Tolerances::rate_duration_and_period}) {
      for (const bool has_jitter : {false, true}) {
        BurstSettings usual;
        usual.tolerances = tolerances;
        usual.has_jitter = has_jitter;
        const BurstTiming timing = BurstSchedule(usual, kernel::Random(seed)).timing();
        const bool is_drawn = timing.pitch % (200 * kMicrosecond) != kernel::Duration::zero();
        EXPECT_TRUE(is_drawn || timing.jitter > kernel::Duration::zero());
        EXPECT_EQ(timing.jitter > kernel::Duration::zero(), has_jitter || tolerances == Tolerances::none);
      }
    }
  }
}

// Whatever is asked in whatever order, the pulses are those of one walk through the run.
RC_GTEST_PROP(BurstScheduleProperty, AnswersDoNotDependOnTheQuestionsBefore, ()) {
  BurstSettings settings;
  settings.repetition =
      *rc::gen::element(Repetition::khz_5, Repetition::khz_100, Repetition::khz_2_5_edition_1);
  settings.phase = *rc::gen::element(BurstPhase::asynchronous, BurstPhase::swept);
  settings.tolerances =
      *rc::gen::element(Tolerances::none, Tolerances::rate, Tolerances::rate_duration_and_period);
  const auto instant = [] { return kernel::Duration{*rc::gen::inRange<std::int64_t>(0, kSecond.count())}; };
  if (*rc::gen::arbitrary<bool>()) settings.on = kStart + instant();
  if (*rc::gen::arbitrary<bool>()) settings.off = kStart + instant();
  if (*rc::gen::arbitrary<bool>()) settings.first_burst = instant();
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  BurstSchedule walked(settings, random);
  const auto pulses = pulses_of(walked, kStart, kStart + 2 * kSecond);
  RC_ASSERT(std::is_sorted(pulses.begin(), pulses.end()));
  BurstSchedule asked(settings, random);
  const auto questions = *rc::gen::container<std::vector<std::int64_t>>(
      rc::gen::inRange<std::int64_t>(-kMillisecond.count(), kSecond.count()));
  for (const std::int64_t question : questions) {
    const kernel::Time from = kStart + kernel::Duration{question};
    const auto found = std::lower_bound(pulses.begin(), pulses.end(), from);
    const kernel::Time expected = found == pulses.end() ? kernel::kNever : *found;
    const kernel::Time to = *rc::gen::element(
        from + kernel::Duration{*rc::gen::inRange<std::int64_t>(0, kMillisecond.count())}, expected);
    RC_ASSERT(asked.has_pulse_in(from, to) == (expected < to));
    if (*rc::gen::arbitrary<bool>()) asked = BurstSchedule(asked);
    if (*rc::gen::arbitrary<bool>()) continue;  // nothing is drawn where the look was enough
    RC_ASSERT(asked.first_from(from) == expected);
    RC_ASSERT(!asked.has_pulse_in(from, expected));
    if (expected < kernel::kNever) RC_ASSERT(asked.has_pulse_in(from, expected + kPicosecond));
  }
}

}  // namespace
}  // namespace fieldproof::emc

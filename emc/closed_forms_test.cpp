// Subject: bursts on a line as a whole (generator, channel, sampling), held against closed forms.
// Frames of 182 random bits every 0.8148 ms at 500 kbit/s, as an INTERBUS line has them. Each test prints the
// rows of the table in the README: the formula beside the simulation.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "emc/burst_channel.hpp"
#include "emc/effective_time.hpp"
#include "emc/profile.hpp"
#include "emc/random_flips.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/telegram_receiver.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kNanosecond;
using kernel::kSecond;
using kernel::kStart;
using line::Sampling;

constexpr std::int64_t kBitRate = 500'000;
constexpr std::size_t kFrameBits = 182;
constexpr Duration kCycle = 814'800 * kNanosecond;
constexpr double kPulsesPerSecond = 250;
constexpr double kActivity = 364.0 / 814.8;

constexpr Sampling kMajority{Sampling::Kind::majority_of_three};
constexpr Sampling kSingle{Sampling::Kind::mid_bit};

// The output is forced to 0 for a time from `delay` behind each pulse on.
WrongOutput forced_low(Duration tau, Duration delay = {}) {
  WrongOutput wrong;
  wrong.of_level[1] = {{delay, delay + tau}};
  return wrong;
}

struct Setup {
  WrongOutput wrong;
  Sampling sampling = kSingle;
  Repetition repetition = Repetition::khz_5;
  std::int64_t bit_rate = kBitRate;
  GeneratorClock clock = GeneratorClock::its_own;
  int runs = 240;  // each draws its tolerances
  std::int64_t seconds_per_run = 60;
};

struct Outcome {
  double pulses = 0;
  double cycles = 0;
  double overlapped = 0;  // cycles whose frame met a pulse
  double bad = 0;         // cycles with a flip
  double multiple = 0;    // with more than one
  double flips = 0;
  int longest_run = 0;  // of bad cycles

  // At the nominal number of pulses.
  double flips_per_second() const { return flips / pulses * kPulsesPerSecond; }
  double bad_share() const {
    return bad / pulses * kPulsesPerSecond * static_cast<double>(kCycle.count()) /
           static_cast<double>(kSecond.count());
  }
  double bad_given_overlap() const { return bad / overlapped; }
  double multiple_share() const { return multiple / bad; }
};

void refill(line::Waveform& wave, kernel::Random& random) {
  wave.levels.clear();
  std::size_t left = kFrameBits;
  for (; left > 64; left -= 64) wave.levels.append(random.next(), 64);
  wave.levels.append(random.next(), static_cast<unsigned>(left));
}

void add_run(const Setup& setup, const kernel::Random& random, Outcome& outcome) {
  BurstSettings settings;
  settings.repetition = setup.repetition;
  settings.clock = setup.clock;
  trace::Trace trace;
  BurstChannel channel({settings, random}, setup.wrong,
                       {setup.bit_rate, std::make_shared<SynchronousFraming>(), setup.sampling, true, true},
                       trace, trace.add_channel("rx"));
  kernel::Random data = random.split("data");
  std::vector<line::Waveform> arrivals;
  line::Waveform wave;
  wave.rate = setup.bit_rate;
  refill(wave, data);
  const kernel::Time end = kStart + setup.seconds_per_run * kSecond;
  int run = 0;
  for (wave.start = kStart; wave.start < end; wave.start += kCycle) {
    ++outcome.cycles;
    if (channel.schedule().has_pulse_in(wave.start, wave.end())) {
      ++outcome.overlapped;
      refill(wave, data);
    }
    const std::uint64_t before = channel.statistics().flipped_bits;
    arrivals.clear();
    if (!channel.pass(wave, arrivals)) {
      run = 0;
      continue;
    }
    const std::uint64_t flips = channel.statistics().flipped_bits - before;
    ++outcome.bad;
    outcome.multiple += flips > 1;
    outcome.flips += static_cast<double>(flips);
    outcome.longest_run = std::max(outcome.longest_run, ++run);
  }
  BurstSchedule pulses(settings, random);
  for (kernel::Time at = pulses.first_from(kStart); at < end;
       at = pulses.first_from(at + kernel::kPicosecond)) {
    ++outcome.pulses;
  }
}

Outcome simulate(const Setup& setup) {
  Outcome outcome;
  const kernel::Random random(20240611);
  for (int run = 0; run < setup.runs; ++run) {
    add_run(setup, random.split(static_cast<std::uint64_t>(run)), outcome);
  }
  return outcome;
}

void print_row(const std::string& what, double formula, double simulated) {
  fmt::print("| {} | {:.4g} | {:.4g} | {:+.1f} % |\n", what, formula, simulated,
             formula == 0 ? 0 : 100 * (simulated / formula - 1));
}

// Within 2 %, and the last digit that the figure is given with.
void expect_figure(const std::string& what, double figure, double simulated, double half_digit = 0) {
  print_row(what, figure, simulated);
  EXPECT_NEAR(simulated, figure, 0.02 * figure + half_digit) << what;
}

std::string ns_text(Duration tau) {
  return std::to_string(tau / kNanosecond) + " ns";
}

// tau / (2 T_b) per pulse on a busy line, for a single sample; all of it from pulses and sampling instants.
TEST(ClosedFormsTest, OneSampleFlipsInProportionToTheWrongTime) {
  for (const int tau : {50, 100, 300, 1000, 2000}) {
    const Setup setup{.wrong = forced_low(tau * kNanosecond)};
    const double formula = kPulsesPerSecond * kActivity * tau / 4000;
    expect_figure(fmt::format("flips/s, one sample, {} ns, 5 kHz", tau), formula,
                  simulate(setup).flips_per_second());
  }
}

TEST(ClosedFormsTest, TheVotingReceiverSeesItsEffectiveTime) {
  for (const auto& [tau, effective] :
       {std::pair{100, 0}, {125, 0}, {150, 50}, {200, 150}, {250, 250}, {300, 300}}) {
    const Setup setup{.wrong = forced_low(tau * kNanosecond), .sampling = kMajority};
    const double formula = kPulsesPerSecond * kActivity * effective / 4000;
    const double simulated = simulate(setup).flips_per_second();
    expect_figure(fmt::format("flips/s, 3 votes, {} ns, 5 kHz", tau), formula, simulated);
    if (effective == 0) EXPECT_EQ(simulated, 0) << tau;
  }
}

// Nothing up to a sixteenth of a bit, something beyond: 167 ns at 375 kbit/s, 1 us at 62.5 kbit/s.
TEST(ClosedFormsTest, TheVotingReceiverIsImmuneUpToASixteenthOfABit) {
  for (const auto& [bit_rate, immune] : {std::pair<std::int64_t, Duration>{500'000, 125 * kNanosecond},
                                         {375'000, 150 * kNanosecond},
                                         {62'500, 1000 * kNanosecond},
                                         {19'200, 3250 * kNanosecond}}) {
    Setup setup{.wrong = forced_low(immune), .sampling = kMajority, .bit_rate = bit_rate, .runs = 20};
    const double flips = simulate(setup).flips;
    print_row(fmt::format("flips, 3 votes, {} at {} bit/s", ns_text(immune), bit_rate), 0, flips);
    EXPECT_EQ(flips, 0) << bit_rate;
    setup.wrong = forced_low(immune * 5 / 4);
    EXPECT_GT(simulate(setup).flips, 0) << bit_rate;
  }
}

TEST(ClosedFormsTest, BothRepetitionRatesFlipAsManyBits) {
  for (const int tau : {100, 300, 1000}) {
    const Setup setup{.wrong = forced_low(tau * kNanosecond), .repetition = Repetition::khz_100};
    const double formula = kPulsesPerSecond * kActivity * tau / 4000;
    expect_figure(fmt::format("flips/s, one sample, {} ns, 100 kHz", tau), formula,
                  simulate(setup).flips_per_second());
  }
}

struct Clustering {
  int tau;
  double bad_share;
  double bad_given_overlap;
  double multiple_share;
};

// Each figure with half of its last digit.
TEST(ClosedFormsTest, FiveKilohertzSpreadsItsFlipsOverCycles) {
  for (const Clustering& figures :
       {Clustering{100, 2.2e-3, 0.044, 0.012}, {300, 6.6e-3, 0.129, 0.033}, {1000, 2.0e-2, 0.395, 0.12}}) {
    const Outcome outcome = simulate({.wrong = forced_low(figures.tau * kNanosecond)});
    const std::string tau = fmt::format(", {} ns, 5 kHz", figures.tau);
    expect_figure("bad cycles" + tau, figures.bad_share, outcome.bad_share(),
                  figures.tau == 1000 ? 5e-4 : 5e-5);
    expect_figure("bad given overlap" + tau, figures.bad_given_overlap, outcome.bad_given_overlap(), 5e-4);
    expect_figure("share with several flips" + tau, figures.multiple_share, outcome.multiple_share(),
                  figures.tau == 1000 ? 5e-3 : 5e-4);
  }
}

TEST(ClosedFormsTest, AHundredKilohertzCollectsThemInOne) {
  for (const Clustering& figures :
       {Clustering{100, 1.7e-3, 0.46, 0.28}, {300, 2.8e-3, 0.76, 0.70}, {1000, 3.5e-3, 0.94, 0.93}}) {
    const Outcome outcome =
        simulate({.wrong = forced_low(figures.tau * kNanosecond), .repetition = Repetition::khz_100});
    const std::string tau = fmt::format(", {} ns, 100 kHz", figures.tau);
    expect_figure("bad cycles" + tau, figures.bad_share, outcome.bad_share(), 5e-5);
    expect_figure("bad given overlap" + tau, figures.bad_given_overlap, outcome.bad_given_overlap(), 5e-3);
    expect_figure("share with several flips" + tau, figures.multiple_share, outcome.multiple_share(), 5e-3);
    EXPECT_LE(outcome.longest_run, 2) << "a burst of 0.75 ms cannot reach three frames";
  }
}

}  // namespace
}  // namespace fieldproof::emc

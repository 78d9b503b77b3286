// Subject: bursts on a line of Manchester code, held against closed forms and against its receiver. Each test
// prints the rows of the table in the README: the formula beside the simulation.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "emc/burst_channel.hpp"
#include "harness/line/manchester.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kStart;

constexpr std::size_t kFrameOctets = 64;

Duration half_bit(std::int64_t bit_rate) {
  return kernel::levels_duration(1, 2 * bit_rate);
}

// The receiver's clock ticks in half bits, and it samples each once.
BurstReceiver receiver_of(std::int64_t bit_rate, bool has_short_cuts) {
  return {2 * bit_rate, has_short_cuts ? std::make_shared<SynchronousFraming>() : nullptr, line::kMidBit,
          true, true};
}

// What pulses come to on a line that is never idle, for each of them.
struct PerPulse {
  double wrong_halves = 0;
  double violations = 0;  // bits that are no data any more
  double data_flips = 0;  // bits that became the other one
};

class ManchesterLine {
 public:
  ManchesterLine(std::int64_t bit_rate, WrongOutput wrong, std::uint64_t seed)
      : random_(seed),
        channel_(BurstSchedule({}, random_.split("bursts")), std::move(wrong), receiver_of(bit_rate, true),
                 trace_, trace_.add_channel("rx")),
        receiver_({}, bit_rate) {
    wave_.rate = 2 * bit_rate;
  }

  PerPulse run(std::uint64_t pulses) {
    kernel::Time at = kStart + kernel::kSecond;
    while (pulses_ < pulses) at = run_burst(at);
    const auto per_pulse = [this](std::uint64_t count) {
      return static_cast<double>(count) / static_cast<double>(pulses_);
    };
    return {per_pulse(channel_.statistics().flipped_bits), per_pulse(violations_), per_pulse(data_flips_)};
  }

 private:
  // Frames without a gap over the next burst, from any phase on. Gives an instant after it.
  kernel::Time run_burst(kernel::Time from) {
    BurstSchedule schedule = channel_.schedule();
    const kernel::Time first = schedule.first_from(from);
    const auto window = schedule.window_of(first);
    for (kernel::Time pulse = first; pulse < window.to;
         pulse = schedule.first_from(pulse + kernel::kPicosecond)) {
      ++pulses_;
    }
    constexpr auto kPhase = static_cast<std::uint64_t>(kernel::kMillisecond.count());
    wave_.start = first - Duration{static_cast<std::int64_t>(random_.below(kPhase)) + 1};
    while (wave_.start < window.to + kernel::kMillisecond) {
      pass_frame();
      wave_.start = wave_.end();
    }
    return window.to + kernel::kMillisecond;
  }

  void pass_frame() {
    wave_.levels.clear();
    for (std::size_t n = 0; n < kFrameOctets; ++n) {
      code_.append_octet(wave_.levels, static_cast<std::uint8_t>(random_.below(256)));
    }
    arrivals_.clear();
    if (!channel_.pass(wave_, arrivals_)) return;
    sent_.clear();
    heard_.clear();
    receiver_.receive(wave_, sent_);
    ASSERT_EQ(arrivals_.size(), 1U);
    receiver_.receive(arrivals_.front(), heard_);
    for (std::size_t n = 0; n < sent_.size(); ++n) {
      if (!line::is_data(heard_[n])) {
        ++violations_;
      } else if (heard_[n] != sent_[n]) {
        ++data_flips_;
      }
    }
  }

  kernel::Random random_;
  trace::Trace trace_;
  BurstChannel channel_;
  line::ManchesterCode code_{{}};
  line::ManchesterReceiver receiver_;
  line::Waveform wave_;
  line::Waveforms arrivals_;
  std::vector<line::Symbol> sent_;
  std::vector<line::Symbol> heard_;
  std::uint64_t pulses_ = 0;
  std::uint64_t violations_ = 0;
  std::uint64_t data_flips_ = 0;
};

void expect_row(const std::string& what, double formula, double simulated) {
  fmt::print("| {} | {:.4g} | {:.4g} | {:+.1f} % |\n", what, formula, simulated,
             formula == 0 ? 0 : 100 * (simulated / formula - 1));
  EXPECT_NEAR(simulated, formula, 0.02 * formula) << what;
}

// Half of the half bits are high whatever the data are, so a forced low is as likely as with random bits:
// tau / (2 T_h) for each pulse. No bit can become the other one, for one of its halves is low already.
TEST(ManchesterClosedForms, AForcedLevelIsAlwaysACodeViolation) {
  for (const std::int64_t bit_rate : {31'250, 1'000'000, 2'500'000, 10'000'000}) {
    const Duration tau = half_bit(bit_rate) / 2;
    WrongOutput wrong;
    wrong.of_level[1] = {{Duration{}, tau}};
    const PerPulse outcome = ManchesterLine(bit_rate, wrong, 1).run(100'000);
    expect_row(fmt::format("wrong half bits of a pulse, forced low for T_h/2, {} bit/s", bit_rate), 0.25,
               outcome.wrong_halves);
    EXPECT_EQ(outcome.violations, outcome.wrong_halves);
    EXPECT_EQ(outcome.data_flips, 0);
  }
}

// tau / T_h half bits are wrong. Both of one bit lie within tau at (tau - T_h) / T_b of all phases; what is
// left over is seen.
TEST(ManchesterClosedForms, AnInvertingPulseFlipsDataOnlyWhereItCoversBothHalves) {
  for (const int quarters : {2, 3, 6, 12, 24}) {
    constexpr std::int64_t kBitRate = 1'000'000;
    const Duration tau = half_bit(kBitRate) * quarters / 4;
    const double in_halves = quarters / 4.0;
    const double flips = std::max(0.0, in_halves - 1) / 2;
    WrongOutput wrong;
    for (auto& of_level : wrong.of_level) of_level = {{Duration{}, tau}};
    const PerPulse outcome = ManchesterLine(kBitRate, wrong, 2).run(100'000);
    const std::string what = fmt::format("of a pulse, inverted for {} T_h, 1 Mbit/s", in_halves);
    expect_row("wrong half bits " + what, in_halves, outcome.wrong_halves);
    expect_row("code violations " + what, in_halves - 2 * flips, outcome.violations);
    expect_row("flipped data bits " + what, flips, outcome.data_flips);
  }
}

// Whole half bits: each pulse makes as many of them wrong, wherever it comes.
TEST(ManchesterClosedForms, AFastLineLosesSeveralHalfBitsToAPulse) {
  for (const auto& [bit_rate, halves] : {std::pair<std::int64_t, double>{5'000'000, 3}, {10'000'000, 6}}) {
    WrongOutput wrong;
    for (auto& of_level : wrong.of_level) of_level = {{Duration{}, 300 * kernel::kNanosecond}};
    const PerPulse outcome = ManchesterLine(bit_rate, wrong, 3).run(50'000);
    expect_row(fmt::format("wrong half bits of a pulse, inverted for 300 ns, {} bit/s", bit_rate), halves,
               outcome.wrong_halves);
    EXPECT_EQ(outcome.wrong_halves, halves);
  }
}

// The flipped half bits are those that the receiver hears wrongly in the wave itself.
RC_GTEST_PROP(ManchesterProperty, ShortCutsGiveWhatTheReceiverMakesOfTheWrongWave, ()) {
  const auto bit_rate = *rc::gen::element<std::int64_t>(31'250, 1'000'000, 2'500'000);
  const kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  WrongOutput wrong;
  for (auto& of_level : wrong.of_level) {
    const auto from = *rc::gen::inRange<std::int64_t>(0, half_bit(bit_rate).count());
    const auto length = *rc::gen::inRange<std::int64_t>(0, 3 * half_bit(bit_rate).count());
    of_level = {{Duration{from}, Duration{from + length}}};
  }
  BurstSettings settings;
  settings.repetition = Repetition::khz_100;
  const BurstSchedule schedule(settings, random);
  line::Waveform wave;
  wave.rate = 2 * bit_rate;
  wave.start = BurstSchedule(schedule).first_from(kStart + kernel::kSecond);
  kernel::Random draws = random.split("octets");
  for (int n = 0; n < 16; ++n) {
    line::ManchesterCode({}).append_octet(wave.levels, static_cast<std::uint8_t>(draws.below(256)));
  }
  trace::Trace trace;
  const auto heard_with = [&](bool has_short_cuts) {
    BurstChannel channel(schedule, wrong, receiver_of(bit_rate, has_short_cuts), trace,
                         trace.add_channel(has_short_cuts ? "quick" : "full"));
    line::Waveforms arrivals;
    if (!channel.pass(wave, arrivals)) arrivals.add(wave);
    std::vector<line::Symbol> symbols;
    line::ManchesterReceiver({}, bit_rate).receive(arrivals.front(), symbols);
    return symbols;
  };
  RC_ASSERT(heard_with(true) == heard_with(false));
}

}  // namespace
}  // namespace fieldproof::emc

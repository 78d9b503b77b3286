// Chapter skew: from an input to the output that the copy task drives from it (IM-24 to IM-26).
//
// Model: inputs are taken at the start of the frame of cycle k, copied after it, sent in cycle k + 1 and put
// out at the end of that frame: T_c + T_x later, T_x from the start of the frame to the latch. An edge waits
// for the next sample, evenly between 0 and T_c.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using judge::Standing;

constexpr unsigned kInputWord = 0;
constexpr unsigned kOutputWord = 1;
constexpr kernel::Duration kPaperCycle = 814 * kernel::kMicrosecond;

double ratio(kernel::Duration a, kernel::Duration b) {
  return static_cast<double>(a.count()) / static_cast<double>(b.count());
}

void bring_up_copying(MasterBench& bench, CaseJudge& judge) {
  bench.configuration().copy = {{kInputWord, kOutputWord}};
  bench.configuration().cycle_time = kPaperCycle;
  bench.bring_up(judge, paper_ring());
  bench.run_data_cycles(judge, 2);
}

kernel::Duration model_latency(MasterBench& bench) {
  const auto& seen = bench.ring().last_cycle();
  return kPaperCycle + (seen.end - seen.start);
}

void edge_delay(MasterBench& bench, CaseJudge& judge) {
  bring_up_copying(bench, judge);
  const auto edges = bench.volume<std::size_t>(60, 5000);
  // One edge in each of equal parts of the cycle, in random order: the extremes and the mean are exact.
  std::vector<std::int64_t> phases(edges);
  for (std::size_t n = 0; n < edges; ++n) {
    const auto part = kPaperCycle.count() / static_cast<std::int64_t>(edges);
    phases[n] = static_cast<std::int64_t>(n) * part + bench.random().between(0, part - 1);
  }
  bench.random().shuffle(phases);
  const kernel::Time base = bench.ring().last_cycle().start + 4 * kPaperCycle;
  std::vector<kernel::Time> at(edges);
  for (std::size_t n = 0; n < edges; ++n) {
    at[n] = base + static_cast<std::int64_t>(5 * n) * kPaperCycle + kernel::Duration{phases[n]};
  }
  std::size_t passed = 0;
  bench.ring().set_signal([&](unsigned word, kernel::Time when) -> std::uint16_t {
    if (word != kInputWord) return 0;
    while (passed < edges && at[passed] <= when) ++passed;
    return passed % 2 == 0 ? 0 : 1;
  });
  std::vector<kernel::Time> changes;
  std::uint16_t level = 0;
  bench.ring().on_outputs([&](std::span<const std::uint16_t> outputs, kernel::Time when) {
    if (outputs[kOutputWord] == std::exchange(level, outputs[kOutputWord])) return;
    changes.push_back(when);
  });
  const std::uint64_t cycles = 5 * edges + 10;
  bench.run_data_cycles(judge, cycles);
  judge.expect_equal(changes.size(), edges, "edges_lost", "changes of the output");
  kernel::Duration least = kernel::Duration::max();
  kernel::Duration most{};
  double mean = 0;
  for (std::size_t n = 0; n < edges; ++n) {
    const kernel::Duration delay = changes[n] - at[n];
    least = std::min(least, delay);
    most = std::max(most, delay);
    mean += ratio(delay, kPaperCycle) / static_cast<double>(edges);
  }
  const double latency = ratio(model_latency(bench), kPaperCycle);
  const auto expect_near = [&](std::string_view what, double value, double model) {
    judge.expect_between(fmt::format("{} delay of an edge", what), "T_c", value, model - 0.02, model + 0.02,
                         "delay_outside_model");
  };
  expect_near("least", ratio(least, kPaperCycle), latency);
  expect_near("mean", mean, latency + 0.5);
  expect_near("largest", ratio(most, kPaperCycle), latency + 1);
}

// A square wave at the input, from the next cycle on.
struct SquareWave {
  kernel::Time base;
  kernel::Duration period;

  bool is_high(kernel::Time when) const { return when >= base && (when - base) % period < period / 2; }
  std::int64_t pulse(kernel::Time when) const { return (when - base) / period; }
};

SquareWave apply_square_wave(MasterBench& bench, std::int64_t hertz) {
  const SquareWave wave{bench.ring().last_cycle().start + kPaperCycle +
                            kernel::Duration{bench.random().between(0, kPaperCycle.count() - 1)},
                        kernel::kSecond / hertz};
  bench.ring().set_signal([wave](unsigned word, kernel::Time when) -> std::uint16_t {
    return word == kInputWord && wave.is_high(when) ? 1 : 0;
  });
  return wave;
}

constexpr std::int64_t kSlowPhaseHertz = 200;

void expect_widths(RingScene& scene) {
  constexpr std::array<std::int64_t, 3> kHertz{50, 150, kSlowPhaseHertz};
  MasterBench& bench = scene.bench;
  CaseJudge& judge = scene.judge;
  const std::int64_t hertz = kHertz.at(scene.round);
  const auto pulses = bench.volume<std::uint64_t>(40, 400);
  bring_up_copying(bench, judge);
  const SquareWave wave = apply_square_wave(bench, hertz);
  const double units = ratio(wave.period / 2, kPaperCycle);
  const double least = std::floor(units);
  kernel::Time rise{};
  std::uint16_t level = 0;
  double sum = 0;
  double squares = 0;
  double count = 0;
  double strange = 0;  // a width outside of the set
  bench.ring().on_outputs([&](std::span<const std::uint16_t> outputs, kernel::Time when) {
    const std::uint16_t before = std::exchange(level, outputs[kOutputWord]);
    if (before == 0 && level != 0) rise = when;
    if (before == 0 || level != 0) return;
    const double width = ratio(when - rise, kPaperCycle);
    if (std::abs(width - least) > 0.02 && std::abs(width - least - 1) > 0.02) strange = width;
    sum += width;
    squares += width * width;
    ++count;
  });
  bench.run_data_cycles(judge, static_cast<std::uint64_t>(2 * units * static_cast<double>(pulses)) + 8);
  bench.ring().on_outputs(nullptr);  // this ring stays in the segment when the next one takes over
  judge.expect(strange == 0, "width_outside_set",
               fmt::format("pulses of {} or {} T_c at {} Hz", least, least + 1, hertz),
               fmt::format("a pulse of {:.3f} T_c", strange));
  judge.expect(count >= static_cast<double>(pulses) - 2, "pulses_lost", "every pulse", "fewer pulses");
  const double mean = sum / count;
  const double part = units - least;
  const double model = std::sqrt(part * (1 - part));
  const double slack = bench.volume(0.12, 0.03);
  // At 200 Hz seven periods are nearly 43 cycles: the phase needs 400 pulses to go once around.
  if (bench.volume(hertz != kSlowPhaseHertz, true)) {
    judge.expect_between(fmt::format("sd of the width at {} Hz", hertz), "T_c",
                         std::sqrt(std::max(0.0, squares / count - mean * mean)), model - slack,
                         model + slack, "width_spread_off");
  }
  judge.expect_between(fmt::format("mean width at {} Hz", hertz), "T_c", mean, units - slack, units + slack,
                       "width_outside_set");
}

void lost_pulses(MasterBench& bench, CaseJudge& judge) {
  bring_up_copying(bench, judge);
  const kernel::Duration latency = model_latency(bench);
  const SquareWave wave = apply_square_wave(bench, 700);
  const auto pulses = bench.volume<std::int64_t>(300, 5000);
  std::int64_t last = -1;
  std::int64_t seen = 0;
  bench.ring().on_outputs([&](std::span<const std::uint16_t> outputs, kernel::Time when) {
    // The instant at which the ring must have sampled what it now puts out.
    const kernel::Time sampled = when - latency;
    if (outputs[kOutputWord] == 0 || !wave.is_high(sampled)) return;
    const std::int64_t pulse = wave.pulse(sampled);
    if (pulse < pulses && pulse != std::exchange(last, pulse)) ++seen;
  });
  const double cycles = static_cast<double>(pulses) * ratio(wave.period, kPaperCycle);
  bench.run_data_cycles(judge, static_cast<std::uint64_t>(cycles) + 8);
  const double lost = 1 - static_cast<double>(seen) / static_cast<double>(pulses);
  const double model = 1 - ratio(wave.period / 2, kPaperCycle);
  judge.expect_between("share of lost pulses at 700 Hz", "", lost, model - 0.01, model + 0.01,
                       "pulse_loss_off");
}

}  // namespace

std::vector<MasterCase> master_skew_cases() {
  const auto skew_case = [](std::string_view id, std::string_view purpose, std::string_view requirement,
                            std::vector<MustCatch> catches, MasterChart chart) {
    const judge::Reference model{"Park 2004, section 3; computed",
                                 "inputs at the start, outputs at the end of a frame", Standing::calc};
    return master_case(id, purpose, requirement, model, {"timing", "long"}, std::move(catches),
                       std::move(chart));
  };
  return {
      skew_case(
          "skew/edge_delay_follows_the_model", "IM-24",
          "From an input edge to the copied output pass between one and two cycle times and the frame time",
          {{"copied_one_cycle_late", "delay_outside_model"}},
          {.steps = {step("edges spread over the cycle",
                          "least, mean and largest delay within 2 % of the cycle time of the model",
                          edge_delay)}}),
      skew_case(
          "skew/square_wave_widths_follow_the_model", "IM-25",
          "A copied pulse is a whole number of cycle times long, one of the two next to its length",
          {{"copies_every_second_cycle", "width_outside_set"}, {"pulse_widths_even", "width_spread_off"}},
          {.steps = {{"a square wave at 0.814 ms", "the two widths, mean and standard deviation of the model",
                      expect_widths}},
           .walk = each("each of 50, 150 and 200 Hz", 3)}),
      skew_case("skew/pulses_shorter_than_a_cycle_are_lost_by_the_model", "IM-26",
                "A pulse is lost when no sample falls into it",
                {{"copies_every_second_cycle", "pulse_loss_off"}},
                {.steps = {step("a square wave of 700 Hz at 0.814 ms",
                                "0.1225 of the pulses lost, within 0.01", lost_pulses)}})};
}

}  // namespace fieldproof::conformance

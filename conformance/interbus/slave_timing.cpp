#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "conformance/interbus/moved_edges.hpp"
#include "conformance/interbus/slave_scene.hpp"

// IS-23 to IS-25, IS-37 and IS-38: bit rate, jitter, gaps, delay and retiming.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

// Words whose bits alternate: a sample that slips by one bit always shows.
std::vector<std::uint16_t> alternating(const SlaveBench& bench, bool begin_with_one) {
  return std::vector<std::uint16_t>(bench.words(), begin_with_one ? 0xAAAA : 0x5555);
}

// Whether a waveform that carries a data cycle was accepted: outputs and status word.
bool is_accepted(SlaveBench& bench, line::Waveform wave, std::span<const std::uint16_t> words) {
  bench.drive_at_receiver(wave);
  const bool shows = !bench.pics().supports("outputs") || std::ranges::equal(bench.outputs(), words);
  bench.terminals().forget_changes();
  return left_clean(bench) && shows;
}

std::int64_t rate_with(const SlaveBench& bench, double percent) {
  return std::llround(static_cast<double>(bench.rules().bit_rate) * (1 + percent / 100));
}

constexpr unsigned kRounds = 3;  // at each rate, with other words, so that it is no chance

line::Waveform cycle_at_rate(SlaveBench& bench, double percent, std::span<const std::uint16_t> words) {
  return {bench.now(), rate_with(bench, percent), bench.direct_data_cycle(words, 2)};
}

bool accepts_rate(SlaveBench& bench, double percent) {
  unsigned accepted = 0;
  for (unsigned round = 0; round < kRounds; ++round) {
    const std::vector<std::uint16_t> words = alternating(bench, round % 2 == 0);
    if (is_accepted(bench, cycle_at_rate(bench, percent, words), words)) ++accepted;
  }
  return accepted == kRounds;
}

void accept_rates_within_limit(SlaveScene& scene) {
  scene.bench.require_line_interface();
  for (const double percent : {0.1, -0.1, 1.0, -1.0}) {
    scene.judge.expect(accepts_rate(scene.bench, percent), "rate_within_limit_rejected",
                       fmt::format("cycles at {:+.1f} % of the bit rate are accepted", percent),
                       "one was rejected");
  }
}

// None of the cycles has an effect: whatever the slave reads, its check does not fit.
void reject_rates_beyond_limit(SlaveScene& scene) {
  for (unsigned n = 0; n < 2 * kRounds; ++n) {
    const double percent = n < kRounds ? 6.0 : -6.0;
    const std::vector<std::uint16_t> words = alternating(scene.bench, n % 2 == 0);
    line::Waveform wave = cycle_at_rate(scene.bench, percent, words);
    scene.bench.drive_at_receiver(wave);
    scene.judge.expect(!left_clean(scene.bench), "rate_beyond_limit_accepted",
                       fmt::format("cycles at {:+.1f} % of the bit rate are rejected", percent),
                       "one left with a clean status word");
    expect_no_change(scene.bench, scene.judge, "output_changed_by_rejected_cycle",
                     fmt::format("the cycle came at {:+.1f} % of the bit rate", percent));
  }
}

// Between the limits nothing is required; what the receiver stands is recorded.
void measure_accepted_rates(SlaveScene& scene) {
  for (const double sign : {1.0, -1.0}) {
    double most = 1;
    while (most < 5.5 && accepts_rate(scene.bench, sign * (most + 0.5))) most += 0.5;
    scene.judge.measure(sign > 0 ? "accepted above the bit rate" : "accepted below the bit rate", "%", most);
  }
}

// ---- edges ----

void accept_jitter(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  bench.require_line_interface();
  const std::vector<std::uint16_t> words =
      scene.round % 2 == 0 ? alternating(bench, scene.round % 4 == 0) : bench.random_words();
  const line::Levels levels = with_moved_edges(bench.direct_data_cycle(words, 2), [&](bool) {
    // At the limits more often than between them.
    return std::clamp<std::int64_t>(bench.random().between(-5, 5), -3, 3);
  });
  scene.judge.expect(is_accepted(bench, {bench.now(), bench.rules().bit_rate * kEdgesPerBit, levels}, words),
                     "jitter_rejected", [&] {
                       return Mismatch{
                           .expected = {"a cycle whose edges lie within 15 % of a bit is accepted"},
                           .actual = "it was rejected",
                           .first_difference = fmt::format("jittered cycle {}", scene.round)};
                     });
}

void cycle_with_gaps(SlaveScene& scene) {
  constexpr std::array kGaps{0U, 1U, 2U, 13U, 100U};
  const unsigned gap = kGaps.at(scene.round % kGaps.size());
  scene.bench.train().set_gap(gap);
  data_cycle().run(scene);
  const std::size_t left = scene.bench.out().data_telegrams().size();
  const std::size_t arrived = scene.bench.in().data_telegrams().size();
  scene.judge.expect(left == arrived, "gap_rejected", fmt::format("all telegrams pass, {} bits apart", gap),
                     fmt::format("{} of {} passed", left, arrived));
}

// ---- delay ----

void delay_is_constant(SlaveBench& bench, CaseJudge& judge) {
  kernel::Duration least = kernel::Duration::max();
  kernel::Duration most{};
  for (unsigned n = 0; n < bench.volume(40U, 1'000U); ++n) {
    bench.silence(kernel::Duration{static_cast<std::int64_t>(bench.random().below(9'000'000))});
    bench.begin();
    bench.train().status(1 + n % 3);
    bench.append_data_cycle(bench.random_words());
    bench.send();
    const auto in = bench.in().telegrams();
    const auto out = bench.out().telegrams();
    judge.expect_equal(out.size(), in.size(), out.size() < in.size() ? "telegram_lost" : "telegram_added",
                       "telegrams that left");
    for (std::size_t k = 0; k < in.size(); ++k) {
      const kernel::Duration delay = bench.out().start_of(out[k]) - bench.in().start_of(in[k]);
      least = std::min(least, delay);
      most = std::max(most, delay);
    }
  }
  const auto in_bits = [&](kernel::Duration duration) {
    return static_cast<double>(duration.count()) / static_cast<double>(bench.bits(1).count());
  };
  judge.expect_between("spread of the delay", "bit", in_bits(most - least), 0, 1e-3, "delay_not_constant");
  // Three, and a quarter that each delay may be off.
  judge.expect_between("delay from receiver to return line", "bit", in_bits(most), 0, 3.25,
                       "delay_above_limit");
}

void pulses_are_retimed(SlaveBench& bench, CaseJudge& judge) {
  bench.require_line_interface();
  double worst = 0;
  for (unsigned n = 0; n < bench.volume(8U, 100U); ++n) {
    // Low pulses 15 % of a bit longer, or shorter: rising edges late, or early.
    const std::int64_t shift = n % 2 == 0 ? 3 : -3;
    const std::vector<std::uint16_t> words = bench.random_words();
    const line::Levels levels =
        with_moved_edges(bench.direct_data_cycle(words, 2), [&](bool falls) { return falls ? 0 : shift; });
    judge.expect(is_accepted(bench, {bench.now(), bench.rules().bit_rate * kEdgesPerBit, levels}, words),
                 "pulse_width_rejected", "a cycle with pulses 15 % of a bit longer or shorter is accepted",
                 "it was rejected");
    worst = std::max(worst, worst_edge(bench));
  }
  judge.expect_between("distance of driven edges from the bit grid", "% of a bit", 100 * worst, 0, 3,
                       "output_not_retimed");
}

std::vector<SlaveCase> charted_timing_cases() {
  return {
      slave_case("timing/bit_rate_within_one_percent_is_accepted", "IS-23",
                 "A receiver that starts its clock at the edge of each start bit reads telegrams whose bit "
                 "rate differs by up to 1 % from its own. At 6 % the thirteenth bit is sampled in its "
                 "neighbour: such cycles must not pass.",
                 sources::own("limits of 1 % and 6 %; the geometry of thirteen bits is computed"),
                 {{"clock_too_fast", "rate_within_limit_rejected"},
                  {"follows_any_rate", "rate_beyond_limit_accepted"},
                  {"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"}},
                 {.steps = {identified(),
                            good_cycle(),
                            {"data cycles with alternating bits at +-0.1 and +-1 % of the bit rate",
                             "every one is accepted", accept_rates_within_limit},
                            {"such cycles at +-6 %", "no output changes, no status word leaves clean",
                             reject_rates_beyond_limit},
                            {"such cycles in steps of 0.5 % between", "how far it reads is recorded",
                             measure_accepted_rates},
                            status_telegrams(2),
                            good_cycle("no_recovery")}},
                 {.details = {details::status_coding()}, .tags = {"timing"}, .only_for = for_outputs()}),
      slave_case("timing/edge_jitter_is_accepted", "IS-24",
                 "Edges that lie within 15 % of a bit of their place are read as if they were at it.",
                 sources::own("15 % of a bit"), {{"clock_too_fast", "jitter_rejected"}},
                 {{40, 400},
                  {{"a data cycle, each edge moved at random by up to 15 % of a bit to either side",
                    "it is accepted and its words are at the outputs", accept_jitter}},
                  {identified()}},
                 {.tags = {"timing"}}),
      slave_case(
          "timing/gaps_between_telegrams_are_accepted", "IS-25",
          "The idle time between the telegrams of a cycle is the master's affair: none, a few bits or many.",
          sources::derived("the factor 1.15 of the cycle time"),
          {{"needs_idle_between_telegrams", "gap_rejected"}},
          {{10, 250},
           {{"a valid data cycle with 0, 1, 2, 13 or 100 bits of idle line between telegrams",
             "all telegrams pass", cycle_with_gaps},
            answered(),
            shown("gap_rejected")},
           {identified()}},
          {.details = details::answer()})};
}

}  // namespace

std::vector<SlaveCase> slave_timing_cases() {
  return joined(
      {charted_timing_cases(),
       {slave_case(
            "timing/delay_is_constant_and_at_most_three_bits", "IS-37",
            "A telegram leaves the last slave of the ring a constant time after it began to arrive, at most "
            "three bits: the cycle-time formula counts 3 bits for a station, both ways.",
            sources::park("section 2.2: the term 3 m of the cycle time"),
            {{"delays_four_bits", "delay_above_limit"}, {"delay_varies", "delay_not_constant"}},
            {.steps =
                 {identified(),
                  step(
                      "status telegrams and data cycles at random instants",
                      "every telegram leaves after the same delay, at most three bits; the delay is recorded",
                      delay_is_constant)}},
            {.tags = {"timing"}}),
        slave_case("timing/pulses_leave_retimed", "IS-38",
                   "A slave regenerates: what arrives with pulses 15 % of a bit too long or too short leaves "
                   "with edges within 3 % of a bit of their place.",
                   sources::own("15 % and 3 % of a bit"), {{"does_not_retime", "output_not_retimed"}},
                   {.steps = {identified(), step("data cycles whose low pulses are all 15 % of a bit longer, "
                                                 "then shorter, at the slave's receiver",
                                                 "the cycles are accepted, and every edge that leaves lies "
                                                 "within 3 % of a bit of the grid of its telegram",
                                                 pulses_are_retimed)}},
                   {.tags = {"timing"}})}});
}

}  // namespace fieldproof::conformance

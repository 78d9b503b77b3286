#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// IS-23 to IS-25, IS-37 and IS-38: bit rate, jitter, gaps, delay and retiming.
namespace fieldproof::conformance {
namespace {

// Words whose bits alternate: a sample that slips by one bit always shows.
std::vector<std::uint16_t> alternating(const SlaveBench& bench, bool begin_with_one) {
  return std::vector<std::uint16_t>(bench.words(), begin_with_one ? 0xAAAA : 0x5555);
}

// Whether a data cycle left with a clean status word.
bool left_clean(SlaveBench& bench) {
  FoundCycle cycle;
  find_last_cycle(bench.out().data_telegrams(), cycle);
  return cycle.is_found && cycle.status == bench.rules().status_clean;
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

// None of the cycles has an effect: whatever the slave reads, its check does not fit.
void expect_rate_rejected(SlaveBench& bench, CaseJudge& judge, double percent) {
  for (unsigned round = 0; round < kRounds; ++round) {
    const std::vector<std::uint16_t> words = alternating(bench, round % 2 == 0);
    line::Waveform wave = cycle_at_rate(bench, percent, words);
    bench.drive_at_receiver(wave);
    judge.expect(!left_clean(bench), "rate_beyond_limit_accepted", [&] {
      return Mismatch{.expected = {fmt::format("cycles at {:+.1f} % of the bit rate are rejected", percent)},
                      .actual = "one left with a clean status word"};
    });
    expect_no_change(bench, judge, "output_changed_by_rejected_cycle",
                     fmt::format("the cycle came at {:+.1f} % of the bit rate", percent));
  }
}

void bit_rate_tolerance(SlaveBench& bench, CaseJudge& judge) {
  bench.require_line_interface();
  bench.bring_up();
  expect_good_cycle(bench, judge, "valid_cycle_rejected");
  for (const double percent : {0.1, -0.1, 1.0, -1.0}) {
    judge.expect(accepts_rate(bench, percent), "rate_within_limit_rejected", [&] {
      return Mismatch{.expected = {fmt::format("cycles at {:+.1f} % of the bit rate are accepted", percent)},
                      .actual = "one was rejected"};
    });
  }
  for (const double percent : {6.0, -6.0}) expect_rate_rejected(bench, judge, percent);
  // Between the limits nothing is required; what the receiver stands is told.
  for (const double sign : {1.0, -1.0}) {
    double most = 1;
    while (most < 5.5 && accepts_rate(bench, sign * (most + 0.5))) most += 0.5;
    judge.measure(sign > 0 ? "accepted above the bit rate" : "accepted below the bit rate", "%", most);
  }
  bench.status_telegrams(2);
  expect_good_cycle(bench, judge, "no_recovery");
}

// ---- edges ----

constexpr std::int64_t kPerBit = 20;

// Writes levels at twenty per bit, each edge moved by `shift(is_falling)` twentieths; no edge overtakes one.
template <typename Shift>
line::Levels with_moved_edges(const line::Levels& levels, Shift&& shift) {
  line::Levels moved;
  moved.append_idle(kPerBit);
  bool level = true;
  for (std::size_t n = 0; n <= levels.size(); ++n) {
    if (levels[n] == level) continue;
    const auto edge = static_cast<std::int64_t>((n + 1) * kPerBit) + shift(level);
    moved.append_fill(level, static_cast<std::size_t>(edge) - moved.size());
    level = !level;
  }
  moved.append_idle(4 * kPerBit);
  return moved;
}

void edge_jitter(SlaveBench& bench, CaseJudge& judge) {
  bench.require_line_interface();
  bench.bring_up();
  for (unsigned n = 0; n < bench.volume(40U, 400U); ++n) {
    const std::vector<std::uint16_t> words =
        n % 2 == 0 ? alternating(bench, n % 4 == 0) : bench.random_words();
    const line::Levels levels = with_moved_edges(bench.direct_data_cycle(words, 2), [&](bool) {
      // At the limits more often than between them.
      const std::int64_t drawn = bench.random().between(-5, 5);
      return std::clamp<std::int64_t>(drawn, -3, 3);
    });
    judge.expect(is_accepted(bench, {bench.now(), bench.rules().bit_rate * kPerBit, levels}, words),
                 "jitter_rejected", [&] {
                   return Mismatch{.expected = {"a cycle whose edges lie within 15 % of a bit is accepted"},
                                   .actual = "it was rejected",
                                   .first_difference = fmt::format("jittered cycle {}", n)};
                 });
  }
}

void gaps_between_telegrams(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  for (unsigned round = 0; round < bench.volume(2U, 50U); ++round) {
    for (const unsigned gap : {0U, 1U, 2U, 13U, 100U}) {
      const std::vector<std::uint16_t> words = bench.random_words();
      bench.set_inputs(bench.random_words());
      bench.train().set_gap(gap);
      bench.data_cycle(words);
      judge.expect(
          bench.out().data_telegrams().size() == bench.in().data_telegrams().size(), "gap_rejected", [&] {
            return Mismatch{.expected = {fmt::format("all telegrams pass, {} bits apart", gap)},
                            .actual = fmt::format("{} of {} passed", bench.out().data_telegrams().size(),
                                                  bench.in().data_telegrams().size())};
          });
      expect_answer(bench, judge, 0, bench.data_load());
      expect_outputs(bench, judge, words, "gap_rejected");
    }
  }
  bench.train().set_gap(2);
}

// ---- delay ----

void delay_is_constant(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
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
  judge.expect_between("delay from receiver to return line", "bit", in_bits(most), 0, 3, "delay_above_limit");
}

// The largest distance of an edge that left from the grid of its telegram, in bits.
double worst_edge(SlaveBench& bench) {
  const auto telegrams = bench.out().telegrams();
  const auto bit = static_cast<double>(bench.bits(1).count());
  double worst = 0;
  std::size_t next = 0;
  for (const line::Waveform& wave : bench.out().waves()) {
    bool level = true;
    for (std::size_t n = 0; n <= wave.levels.size(); ++n) {
      if (wave.levels[n] == level) continue;
      level = !level;
      const kernel::Time edge = wave.time_of(n);
      while (next + 1 < telegrams.size() && bench.out().start_of(telegrams[next + 1]) <= edge) ++next;
      if (next >= telegrams.size()) return worst;
      const double at = static_cast<double>((edge - bench.out().start_of(telegrams[next])).count()) / bit;
      worst = std::max(worst, std::abs(at - std::round(at)));
    }
  }
  return worst;
}

void pulses_are_retimed(SlaveBench& bench, CaseJudge& judge) {
  bench.require_line_interface();
  bench.bring_up();
  double worst = 0;
  for (unsigned n = 0; n < bench.volume(8U, 100U); ++n) {
    // Low pulses 15 % of a bit longer, or shorter: rising edges late, or early.
    const std::int64_t shift = n % 2 == 0 ? 3 : -3;
    const std::vector<std::uint16_t> words = bench.random_words();
    const line::Levels levels =
        with_moved_edges(bench.direct_data_cycle(words, 2), [&](bool falls) { return falls ? 0 : shift; });
    judge.expect(is_accepted(bench, {bench.now(), bench.rules().bit_rate * kPerBit, levels}, words),
                 "pulse_width_rejected", "a cycle with pulses 15 % of a bit longer or shorter is accepted",
                 "it was rejected");
    worst = std::max(worst, worst_edge(bench));
  }
  judge.expect_between("distance of driven edges from the bit grid", "% of a bit", 100 * worst, 0, 3,
                       "output_not_retimed");
}

}  // namespace

std::vector<SlaveCase> slave_timing_cases() {
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/timing/bit_rate_within_one_percent_is_accepted",
        .purpose = "IS-23",
        .requirement =
            "A receiver that starts its clock at the edge of each start bit reads telegrams whose bit "
            "rate differs by up to 1 % from its own. At 6 % the thirteenth bit is sampled in its "
            "neighbour: such cycles must not pass.",
        .reference = sources::own("limits of 1 % and 6 %; the geometry of thirteen bits is computed"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles with alternating bits at +-0.1, +-1 and +-6 % of the bit rate; then in steps of "
            "0.5 % between.",
        .expected = "Up to 1 % every cycle accepted; at 6 % none: no output changes, no status word leaves "
                    "clean; how far "
                    "it reads is recorded.",
        .tags = {"must", "timing"},
        .catches = {{"clock_too_fast", "rate_within_limit_rejected"},
                    {"follows_any_rate", "rate_beyond_limit_accepted"},
                    {"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"}},
        .not_applicable = for_outputs()},
       bit_rate_tolerance});
  cases.push_back(
      {{.id = "interbus/slave/timing/edge_jitter_is_accepted",
        .purpose = "IS-24",
        .requirement = "Edges that lie within 15 % of a bit of their place are read as if they were at it.",
        .reference = sources::own("15 % of a bit"),
        .stimulus = "Data cycles, each edge moved at random by up to 15 % of a bit to either side.",
        .expected = "Every cycle is accepted and its words are at the outputs.",
        .tags = {"must", "timing"},
        .catches = {{"clock_too_fast", "jitter_rejected"}}},
       edge_jitter});
  cases.push_back(
      {{.id = "interbus/slave/timing/gaps_between_telegrams_are_accepted",
        .purpose = "IS-25",
        .requirement =
            "The idle time between the telegrams of a cycle is the master's affair: none, a few bits "
            "or many.",
        .reference = sources::derived("the factor 1.15 of the cycle time"),
        .details = details::answer(),
        .stimulus = "Valid data cycles with 0, 1, 2, 13 and 100 bits of idle line between telegrams.",
        .expected = "Every cycle is answered and taken over.",
        .tags = {"must"},
        .catches = {{"needs_idle_between_telegrams", "gap_rejected"}}},
       gaps_between_telegrams});
  cases.push_back(
      {{.id = "interbus/slave/timing/delay_is_constant_and_at_most_three_bits",
        .purpose = "IS-37",
        .requirement =
            "A telegram leaves the last slave of the ring a constant time after it began to arrive, at "
            "most three bits: the cycle-time formula counts 3 bits for a station, both ways.",
        .reference = sources::park("section 2.2: the term 3 m of the cycle time"),
        .stimulus = "Status telegrams and data cycles at random instants.",
        .expected = "Every telegram leaves after the same delay, at most three bits; the delay is recorded.",
        .tags = {"must", "timing"},
        .catches = {{"delays_four_bits", "delay_above_limit"}, {"delay_varies", "delay_not_constant"}}},
       delay_is_constant});
  cases.push_back(
      {{.id = "interbus/slave/timing/pulses_leave_retimed",
        .purpose = "IS-38",
        .requirement =
            "A slave regenerates: what arrives with pulses 15 % of a bit too long or too short leaves "
            "with edges within 3 % of a bit of their place.",
        .reference = sources::own("15 % and 3 % of a bit"),
        .stimulus = "Data cycles whose low pulses are all 15 % of a bit longer, then shorter, at the slave's "
                    "receiver.",
        .expected =
            "The cycles are accepted, and every edge that leaves lies within 3 % of a bit of the grid "
            "of its telegram.",
        .tags = {"must", "timing"},
        .catches = {{"does_not_retime", "output_not_retimed"}}},
       pulses_are_retimed});
  return cases;
}

}  // namespace fieldproof::conformance

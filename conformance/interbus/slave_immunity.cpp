#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/slave_arrivals.hpp"
#include "conformance/interbus/slave_scene.hpp"
#include "harness/kernel/check.hpp"

// IS-40 and IS-42: outputs while cycles are rejected, under random faults, and under stresses of the line.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

void expect_outputs_held(SlaveScene& scene) {
  const std::vector<std::uint16_t>& words = scene.words;
  expect_outputs(scene.bench, scene.judge, words, "output_changed_by_rejected_cycle");
  // A change that was taken back is a glitch; one of up to a microsecond is not seen by anything connected.
  const auto& changes = scene.bench.changes();
  for (std::size_t n = 0; n < changes.size(); ++n) {
    const auto back = std::find_if(
        changes.begin() + static_cast<std::ptrdiff_t>(n) + 1, changes.end(),
        [&](const auto& later) { return later.word == changes[n].word && later.after == changes[n].before; });
    const bool is_short = back != changes.end() && back->when - changes[n].when <= 1 * kernel::kMicrosecond;
    if (is_short || changes[n].before != words[changes[n].word]) continue;
    scene.judge.fail(
        "output_glitch",
        {.expected = {"outputs hold their value; a mutant of up to 1 us is not counted"},
         .actual = back == changes.end()
                       ? fmt::format("word {} went to {:04X}h", changes[n].word, changes[n].after)
                       : fmt::format("word {} was {:04X}h for {}", changes[n].word, changes[n].after,
                                     kernel::describe(back->when - changes[n].when)),
         .time = changes[n].when});
  }
}

// ---- random faults ----

// Draws flips at the slave's receiver over the next train.
unsigned flip_at_random(SlaveBench& bench, const kernel::GeometricSkip& skip) {
  const std::size_t levels = bench.train().levels().size();
  unsigned flips = 0;
  bench.channel().on_next();
  for (std::uint64_t at = skip(bench.random()); at < levels; at += 1 + skip(bench.random())) {
    bench.channel().flip(at);
    ++flips;
  }
  return flips;
}

// Cycles of one strength of faults that were not taken over.
struct Rejects {
  unsigned by_model = 0;  // by what arrived
  unsigned by_slave = 0;
};

// Outputs may show the words that arrived, when these are a cycle with a right check and a clean status word;
// else they stay.
void check_outputs_under_faults(SlaveBench& bench, CaseJudge& judge, SlaveArrivals& arrivals,
                                Rejects& rejects, std::span<const std::uint16_t> before) {
  const bool may_change = arrivals.take();
  if (!may_change) ++rejects.by_model;
  if (!may_change || !std::ranges::equal(bench.outputs(), arrivals.words())) ++rejects.by_slave;
  if (bench.changes().empty()) return;
  const std::vector<std::uint16_t> allowed =
      may_change ? arrivals.words() : std::vector<std::uint16_t>(before.begin(), before.end());
  judge.expect(std::ranges::equal(bench.outputs(), allowed), "wrong_value_latched", [&] {
    return Mismatch{.expected = {fmt::format("outputs {}: {}", text_of(allowed),
                                             may_change ? "the words that arrived with a right check"
                                                        : "what arrived has no right check")},
                    .actual = fmt::format("outputs {}", text_of(bench.outputs()))};
  });
}

// The faults end; gives how many clean cycles were lost until one was taken over.
unsigned recover(SlaveBench& bench, CaseJudge& judge, SlaveArrivals& arrivals) {
  unsigned lost = 0;
  for (; lost < bench.rules().published_recovery_cycles; ++lost) {
    const std::vector<std::uint16_t> words = bench.random_words();
    bench.data_cycle(words);
    arrivals.take();
    if (std::ranges::equal(bench.outputs(), words)) break;
  }
  judge.expect(lost < bench.rules().published_recovery_cycles, "no_recovery", [&] {
    return Mismatch{.expected = {fmt::format("one of {} clean cycles after the faults is taken over",
                                             bench.rules().published_recovery_cycles)},
                    .actual = "none was"};
  });
  bench.id_cycle(bench.interfaces_off());
  arrivals.take();
  expect_good_cycle(bench, judge, "no_recovery");
  arrivals.take();
  return lost;
}

// Faults of one strength, with pauses; counts what was struck and the clean cycles that the longest recovery
// cost.
struct Faults {
  unsigned struck = 0;
  unsigned longest_recovery = 0;
};

void faults_of_chance(SlaveBench& bench, CaseJudge& judge, SlaveArrivals& arrivals, double chance,
                      Faults& faults) {
  const kernel::GeometricSkip skip(chance);
  Rejects rejects;
  for (unsigned round = 0; round < bench.volume(100U, 4'000U); ++round) {
    const std::vector<std::uint16_t> before = bench.outputs();
    bench.terminals().forget_changes();
    bench.begin();
    bench.train().status(2);
    bench.append_data_cycle(bench.random_words());
    bench.train().status(2);
    if (flip_at_random(bench, skip) > 0) ++faults.struck;
    bench.send();
    check_outputs_under_faults(bench, judge, arrivals, rejects, before);
    if (round % 16 == 15)
      faults.longest_recovery = std::max(faults.longest_recovery, recover(bench, judge, arrivals));
  }
  // Whether a telegram without its stop bit begins a transfer is a slave's own affair: it costs the next
  // cycle or not.
  constexpr double kMargin = 0.2;
  constexpr double kLeastMargin = 2;
  const double margin = std::max(kMargin * rejects.by_model, kLeastMargin);
  judge.expect_between(fmt::format("cycles rejected at flips of {} %", 100 * chance), "", rejects.by_slave,
                       rejects.by_model - margin, rejects.by_model + margin,
                       "rejects_other_than_what_arrived_broken");
}

// ---- stresses ----

// A cycle at whose end the outputs are as before, or what was sent, or what arrived with a right check: a
// receiver that samples at other instants than the tester's own may have got it right.
void stressed_cycle(SlaveBench& bench, CaseJudge& judge, SlaveArrivals& arrivals) {
  const std::vector<std::uint16_t> before = bench.outputs();
  const std::vector<std::uint16_t> sent = bench.random_words();
  bench.terminals().forget_changes();
  bench.begin();
  bench.train().status(2);
  bench.append_data_cycle(sent);
  bench.train().status(2);
  bench.send();
  const bool has_arrived = arrivals.take();
  const std::vector<std::uint16_t>& after = bench.outputs();
  const bool is_right = std::ranges::equal(after, before) || std::ranges::equal(after, sent) ||
                        (has_arrived && std::ranges::equal(after, arrivals.words()));
  judge.expect(is_right, "wrong_value_latched", [&] {
    return Mismatch{.expected = {fmt::format("outputs {}: those before the cycle", text_of(before)),
                                 fmt::format("outputs {}: those of the cycle", text_of(sent))},
                    .actual = fmt::format("outputs {}", text_of(after))};
  });
}

void stresses(SlaveBench& bench, CaseJudge& judge) {
  FIELDPROOF_CHECK(!bench.stresses().empty(), "a case under stresses has some");
  SlaveArrivals arrivals(bench);
  unsigned longest_recovery = 0;
  for (const fault::Stress& stress : bench.stresses()) {
    for (unsigned burst = 0; burst < bench.volume(1U, 12U); ++burst) {
      bench.begin_stress(stress);
      const kernel::Time end = bench.now() + stress.duration;
      while (bench.now() < end) stressed_cycle(bench, judge, arrivals);
      bench.end_stress();
      longest_recovery = std::max(longest_recovery, recover(bench, judge, arrivals));
    }
  }
  judge.measure("transmissions struck by a pulse", "", static_cast<double>(bench.stressed_transmissions()));
  judge.measure("clean cycles lost after a burst", "", longest_recovery);
}

void random_faults(SlaveBench& bench, CaseJudge& judge) {
  SlaveArrivals arrivals(bench);
  Faults faults;
  for (const double chance : {0.001, 0.01, 0.05}) faults_of_chance(bench, judge, arrivals, chance, faults);
  judge.measure("cycles struck by a flip", "", faults.struck);
  judge.measure("clean cycles lost after the faults", "", faults.longest_recovery);
}

SlaveCase held_case() {
  const SlaveStep set_words =
      stimulus<SlaveScene>("a valid data cycle without an octet of 0", [](SlaveScene& scene) {
        scene.words = scene.bench.random_words();
        for (std::uint16_t& word : scene.words) word |= 0x0101;
        scene.bench.data_cycle(scene.words);
      });
  return slave_case(
      "immunity/rejected_cycle_leaves_outputs_alone", "IS-40",
      "While a cycle is rejected, the outputs hold the words of the last valid one, without a glitch longer "
      "than 1 us.",
      sources::from_memory("the previous data stay valid when a cycle is rejected"),
      {{"clears_outputs_on_rejected_cycle", "output_changed_by_rejected_cycle"},
       {"glitches_outputs_on_rejected_cycle", "output_glitch"}},
      {.rounds = {10, 500},
       .steps = {set_words, shown(), flipped_bit(),
                 expected<SlaveScene>("no output leaves its value for more than 1 us", expect_outputs_held),
                 good_cycle("no_recovery")},
       .first = {identified()}},
      {.details = {details::status_coding()}, .only_for = for_outputs()});
}

}  // namespace

std::vector<SlaveCase> slave_immunity_cases() {
  const judge::Reference recovery{"Beckhoff BC4000 documentation",
                                  "five cycle times until valid data are exchanged again",
                                  judge::Standing::searched};
  return {
      held_case(),
      slave_case(
          "immunity/random_faults_latch_no_wrong_value", "IS-42",
          "Whatever strikes the slave's receiver, outputs change only by a cycle whose check fits, and after "
          "the faults clean cycles are accepted again within the published five. Judged here under "
          "independent random flips, by the next case under bursts.",
          recovery,
          {{"latches_in_spite_of_own_error", "wrong_value_latched"},
           {"locks_up_after_rejected_cycle", "no_recovery"},
           {"waits_for_id_cycle_after_rejected_cycle", "no_recovery"},
           {"loses_the_cycle_behind_a_rejected_one", "rejects_other_than_what_arrived_broken"}},
          {.steps = {identified(),
                     step("data cycles between status telegrams, each level flipped with a chance of 0.1, 1 "
                          "and 5 % at the slave's receiver; every 16 cycles the faults pause",
                          "after each cycle the outputs show the words before it, or the words that arrived "
                          "when these have a right check, and as many cycles are rejected as arrive broken, "
                          "within 20 % or two cycles; in the pauses one of five clean cycles is taken over",
                          random_faults)}},
          {.details = {details::status_coding(),
                       {sources::own("within 20 % of what the tester's own receiver rejects, or two cycles"),
                        {"rejects_other_than_what_arrived_broken"}}},
           .tags = {"long"},
           .only_for = for_outputs()}),
      slave_case(
          "immunity/bursts_latch_no_wrong_value", "IS-42",
          "Under bursts at the slave's receiver, outputs change only by a cycle whose check fits, and after "
          "each burst clean cycles are accepted again within the published five.",
          recovery,
          {{"latches_in_spite_of_own_error", "wrong_value_latched"},
           {"locks_up_after_rejected_cycle", "no_recovery"},
           {"waits_for_id_cycle_after_rejected_cycle", "no_recovery"}},
          {.steps = {identified(),
                     step("data cycles between status telegrams, while single bursts of IEC 61000-4-4 couple "
                          "into the slave's incoming line: levels 4 and 3, 5 and 100 kHz, both polarities",
                          "after each cycle the outputs show the words before it, or those of the cycle; "
                          "after each burst one of five clean cycles is taken over",
                          stresses)}},
          {.details = {details::status_coding(),
                       {sources::own(
                            "what a level of IEC 61000-4-4 does at a receiver is an uncalibrated model"),
                        {"wrong_value_latched"}}},
           .tags = {std::string(kStressTag)},
           .only_for = for_outputs()})};
}

}  // namespace fieldproof::conformance

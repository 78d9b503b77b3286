#include "conformance/interbus/slave_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

// IS-05 to IS-08 and IS-39: what a valid data cycle does.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

void outputs_change_after_the_check(SlaveBench& bench, CaseJudge& judge) {
  kernel::Duration latest{};
  for (unsigned n = 0; n < bench.volume(20U, 200U); ++n) {
    const std::vector<std::uint16_t> words = bench.random_words();
    bench.data_cycle(words);
    if (!bench.changes().empty() && !bench.in().data_telegrams().empty()) {
      latest = std::max(latest,
                        bench.changes().back().when - bench.in().end_of(bench.in().data_telegrams().back()));
    }
    expect_latched_in_order(bench, judge, words);
  }
  judge.measure("latest output change after the last check telegram", "us",
                static_cast<double>(latest.count()) / 1e6);
}

// Inputs that jump between 0000h and FFFFh at instants that have nothing to do with the cycle.
std::uint16_t jumping(kernel::Time when, std::uint64_t seed) {
  constexpr std::int64_t kPiece = 7'300'000;  // ps
  std::uint64_t mixed = static_cast<std::uint64_t>(when.time_since_epoch().count() / kPiece) + seed;
  mixed = (mixed ^ mixed >> 31) * 0x9E3779B97F4A7C15U;
  return (mixed >> 40 & 1U) != 0 ? 0xFFFF : 0x0000;
}

// A clock at the terminals: tells when it was looked at, in microseconds.
std::uint16_t clock_word(kernel::Time when, std::uint64_t = 0) {
  return static_cast<std::uint16_t>(when.time_since_epoch().count() / 1'000'000 & 0xFFFF);
}

void set_signals(SlaveBench& bench, std::uint16_t (*signal)(kernel::Time, std::uint64_t),
                 std::uint64_t seed) {
  for (unsigned word = 0; word < bench.words(); ++word)
    bench.terminals().set_signal(word, [=](kernel::Time when) { return signal(when, seed); });
}

void check_snapshots(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  CaseJudge& judge = scene.judge;
  set_signals(bench, jumping, bench.random().next());
  constexpr unsigned kTrain = 32;
  const std::vector<std::uint16_t> nothing(bench.words());
  const unsigned cycles = bench.volume(800U, 100'000U);
  for (unsigned done = 0; done < cycles; done += kTrain) {
    bench.begin();
    for (unsigned n = 0; n < kTrain; ++n) bench.append_data_cycle(nothing);
    bench.send();
    expect_all_telegrams(bench, judge);
    for (unsigned n = 0; n < kTrain; ++n) {
      const CycleOnLine out = cycle_that_left(bench, judge, n);
      for (unsigned word = 0; word < bench.words(); ++word) {
        const std::uint16_t seen = out.word(2 * word);
        judge.expect(seen == 0x0000 || seen == 0xFFFF, "input_word_torn", [&] {
          return Mismatch{.expected = {"0000h", "FFFFh"},
                          .actual = fmt::format("{:04X}h", seen),
                          .time = bench.out().start_of(out.telegrams[2 * word]),
                          .first_difference = fmt::format("input word {}", word)};
        });
      }
    }
  }
}

// The earliest and the latest of sample instants after the start of their cycle, in microseconds.
struct SampleInstants {
  int least = std::numeric_limits<int>::max();
  int most = std::numeric_limits<int>::min();

  void add(int offset) {
    least = std::min(least, offset);
    most = std::max(most, offset);
  }
};

// Of the words of the data cycle that just passed, from the clock that came back in each.
SampleInstants sample_instants(SlaveBench& bench, CaseJudge& judge) {
  expect_all_telegrams(bench, judge);
  const CycleOnLine out = cycle_that_left(bench, judge, 0);
  const std::uint16_t begin = clock_word(bench.in().start_of(bench.in().data_telegrams()[0]));
  SampleInstants instants;
  for (unsigned word = 0; word < bench.words(); ++word)
    instants.add(static_cast<std::int16_t>(static_cast<std::uint16_t>(out.word(2 * word) - begin)));
  return instants;
}

void check_sample_instant(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  CaseJudge& judge = scene.judge;
  set_signals(bench, clock_word, 0);
  SampleInstants all;
  for (unsigned n = 0; n < bench.volume(40U, 1'000U); ++n) {
    bench.silence(bench.bits(static_cast<std::int64_t>(bench.random().below(300))));
    bench.data_cycle(bench.random_words());
    const SampleInstants words = sample_instants(bench, judge);
    // The clock may tick between two words.
    judge.expect(words.most - words.least <= 1, "input_words_not_of_one_instant", [&] {
      return Mismatch{.expected = {"all words of a cycle are sampled at one instant"},
                      .actual = fmt::format("they are {} us apart", words.most - words.least),
                      .first_difference = fmt::format("data cycle {}", n)};
    });
    all.add(words.least);
    all.add(words.most);
  }
  judge.measure("sample instant after the start of the cycle", "us", all.least);
  // One bit to either side, and the resolution of the clock.
  const double spread = static_cast<double>(bench.bits(2).count()) / 1e6 + 1;
  judge.expect_between("spread of the sample instant", "us", all.most - all.least, 0, spread,
                       "sample_instant_not_constant");
}

// ---- loopback words ----

std::vector<std::uint16_t> loopback_words(SlaveBench& bench) {
  std::vector<std::uint16_t> words = {0x0000, 0xFFFF, 0xA55A, 0x5AA5};
  for (unsigned bit = 0; bit < 16; ++bit) {
    words.push_back(static_cast<std::uint16_t>(1U << bit));
    words.push_back(static_cast<std::uint16_t>(~(1U << bit)));
  }
  if (bench.volume(false, true)) {
    words.clear();
    for (unsigned word = 0; word < 65'536; ++word) words.push_back(static_cast<std::uint16_t>(word));
  } else {
    while (words.size() < 512) words.push_back(static_cast<std::uint16_t>(bench.random().next()));
  }
  return words;
}

void loopback_word_returns_unchanged(SlaveBench& bench, CaseJudge& judge) {
  constexpr std::size_t kTrain = 64;
  bench.set_inputs(bench.random_words());
  const std::vector<std::uint8_t> load = bench.data_load();
  const std::vector<std::uint16_t> sent = bench.random_words();
  const std::vector<std::uint16_t> loopbacks = loopback_words(bench);
  for (std::size_t done = 0; done < loopbacks.size(); done += kTrain) {
    const std::size_t count = std::min(kTrain, loopbacks.size() - done);
    bench.begin();
    for (std::size_t n = 0; n < count; ++n) {
      bench.set_loopback_word(loopbacks[done + n]);
      bench.append_data_cycle(sent);
    }
    bench.send();
    expect_all_telegrams(bench, judge);
    for (std::size_t n = 0; n < count; ++n) expect_answer(bench, judge, n, load);
    expect_outputs(bench, judge, sent, "valid_cycle_rejected");
  }
}

// ---- process data ----

// The next of a pseudo-random sequence of 2^15 - 1 words.
std::uint16_t prbs15(std::uint16_t word) {
  for (unsigned n = 0; n < 15; ++n)
    word = static_cast<std::uint16_t>((word << 1 | ((word >> 14 ^ word >> 13) & 1)) & 0x7FFF);
  return word;
}

std::vector<std::uint16_t> patterns() {
  std::vector<std::uint16_t> list = {0x0000, 0xFFFF, 0x0000, 0x00FF, 0xFF00, 0x5555, 0xAAAA};
  for (unsigned bit = 0; bit < 16; ++bit) list.push_back(static_cast<std::uint16_t>(1U << bit));
  for (unsigned bit = 0; bit < 16; ++bit) list.push_back(static_cast<std::uint16_t>(~(1U << bit)));
  std::uint16_t word = 1;
  for (unsigned n = 0; n < 32'767; ++n) list.push_back(word = prbs15(word));
  return list;
}

// Outputs from the begin of the list on, inputs from the end of what this volume takes of it.
void exchange_patterns(SlaveScene& scene) {
  static const std::vector<std::uint16_t> list = patterns();
  SlaveBench& bench = scene.bench;
  const std::size_t count = bench.volume<std::size_t>(339, list.size());
  std::vector<std::uint16_t> inputs(bench.words());
  scene.words.resize(bench.words());
  for (unsigned word = 0; word < bench.words(); ++word) {
    scene.words[word] = list[(scene.round + word) % count];
    inputs[word] = list[count - 1 - (scene.round + 5 * word) % count];
  }
  bench.set_inputs(inputs);
  bench.data_cycle(scene.words);
}

// ---- endurance ----

void cycles_back_to_back(SlaveBench& bench, CaseJudge& judge) {
  constexpr unsigned kTrain = 64;
  const unsigned words = bench.words();
  bench.train().set_gap(0);
  std::vector<std::uint16_t> sent(std::size_t{kTrain} * words);
  for (unsigned done = 0; done < bench.volume(1'024U, 1'000'000U); done += kTrain) {
    for (std::uint16_t& word : sent) word = static_cast<std::uint16_t>(bench.random().next());
    bench.set_inputs(bench.random_words());
    const std::vector<std::uint8_t> load = bench.data_load();
    bench.begin();
    for (std::size_t n = 0; n < kTrain; ++n)
      bench.append_data_cycle(std::span<const std::uint16_t>(sent).subspan(n * words, words));
    bench.send();
    expect_all_telegrams(bench, judge);
    for (std::size_t n = 0; n < kTrain; ++n) expect_answer(bench, judge, n, load);
    expect_latched_in_order(bench, judge, sent);
  }
}

SlaveCase snapshot_case() {
  return slave_case(
      "data_cycle/inputs_are_one_snapshot", "IS-06",
      "The inputs that a cycle carries are sampled at one instant, which has a fixed place in the cycle.",
      sources::own("sampling at the start of the cycle"),
      {{"tears_inputs", "input_word_torn"},
       {"tears_between_input_words", "input_words_not_of_one_instant"},
       {"falls_silent_after_820_cycles", "telegram_lost"},
       {"samples_with_previous_cycle", "sample_instant_not_constant"}},
      {.steps = {identified(),
                 {"100 000 data cycles while all inputs jump between 0000h and FFFFh at instants unrelated "
                  "to the cycle",
                  "a returned word is 0000h or FFFFh, never a mixture", check_snapshots},
                 {"1 000 data cycles with a clock at the inputs",
                  "the instant that the clock shows is the same in all words, but for a tick of 1 us, and "
                  "stays at its place in the cycle within one bit to either side",
                  check_sample_instant}}},
      {.tags = {"timing"}, .only_for = for_inputs()});
}

SlaveCase process_data_case() {
  return slave_case(
      "data_cycle/process_data_is_exact", "IS-08",
      "Outputs show exactly the words of the cycle, and the cycle carries exactly the words at the inputs, "
      "in both cases with the octets in order.",
      sources::park("section 2.2: full duplex exchange of process data"),
      {{"output_octets_swapped", "output_word_wrong"},
       {"latches_5_ms_late", "output_word_wrong"},
       {"input_bit_stuck", "register_content_wrong"}},
      {.rounds = {339, 32'806},
       .steps = {stimulus<SlaveScene>(
                     "a valid data cycle with the next of walking ones and zeros, 0000h, FFFFh and a "
                     "pseudo-random sequence of 32 767 words, other words in each direction",
                     exchange_patterns),
                 answered(), shown("output_word_wrong")},
       .first = {identified()}},
      {.details = details::answer(), .only_for = for_all({for_outputs(), for_inputs()})});
}

}  // namespace

std::vector<SlaveCase> slave_data_cycle_cases() {
  return {
      snapshot_case(), process_data_case(),
      slave_case(
          "data_cycle/outputs_change_after_the_check_phase", "IS-05",
          "The outputs take over the words of a valid data cycle at the end of its check phase: not before, "
          "and within 50 us after its last check telegram.",
          sources::own("the limit of 50 us; that data count only after the check: Practical Guide"),
          {{"latches_at_end_of_data_phase", "outputs_changed_before_check"},
           {"latches_late", "outputs_latched_late"},
           {"latches_5_ms_late", "outputs_latched_late"}},
          {.steps = {identified(), step("valid data cycles with random words",
                                        "each output changes between the last bit of the last check telegram "
                                        "and 50 us after that telegram's end, to the words of the cycle",
                                        outputs_change_after_the_check)}},
          {.tags = {"timing"}, .only_for = for_outputs()}),
      slave_case("data_cycle/loopback_word_returns_unchanged", "IS-07",
                 "The loopback word is data for a slave: whatever its value, it passes unchanged after the "
                 "slave's own register.",
                 sources::park("section 2.2: the cycle ends when the loopback word has returned"),
                 {{"loopback_word_of_ones_changed", "passed_octet_changed"}},
                 {.steps = {identified(), step("valid data cycles with each of the 65 536 loopback words",
                                               "each loopback word leaves as it came, with the register in "
                                               "front of it and a right check",
                                               loopback_word_returns_unchanged)}},
                 {.details = details::answer()}),
      slave_case("data_cycle/cycles_back_to_back_are_all_accepted", "IS-39",
                 "Cycles that follow each other without any pause are each accepted and answered.",
                 sources::derived("one cycle is independent of the one before it"),
                 {{"loses_every_200th_cycle", "valid_cycle_rejected"},
                  {"check_not_reset_between_cycles", "check_wrong"}},
                 {.steps = {identified(), step("1 000 000 valid data cycles with pseudo-random words, no "
                                               "idle bit between telegrams or cycles",
                                               "no cycle is rejected or answered wrongly, and the outputs "
                                               "show each cycle's words in turn",
                                               cycles_back_to_back)}},
                 {.details = details::answer(), .tags = {"long"}})};
}

}  // namespace fieldproof::conformance

#include <fmt/format.h>

#include <array>

#include "conformance/interbus/slave_scene.hpp"

// IS-17 to IS-22 and IS-26: headers, stop bits, glitches and status telegrams inside a cycle.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

std::vector<SlaveStep> start() {
  return {identified(), good_cycle()};
}

using LevelOf = unsigned (*)(const TrainWriter&);

template <line::HeaderLevel kWhich>
unsigned header(const TrainWriter& train) {
  return train.header_level(kWhich);
}

// A cycle with a fault has no effect, and the next one is taken over.
std::vector<SlaveStep> without_effect(SlaveStep fault, std::string reason_of_recovery) {
  return {std::move(fault), not_taken_over(), status_telegrams(2), good_cycle(std::move(reason_of_recovery))};
}

// Of each telegram but the last ones.
SlaveChart flipped_in_turn(std::string_view what, LevelOf level, std::size_t last) {
  return {.rounds = {1, 20},
          .steps = without_effect(
              flipped(fmt::format("a data cycle in which its {} is flipped at the slave's receiver", what),
                      [level, last](SlaveScene& scene, const CyclePlace& cycle) {
                        return cycle.level_of(telegram_in_turn(scene, cycle, last),
                                              level(scene.bench.train()));
                      }),
              "no_recovery"),
          .first = start(),
          .walk = each_telegram(
              last == 0 ? "each telegram of data and check phase" : "each telegram of the data phase", last)};
}

SlaveChart missing_stop_chart() {
  constexpr std::array kGaps{2U, 0U, 13U};
  const Walk<SlaveScene> walk =
      each_telegram("each telegram, with gaps of 2, 0 and 13 bits between telegrams", 0, kGaps.size());
  std::vector<SlaveStep> steps = without_effect(stop_bit_missing(), "no_resynchronisation");
  steps[0].run = [flip = steps[0].run, count = walk.count, gaps = kGaps](SlaveScene& scene) {
    scene.bench.train().set_gap(gaps.at(scene.round * gaps.size() / count(scene)));
    flip(scene);
  };
  return {.steps = std::move(steps), .first = start(), .walk = walk};
}

unsigned control_level(const SlaveScene& scene) {
  return scene.bench.train().header_level(line::HeaderLevel::control);
}

// One telegram late: the slave takes the first check telegram for data and cannot know better. What it does
// is recorded; only that it goes on is required.
void late_check_phases(SlaveScene& scene) {
  const SlaveStep late = flipped("", [](SlaveScene& s, const CyclePlace& cycle) {
    return cycle.level_of(cycle.octets, control_level(s));
  });
  unsigned changed = 0;
  for (unsigned n = scene.bench.volume(4U, 100U); n > 0; --n) {
    late.run(scene);
    if (!scene.bench.changes().empty()) ++changed;
    scene.bench.status_telegrams(2);
    expect_good_cycle(scene.bench, scene.judge, "no_recovery");
  }
  scene.judge.measure("cycles with a late check phase that changed outputs", "of the rounds", changed);
}

constexpr std::size_t kGlitchLevelsPerBit = 20;

// One low pulse on the idle line, idle line after it, then a data cycle, all in one waveform; pulse and idle
// line in twentieths of a bit.
void drive_glitch_and_cycle(SlaveScene& scene, std::size_t low, std::size_t idle) {
  SlaveBench& bench = scene.bench;
  scene.fault = fmt::format("low pulse of {}/20 of a bit with {}/20 bits of idle line after", low, idle);
  scene.words = inverted_outputs(bench);
  line::Waveform wave{bench.now(), bench.rules().bit_rate * std::int64_t{kGlitchLevelsPerBit}, {}};
  wave.levels.append_idle(4 * kGlitchLevelsPerBit);
  wave.levels.append_fill(false, low);
  wave.levels.append_idle(idle);
  const line::Levels cycle = bench.direct_data_cycle(scene.words, 2);
  for (std::size_t n = 0; n < cycle.size(); ++n) wave.levels.append_fill(cycle[n], kGlitchLevelsPerBit);
  wave.levels.append_idle(4 * kGlitchLevelsPerBit);
  bench.drive_at_receiver(wave);
}

// 0.6 of a bit is a start bit. The least idle line that is allowed for, a bit more, then anything.
void drive_long_glitch(SlaveScene& scene) {
  constexpr std::size_t kLeast = std::size_t{line::kDataTelegramLevels} * kGlitchLevelsPerBit;
  const std::size_t more =
      scene.round < 20 ? scene.round : scene.bench.random().below(40 * kGlitchLevelsPerBit);
  drive_glitch_and_cycle(scene, 12, kLeast + more);
}

// The cycle after the glitch left and was taken over, and nothing before it was.
void expect_cycle_after_glitch(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  CaseJudge& judge = scene.judge;
  const std::string& glitch = scene.fault;
  FoundCycle arrived;
  FoundCycle left;
  find_last_cycle(bench.in().data_telegrams(), arrived);
  find_last_cycle(bench.out().data_telegrams(), left);
  if (!is_right_data_cycle(bench, arrived))
    judge.inconclusive("cycle_did_not_arrive", {{"the cycle arrives as it was driven"}, "it did not"});
  judge.expect(left.is_found && left.octets.size() == arrived.octets.size(), "cycle_after_glitch_rejected",
               "the cycle leaves after the " + glitch, "it did not leave whole");
  const kernel::Time check_phase = bench.in().start_of(bench.in().data_telegrams().back());
  for (const auto& change : bench.changes()) {
    judge.expect(change.when >= check_phase, "output_changed_by_glitch", [&] {
      return Mismatch{.expected = {"outputs change after the check phase of the cycle"},
                      .actual = fmt::format("they changed at {}", kernel::describe(change.when)),
                      .time = change.when,
                      .first_difference = glitch};
    });
  }
  expect_outputs(bench, judge, scene.words, "cycle_after_glitch_rejected");
  judge.expect(left.status == bench.rules().status_clean, "status_word_wrong",
               "an accepted cycle leaves with a clean status word",
               fmt::format("status word {:04X}h after the {}", left.status, glitch));
  bench.terminals().forget_changes();
}

void expect_nothing_before_the_cycle(SlaveScene& scene) {
  LineView& in = scene.bench.in();
  LineView& out = scene.bench.out();
  const bool is_first = out.telegrams().empty() || in.telegrams().empty() ||
                        out.start_of(out.telegrams()[0]) >= in.start_of(in.telegrams()[0]);
  scene.judge.expect(
      is_first && out.telegrams().size() <= in.telegrams().size(), "glitch_taken_for_telegram", [&] {
        const SeenTelegram& first = out.telegrams()[0];
        return Mismatch{
            .expected = {"nothing leaves but the cycle"},
            .actual = describe(out, first, in.start_of(in.telegrams()[0])) + ", reckoned from the cycle",
            .time = out.start_of(first),
            .first_difference = scene.fault};
      });
}

void drive_short_glitch(SlaveScene& scene) {
  scene.bench.require_line_interface();
  drive_glitch_and_cycle(scene, 2 + scene.round % 7, (14 - scene.round % 14) * kGlitchLevelsPerBit);
  expect_nothing_before_the_cycle(scene);
}

SlaveStep cycle_after_glitch() {
  return expected<SlaveScene>("the cycle is taken over, no output changes before its check phase",
                              expect_cycle_after_glitch);
}

void send_status_inside(SlaveScene& scene) {
  constexpr std::array kBetween{1U, 2U, 5U};
  SlaveBench& bench = scene.bench;
  bench.set_inputs(bench.random_words());
  scene.words = bench.random_words();
  bench.begin();
  bench.train().set_status_between(kBetween.at(scene.round % kBetween.size()));
  bench.append_data_cycle(scene.words);
  bench.train().set_status_between(0);
  bench.send();
}

void leave_something(SlaveScene& scene) {
  scene.judge.expect(!scene.bench.out().data_telegrams().empty(), "telegram_lost",
                     "data telegrams leave: there is something that could overlap", "none has left");
}

std::vector<SlaveCase> cases_of_headers() {
  return {
      slave_case("telegram/flipped_select_bit_rejects_the_cycle", "IS-17",
                 "The select bit (SL) of a telegram is not inside the frame check. A telegram whose SL says "
                 "ID cycle inside the data phase breaks the data cycle, which must not be taken over.",
                 sources::practical_guide("SL is FALSE while the data phase runs"),
                 {{"ignores_select_inside_a_cycle", "output_changed_by_rejected_cycle"}},
                 flipped_in_turn("SL bit", header<line::HeaderLevel::select>, 4),
                 {.details = {details::status_coding()}, .only_for = for_outputs()}),
      slave_case(
          "telegram/early_check_phase_rejects_the_cycle", "IS-18",
          "A check phase that begins one telegram early makes the slave compare other octets than the check: "
          "the cycle must not be taken over, except where they fit by chance (one cycle in 256, whose last "
          "data octet equals the first check octet of those before it). One that begins late shifts the "
          "data, which the slave cannot see; the master sees it.",
          sources::practical_guide("CR is TRUE in the check phase"),
          {{"latches_at_end_of_data_phase", "output_changed_by_rejected_cycle"},
           {"locks_up_after_rejected_cycle", "no_recovery"}},
          {.rounds = {4, 100},
           .steps = without_effect(flipped("a data cycle in which the CR bit of the last data telegram is "
                                           "set at the slave's receiver",
                                           [](SlaveScene& scene, const CyclePlace& cycle) {
                                             return cycle.level_of(cycle.octets - 1, control_level(scene));
                                           }),
                                   "no_recovery"),
           .first = {identified(),
                     good_cycle(),
                     {"100 data cycles in which the CR bit of the first check telegram is cleared at the "
                      "slave's receiver, a valid one after each",
                      "the valid ones are taken over; whether a late check phase changed outputs is recorded",
                      late_check_phases}}},
          {.details = {details::status_coding()}, .only_for = for_outputs()}),
      slave_case("telegram/flipped_flag_rejects_the_cycle", "IS-19",
                 "The flag bit (FL) is not inside the frame check. A data telegram that arrives as a status "
                 "telegram makes the ring eight bits short and leaves data levels that may look like other "
                 "telegrams: the cycle must not be taken over.",
                 sources::derived("five header bits, outside the checksum"),
                 {{"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"},
                  {"locks_up_after_rejected_cycle", "no_recovery"}},
                 flipped_in_turn("FL bit", header<line::HeaderLevel::flag>, 0),
                 {.details = {details::status_coding()}, .only_for = for_outputs()}),
      slave_case("telegram/missing_stop_bit_rejects_the_cycle", "IS-20",
                 "A telegram without its stop bit is broken, whatever its octet says: its cycle is not taken "
                 "over. The receiver finds the telegrams after it again within two status telegrams.",
                 sources::own("resynchronisation within two status telegrams"),
                 {{"stop_bit_not_checked", "output_changed_by_rejected_cycle"},
                  {"does_not_resynchronise", "no_resynchronisation"}},
                 missing_stop_chart(), {.details = {details::status_coding()}, .only_for = for_outputs()})};
}

std::vector<SlaveCase> cases_of_the_line() {
  return {
      slave_case("telegram/short_glitch_is_ignored", "IS-21",
                 "A start bit is validated in its middle: a low pulse of less than half a bit on the idle "
                 "line is no telegram.",
                 sources::own("receiver samples in the middle of the bit, majority of three"),
                 {{"start_bit_not_validated", "glitch_taken_for_telegram"}},
                 {{14, 350},
                  {{"a low pulse of 0.10 to 0.40 bit on the idle line at the slave's receiver, 1 to 14 bits "
                    "of idle line and a valid data cycle",
                    "nothing leaves but the cycle", drive_short_glitch},
                   cycle_after_glitch()},
                  start()},
                 {.details = {details::status_coding()}}),
      slave_case("telegram/long_glitch_costs_no_cycle", "IS-22",
                 "A low pulse that passes for a start bit makes one false telegram. It has no effect, and a "
                 "telegram that begins after its 13 bits is received.",
                 sources::own("a false telegram outside of a cycle is discarded"),
                 {{"stray_telegram_spoils_next_cycle", "cycle_after_glitch_rejected"}},
                 {{10, 200},
                  {stimulus<SlaveScene>("a low pulse of 0.60 bit on the idle line at the slave's receiver, "
                                        "13 bits of idle line or more and a valid data cycle",
                                        drive_long_glitch),
                   cycle_after_glitch()},
                  start()},
                 {.details = {details::status_coding()}}),
      slave_case("telegram/status_telegrams_inside_a_cycle_have_no_effect", "IS-26",
                 "Status telegrams between the data telegrams of a cycle fill pauses of the master; they "
                 "shift nothing and do not enter the frame check.",
                 sources::phoenix_maintenance("status telegrams in every pause"),
                 {{"status_telegram_shifts", "register_content_wrong"}},
                 {{6, 150},
                  {stimulus<SlaveScene>(
                       "a valid data cycle with 1, 2 or 5 status telegrams after each data telegram",
                       send_status_inside),
                   answered(), shown(),
                   expected<SlaveScene>(
                       "the status telegrams leave as they came",
                       [](SlaveScene& scene) { expect_status_telegrams(scene.bench, scene.judge); })},
                  start()},
                 {.details = details::answer()}),
      slave_case("telegram/transmissions_do_not_overlap", "monitor",
                 "A slave begins a transmission when the one before it has left, on each of its lines. The "
                 "monitors of these lines judge every other case too.",
                 sources::derived("one telegram after the other on a segment"),
                 {{"drives_over_itself", "transmissions_overlap"}},
                 {{5, 50},
                  {data_cycle(),
                   expected<SlaveScene>("data telegrams leave, and the monitors of the lines see no overlap",
                                        leave_something),
                   status_telegrams(2)},
                  {identified()}})};
}

}  // namespace

std::vector<SlaveCase> slave_telegram_cases() {
  return joined({cases_of_headers(), cases_of_the_line()});
}

}  // namespace fieldproof::conformance

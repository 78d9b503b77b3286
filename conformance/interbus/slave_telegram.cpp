#include <fmt/format.h>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// IS-17 to IS-22 and IS-26: headers, stop bits, glitches and status telegrams inside a cycle.
namespace fieldproof::conformance {
namespace {

// Sends a data cycle whose telegram k arrives with one level flipped; then requires that no output changed
// and that the next clean cycle is accepted.
void reject_flipped_level(SlaveBench& bench, CaseJudge& judge, std::size_t k, unsigned level,
                          std::string_view recovery_reason, unsigned status_between = 2) {
  bench.begin();
  std::vector<std::uint16_t> words = bench.random_words();
  for (unsigned word = 0; word < bench.words(); ++word)
    words[word] = static_cast<std::uint16_t>(~bench.outputs()[word]);
  const CyclePlace& cycle = bench.append_data_cycle(words);
  bench.channel().on_next().flip(cycle.level_of(k, level));
  bench.send();
  // One early check phase in 256, and few other faults in headers, leave a cycle whose check fits by chance:
  // no slave can know, so it is not judged.
  FoundCycle arrived;
  find_last_cycle(bench.in().data_telegrams(), arrived);
  if (!is_right_data_cycle(bench, arrived)) {
    expect_no_change(bench, judge, "output_changed_by_rejected_cycle",
                     fmt::format("telegram {} of the cycle arrived with level {} flipped", k, level));
  }
  bench.terminals().forget_changes();
  bench.status_telegrams(status_between);
  expect_good_cycle(bench, judge, recovery_reason);
}

std::size_t transfer_telegrams(SlaveBench& bench) {
  bench.begin();
  return bench.append_data_cycle(bench.random_words()).octets;
}

void flip_everywhere(SlaveBench& bench, CaseJudge& judge, line::HeaderLevel which, std::size_t telegrams) {
  const unsigned level = bench.train().header_level(which);
  for (unsigned round = 0; round < bench.volume(1U, 20U); ++round) {
    for (std::size_t k = 0; k < telegrams; ++k) reject_flipped_level(bench, judge, k, level, "no_recovery");
  }
}

void start(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  expect_good_cycle(bench, judge, "valid_cycle_rejected");
}

void select_flipped(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  flip_everywhere(bench, judge, line::HeaderLevel::select, transfer_telegrams(bench));
}

void flag_flipped(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  flip_everywhere(bench, judge, line::HeaderLevel::flag, transfer_telegrams(bench) + 4);
}

void check_phase_early_or_late(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  const std::size_t transfer = transfer_telegrams(bench);
  const unsigned level = bench.train().header_level(line::HeaderLevel::control);
  for (unsigned round = 0; round < bench.volume(4U, 100U); ++round)
    reject_flipped_level(bench, judge, transfer - 1, level, "no_recovery");
  // One telegram late: the slave takes the first check telegram for data and cannot know better. What it does
  // is told; only that it goes on is required.
  unsigned changed = 0;
  const unsigned rounds = bench.volume(4U, 100U);
  for (unsigned round = 0; round < rounds; ++round) {
    bench.begin();
    const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
    bench.channel().on_next().flip(cycle.level_of(transfer, level));
    bench.send();
    if (!bench.changes().empty()) ++changed;
    bench.status_telegrams(2);
    expect_good_cycle(bench, judge, "no_recovery");
  }
  judge.measure("cycles with a late check phase that changed outputs", "of the rounds", changed);
}

void stop_level_missing(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  const std::size_t telegrams = transfer_telegrams(bench) + 4;
  for (const unsigned gap : {2U, 0U, 13U}) {
    for (std::size_t k = 0; k < telegrams; ++k) {
      bench.train().set_gap(gap);
      reject_flipped_level(bench, judge, k, TrainWriter::kStopLevel, "no_resynchronisation");
    }
  }
  bench.train().set_gap(2);
}

// ---- glitches on the idle line ----

constexpr unsigned kGlitchLevelsPerBit = 20;

// One low pulse on the idle line, idle line after it, then a data cycle, all in one waveform; pulse and idle
// line in twentieths of a bit.
void drive_glitch_and_cycle(SlaveBench& bench, std::size_t low, std::size_t idle,
                            std::span<const std::uint16_t> words) {
  line::Waveform wave{bench.now(), bench.rules().bit_rate * std::int64_t{kGlitchLevelsPerBit}, {}};
  wave.levels.append_idle(4 * kGlitchLevelsPerBit);
  wave.levels.append_fill(false, low);
  wave.levels.append_idle(idle);
  const line::Levels cycle = bench.direct_data_cycle(words, 2);
  for (std::size_t n = 0; n < cycle.size(); ++n) wave.levels.append_fill(cycle[n], kGlitchLevelsPerBit);
  wave.levels.append_idle(4 * kGlitchLevelsPerBit);
  bench.drive_at_receiver(wave);
}

std::vector<std::uint16_t> other_words(SlaveBench& bench) {
  std::vector<std::uint16_t> words = bench.random_words();
  for (unsigned word = 0; word < words.size(); ++word)
    words[word] = static_cast<std::uint16_t>(~bench.outputs()[word]);
  return words;
}

// The cycle after the glitch left and was taken over, and nothing before it was.
void expect_cycle_behind_glitch(SlaveBench& bench, CaseJudge& judge, std::span<const std::uint16_t> words,
                                const std::string& glitch) {
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
  expect_outputs(bench, judge, words, "cycle_after_glitch_rejected");
  judge.expect(left.status == bench.rules().status_clean, "status_word_wrong",
               "an accepted cycle leaves with a clean status word",
               fmt::format("status word {:04X}h after the {}", left.status, glitch));
  bench.terminals().forget_changes();
}

void expect_nothing_before_the_cycle(SlaveBench& bench, CaseJudge& judge, const std::string& glitch) {
  const std::span<const SeenTelegram> out = bench.out().telegrams();
  const bool is_first = out.empty() || bench.in().telegrams().empty() ||
                        bench.out().start_of(out[0]) >= bench.in().start_of(bench.in().telegrams()[0]);
  judge.expect(is_first && out.size() <= bench.in().telegrams().size(), "glitch_taken_for_telegram", [&] {
    return Mismatch{.expected = {"nothing leaves but the cycle"},
                    .actual = describe(bench.out(), out[0], bench.in().start_of(bench.in().telegrams()[0])) +
                              ", reckoned from the cycle",
                    .time = bench.out().start_of(out[0]),
                    .first_difference = glitch};
  });
}

void short_glitch_is_ignored(SlaveBench& bench, CaseJudge& judge) {
  bench.require_line_interface();
  start(bench, judge);
  unsigned idle = 14;  // bits, down to 1 and again
  for (unsigned round = 0; round < bench.volume(2U, 50U); ++round) {
    for (unsigned low = 2; low <= 8; ++low, idle = idle > 1 ? idle - 1 : 14) {
      const std::string glitch =
          fmt::format("low pulse of {}/20 of a bit with {} bits of idle line after", low, idle);
      const std::vector<std::uint16_t> words = other_words(bench);
      drive_glitch_and_cycle(bench, low, std::size_t{idle} * kGlitchLevelsPerBit, words);
      expect_nothing_before_the_cycle(bench, judge, glitch);
      expect_cycle_behind_glitch(bench, judge, words, glitch);
    }
  }
}

void long_glitch_costs_no_cycle(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  constexpr std::size_t kLeast = std::size_t{line::kDataTelegramLevels} * kGlitchLevelsPerBit;
  for (unsigned round = 0; round < bench.volume(10U, 200U); ++round) {
    // 0.6 of a bit is a start bit. The least idle line that is allowed for, a bit more, then anything.
    const std::size_t more =
        round < 20 ? round : static_cast<std::size_t>(bench.random().below(40 * kGlitchLevelsPerBit));
    const std::vector<std::uint16_t> words = other_words(bench);
    drive_glitch_and_cycle(bench, 12, kLeast + more, words);
    expect_cycle_behind_glitch(
        bench, judge, words,
        fmt::format("low pulse of 12/20 of a bit with {}/20 bits of idle line after", kLeast + more));
  }
}

// ---- status telegrams inside a cycle ----

void status_inside_a_cycle(SlaveBench& bench, CaseJudge& judge) {
  start(bench, judge);
  for (const unsigned between : {1U, 2U, 5U}) {
    for (unsigned round = 0; round < bench.volume(2U, 50U); ++round) {
      bench.set_inputs(bench.random_words());
      const std::vector<std::uint16_t> words = bench.random_words();
      bench.begin();
      bench.train().set_status_between(between);
      bench.append_data_cycle(words);
      bench.train().set_status_between(0);
      bench.send();
      expect_answer(bench, judge, 0, bench.data_load());
      expect_outputs(bench, judge, words, "valid_cycle_rejected");
      expect_status_telegrams(bench, judge);
    }
  }
}

// What is judged are the monitors of the bench.
void transmissions_do_not_overlap(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  for (int n = bench.volume(5, 50); n > 0; --n) {
    bench.data_cycle(bench.random_words());
    judge.expect(!bench.out().data_telegrams().empty(), "telegram_lost",
                 "data telegrams leave: there is something that could overlap", "none has left");
    bench.status_telegrams(2);
  }
}

void add_cases_of_wrong_bits(std::vector<SlaveCase>& cases) {
  cases.push_back(
      {{.id = "interbus/slave/telegram/flipped_select_bit_rejects_the_cycle",
        .purpose = "IS-17",
        .requirement =
            "The select bit (SL) of a telegram is not inside the frame check. A telegram whose SL says "
            "ID cycle inside the data phase breaks the data cycle, which must not be taken over.",
        .reference = sources::practical_guide("SL is FALSE while the data phase runs"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles in which the SL bit of one telegram of the data phase is flipped at the slave's "
            "receiver, each telegram in turn; two status telegrams, then a clean cycle.",
        .expected = "No output changes; the clean cycle is accepted.",
        .tags = {"must"},
        .catches = {{"ignores_select_inside_a_cycle", "output_changed_by_rejected_cycle"}},
        .not_applicable = for_outputs()},
       select_flipped});
  cases.push_back(
      {{.id = "interbus/slave/telegram/early_check_phase_rejects_the_cycle",
        .purpose = "IS-18",
        .requirement =
            "A check phase that begins one telegram early makes the slave compare other octets than "
            "the check: the cycle must not be taken over, except where they fit by chance (one cycle "
            "in 256, whose last data octet equals the first check octet of those before it). One that "
            "begins late shifts the data, which the slave cannot see; the master sees it.",
        .reference = sources::practical_guide("CR is TRUE in the check phase"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles in which the CR bit of the last data telegram is set at the slave's receiver; "
            "then cycles in which that of the first check telegram is cleared. A clean cycle after each.",
        .expected = "No output changes by an early check phase that does not fit; the clean cycles are "
                    "accepted. Whether a late "
                    "check phase changed outputs is recorded.",
        .tags = {"must"},
        .catches = {{"latches_at_end_of_data_phase", "output_changed_by_rejected_cycle"},
                    {"locks_up_after_rejected_cycle", "no_recovery"}},
        .not_applicable = for_outputs()},
       check_phase_early_or_late});
  cases.push_back(
      {{.id = "interbus/slave/telegram/flipped_flag_rejects_the_cycle",
        .purpose = "IS-19",
        .requirement =
            "The flag bit (FL) is not inside the frame check. A data telegram that arrives as a status "
            "telegram makes the ring eight bits short and leaves data levels that may look like other "
            "telegrams: the cycle must not be taken over.",
        .reference = sources::derived("five header bits, outside the checksum"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles in which the FL bit of one telegram is flipped at the slave's receiver, each "
            "telegram of data and check phase in turn; two status telegrams, then a clean cycle.",
        .expected = "No output changes; the clean cycle is accepted.",
        .tags = {"must"},
        .catches = {{"latches_in_spite_of_own_error", "output_changed_by_rejected_cycle"},
                    {"locks_up_after_rejected_cycle", "no_recovery"}},
        .not_applicable = for_outputs()},
       flag_flipped});
  cases.push_back(
      {{.id = "interbus/slave/telegram/missing_stop_bit_rejects_the_cycle",
        .purpose = "IS-20",
        .requirement =
            "A telegram without its stop bit is broken, whatever its octet says: its cycle is not taken "
            "over. The receiver finds the telegrams after it again within two status telegrams.",
        .reference = sources::own("resynchronisation within two status telegrams"),
        .details = {details::status_coding()},
        .stimulus =
            "Data cycles in which the stop bit of one telegram arrives as 0, each telegram in turn, with "
            "gaps of 2, 0 and 13 bits; two status telegrams, then a clean cycle.",
        .expected = "No output changes; the clean cycle is accepted.",
        .tags = {"must"},
        .catches = {{"stop_bit_not_checked", "output_changed_by_rejected_cycle"},
                    {"does_not_resynchronise", "no_resynchronisation"}},
        .not_applicable = for_outputs()},
       stop_level_missing});
}

void add_cases_of_the_line(std::vector<SlaveCase>& cases) {
  cases.push_back(
      {{.id = "interbus/slave/telegram/short_glitch_is_ignored",
        .purpose = "IS-21",
        .requirement =
            "A start bit is validated in its middle: a low pulse of less than half a bit on the idle "
            "line is no telegram.",
        .reference = sources::own("receiver samples in the middle of the bit, majority of three"),
        .details = {details::status_coding()},
        .stimulus =
            "Low pulses of 0.10 to 0.40 bit on the idle line at the slave's receiver, with 1 to 14 bits of "
            "idle line after them; then a clean cycle.",
        .expected = "Nothing leaves but the clean cycle, which is accepted; no output changes before it.",
        .tags = {"must"},
        .catches = {{"start_bit_not_validated", "glitch_taken_for_telegram"}}},
       short_glitch_is_ignored});
  cases.push_back(
      {{.id = "interbus/slave/telegram/long_glitch_costs_no_cycle",
        .purpose = "IS-22",
        .requirement =
            "A low pulse that passes for a start bit makes one false telegram. It has no effect, and a "
            "telegram that begins after its 13 bits is received.",
        .reference = sources::own("a false telegram outside of a cycle is discarded"),
        .details = {details::status_coding()},
        .stimulus =
            "Low pulses of 0.60 bit on the idle line at the slave's receiver, 13 bits of idle line and "
            "more, then a clean cycle.",
        .expected = "No output changes by the pulse, and the clean cycle is accepted.",
        .tags = {"must"},
        .catches = {{"stray_telegram_spoils_next_cycle", "cycle_after_glitch_rejected"}}},
       long_glitch_costs_no_cycle});
  cases.push_back(
      {{.id = "interbus/slave/telegram/status_telegrams_inside_a_cycle_have_no_effect",
        .purpose = "IS-26",
        .requirement =
            "Status telegrams between the data telegrams of a cycle fill pauses of the master; they "
            "shift nothing and do not enter the frame check.",
        .reference = sources::phoenix_maintenance("status telegrams in every pause"),
        .details = details::answer(),
        .stimulus = "Valid data cycles with 1, 2 and 5 status telegrams after each data telegram.",
        .expected =
            "The data telegrams leave as without them, the status telegrams leave, the outputs take over "
            "the words.",
        .tags = {"must"},
        .catches = {{"status_telegram_shifts", "register_content_wrong"}}},
       status_inside_a_cycle});
  cases.push_back(
      {{.id = "interbus/slave/telegram/transmissions_do_not_overlap",
        .purpose = "monitor",
        .requirement = "A slave begins a transmission when the one before it has left, on each of its lines.",
        .reference = sources::derived("one telegram after the other on a segment"),
        .stimulus = "An ID cycle, then data cycles with status telegrams between them.",
        .expected = "The monitors of the lines that the slave drives see no overlap. They judge every other "
                    "case too.",
        .tags = {"must"},
        .catches = {{"drives_over_itself", "transmissions_overlap"}}},
       transmissions_do_not_overlap});
}

}  // namespace

std::vector<SlaveCase> slave_telegram_cases() {
  std::vector<SlaveCase> cases;
  add_cases_of_wrong_bits(cases);
  add_cases_of_the_line(cases);
  return cases;
}

}  // namespace fieldproof::conformance

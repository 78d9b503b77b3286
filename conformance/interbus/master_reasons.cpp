#include "conformance/interbus/master_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfMaster{
    // Which cycles come, and when.
    ReasonRule{"no_data_cycle",
               "In run, data cycles go on until a stop, stop_after_bad_cycles bad cycles in a row or a good "
               "ID cycle of another ring. ID cycles stand between them only as ordered, or after a bad cycle "
               "until one is good."},
    ReasonRule{"cycle_unasked",
               "The last cycle of a run is that of a stop, the one that makes stop_after_bad_cycles bad ones "
               "in a row (only a good data cycle ends the row), or a good ID cycle that shows another ring."},
    ReasonRule{"cycle_wrong",
               "A data cycle has the loopback word, then the outputs as last written or copied, the last "
               "station's first, and end_telegrams octets of 0. An ordered ID cycle takes its place; each "
               "begins at a multiple of the cycle time."},
    ReasonRule{"cycle_time_wrong",
               "The cycle time in force (item 7) is cycle_time, but at least frame, delay of the ring as the "
               "recognition has measured it, and software_time."},
    ReasonRule{"cycle_only_claimed",
               "Each cycle that is reported as ended (item 0Ah) has been driven, and as that kind: a data "
               "cycle as 1, an ID cycle as 0, 2 more for a good one."},
    ReasonRule{"no_id_cycle_after_error",
               "An ID cycle follows a bad cycle of either kind, again and again until one is good; then data "
               "cycles go on."},
    ReasonRule{"restart_without_id_cycle",
               "Each start begins with the recognition: the first cycle after it is an ID cycle."},
    ReasonRule{
        "does_not_work_again",
        "Once in run, an ID cycle that is ordered takes the place of the next data cycle, and data cycles "
        "that come back right are good, whatever ended the run before and disturbed the recognition."},
    // What it makes of what comes back.
    ReasonRule{"wrong_cycle_accepted",
               "A cycle is bad with a telegram less, one more that begins within 13 bits, a missing stop "
               "level, a header that was not sent, the loopback word elsewhere, a wrong check or a status "
               "word that is not status_clean."},
    ReasonRule{"right_cycle_rejected",
               "A cycle is good when just its telegrams come back with stop levels and the headers sent, the "
               "loopback word in its place, check and status word right, whatever the inputs are and as late "
               "as the ring's delay."},
    ReasonRule{"new_inputs_missed",
               "A good data cycle makes the registers that came back the input words, all of this cycle: "
               "those of the last station come first, those of each station in their order."},
    ReasonRule{"inputs_not_held",
               "A bad cycle, an ID cycle, a stop and a bus stop change no input, nor does the end of a "
               "recognition; only the order to start may clear them."},
    ReasonRule{"inputs_wrong",
               "A cycle is told as good or bad by what came back, and the inputs then stand as the last good "
               "data cycle has brought them."},
    // What it reports.
    ReasonRule{"report_wrong",
               "Reported are bad cycles in a row up to a good data cycle, the fault before the first check "
               "error message, messages of the last good ID cycle, the quality bit (quality_bad_cycles of "
               "quality_window_cycles) and outputs as they stand."},
    ReasonRule{
        "counter_wrong",
        "Items 1 to 4 count the data cycles and the ID cycles that have ended, good or bad, the rejected "
        "ones of both kinds and the rejected data cycles, each once; a start begins them at 0."},
    ReasonRule{"state_missing",
               "stop_after_bad_cycles bad cycles in a row, or a good ID cycle of another ring, lead to bus "
               "stop, the former on to locating after the silence. A start leads to ready until a station "
               "answers, identification and run."},
    ReasonRule{"state_unasked",
               "Run lasts until a stop is ordered, stop_after_bad_cycles cycles in a row were bad or a good "
               "ID cycle shows another ring: fewer bad cycles, marks and messages of stations end none."},
    ReasonRule{"state_wrong",
               "A start leads to run with each station by ID code, words and place, to bus stop with a "
               "sentence where the ring exceeds a limit or is not as expected. A cut is placed before the "
               "first station missing; out of run outputs are 0."},
    // Start and stop.
    ReasonRule{"outputs_not_cleared",
               "An order to stop in run brings a last data cycle with all outputs 0, also where the "
               "application writes an output after it."},
    ReasonRule{"goes_on_after_a_stop",
               "After the cycle that is under way a stop in run brings one data cycle, which is not repeated "
               "when it comes back bad, and no other."},
    ReasonRule{"not_silent",
               "After a stop there are no cycles until a start, only status telegrams or silence; ordered "
               "before run, in bus stop or while the fault is looked for, it ends all at once: off."},
    ReasonRule{"order_starts_again",
               "Start counts in the states off and bus stop only: within a recognition no order begins it "
               "again, with the silence that goes in front."},
    ReasonRule{"early_output_kept",
               "An output that is ordered outside of run has no effect, then and later: it is 0 on the line "
               "and in the image until the application writes it in run."},
    // What lies on its line.
    ReasonRule{"silence_too_short",
               "Before each recognition but the first, for a start or to locate a fault after a bus stop, "
               "the line is silent for silence_limit plus silence_tolerance: then all interfaces are off."},
    ReasonRule{
        "silence_too_long",
        "Status telegrams fill the time between cycles: from the first telegram to a stop or bus stop the "
        "line is never silent for longer than silence_limit, after which slaves reset themselves."},
    ReasonRule{"silence_before_the_first_start",
               "The first start after the supply has come begins the recognition without the silence that "
               "later ones have in front."},
    ReasonRule{"phase_wrong",
               "Telegrams of a cycle are data telegrams, without CR in the transfer phase, with it for "
               "check, status word and end_telegrams; SL is set in both phases of an ID cycle and in none of "
               "a data cycle."},
    ReasonRule{"check_wrong",
               "After the transfer phase comes the check of all its octets by check_polynomial, "
               "check_preset, check_final_xor and check_is_reflected."},
    ReasonRule{"header_wrong", "Status telegrams have neither select nor control."},
    ReasonRule{"stop_missing", "Each telegram, also a status telegram, ends with a stop level of 1."},
    ReasonRule{"gap_wrong",
               "Telegram n of a cycle begins n times the sum of 13 bits and telegram_gap_millibits after the "
               "first one, to a bit."},
    ReasonRule{"status_pitch_wrong",
               "The first status telegram follows within a pitch, status_pitch_bits, after the last telegram "
               "of a cycle and its gap, each other one a pitch after the one before, to half a bit."},
    ReasonRule{
        "pause_not_filled",
        "Status telegrams go on up to the next cycle, as long as a whole pitch, status_pitch_bits, is left."},
    ReasonRule{"transmissions_overlap",
               "A master begins a transmission when its last one has ended: a cycle waits for the status "
               "telegrams that were said."},
    ReasonRule{"station_babbles",
               "Telegrams are driven one after the other, those of a cycle telegram_gap_millibits apart, "
               "status telegrams each status_pitch_bits: never more than fit on the line."},
};

}  // namespace

std::span<const ReasonRule> master_reasons() {
  return kReasonsOfMaster;
}

}  // namespace fieldproof::conformance

#include "conformance/interbus/slave_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfSlave{
    // What leaves on each line.
    ReasonRule{"telegram_not_passed",
               "Each telegram is passed on, also without a stop level, in a rejected cycle or in parts: from "
               "port 0 to OUT2, else OUT1, where a good ID cycle switched it on, else back; what comes back "
               "goes to the next one on, then to port 0."},
    ReasonRule{"telegram_added",
               "Only telegrams that came leave, each once. An interface that is off (from power-up or "
               "silence, by the control word, in the time of control_reset, or empty) gives and takes none; "
               "a pulse too short for a start level is none."},
    ReasonRule{
        "header_wrong",
        "Each telegram leaves in its turn with SL, CR and FL as they came, and with a stop level of 1."},
    ReasonRule{"octet_wrong",
               "First leaves the register (inputs; in an ID cycle the ID code and messages, a check error "
               "until a good one has brought it back), then what came in, the check of what left, and the "
               "status word, marked after an own error."},
    ReasonRule{"passed_at_another_time",
               "A telegram leaves forward_delay_half_bits after it began to arrive, return_delay_half_bits "
               "more at port 0; what comes back takes the latter only, from OUT2 to OUT1 nothing; to a "
               "quarter of a bit, and after the one before it."},
    ReasonRule{"output_not_retimed",
               "A slave sends each telegram anew: its edges lie in their places by the slave's own bit rate, "
               "also where those that came lie 15 % of a bit beside theirs at a bit rate that is 1 % off."},
    ReasonRule{
        "rate_beyond_limit_accepted",
        "A cycle whose bit rate is 6 % off is not received: no cycle leaves with a clean status word."},
    // Its terminals.
    ReasonRule{"outputs_wrong",
               "Outputs take the words of each good data cycle (no own error, clean status word received) "
               "once an ID cycle was good, and stay after any other; they are 0 from power-up and from "
               "silence_limit without a telegram at port 0."},
    ReasonRule{
        "outputs_at_another_time",
        "A good data cycle moves the outputs after its last telegram, within latch_limit. Silence makes them "
        "0 silence_limit after the end of the last telegram at port 0, to silence_tolerance."},
    ReasonRule{"input_word_torn",
               "Both octets of an input word show one instant: the first data telegram of a transfer phase "
               "loads the whole register."},
    ReasonRule{"input_words_not_of_one_instant",
               "All input words of a data cycle show one instant, also those that leave later: the first "
               "data telegram loads the whole register."},
    ReasonRule{"inputs_of_another_instant",
               "The inputs of a data cycle are those at the start level of its first data telegram, or up to "
               "a bit later, not those of the cycle before or of when a word leaves."},
    // How it drives its lines.
    ReasonRule{
        "transmissions_overlap",
        "Nothing leaves on a line before what went out there before has ended, whichever port it came from."},
    ReasonRule{"station_babbles",
               "A slave drives nothing but the telegrams that it passes on, each once and after the one "
               "before it: never more than fit on a line."},
};

}  // namespace

std::span<const ReasonRule> slave_reasons() {
  return kReasonsOfSlave;
}

}  // namespace fieldproof::conformance

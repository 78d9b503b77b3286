#include "conformance/token_bus/translator_reasons.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

constexpr std::array kReasonsOfTranslator{
    // Towards the line.
    ReasonRule{"sent_other",
               "pad_idle and one go out as CD1,CD0, zero as CD0,CD1, two non_data as CD1,CD1 then CD0,CD0, "
               "silence as IDL,IDL; nothing in management mode, or with the transmitter off: power-up, "
               "RESET, more than jabber_symbols."},
    ReasonRule{"sent_too_late", "Each symbol that the MAC requests goes out within delay_symbols."},
    ReasonRule{"nothing_sent",
               "After RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER and END PHYSICAL the transmitter is on: "
               "the pad_idle that is requested goes out as CD1,CD0."},
    // Towards the MAC.
    ReasonRule{"indication_other",
               "Two bits are indicated as the table says (no carrier: silence, signal error: bad_signal) in "
               "the phase found, with blanking_symbols of silence after I = 0; in management mode only the "
               "answer; in loopback what is requested."},
    ReasonRule{"indicated_too_late",
               "A symbol from the line is indicated within delay_symbols, and a command answered within "
               "answer_symbols after it began."},
    ReasonRule{"answer_wrong",
               "RESET, DISABLE LOOPBACK and, unless there was a jabber, ENABLE TRANSMITTER are answered with "
               "ACK at the latest answer_symbols after the command began, as long as it stands."},
    ReasonRule{"precondition_not_met",
               "While a command of the management mode stands it is answered, at the latest answer_symbols "
               "after it began: RESET, also the first one after power-up, with ACK."},
    ReasonRule{"phase_wrong",
               "Two zeros in a row in front of the first non_data of a transmission drop one bit, each time; "
               "after two ones in a row, or a non_data, none is dropped until the line was silent for a "
               "symbol or longer."},
    ReasonRule{"remembers_over_silence",
               "After silence of a symbol or longer, with carrier or without, nothing is left of what was "
               "before: no zero or one in a row, no phase that is held, no half pair of non_data, no part of "
               "an end delimiter."},
    ReasonRule{
        "mask_wrong",
        "A signal error that begins within error_mask_symbols of the end of an own transmission is none, and "
        "its bit is what it is; one that begins later, or within a transmission, is bad_signal."},
    ReasonRule{"masked_without_transmission",
               "error_mask_symbols begin with the end of an own transmission only: a signal error after what "
               "others sent, or after a request with the transmitter off, is bad_signal."},
    ReasonRule{"still_blanked",
               "RESET clears the blanking, and after power-up it is as after RESET: when DISABLE LOOPBACK "
               "follows, what comes from the line is indicated although blanking_symbols are not over."},
    // Of each side.
    ReasonRule{
        "transmissions_overlap",
        "Each level of a port is driven once: a piece begins when the one before has ended, or later."},
    ReasonRule{"station_babbles",
               "What is driven on a port are units of four levels, one after the other: a symbol on the MAC "
               "side, a bit on the physical side."},
};

}  // namespace

std::span<const ReasonRule> translator_reasons() {
  return kReasonsOfTranslator;
}

}  // namespace fieldproof::conformance

# SPDX-License-Identifier: Apache-2.0
"""Faults of a translator, to see that the bench finds them: translator.py --fault NAME."""
from translator import Translator
from translator_code import ANSWER_ACK, CD1, COMMAND_IDLE, IDL, NORMAL, ONE, SILENCE, ZERO, Decoder


class SwapsZeroAndOne(Translator):
    def coded(self, symbol):
        return super().coded({ZERO: ONE, ONE: ZERO}.get(symbol, symbol))


class ReadsIdleAfterABitAsSilence(Translator):
    class decoder(Decoder):
        table = {**Decoder.table, (NORMAL, CD1, IDL): SILENCE}


class SlipsAfterThreeZeros(Translator):
    class decoder(Decoder):
        zeros_to_slip = 3


class NeverBlanks(Translator):
    class decoder(Decoder):
        def look_for_end(self, symbol, end):
            super().look_for_end(symbol, end)
            self.blanked_until = 0


class NeverMasks(Translator):
    def is_masked(self, at):
        return False


class AnswersIdleWithAck(Translator):
    def answer_to(self, code):
        answer = super().answer_to(code)
        return ANSWER_ACK if code == COMMAND_IDLE else answer


class KeepsHalfAPair(Translator):
    def coded(self, symbol):
        was_half_pair = self.is_half_pair
        bits = super().coded(symbol)
        if symbol == SILENCE:
            self.is_half_pair = was_half_pair
        return bits


class StaysEnabledAfterReset(Translator):
    def reset(self):
        was_enabled = getattr(self, "is_enabled", False)
        super().reset()
        self.is_enabled = was_enabled


# name: (class, what it does, which case of token_bus/translator finds it)
FAULTS = {
    "swaps_zero_and_one": (SwapsZeroAndOne, "sends a zero as a one, and a one as a zero",
                           "encoding/each_symbol_is_two_bits"),
    "idle_after_a_bit_is_silence": (ReadsIdleAfterABitAsSilence, "reads CD1, IDL as silence",
                                    "decoding/each_pair_by_carrier_and_signal"),
    "slips_after_three_zeros": (SlipsAfterThreeZeros, "wants three zeros in a row to slip its phase",
                                "locking/what_moves_and_what_holds_the_phase"),
    "never_blanks": (NeverBlanks, "indicates what comes after the end of a transmission", "blanking/lasts_its_symbols"),
    "never_masks": (NeverMasks, "takes the test of a transceiver for an error", "blanking/the_heartbeat_is_silence"),
    "answers_idle_with_ack": (AnswersIdleWithAck, "answers IDLE with ACK", "management/commands_are_answered"),
    "keeps_half_a_pair": (KeepsHalfAPair, "begins a transmission with the second non_data of a pair",
                          "encoding/a_cut_transmission_leaves_nothing_behind"),
    "enabled_after_reset": (StaysEnabledAfterReset, "its transmitter outlives RESET",
                            "management/reset_takes_it_off_the_line"),
}

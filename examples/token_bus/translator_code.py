# SPDX-License-Identifier: Apache-2.0
"""The codes of a translator's two sides, and the decoder of the line: protocols/token_bus/translator.md has both tables."""

CD0, CD1, IDL, BAD, ERROR = range(5)  # what a bit of the line is
ZERO, ONE, PAD_IDLE, NON_DATA, BAD_SIGNAL, SILENCE = "0", "1", "P", "N", "B", "S"  # symbols of the MAC
OFF = 0b1111  # levels of what is not driven

# Of the line: half bits in bits 2 and 3, no signal error in bit 1, the transmitter on in bit 0 (low).
LINE_LEVELS = {CD0: 0b0110, CD1: 0b1010}
# Of the MAC: bit 0 is SM*, bits 1 to 3 the code with its last bit highest.
REQUESTS = {0b0001: ZERO, 0b1001: ONE, 0b0101: PAD_IDLE, 0b1101: PAD_IDLE, 0b0011: NON_DATA, 0b1011: NON_DATA,
            0b0111: SILENCE, 0b1111: SILENCE}
INDICATIONS = {ZERO: 0b0001, ONE: 0b1001, BAD_SIGNAL: 0b0101, NON_DATA: 0b0011, SILENCE: 0b1111}
COMMAND_IDLE, COMMAND_ENABLE, COMMAND_DISABLE, COMMAND_RESET = 0b1000, 0b1100, 0b1010, 0b1110
ANSWER_IDLE, ANSWER_ACK, ANSWER_NACK, ANSWER_ERROR = 0b1000, 0b1100, 0b1010, 0b1110

NORMAL, DUE, LAST_IS_OVER = range(3)  # the second non_data of a pair is due; an end delimiter with I = 0 was the last


def decoding_table():
    """(context, first bit, second bit) -> symbol."""
    table = {}
    for context in (NORMAL, DUE, LAST_IS_OVER):
        is_due = context == DUE
        table[context, CD1, CD0] = BAD_SIGNAL if is_due else ONE
        table[context, CD0, CD1] = BAD_SIGNAL if is_due else ZERO
        table[context, CD1, CD1] = BAD_SIGNAL if is_due else NON_DATA
        table[context, CD0, CD0] = NON_DATA if is_due else BAD_SIGNAL
        table[context, CD1, IDL] = table[context, CD0, IDL] = SILENCE if context == LAST_IS_OVER else BAD_SIGNAL
        table[context, IDL, CD1] = table[context, IDL, CD0] = table[context, IDL, IDL] = SILENCE
    return table


class Decoder:
    """Pairs of bits to symbols: the phase that two ones or a non_data lock and two zeros slip, and the blanking after an
    end delimiter after which nothing follows."""

    table = decoding_table()
    zeros_to_slip, ones_to_lock = 2, 2

    def __init__(self, blanking):
        self.blanking = blanking
        self.reset()

    def reset(self):
        self.blanked_until = 0
        self.clear()

    def clear(self):
        """The line was silent."""
        self.half = None  # the first bit of a pair, and its begin
        self.was_silent, self.is_locked, self.drops_one = True, False, False
        self.zeros = self.ones = 0
        self.is_due = self.last_is_over = False
        self.recent = ""

    def is_silent(self):
        return self.half is None and self.was_silent and not self.drops_one

    def take(self, bit, begin, end):
        """A bit that is over: the symbol that it completes and its begin, or nothing."""
        if self.drops_one:
            self.drops_one = False
            return None
        if self.half is None:
            if not self.was_silent or bit != IDL:
                self.was_silent, self.half = False, (bit, begin)
            return None
        (first, begin), self.half = self.half, None
        symbol = self.symbol_of(first, bit)
        if symbol == SILENCE:
            self.clear()
            return None
        is_blanked = begin < self.blanked_until
        self.is_due = symbol == NON_DATA and not self.is_due
        if not self.is_locked:
            self.find_phase(symbol)
        self.look_for_end(symbol, end)
        return None if is_blanked else (symbol, begin)

    def symbol_of(self, first, second):
        if first in (ERROR, BAD) or second in (ERROR, BAD):
            return BAD_SIGNAL
        context = DUE if self.is_due else LAST_IS_OVER if self.last_is_over else NORMAL
        return self.table[context, first, second]

    def find_phase(self, symbol):
        if symbol == ZERO:
            self.zeros, self.ones = self.zeros + 1, 0
            if self.zeros == self.zeros_to_slip:
                self.zeros, self.drops_one = 0, True
        elif symbol == ONE:
            self.zeros, self.ones = 0, self.ones + 1
            self.is_locked = self.ones == self.ones_to_lock
        else:
            self.zeros = self.ones = 0
            self.is_locked = symbol == NON_DATA

    def look_for_end(self, symbol, end):
        """NN1NN1, I and E."""
        self.recent = (self.recent + symbol)[-8:]
        flags = self.recent[6:]
        if len(self.recent) == 8 and self.recent.startswith("NN1NN1") and BAD_SIGNAL not in flags and NON_DATA not in flags:
            self.last_is_over = flags[0] == ZERO
            if self.last_is_over:
                self.blanked_until = end + self.blanking

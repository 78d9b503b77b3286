#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A physical layer service translator of the token bus on the line of IEEE 802.3:
fieldproof run 'token_bus/translator/**' --iut 'exec:python3 translator.py'

protocols/token_bus/translator.md describes it. Here are its two sides and their time; translator_code.py has the codes
and what is read of pairs of bits. --fault NAME gives it a fault of translator_faults.py."""
from collections import deque

from contract import NEVER, SECOND, implementation, serve
from translator_code import (ANSWER_ACK, ANSWER_ERROR, ANSWER_IDLE, ANSWER_NACK, BAD, CD0, CD1, COMMAND_DISABLE,
                             COMMAND_ENABLE, COMMAND_IDLE, COMMAND_RESET, ERROR, IDL, INDICATIONS, LINE_LEVELS, NON_DATA,
                             OFF, REQUESTS, SILENCE, ZERO, Decoder)

LINE, MAC = 0, 1  # ports


class Reception:
    """What was received at once: units of four levels, one after the other."""

    def __init__(self, start, rate, count, packed):
        self.start, self.rate, self.next = start, rate, 0
        self.count = (count + 3) // 4
        if count % 4:  # what is not driven any more is high
            levels = int.from_bytes(packed, "little") & ((1 << count) - 1)
            levels |= ((1 << (4 * self.count - count)) - 1) << count
            packed = levels.to_bytes((self.count + 1) // 2, "little")
        self.packed = packed

    def begin(self, unit):
        return self.start + unit * 4 * SECOND // self.rate

    def levels(self, unit):
        octet = self.packed[unit >> 1]
        return octet >> 4 if unit & 1 else octet & 15

    def is_over(self):
        return self.next >= self.count


class Sent:
    """What goes out within one call, in as few pieces as there are gaps."""

    def __init__(self, stream):
        self.stream, self.pieces = stream, []

    def put(self, port, start, end, units, rate):
        last = next((piece for piece in reversed(self.pieces) if piece[0] == port), None)
        if last and last[2] == start and last[4] == rate:
            last[3].extend(units)
            last[2] = end
        else:
            self.pieces.append([port, start, end, list(units), rate])

    def send(self, now):
        for port, start, _, units, rate in self.pieces:
            packed = bytearray((len(units) + 1) // 2)
            for n, unit in enumerate(units):
                packed[n >> 1] |= unit << 4 * (n & 1)
            self.stream.transmit_levels(port, max(start, now), rate, 4 * len(units), bytes(packed))
        self.pieces = []


class Translator:
    """Between a MAC and a line. Whatever is over at an instant is taken then, and passed on a delay after its begin."""

    decoder = Decoder

    def __init__(self, stream, settings, seed):
        del seed  # nothing is random
        self.sent, self.settings = Sent(stream), settings
        self.bit = SECOND // settings["phy_bit_rate"]
        self.symbol = self.symbols(1)
        self.delay = self.symbols(min(settings["delay_symbols"], settings["answer_symbols"]))
        self.mask = self.symbols(settings["error_mask_symbols"])
        self.is_on = False
        self.queues = (deque(), deque())
        self.forget()

    def symbols(self, count):
        return count * 2 * SECOND // self.settings["phy_bit_rate"]

    def forget(self):
        """What a loss of the supply does."""
        self.rates = [4 * self.settings["phy_bit_rate"], 2 * self.settings["phy_bit_rate"]]  # as received last
        self.taken_until = [0, 0]
        self.own = deque(maxlen=4)  # [begin, end] of transmissions
        self.management = [0, 0]  # the last interval of management mode
        self.is_mac_silent, self.is_half_pair, self.length = True, False, 0
        self.decoder_of_line = self.decoder(self.symbols(self.settings["blanking_symbols"]))
        self.reset()

    def reset(self):
        self.is_enabled, self.is_loopback, self.has_jabbered = False, True, False
        self.decoder_of_line.reset()

    # ---- calls ----

    def power(self, is_on, now):
        if not is_on:
            self.on_time(now)
        if is_on != self.is_on:
            self.forget()
            for queue in self.queues if is_on else ():
                while queue and queue[0].begin(queue[0].count) <= now:
                    queue.popleft()
                for reception in queue:
                    while not reception.is_over() and reception.begin(reception.next) < now:
                        reception.next += 1
            self.taken_until = [now, now]
        self.is_on = is_on

    def receive_levels(self, port, start, rate, count, packed):
        self.on_time(start)
        self.queues[port].append(Reception(start, rate, count, packed))

    def on_time(self, now):
        while self.is_on:
            mac, line = self.next_unit(MAC), self.next_unit(LINE)
            if mac and mac[1] <= now and (not line or mac[1] <= line[1]):
                self.from_mac(*self.taken(MAC, mac))
            elif line and line[1] <= now:
                begin, end, levels = self.taken(LINE, line)
                if not self.is_loopback:
                    self.decode(self.bit_of(levels, begin), begin, end)
            else:
                break
        self.sent.send(now)

    def next_time(self):
        if not self.is_on:
            return NEVER
        times = [NEVER]
        for port in (MAC, LINE):
            unit = self.next_unit(port)
            if unit and not (port == LINE and self.is_loopback):
                begin, half = unit[0], self.decoder_of_line.half
                if half and (port == LINE or self.is_loopback):
                    begin = min(begin, half[1])
                times.append(max(begin + self.delay, unit[1]))
        return min(times)

    # ---- what comes next at a port ----

    def next_unit(self, port):
        """(begin, end, levels, reception or None): what is not driven is a unit, too, while that says something."""
        queue = self.queues[port]
        while queue and queue[0].is_over():
            queue.popleft()
        reception = queue[0] if queue else None
        begin = reception.begin(reception.next) if reception else NEVER
        is_quiet, length = self.is_quiet(port), self.symbol if port == MAC else self.bit
        at = self.taken_until[port]
        if not is_quiet and begin > at:
            return at, min(at + length, begin), OFF, None
        if reception:
            return begin, reception.begin(reception.next + 1), reception.levels(reception.next), reception
        return None

    def is_quiet(self, port):
        if port == MAC:
            return self.is_mac_silent and (not self.is_loopback or self.decoder_of_line.is_silent())
        return self.is_loopback or self.decoder_of_line.is_silent()

    def taken(self, port, unit):
        begin, end, levels, reception = unit
        if reception:
            reception.next += 1
            self.rates[port] = reception.rate
        self.taken_until[port] = end
        return begin, end, levels

    # ---- from the MAC ----

    def from_mac(self, begin, end, levels):
        symbol = SILENCE
        if levels & 1:
            symbol = REQUESTS[levels]
        else:
            self.take_command(begin, end, levels)
        bits = self.coded(symbol)
        self.is_mac_silent = symbol == SILENCE
        if symbol != SILENCE and self.is_enabled:
            self.length += 1
            if self.length > self.settings["jabber_symbols"]:
                self.is_enabled, self.has_jabbered = False, True
        if symbol != SILENCE and self.is_enabled:
            self.drive(begin + self.delay, end + self.delay, bits)
        if self.is_loopback:
            middle = (begin + end) // 2
            self.decode(bits[0], begin, middle)
            self.decode(bits[1], middle, end)

    def coded(self, symbol):
        """The two bits of a symbol; of two non_data the first is CD1, CD1, the second CD0, CD0."""
        if symbol == SILENCE:
            self.is_half_pair, self.length = False, 0
            return IDL, IDL
        if symbol == NON_DATA:
            self.is_half_pair = not self.is_half_pair
            return (CD1, CD1) if self.is_half_pair else (CD0, CD0)
        self.is_half_pair = False
        return (CD0, CD1) if symbol == ZERO else (CD1, CD0)

    def drive(self, begin, end, bits):
        self.sent.put(LINE, begin, end, [LINE_LEVELS[bit] for bit in bits], 2 * self.rates[MAC])
        if self.own and self.own[-1][1] == begin:
            self.own[-1][1] = end
        else:
            self.own.append([begin, end])

    def take_command(self, begin, end, code):
        if self.management[1] == begin:
            self.management[1] = end
        else:
            self.management = [begin, end]
        self.sent.put(MAC, begin + self.delay, end + self.delay, [self.answer_to(code)], self.rates[MAC])

    def answer_to(self, code):
        if code == COMMAND_RESET:
            self.reset()
            return ANSWER_ACK
        if code == COMMAND_DISABLE:
            if self.is_loopback:
                self.is_loopback = False
                self.decoder_of_line.clear()
            return ANSWER_ACK
        if code == COMMAND_ENABLE:
            if self.has_jabbered:
                return ANSWER_NACK
            self.is_enabled = True
            return ANSWER_ACK
        if code == COMMAND_IDLE:
            return ANSWER_ERROR if self.has_jabbered else ANSWER_IDLE
        return ANSWER_NACK

    # ---- from the line ----

    def bit_of(self, levels, begin):
        if levels & 1:
            return IDL
        if not levels & 2 and not self.is_masked(begin):
            return ERROR
        return (BAD, CD0, CD1, IDL)[levels >> 2]

    def is_masked(self, at):
        """Within the mask after the last own transmission that had begun."""
        last = next((one for one in reversed(self.own) if one[0] <= at), None)
        return last is not None and last[1] <= at < last[1] + self.mask

    def decode(self, bit, begin, end):
        read = self.decoder_of_line.take(bit, begin, end)
        if not read:
            return
        symbol, begin = read
        if not self.is_managed(begin, end):
            rate = self.rates[MAC] if self.is_loopback else self.rates[LINE] // 2
            self.sent.put(MAC, begin + self.delay, end + self.delay, [INDICATIONS[symbol]], rate)

    def is_managed(self, begin, end):
        """An answer stands there; what is looped back is the MAC's own."""
        if self.is_loopback:
            return False
        if self.management[0] < end and self.management[1] > begin:
            return True
        unit = self.next_unit(MAC)
        return unit is not None and unit[0] < end and not unit[2] & 1


if __name__ == "__main__":
    from translator_faults import FAULTS

    serve("translator", implementation(FAULTS, Translator))

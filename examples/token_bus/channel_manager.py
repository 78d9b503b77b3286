#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A dual channel manager between a MAC of a token bus and two channels:
fieldproof run 'token_bus/channel_manager/**' --iut 'exec:python3 channel_manager.py'

protocols/token_bus/channel_manager.md describes it. Which channel the MAC is given is decided in channel_selection.py;
here are levels and delays. --fault NAME gives it a fault of channel_manager_faults.py."""
from collections import deque, namedtuple
from itertools import repeat

from channel_selection import ANSWER, BAD_SIGNAL, DELIMITER_SYMBOLS, NON_DATA, ONE, SILENCE, ZERO, Selection
from contract import NEVER, end_of, implementation, serve

MAC, CHANNEL_A, CHANNEL_B = 0, 1, 2  # ports
FAULT = 1  # item

# Of the four levels of a unit, the first one in bit 0: SM*, symbol 2, symbol 1, symbol 0.
CODES = [ZERO, ONE, BAD_SIGNAL, BAD_SIGNAL, NON_DATA, NON_DATA, SILENCE, SILENCE]
SYMBOLS = [CODES[(unit >> 1 & 1) << 2 | (unit >> 2 & 1) << 1 | unit >> 3] if unit & 1 else ANSWER for unit in range(16)]

Unit = namedtuple("Unit", "begin end levels rate")


class Line:
    """What is received at a port: units that are still to come, and those that wait to be passed on."""
    def __init__(self, symbol):
        self.symbol = symbol  # how long one lasts
        self.coming, self.waiting = deque(), deque()
        self.heard_until, self.is_silent = 0, True
        self.heard = deque()  # when something was: [begin, end] of each

    def add(self, start, rate, count, packed):
        while self.coming and self.coming[-1].end > start:  # cut short by a new reception
            self.coming.pop()
        times = [end_of(start, 4 * n, rate) for n in range(count // 4 + 1)]
        levels = [unit for octet in packed for unit in (octet & 15, octet >> 4)]
        self.coming.extend(map(Unit, times, times[1:], levels, repeat(rate)))

    def next_end(self):
        """When a unit is over, or the silence behind the last one has lasted a symbol."""
        if self.is_silent or self.coming and self.coming[0].begin < self.heard_until + self.symbol:
            return self.coming[0].end if self.coming else NEVER
        return self.heard_until + self.symbol

    def take(self, now):
        """The unit that is over now; None for silence."""
        if not self.coming or self.coming[0].end > now:
            self.is_silent = True
            return None
        unit = self.coming.popleft()
        self.waiting.append(unit)
        self.heard_until, self.is_silent = unit.end, False
        if SYMBOLS[unit.levels] != SILENCE:
            if self.heard and self.heard[-1][1] == unit.begin:
                self.heard[-1][1] = unit.end
            else:
                self.heard.append([unit.begin, unit.end])
        return unit

    def has_shown(self, since, until):
        return any(begin <= until and since < end for begin, end in self.heard)

    def forget_before(self, instant):
        while self.heard and self.heard[0][1] < instant:
            self.heard.popleft()

    def pass_until(self, instant):
        """Units that begin by then, each once."""
        while self.waiting and self.waiting[0].begin <= instant:
            yield self.waiting.popleft()


class ChannelManager:
    make_selection = Selection

    def __init__(self, stream, settings, seed):
        del seed  # nothing is random
        self.stream, self.settings, self.now = stream, settings, 0
        self.power(False, 0)

    def power(self, is_on, now):
        self.is_on, self.now = is_on, now
        self.selection = self.make_selection(self.settings, (CHANNEL_A, CHANNEL_B), self.report)
        self.rules = self.selection.rules
        self.lines = [Line(self.rules.symbol) for _ in (MAC, CHANNEL_A, CHANNEL_B)]
        self.channels = list(zip(self.selection.channels, self.lines[CHANNEL_A:]))
        # Half a symbol less than the most is left for clocks that differ.
        most = self.settings["delay_symbols"] * self.rules.symbol - self.rules.symbol // 2
        self.request_delay = most
        self.undecided = DELIMITER_SYMBOLS * self.rules.symbol + self.rules.skew + self.rules.symbol // 4
        self.indication_delay = DELIMITER_SYMBOLS * self.rules.symbol + self.rules.skew + most

    def report(self, kind, port):
        self.stream.write(FAULT, port << 8 | kind, self.now)

    # ---- what is received ----

    def receive_levels(self, port, start, rate, count, packed):
        self.now = start
        self.advance(start - 1)
        if self.is_on:
            self.lines[port].add(start, rate, count, packed)

    def advance(self, now):
        """All that both channels show until now, and what becomes due meanwhile, in the order of time."""
        (first, first_line), (second, second_line) = self.channels
        while self.is_on:
            first_end, second_end = first_line.next_end(), second_line.next_end()
            end, due = min(first_end, second_end), self.selection.next_time()
            if min(end, due) > now:
                return
            if due < end:
                self.selection.on_time(due)
            elif end == first_end:
                self.take(first, first_line, end)
            else:
                self.take(second, second_line, end)

    def take(self, channel, line, now):
        unit = line.take(now)
        if unit:
            channel.take(SYMBOLS[unit.levels], unit.begin, unit.end)
        else:
            channel.fall_silent(line.heard_until)

    # ---- what is passed on ----

    def request(self, now):
        """What the MAC requests, to both channels."""
        line, due = self.lines[MAC], []
        if not line.coming or line.coming[0].begin + self.request_delay > now:
            return
        while line.coming and line.coming[0].end <= now:
            due.append(line.coming.popleft())
        for port in (CHANNEL_A, CHANNEL_B):
            self.transmit(port, due, self.request_delay)

    def indicate(self, now):
        """To the MAC, what is decided by now of what the channels have shown."""
        if self.next_indication() > now:
            return
        due = [unit for channel, line in self.channels for unit in line.pass_until(now - self.undecided)
               if SYMBOLS[unit.levels] != SILENCE and self.is_indicated(channel, unit)]
        self.transmit(MAC, sorted(due), self.indication_delay)
        self.selection.forget_before(now - self.indication_delay)
        for _, line in self.channels:
            line.forget_before(now - self.indication_delay - self.rules.skew)

    def is_indicated(self, channel, unit):
        if SYMBOLS[unit.levels] != ANSWER or channel is self.selection.preferred:
            return self.selection.is_indicated(channel, unit.begin, unit.end)
        # The same answer may come a skew earlier or later on the preferred channel.
        since, until = unit.begin - self.rules.skew, unit.begin + self.rules.skew
        return not self.lines[channel.other.port].has_shown(since, until)

    def transmit(self, port, units, delay):
        """In as few pieces as there are gaps."""
        piece = []
        for unit in units:
            if piece and (unit.begin != piece[-1].end or unit.rate != piece[-1].rate):
                self.transmit_piece(port, piece, delay)
                piece = []
            piece.append(unit)
        if piece:
            self.transmit_piece(port, piece, delay)

    def transmit_piece(self, port, units, delay):
        packed = bytearray((len(units) + 1) // 2)
        for n, unit in enumerate(units):
            packed[n >> 1] |= unit.levels << (n & 1) * 4
        self.stream.transmit_levels(port, units[0].begin + delay, units[0].rate, 4 * len(units), bytes(packed))

    # ---- time ----

    def on_time(self, now):
        self.now = now
        self.advance(now)
        if self.is_on:
            self.request(now)
            self.indicate(now)

    def next_indication(self):
        begins = [line.waiting[0].begin for _, line in self.channels if line.waiting]
        return min(begins) + self.indication_delay if begins else NEVER

    def next_time(self):
        if not self.is_on:
            return NEVER
        requests = self.lines[MAC].coming
        request = requests[0].begin + self.request_delay if requests else NEVER
        end = min(line.next_end() for _, line in self.channels)
        look = end + self.settings["delay_symbols"] * self.rules.symbol if end != NEVER else NEVER
        return min(request, self.next_indication(), look, self.selection.next_time())


if __name__ == "__main__":
    from channel_manager_faults import FAULTS

    serve("channel_manager", implementation(FAULTS, ChannelManager))

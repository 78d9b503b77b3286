#!/usr/bin/env python3
"""An INTERBUS slave that hears levels: fieldproof run 'interbus/slave/**' --iut 'exec:python3 slave.py'

What a slave does with its telegrams is in slave_telegrams.py; here is how it finds them in levels."""
import struct
import sys

from slave_telegrams import CONTROL, DATA, NEVER, SECOND, SELECT, TRANSMIT_LEVELS, UPSTREAM
from slave_telegrams import Slave, Stream, serve


class Receiver:
    """Finds telegrams on one line: an edge to 0, then samples in the middle of each bit."""
    def __init__(self, bit, flag_place, flag_level):
        self.bit, self.flag_place, self.flag_level = bit, flag_place, flag_level
        self.waves, self.at = [], 0

    def add(self, start, rate, count, packed):
        self.waves = [wave for wave in self.waves if wave[0] + wave[2] * SECOND // wave[1] > self.at]
        self.waves.append((start, rate, count, packed))

    def level(self, time):
        for start, rate, count, packed in self.waves:
            n = (time - start) * rate // SECOND
            if 0 <= n < count:
                return packed[n >> 3] >> (n & 7) & 1
        return 1  # idle

    def next_edge(self):
        """The first fall to 0 at or after self.at."""
        for start, rate, count, packed in self.waves:
            n = max(0, -(-(self.at - start) * rate // SECOND))
            while n < count:
                if not packed[n >> 3] >> (n & 7) & 1:
                    time = start + n * SECOND // rate
                    if time >= self.at and self.level(time - 1):
                        return time
                n += 1
        return NEVER

    def heard_until(self):
        start, rate, count, _ = self.waves[-1]
        return start + count * SECOND // rate

    def telegrams(self, now):
        """(start, levels after the start level) of each one that is whole, or over, by `now`."""
        while self.waves and (edge := self.next_edge()) != NEVER:
            known = max(now, self.heard_until())
            sample = lambda n: self.level(edge + self.bit // 2 + n * self.bit)
            if sample(0):  # no start bit
                self.at = edge + self.bit // 2
                continue
            has_header = known >= edge + 4 * self.bit
            count = 12 if has_header and sample(1 + self.flag_place) == self.flag_level else 4
            if known < edge + (count + 1) * self.bit:
                return
            levels = [sample(n) for n in range(1, count + 1)]
            # Behind a missing stop level the next edge counts.
            self.at = edge + count * self.bit + self.bit // 2
            yield edge, levels

    def pending(self):
        edge = self.next_edge() if self.waves else NEVER
        return edge + 13 * self.bit if edge != NEVER else NEVER


class LevelSlave(Slave):
    unit, name = 2, b"slave in Python"

    def __init__(self, stream, settings):
        super().__init__(stream, settings)
        flag = settings["flag_place"], settings["data_flag_level"]
        self.receivers = [Receiver(self.bit, *flag) for _ in range(3)]
        self.header = [(settings["select_place"], settings["select_level"], SELECT),
                       (settings["control_place"], settings["control_level"], CONTROL), (*flag, DATA)]

    # ---- levels and telegrams ----

    def octet_bits(self):
        return range(7, -1, -1) if self.s["most_significant_first"] else range(8)

    def telegram(self, levels):
        telegram = sum(bit for place, level, bit in self.header if levels[place] == level)
        if telegram & DATA:
            telegram |= sum(level << bit for level, bit in zip(levels[3:11], self.octet_bits()))
        return telegram

    def levels(self, telegram):
        levels = [0] * 4
        for place, level, bit in self.header:
            levels[1 + place] = level if telegram & bit else 1 - level
        if telegram & DATA:
            levels += [telegram >> bit & 1 for bit in self.octet_bits()]
        return levels + [1]

    def say(self, port, start, telegram):
        levels = self.levels(telegram)
        octets = (len(levels) + 7) // 8
        value = sum(level << n for n, level in enumerate(levels))
        self.stream.send(TRANSMIT_LEVELS, f"BqqI{octets}s", port, start, self.s["bit_rate"], len(levels),
                         value.to_bytes(octets, "little"))

    def hear(self, message):
        port, start, rate, count = struct.unpack_from("<xBqqI", message)
        self.now = start
        self.receivers[port].add(start, rate, count, message[22:])
        self.take_known(port)

    def take_known(self, port):
        for start, levels in self.receivers[port].telegrams(self.now):
            self.take(port, start, self.telegram(levels), levels[-1])

    # ---- time ----

    def on_time(self, now):
        self.now = now
        for port in range(3):
            self.take_known(port)
        # A telegram that has begun is no silence any more.
        if now >= self.silence_ends() and self.receivers[UPSTREAM].pending() == NEVER:
            self.reset()

    def next_time(self):
        return min([self.silence_ends()] + [receiver.pending() for receiver in self.receivers])


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), LevelSlave)

#!/usr/bin/env python3
"""An INTERBUS master that hears telegrams:
fieldproof run 'interbus/master/**' --iut 'exec:python3 master_telegrams.py'

What a master does with its cycles is in master.py; here is how it says them and hears what comes back."""
import struct
import sys

from master import LINE, CHARACTERS, Frame, Master, Stream, serve

SELECT, CONTROL, DATA = 0x100, 0x200, 0x400  # bits of a telegram, above its octet
STOP_MISSING = 2  # flag of one that was heard


class ReturnedTelegrams:
    """What has come back. It is reported when a transmission begins, telegrams of the future with it."""
    def __init__(self):
        self.heard = []

    def add(self, message):
        count = struct.unpack_from("<xxxxxxxxxxH", message)[0]
        self.heard += struct.iter_unpack("<qqHB", message[12:12 + 19 * count])

    def telegrams(self, until):
        """(start, (is ID, is check), octet or None, has stop level) of those that have ended by `until`."""
        known, self.heard = ([one for one in self.heard if is_known == (one[1] <= until)]
                             for is_known in (True, False))
        for start, _, telegram, flags in known:
            kind = int(telegram & SELECT != 0), int(telegram & CONTROL != 0)
            yield start, kind, telegram & 0xFF if telegram & DATA else None, not flags & STOP_MISSING

    def forget(self):
        pass  # what was told is gone


class TelegramMaster(Master):
    unit, name = 3, b"master in Python, of telegrams"
    most_at_once = 1000  # status telegrams of a call

    def __init__(self, stream, settings):
        super().__init__(stream, settings, Frame(settings), ReturnedTelegrams())
        self.pause_at, self.pause_left = 0, 0

    def transmit(self, start, telegram):
        self.stream.send(CHARACTERS, "BqHH", LINE, start, 1, telegram)

    def drive(self, now, telegrams, pause):
        """A cycle and the status telegrams after it."""
        bit = self.coding.bit
        for n, (is_check, octet) in enumerate(telegrams):
            kind = DATA | (SELECT if self.is_id else 0) | (CONTROL if is_check else 0)
            self.transmit(now + self.coding.place(n) * bit, kind | octet)
        self.pause_at, self.pause_left = now + self.coding.place(len(telegrams)) * bit, pause
        self.go_on_with_pause()

    def go_on_with_pause(self):
        count = min(self.pause_left, self.most_at_once)
        for _ in range(count):
            self.transmit(self.pause_at, 0)
            self.pause_at += self.s["status_pitch_bits"] * self.coding.bit
        self.pause_left -= count

    def hear(self, message):
        self.returned.add(message)

    # ---- time ----

    def on_time(self, now):
        if self.pause_left and now >= self.pause_at:
            self.go_on_with_pause()
        super().on_time(now)

    def next_time(self):
        return min(self.pause_at, super().next_time()) if self.pause_left else super().next_time()


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), TelegramMaster)

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A basic station of ISA-D: fieldproof run 'fieldbus_dll/isa_dle/**' --iut 'exec:python3 dle.py'

harness/iut/README.md describes the messages, protocols/fieldbus_dll/README.md the station; messages and frames are those
of examples/ff_device. --fault NAME gives it a fault of dle_faults.py, --units levels makes it receive levels."""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent.parent / "ff_device"))

from link_end import LinkEnd
from messages import EVENT, NEVER, REFUSED, USER, run

SUBMIT, DELIVERED = 1, 1
UNIT, COMPEL, FOR_COMPEL = range(3)  # services
REPLY_MISSING, TOKEN_DROPPED = 0, 1  # events
FINAL, PRIORITY = 4, 3  # bits of a first octet
NOTHING, NO_TIME, SINGLE_FRAME = range(3)  # why a token is returned
WORKED_OUT = 16  # item, and a priority


class Station(LinkEnd):
    def __init__(self, stream, settings):
        super().__init__(stream, settings)
        self.address = settings["address"]
        self.forget()

    def forget(self):
        self.queues = {priority: [] for priority in (3, 2, 1)}  # what goes under a token
        self.replies = {priority: [] for priority in (3, 2, 1)}  # what is compelled
        self.end_all()

    def end_all(self):
        self.token = self.awaited = self.compelled = None

    def is_address(self, octet):
        return self.s["first_address"] <= octet <= self.s["last_address"]

    # ---- the user ----

    def ask(self, request, now):
        self.now = now
        if request[0] != SUBMIT or len(request) < 4 or not self.submit(*request[1:4], request[4:]):
            self.stream.write(REFUSED, 1, now)

    def submit(self, service, priority, to, data):
        if priority not in self.queues or len(data) > self.s[f"most_data_{priority}"]:
            return False
        if service == FOR_COMPEL:
            self.replies[priority].append(data)
        elif service == UNIT and (self.is_address(to) or to == self.s["everybody"]):
            self.queues[priority].append(self.dlpdu("du", priority, to) + data)
        elif service == COMPEL and self.is_address(to) and not data:
            self.queues[priority].append(self.dlpdu("cd", priority, to))
        else:
            return False
        return True

    def dlpdu(self, kind, bits, to):
        return bytes([self.code[kind] | bits, to, self.address])

    # ---- what is heard ----

    def kind_of(self, octets):
        """What these octets are; None when they are nothing."""
        if len(octets) < 3 or not self.is_address(octets[2]):
            return None
        first, size = octets[0], len(octets)
        exact = {"ee": (FINAL, 4), "tl": (0, 5)}
        for kind, (bits, length) in exact.items():
            if first == self.code[kind] | bits:
                is_known = size == length and (kind == "tl" or octets[3] <= SINGLE_FRAME)
                return kind if is_known and self.is_address(octets[1]) else None
        bits_of = {"cd": PRIORITY, "dt": FINAL | PRIORITY, "du": FINAL | PRIORITY, "et": PRIORITY, "es": PRIORITY}
        for kind, bits in bits_of.items():
            if first & ~bits != self.code[kind] or not first & PRIORITY:
                continue
            if not self.is_address(octets[1]) and (kind != "du" or octets[1] != self.s["everybody"]):
                return None
            most = {"cd": 0, "et": 0, "es": 2}.get(kind, self.s[f"most_data_{first & PRIORITY}"])
            if kind == "es" and octets[3:] == b"\0\0":
                return None
            return kind if (2 if kind == "es" else 0) <= size - 3 <= most else None
        return None

    def take(self, octets):
        kind = self.kind_of(octets)
        if kind is None:
            return
        to, source = octets[1], octets[2]
        self.compelled = None
        if self.awaited:
            is_reply = kind == "dt" and to == self.address and source == self.awaited[0]
            self.awaited = None
            if not is_reply:
                self.token = None
                self.stream.write(EVENT, TOKEN_DROPPED | source << 8, self.now)
                return
        if kind in ("et", "es", "tl"):  # of a scheduler: the token was taken back
            self.token = None
        if to == self.address or kind == "du" and to == self.s["everybody"]:
            getattr(self, "on_" + kind, lambda octets: None)(octets)

    def on_dt(self, octets):
        self.stream.send_octets(USER, self.now, bytes([DELIVERED]) + octets)

    on_du = on_dt

    def on_et(self, octets):
        self.token = octets[0] & PRIORITY, octets[2], None
        self.is_single_done = False

    def on_es(self, octets):
        self.token = octets[0] & PRIORITY, octets[2], self.now + int.from_bytes(octets[3:5], "big") * self.octet

    def on_cd(self, octets):
        if not self.token:
            self.compelled = octets[0] & PRIORITY, octets[2], self.now + self.octets("reply_forming")
            self.is_worked_out = None  # not asked yet

    # ---- what is sent ----

    def next_of(self, queues, least):
        return next((queues[one] for one in (3, 2, 1) if one >= least and queues[one]), None)

    def reply(self):
        least, to, until = self.compelled
        if self.may_begin() > self.now or until < self.now:
            self.compelled = None if until <= self.now else self.compelled
            return
        queue = self.next_of(self.replies, least)
        if not queue:
            if self.is_worked_out is None:
                self.is_worked_out = self.stream.read(WORKED_OUT + least, self.now) == 1
            if self.is_worked_out:
                self.compelled = None if until <= self.now else self.compelled
                return
        priority = next(one for one in (3, 2, 1) if self.replies[one] is queue) if queue else least
        self.compelled = None
        self.drive(self.dlpdu("dt", FINAL | priority, to) + (queue.pop(0) if queue else b""))

    def time_after(self, octets):
        """What has to fit after this frame under a token for a duration."""
        time = self.octets("inter_pdu_delay") + self.time_of(bytes(4))
        if octets[0] & ~PRIORITY == self.code["cd"]:
            time += self.octets("reply_wait") + self.time_of(bytes(3 + self.s[f"most_data_{octets[0] & PRIORITY}"]))
        return time

    def use_token(self):
        least, to, ends = self.token
        if ends is not None and ends <= self.now:
            self.token = None
        elif self.may_begin() <= self.now:
            queue = self.next_of(self.queues, least)
            is_single_done = ends is None and self.is_single_done
            if queue and not is_single_done and (
                    ends is None or self.now + self.time_of(queue[0]) + self.time_after(queue[0]) <= ends):
                frame = queue.pop(0)
                self.is_single_done = True
                self.drive(frame)
                if frame[0] & ~PRIORITY == self.code["cd"]:
                    self.awaited = frame[1], self.driven_until + self.octets("reply_wait")
                return
            reason = SINGLE_FRAME if is_single_done else NO_TIME if queue else NOTHING
            if ends is None or self.now + self.time_of(bytes(4)) <= ends:
                self.drive(self.dlpdu("ee", FINAL, to) + bytes([reason]))
            self.token = None

    def on_time(self, now):
        self.now = now
        if self.awaited:
            if self.awaited[1] <= now and not self.is_active:
                self.stream.write(EVENT, REPLY_MISSING | self.awaited[0] << 8, now)
                self.awaited = None
        if self.compelled:
            self.reply()
        elif self.token and not self.awaited:
            self.use_token()

    def next_time(self):
        if self.awaited:
            return NEVER if self.is_active else self.awaited[1]
        if self.compelled:
            return self.compelled[2] if self.is_worked_out and not self.next_of(self.replies, self.compelled[0]) else min(
                self.may_begin(), self.compelled[2])
        if self.token:
            return min(self.may_begin(), NEVER if self.token[2] is None else self.token[2])
        return NEVER


if __name__ == "__main__":
    from dle_faults import FAULTS

    run(__file__, "isa_dle", "Station", FAULTS)

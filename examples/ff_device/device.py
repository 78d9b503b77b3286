#!/usr/bin/env python3
"""A basic device of Foundation Fieldbus, profile FF-P, that hears frames:
fieldproof run 'fieldbus_dll/ff_device/**' --iut 'exec:python3 device.py'

harness/iut/README.md describes the messages, protocols/fieldbus_dll/README.md the device."""
from messages import EVENT, NEVER, REFUSED, SECOND, USER, run

SUBMIT, WRITE_BUFFER = b"\1", b"\2"  # what the user asks for
DATA, PUBLISHED = 1, 2  # what the user is told
ACTIVATED = 0  # an event
LONG, FINAL, PRIORITY = 8, 4, 3  # bits of a first octet
UNKNOWN_ADDRESS, NOTHING_WRITTEN = 0, 1  # why there is no buffer
ACTIVATION = 1  # of the entities' own messages
EVERYBODY = 0xFFFF


class Device:
    def __init__(self, stream, settings):
        self.stream, self.s, self.now = stream, settings, 0
        self.octet = 8 * SECOND // settings["bit_rate"]
        self.node = settings["node"]
        self.code = {key[5:]: value for key, value in settings.items() if key.startswith("code_")}
        self.buffers = {settings[f"published_{n}"]: [None, 0] for n in range(settings["published"])}
        self.subscribed = [settings[f"subscribed_{n}"] for n in range(settings["subscribed"])]
        self.queues = {priority: [] for priority in (3, 2, 1)}
        self.is_on = self.is_live = self.is_active = False
        self.heard_until = self.driven_until = 0
        self.token = self.answer = None

    # ---- the line ----

    def time_of(self, octets):
        """Of a frame around these octets: preamble, two delimiters, the check."""
        return (len(octets) + 2 + self.s["preamble_octets"] + 2) * self.octet

    def may_begin(self):
        if self.is_active:
            return NEVER
        return max(self.heard_until, self.driven_until) + self.s["inter_pdu_delay_octets"] * self.octet

    def drive(self, octets):
        self.driven_until = self.now + self.time_of(octets)
        self.stream.drive(self.now, octets, self.s)

    def on_activity(self, is_active, now):
        self.now, self.is_active = now, is_active
        if not is_active:
            self.heard_until = now

    def hear(self, octets, begin, now):
        self.now = now
        if self.is_on and begin >= self.driven_until:
            self.take(octets)

    # ---- the user ----

    def ask(self, request, now):
        self.now = now
        service, content = request[:1], request[1:]
        if not (service == SUBMIT and self.submit(content) or service == WRITE_BUFFER and self.write(content)):
            self.stream.write(REFUSED, 1, now)

    def submit(self, content):
        if len(content) < 5 or content[0] not in self.queues or len(content) - 5 > self.s[f"most_data_{content[0]}"]:
            return False
        self.queues[content[0]].append(self.dt1(content[0], int.from_bytes(content[1:5], "big"), content[5:]))
        return True

    def write(self, content):
        buffer, data = self.buffers.get(int.from_bytes(content[:4], "big")), content[4:]
        if len(content) < 4 or buffer is None or len(data) > self.s["most_data_3"]:
            return False
        buffer[:] = data, (buffer[1] + 1) % 256
        return True

    def dt1(self, priority, to, data):
        source = self.node << 8 | 1 | to & 0xFFFF0000
        size, is_long = (4, LONG) if to > 0xFFFF else (2, 0)
        head = bytes([self.code["dt1"] | priority | is_long])
        return head + to.to_bytes(size, "big") + source.to_bytes(size, "big") + data

    # ---- what is heard ----

    def take(self, octets):
        kind = self.kind_of(octets)
        if kind is None:
            return
        self.answer = None
        if kind in ("cd", "pt", "pn", "td", "cl", "tl"):  # of a scheduler: the token was taken back
            self.token = None
        getattr(self, "on_" + kind, lambda octets: None)(octets)

    def kind_of(self, octets):
        """What these octets are; None when they are nothing."""
        sizes = {"sr": 2, "rt": 1, "ri": 3, "pn": 2, "pr": 2, "td": 7, "ct": 2, "cl": 2, "tl": 4, "idle": 1}
        first, code, size = octets[0], self.code, len(octets)
        for kind, exact in sizes.items():
            if first & ~(FINAL if kind == "sr" else 0) == code[kind]:
                if kind == "ri" and octets[1:3] == b"\0\0" or kind == "sr" and octets[1:] > b"\1":
                    return None
                return kind if size == exact else None
        if not first & PRIORITY:
            return None
        if first & ~(FINAL | PRIORITY) == code["pt"]:
            return "pt" if size == 4 and octets[2:] != b"\0\0" else None
        size_of_address = 4 if first & LONG else 2
        addresses = {"cd": 1, "dt1": 2, "dt3": 1}
        for kind, count in addresses.items():
            if first & ~(LONG | FINAL | PRIORITY) != code[kind]:
                continue
            behind = 1 + count * size_of_address + (kind == "dt3")
            if size < behind or kind == "cd" and size != behind:
                return None
            if kind != "cd" and size - behind > self.s[f"most_data_{first & PRIORITY}"]:
                return None
            # A long address is one that needs it.
            is_long = [octets[1 + 4 * n:3 + 4 * n] != b"\0\0" for n in range(count)]
            return kind if not first & LONG or all(is_long) else None
        return None

    def address(self, octets, n=0):
        size = 4 if octets[0] & LONG else 2
        return int.from_bytes(octets[1 + n * size:1 + (n + 1) * size], "big")

    def on_pn(self, octets):
        if octets[1] == self.node:
            self.reply(bytes([self.code["pr"], self.node]))

    def on_pt(self, octets):
        if self.is_live and octets[1] == self.node:
            duration = int.from_bytes(octets[2:4], "big")
            self.token = (octets[0] & PRIORITY, self.now + duration * self.octet)

    def on_cd(self, octets):
        address = self.address(octets)
        if not self.is_live or address >> 8 & 0xFF != self.node:
            return
        data, writes = self.buffers.get(address, (None, 0))
        if data is None:
            reason = NOTHING_WRITTEN if address in self.buffers else UNKNOWN_ADDRESS
            self.reply(bytes([self.code["sr"] | FINAL, reason]))
        else:
            size, is_long = (4, LONG) if address > 0xFFFF else (2, 0)
            head = bytes([self.code["dt3"] | FINAL | octets[0] & PRIORITY | is_long])
            self.reply(head + address.to_bytes(size, "big") + bytes([writes]) + data)

    def on_dt1(self, octets):
        to, source = self.address(octets), self.address(octets, 1)
        if to != EVERYBODY and to >> 8 & 0xFF != self.node:
            return
        if octets[0] & LONG and not self.s["supports_long_addresses"]:
            return
        data = octets[9 if octets[0] & LONG else 5:]
        is_for_entity = (to == EVERYBODY or to & 0xFF == 0) and source & 0xFF == 0 and data
        if not is_for_entity:
            self.stream.send_octets(USER, self.now, bytes([DATA]) + octets)
        elif data[0] == ACTIVATION and not self.is_live and to != EVERYBODY:
            self.is_live = True
            self.stream.write(EVENT, ACTIVATED | self.node << 8, self.now)

    def on_dt3(self, octets):
        if self.address(octets) in self.subscribed:
            self.stream.send_octets(USER, self.now, bytes([PUBLISHED]) + octets)

    # ---- what is sent ----

    def reply(self, octets):
        delay = self.s["response_delay_slots"] * self.s["slot_time_octets"] * self.octet
        self.answer = (octets, self.now + delay)

    def next_frame(self, least):
        """The priority of what goes next under a token of this priority."""
        return next((one for one in (3, 2, 1) if one >= least and self.queues[one]), None)

    def use_token(self):
        least, ends = self.token
        if ends <= self.now:
            self.token = None
        elif self.may_begin() <= self.now:
            fits = lambda octets, begin: begin + self.time_of(octets) <= ends
            priority = self.next_frame(least)
            if priority and fits(self.queues[priority][0], self.now):
                frame = self.queues[priority].pop(0)
                behind = self.now + self.time_of(frame) + self.s["inter_pdu_delay_octets"] * self.octet
                following = self.next_frame(least)
                is_last = not following or not fits(self.queues[following][0], behind)
                is_final = is_last and self.s["returns_with_last_data"]
                self.drive(bytes([frame[0] | (FINAL if is_final else 0)]) + frame[1:])
                if not is_final:
                    return
            elif fits(bytes(1), self.now):
                self.drive(bytes([self.code["rt"]]))
            self.token = None

    def on_time(self, now):
        self.now = now
        if self.answer:
            octets, until = self.answer
            if self.may_begin() <= now or until <= now:
                self.answer = None
                if self.may_begin() <= now:
                    self.drive(octets)
        elif self.token:
            self.use_token()

    def next_time(self):
        if self.answer or self.token:
            return min(self.may_begin(), (self.answer or self.token)[1])
        return NEVER

    def power(self, is_on, now):
        self.now, s = now, self.s
        if not is_on:  # what it knew is gone
            self.buffers = {address: [None, 0] for address in self.buffers}
            self.queues = {priority: [] for priority in (3, 2, 1)}
            self.is_live, self.token, self.answer = False, None, None
        least_gap, slot = s["inter_pdu_delay_octets"], s["slot_time_octets"]
        self.is_on = is_on and least_gap <= min(120, (s["response_delay_slots"] - 1) * slot)
        if is_on and not self.is_on:
            self.stream.write(REFUSED, 1, now)


if __name__ == "__main__":
    from device_faults import FAULTS

    run(__file__, "ff_device", "Device", FAULTS)

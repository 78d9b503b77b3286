#!/usr/bin/env python3
"""A basic device of Foundation Fieldbus, profile FF-P, that hears frames:
fieldproof run 'fieldbus_dll/ff_device/**' --iut 'exec:python3 device.py'

harness/iut/README.md describes the messages, protocols/fieldbus_dll/README.md the device."""
import struct
import sys

NEVER = 2**63 - 1
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_OCTETS, RECEIVE_LEVELS, ON_TIME = range(1, 8)
ACTIVITY = 10
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, OCTETS, TRANSMIT_LEVELS, WRITE = range(129, 136)
LINE, USER = 0, 2  # ports
ASKS_FOR_ACTIVITY = 1
REFUSED, EVENT = 0, 1  # items
SUBMIT, WRITE_BUFFER = 1, 2  # what the user asks for
DATA, PUBLISHED = 1, 2  # what the user is told
ACTIVATED = 0  # an event
LONG, FINAL, PRIORITY = 8, 4, 3  # bits of a first octet
UNKNOWN_ADDRESS, NOTHING_WRITTEN = 0, 1  # why there is no buffer
ACTIVATION = 1  # of the entities' own messages
EVERYBODY = 0xFFFF


def frame_check(octets):
    """CRC-16/PROFIBUS."""
    check = 0xFFFF
    for octet in octets:
        check ^= octet << 8
        for _ in range(8):
            check = (check << 1 ^ 0x1DCF if check & 0x8000 else check << 1) & 0xFFFF
    return struct.pack(">H", check ^ 0xFFFF)


class Stream:
    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        if kind not in (OCTETS, WRITE):  # behind these comes `done`
            self.sink.flush()

    def send_octets(self, port, when, octets):
        self.send(OCTETS, f"BqH{len(octets)}H", port, when, len(octets), *octets)


class Device:
    def __init__(self, stream, settings):
        self.stream, self.s, self.now = stream, settings, 0
        self.octet = 8 * 10**12 // settings["bit_rate"]
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
        self.stream.send_octets(LINE, self.now, octets + frame_check(octets))

    def on_activity(self, is_active, now):
        self.now, self.is_active = now, is_active
        if not is_active:
            self.heard_until = now

    def hear(self, message):
        port, self.now, count = struct.unpack_from("<xBqH", message)
        characters = [message[12 + 19 * n:31 + 19 * n] for n in range(count)]
        octets = bytes(character[16] for character in characters)
        if port == USER:
            self.ask(octets)
        elif self.is_on and octets[-2:] == frame_check(octets[:-2]) and len(octets) > 2:
            begin = struct.unpack("<q", characters[0][:8])[0]
            begin -= (self.s["preamble_octets"] + 1) * self.octet
            if begin >= self.driven_until:
                self.take(octets[:-2])

    # ---- the user ----

    def ask(self, request):
        is_taken = False
        if request[0] == SUBMIT:
            priority, to, data = request[1], request[2:6], request[6:]
            is_taken = len(data) <= self.s[f"most_data_{priority}"]
            if is_taken:
                self.queues[priority].append(self.dt1(priority, int.from_bytes(to, "big"), data))
        elif request[0] == WRITE_BUFFER:
            buffer, data = self.buffers.get(int.from_bytes(request[1:5], "big")), request[5:]
            is_taken = buffer is not None and len(data) <= self.s["most_data_3"]
            if is_taken:
                buffer[:] = data, (buffer[1] + 1) % 256
        if not is_taken:
            self.stream.send(WRITE, "HQq", REFUSED, 1, self.now)

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
            self.stream.send(WRITE, "HQq", EVENT, ACTIVATED | self.node << 8, self.now)

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
            self.stream.send(WRITE, "HQq", REFUSED, 1, now)


def text_at(content, at):
    end = at + 2 + struct.unpack_from("<H", content, at)[0]
    return content[at + 2:end].decode(), end


def case_of(content):
    """The id of a case and its settings."""
    name, at = text_at(content, 1)
    settings, count = {}, struct.unpack_from("<8xH", content, at)[0]
    at += 10
    for _ in range(count):
        key, at = text_at(content, at)
        settings[key] = struct.unpack_from("<q", content, at)[0]
        at += 8
    return name, settings


def serve(stream):
    device = None
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            name = b"basic device in Python"
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH12sH9sB", 3, 3, len(name), name,
                        1, 12, b"fieldbus_dll", 9, b"ff_device", ASKS_FOR_ACTIVITY)
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            name, settings = case_of(message)
            device = Device(stream, settings) if name.startswith("fieldbus_dll/ff_device/") else None
        elif kind == POWER:
            device.power(*struct.unpack("<x?q", message))
        elif kind == RECEIVE_OCTETS:
            device.hear(message)
        elif kind == ACTIVITY:
            device.on_activity(*struct.unpack("<xx?q", message))
        elif kind == ON_TIME:
            device.on_time(struct.unpack("<xq", message)[0])
        if device is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", device.next_time())


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer))

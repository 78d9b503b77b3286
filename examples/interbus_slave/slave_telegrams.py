#!/usr/bin/env python3
"""An INTERBUS slave that hears telegrams:
fieldproof run 'interbus/slave/**' --iut 'exec:python3 slave_telegrams.py'

harness/iut/README.md describes the messages, protocols/interbus/README.md the slave."""
import struct
import sys

NEVER = 2**63 - 1
SECOND = 10**12  # times are picoseconds
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_TELEGRAMS, RECEIVE_LEVELS, ON_TIME = range(1, 8)
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, TELEGRAMS, TRANSMIT_LEVELS, WRITE, READ = range(129, 137)
OUTPUT, INPUT, PERIPHERAL_FAULT, RECONFIGURATION, PLUGGED = 0, 0x100, 0x200, 0x201, {2: 0x202, 1: 0x203}
UPSTREAM, BRANCH, REMOTE = 0, 1, 2
SELECT, CONTROL, DATA = 0x100, 0x200, 0x400  # bits of a telegram, above its octet


class Stream:
    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        if kind not in (TELEGRAMS, TRANSMIT_LEVELS, WRITE):  # behind these comes `done`
            self.sink.flush()

    def read(self, item, when):
        self.send(READ, "Hq", item, when)
        return struct.unpack("<xQ", self.receive())[0]


class Slave:
    unit, name = 3, b"slave in Python, of telegrams"

    def __init__(self, stream, settings):
        self.stream, self.s = stream, settings
        self.bit = SECOND // settings["bit_rate"]
        self.phase, self.is_active, self.messages = "pause", False, 0
        self.on = self.forward = self.back = ()  # interfaces, for control, ways out and ways back
        self.is_switching, self.off_until = False, -1
        self.last, self.is_supervised, self.now = 0, False, 0
        self.driven_until = [0, 0, 0]

    # ---- the way of a telegram ----

    def next_port(self, source):
        ways = self.forward if source == UPSTREAM else self.back
        if source == UPSTREAM and BRANCH in ways:
            return BRANCH
        return REMOTE if source != REMOTE and REMOTE in ways else UPSTREAM

    def send_on(self, source, start, telegram):
        port = self.next_port(source)
        half_bits = self.s["forward_delay_half_bits"] if source == UPSTREAM else 0
        half_bits += self.s["return_delay_half_bits"] if port == UPSTREAM else 0
        # A telegram that came in parts is known late; behind a disturbed one it may come half a bit early.
        start = max(start + half_bits * self.bit // 2, self.now, self.driven_until[port])
        self.driven_until[port] = start + self.time_of(telegram)
        self.say(port, start, telegram)

    def say(self, port, start, telegram):
        self.stream.send(TELEGRAMS, "BqHH", port, start, 1, telegram)

    def time_of(self, telegram):
        return (13 if telegram & DATA else 5) * self.bit

    def hear(self, message):
        port, self.now, count = struct.unpack_from("<xBqH", message)
        for start, _, telegram, flags in struct.iter_unpack("<qqHB", message[12:12 + 19 * count]):
            self.take(port, start, telegram, not flags & 2)

    def take(self, port, start, telegram, stop):
        if port != UPSTREAM:
            if port in self.back:
                self.send_on(port, start, telegram)
            return
        if start >= self.silence_ends():
            self.reset()
        is_check = telegram & (DATA | CONTROL) == DATA | CONTROL
        if self.is_switching and not is_check:
            self.forward, self.is_switching = self.on, False
        self.last, self.is_supervised = start + self.time_of(telegram), True
        if telegram & DATA:
            take = self.check if is_check else self.transfer
            telegram = telegram & ~0xFF | take(telegram & SELECT, start, telegram & 0xFF, stop)
        self.send_on(UPSTREAM, start, telegram)

    # ---- the cycle ----

    def load(self, is_id, when):
        when = max(when, self.now)
        if not is_id:
            words = [self.stream.read(INPUT + n, when) for n in range(self.s["words"])]
        else:
            s = self.s
            self.messages &= ~(s["message_peripheral_fault"] | s["message_reconfiguration"])
            if self.stream.read(PERIPHERAL_FAULT, when):
                self.messages |= s["message_peripheral_fault"]
            if self.stream.read(RECONFIGURATION, when):
                self.messages |= s["message_reconfiguration"]
            words, self.messages_read = [s["id_code"] | self.messages], self.messages
        self.register = [octet for word in words for octet in (word >> 8, word & 0xFF)]
        self.length = len(self.register)

    def transfer(self, is_id, when, octet, stop):
        if self.phase != ("transfer", is_id):
            if self.phase != "pause":
                self.reject()
            self.back = self.on
            self.phase, self.is_wrong, self.received, self.sent = ("transfer", is_id), False, [], []
            self.load(is_id, when)
        self.is_wrong |= not stop
        self.register.append(octet)
        self.received.append(octet)
        self.sent.append(self.register.pop(0))
        return self.sent[-1]

    def check(self, is_id, when, octet, stop):
        if self.phase == ("transfer", is_id):
            self.phase, self.count, self.is_clean = ("check", is_id), 0, True
            self.is_wrong |= len(self.received) < self.length + 2
            self.expected, self.check_sent = self.crc(self.received), self.crc(self.sent)
        elif self.phase != ("check", is_id):
            if self.phase != "pause":
                self.reject()
            return octet
        n, self.count = self.count, self.count + 1
        if n < 2:
            self.is_wrong |= octet != self.expected[n] or not stop
            return self.check_sent[n]
        shift = 8 * (3 - n)
        self.is_clean &= octet == self.s["status_clean"] >> shift & 0xFF
        if self.is_wrong:
            octet |= self.s["status_marked"] >> shift & 0xFF
        self.is_wrong |= not stop  # the octet leaves before its stop level has come
        if n == 3:
            self.finish(is_id, when + 13 * self.bit)
        return octet

    def crc(self, octets):
        reflected, register = self.s["check_is_reflected"], self.s["check_preset"]
        turned = lambda value, bits: int(f"{value:0{bits}b}"[::-1], 2)
        for octet in octets:
            register ^= (turned(octet, 8) if reflected else octet) << 8
            for _ in range(8):
                carry, register = register & 0x8000, register << 1 & 0xFFFF
                register ^= self.s["check_polynomial"] if carry else 0
        value = (turned(register, 16) if reflected else register) ^ self.s["check_final_xor"]
        return [value & 0xFF, value >> 8] if reflected else [value >> 8, value & 0xFF]

    def reject(self):
        self.messages |= self.s["message_check_error"]
        self.phase = "pause"

    def finish(self, is_id, end):
        self.phase = "pause"
        if self.is_wrong:
            return self.reject()
        if not self.is_clean:
            return
        words = [self.register[n] << 8 | self.register[n + 1] for n in range(0, self.length, 2)]
        if is_id:
            self.is_active = True
            self.messages &= ~self.messages_read
            self.control(words[0], max(end, self.now))
        elif self.is_active:
            for n, word in enumerate(words):
                self.stream.send(WRITE, "HQq", OUTPUT + n, word, max(end, self.now))

    def control(self, word, when):
        s = self.s
        if word & s["control_acknowledge"]:
            self.messages = 0
        if word & s["control_reset"]:
            self.off_until = when + s["silence_limit"] + s["silence_tolerance"]
        bits = {REMOTE: s["control_remote_off"], BRANCH: s["control_local_off"]}
        ports = [REMOTE, BRANCH] if s["has_branch"] else [REMOTE]
        on = tuple(p for p in ports if when >= self.off_until and not word & bits[p]
                   and self.stream.read(PLUGGED[p], when))
        self.is_switching = on != self.on
        self.on = on

    # ---- time ----

    def silence_ends(self):
        return self.last + self.s["silence_limit"] if self.is_supervised else NEVER

    def next_time(self):
        # A telegram that has begun before may be told 13 bits later.
        return self.silence_ends() + 13 * self.bit if self.is_supervised else NEVER

    def on_time(self, now):
        self.now = now
        if now >= self.next_time():
            self.reset()

    def reset(self):
        self.is_supervised, self.is_active, self.phase = False, False, "pause"
        self.on = self.forward = self.back = ()
        self.is_switching = False
        self.clear()

    def clear(self):
        for n in range(self.s["words"]):
            self.stream.send(WRITE, "HQq", OUTPUT + n, 0, self.now)


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


def serve(stream, kind_of_slave):
    slave = None
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            name = kind_of_slave.name
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH8sH5s", 3, kind_of_slave.unit, len(name), name,
                        1, 8, b"interbus", 5, b"slave")
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            name, settings = case_of(message)
            slave = kind_of_slave(stream, settings) if name.startswith("interbus/") else None
        elif kind == POWER:
            is_on, now = struct.unpack("<x?q", message)
            if is_on:  # nothing outlasts the supply
                slave = kind_of_slave(stream, settings)
                slave.now = now
                slave.clear()
        elif kind in (RECEIVE_TELEGRAMS, RECEIVE_LEVELS):
            slave.hear(message)
        elif kind == ON_TIME:
            slave.on_time(struct.unpack("<xq", message)[0])
        if slave is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", slave.next_time())


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), Slave)

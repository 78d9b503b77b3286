#!/usr/bin/env python3
"""An INTERBUS slave, to be judged: fieldproof run 'interbus/slave/**' --iut 'exec:python3 slave.py'

harness/iut/README.md describes the messages, protocols/interbus/README.md the slave."""
import struct
import sys

NEVER = 2**63 - 1
SECOND = 10**12  # times are picoseconds
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_LEVELS, ON_TIME = 1, 2, 3, 4, 6, 7
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, TRANSMIT_LEVELS, WRITE, READ = 129, 130, 131, 132, 134, 135, 136
OUTPUT, INPUT, PERIPHERAL_FAULT, RECONFIGURATION, PLUGGED = 0, 0x100, 0x200, 0x201, {2: 0x202, 1: 0x203}
UPSTREAM, BRANCH, REMOTE = 0, 1, 2

class Stream:
    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        self.sink.flush()

    def read(self, item, when):
        self.send(READ, "Hq", item, when)
        return struct.unpack("<xQ", self.receive())[0]


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
        """The first fall to 0 at or behind self.at."""
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
        """(start, levels behind the start level) of each one that is whole, or over, by `now`."""
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


class Slave:
    def __init__(self, stream, settings):
        self.stream, self.s = stream, settings
        self.bit = SECOND // settings["bit_rate"]
        flag = settings["flag_place"], settings["data_flag_level"]
        self.receivers = [Receiver(self.bit, *flag) for _ in range(3)]
        self.phase, self.is_active, self.messages = "pause", False, 0
        self.on = self.forward = self.back = ()  # interfaces, for control, ways out and ways back
        self.is_switching, self.off_until = False, -1
        self.last, self.is_supervised, self.now = 0, False, 0

    # ---- the way of a telegram ----

    def next_port(self, source):
        ways = self.forward if source == UPSTREAM else self.back
        if source == UPSTREAM and BRANCH in ways:
            return BRANCH
        return REMOTE if source != REMOTE and REMOTE in ways else UPSTREAM

    def send_on(self, source, start, levels):
        port = self.next_port(source)
        half_bits = self.s["forward_delay_half_bits"] if source == UPSTREAM else 0
        half_bits += self.s["return_delay_half_bits"] if port == UPSTREAM else 0
        value = sum(level << n for n, level in enumerate([0] + levels[:-1] + [1]))
        octets = (len(levels) + 8) // 8
        # A telegram that came in parts is known late.
        start = max(self.now, start + half_bits * self.bit // 2)
        self.stream.send(TRANSMIT_LEVELS, f"BqqI{octets}s", port, start, self.s["bit_rate"], len(levels) + 1,
                         value.to_bytes(octets, "little"))

    def octet(self, levels):
        bits = levels[3:11] if self.s["most_significant_first"] else levels[10:2:-1]
        return sum(bit << (7 - n) for n, bit in enumerate(bits))

    def with_octet(self, levels, octet):
        bits = [octet >> (7 - n) & 1 for n in range(8)]
        return levels[:3] + (bits if self.s["most_significant_first"] else bits[::-1]) + [1]

    def receive(self, port, start, rate, count, packed):
        self.receivers[port].add(start, rate, count, packed)
        self.take(port, start)

    def take(self, port, now):
        self.now = now
        for start, levels in self.receivers[port].telegrams(now):
            if port != UPSTREAM:
                if port in self.back:
                    self.send_on(port, start, levels)
                continue
            is_data = len(levels) == 12
            is_check = is_data and levels[self.s["control_place"]] == self.s["control_level"]
            if self.is_switching and not is_check:
                self.forward, self.is_switching = self.on, False
            self.last, self.is_supervised = start + (len(levels) + 1) * self.bit, True
            if is_data:
                is_id = levels[self.s["select_place"]] == self.s["select_level"]
                take = self.check if is_check else self.transfer
                octet = take(is_id, start, self.octet(levels), levels[-1])
                levels = self.with_octet(levels, octet)
            self.send_on(UPSTREAM, start, levels)

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
        self.is_wrong |= not stop
        n, self.count = self.count, self.count + 1
        if n < 2:
            self.is_wrong |= octet != self.expected[n]
            return self.check_sent[n]
        shift = 8 * (3 - n)
        self.is_clean &= octet == self.s["status_clean"] >> shift & 0xFF
        if self.is_wrong:
            octet |= self.s["status_marked"] >> shift & 0xFF
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
            self.control(words[0], end)
        elif self.is_active:
            for n, word in enumerate(words):
                self.stream.send(WRITE, "HQq", OUTPUT + n, word, end)

    def control(self, word, when):
        s = self.s
        if word & s["control_acknowledge"]:
            self.messages = 0
        if word & s["control_reset"]:
            self.off_until = when + 1000 * (s["silence_limit_ns"] + s["silence_tolerance_ns"])
        bits = {REMOTE: s["control_remote_off"], BRANCH: s["control_local_off"]}
        ports = [REMOTE, BRANCH] if s["has_branch"] else [REMOTE]
        on = tuple(p for p in ports if when >= self.off_until and not word & bits[p]
                   and self.stream.read(PLUGGED[p], when))
        self.is_switching = on != self.on
        self.on = on

    # ---- time ----

    def silence_ends(self):
        return self.last + 1000 * self.s["silence_limit_ns"] if self.is_supervised else NEVER

    def on_time(self, now):
        for port in range(3):
            self.take(port, now)
        if now >= self.silence_ends() and self.receivers[UPSTREAM].pending() == NEVER:
            self.is_supervised, self.is_active, self.phase = False, False, "pause"
            self.on = self.forward = self.back = ()
            self.clear(now)

    def clear(self, now):
        for n in range(self.s["words"]):
            self.stream.send(WRITE, "HQq", OUTPUT + n, 0, now)

    def next_time(self):
        return min([self.silence_ends()] + [receiver.pending() for receiver in self.receivers])


def text_at(content, at):
    end = at + 2 + struct.unpack_from("<H", content, at)[0]
    return content[at + 2:end].decode(), end


def slave_for(stream, content):
    name, at = text_at(content, 1)
    settings, count = {}, struct.unpack_from("<8xH", content, at)[0]
    at += 10
    for _ in range(count):
        key, at = text_at(content, at)
        settings[key] = struct.unpack_from("<q", content, at)[0]
        at += 8
    return Slave(stream, settings) if name.startswith("interbus/") else None


def serve(stream):
    slave = None
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            stream.send(CAPABILITIES, "HBH15s", 1, 2, 15, b"slave in Python")
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            slave = slave_for(stream, message)
        elif kind == POWER:
            is_on, now = struct.unpack("<x?q", message)
            if is_on:
                slave.clear(now)
        elif kind == RECEIVE_LEVELS:
            port, start, rate, count = struct.unpack_from("<xBqqI", message)
            slave.receive(port, start, rate, count, message[22:])
        elif kind == ON_TIME:
            slave.on_time(struct.unpack("<xq", message)[0])
        if slave is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", slave.next_time())


serve(Stream(sys.stdin.buffer, sys.stdout.buffer))

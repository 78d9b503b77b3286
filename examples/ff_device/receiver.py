#!/usr/bin/env python3
"""A basic device with a receiver: fieldproof run 'fieldbus_dll/ff_device/**' --iut 'exec:python3 receiver.py'

harness/iut/README.md describes the messages, protocols/fieldbus_dll/README.md the device."""
import struct
import sys
from collections import deque
from itertools import groupby

NEVER = 2**63 - 1
SECOND = 10**12  # times are picoseconds
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_CHARACTERS, RECEIVE_LEVELS, ON_TIME = range(1, 8)
ACTIVITY = 10
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, TRANSMIT_LEVELS, WRITE = range(129, 136)
LINE, USER = 0, 2
ASKS_FOR_ACTIVITY = 1
SUBMIT, WRITE_BUFFER = 1, 2
DATA, PUBLISHED = 1, 2
REFUSED, EVENT = 0, 1
ACTIVATED = 0
LEVELS_UNIT = 2

PRIORITY, FINAL, LONG = 0x03, 0x04, 0x08
EVERYBODY, ENTITY = 0xFFFF, 0
UNKNOWN_ADDRESS, NOTHING_WRITTEN = 0, 1
STOPPED, OFFLINE, IDLE, HOLDING, REPLYING = range(5)

# Half bits. A 1 falls in its middle; symbols without an edge there are no data, and delimit frames.
PREAMBLE = "1001100110011001"
START_DELIMITER = "1011001001001101"
END_DELIMITER = "1011001100100110"
BIT_OF = {"10": "1", "01": "0"}
HALVES_OF = [f"{octet:08b}".replace("1", "x").replace("0", "01").replace("x", "10") for octet in range(256)]


class Stream:
    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        if kind not in (WRITE, CHARACTERS, TRANSMIT_LEVELS):
            self.sink.flush()


# ---- frames ----

def shifted(register):
    for _ in range(8):
        register = register << 1 ^ (0x1DCF if register & 0x8000 else 0)
    return register & 0xFFFF


CHECK_TABLE = [shifted(high << 8) for high in range(256)]


def check_of(octets):
    register = 0xFFFF
    for octet in octets:
        register = register << 8 & 0xFFFF ^ CHECK_TABLE[register >> 8 ^ octet]
    return (register ^ 0xFFFF).to_bytes(2, "big")


def half_bits_of_frame(octets, preamble_octets):
    content = "".join(HALVES_OF[octet] for octet in octets + check_of(octets))
    return PREAMBLE * preamble_octets + START_DELIMITER + content + END_DELIMITER


def half_bits_in(rate, count, packed, bit_rate):
    levels = f"{int.from_bytes(packed, 'little'):0{count}b}"[::-1][:count]
    if rate == 2 * bit_rate:
        return levels
    # Each edge is a border of half bits: the clock is recovered from one to the next.
    runs = ((level, len(list(run))) for level, run in groupby(levels))
    return "".join(level * ((4 * length * bit_rate + rate) // (2 * rate)) for level, length in runs)


def frames_in(half_bits):
    """Octets of all frames that end as they should and whose check fits, without it."""
    at = half_bits.find(START_DELIMITER)
    while at >= 0:
        at += len(START_DELIMITER)
        bits = []
        while not half_bits.startswith(END_DELIMITER, at):
            bit = BIT_OF.get(half_bits[at:at + 2])
            if bit is None or half_bits.startswith(START_DELIMITER, at):
                break
            bits.append(bit)
            at += 2
        else:
            octets = int("0" + "".join(bits), 2).to_bytes(len(bits) // 8 + 1, "big")[1:]
            if len(bits) % 8 == 0 and len(octets) > 2 and check_of(octets[:-2]) == octets[-2:]:
                yield octets[:-2]
        at = half_bits.find(START_DELIMITER, at)


# ---- the device ----

class Device:
    def __init__(self, stream, settings):
        self.stream, self.s = stream, settings
        self.node, self.state, self.behind_answer = settings["node"], STOPPED, OFFLINE
        self.queues = {3: deque(), 2: deque(), 1: deque()}  # by priority, the most urgent first
        self.most = {priority: settings[f"most_data_{priority}"] for priority in (1, 2, 3)}
        listed = lambda name: [settings[f"{name}_{n}"] for n in range(settings[name])]
        self.buffers = {address: None for address in listed("published")}
        self.writes = dict.fromkeys(self.buffers, 0)
        self.subscribed = set(listed("subscribed"))
        self.is_active, self.heard_until, self.driven_until = False, 0, 0

    def octets(self, count):
        return 8 * count * SECOND // self.s["bit_rate"]

    def frame(self, octets):
        return self.octets(len(octets) + 2 + self.s["preamble_octets"] + 2)

    # ---- the user ----

    def power(self, is_on, now):
        """What is switched off has forgotten what it knew. V(MID) leaves room for an answer within V(MRD) x V(ST); else it does not start."""
        if not is_on:
            self.state, self.buffers = STOPPED, dict.fromkeys(self.buffers)
            self.queues = {3: deque(), 2: deque(), 1: deque()}
            return
        answer = (self.s["response_delay_slots"] - 1) * self.s["slot_time_octets"]
        if self.s["inter_pdu_delay_octets"] > min(120, answer):
            self.refuse(now)
        else:
            self.state = OFFLINE

    def request(self, now, octets):
        if not {SUBMIT: self.submit, WRITE_BUFFER: self.write}[octets[0]](octets[1:]):
            self.refuse(now)

    def refuse(self, now):
        self.stream.send(WRITE, "HQq", REFUSED, 1, now)

    def submit(self, octets):
        priority, data = octets[0], octets[5:]
        if len(data) > self.most[priority]:
            return False
        self.queues[priority].append((int.from_bytes(octets[1:5], "big"), data))
        return True

    def write(self, octets):
        address, data = int.from_bytes(octets[:4], "big"), octets[4:]
        if address not in self.buffers or len(data) > self.most[3]:
            return False
        self.buffers[address] = data
        self.writes[address] = (self.writes[address] + 1) % 256
        return True

    def tell(self, kind, dlpdu, now):
        told = bytes([kind]) + dlpdu
        self.stream.send(CHARACTERS, f"BqH{len(told)}H", USER, now, len(told), *told)

    # ---- the line ----

    def activity(self, now, begins):
        self.is_active = begins
        if not begins:
            self.heard_until = now

    def receive(self, start, rate, count, packed):
        if start < self.driven_until or self.state == STOPPED:
            return
        end = start + count * SECOND // rate
        for dlpdu in frames_in(half_bits_in(rate, count, packed, self.s["bit_rate"])):
            self.take(dlpdu, end)

    def may_begin(self):
        """V(MID) of silence, after others and after what it has said itself."""
        if self.is_active:
            return NEVER
        return max(self.heard_until, self.driven_until) + self.octets(self.s["inter_pdu_delay_octets"])

    def say(self, dlpdu, now):
        half_bits = half_bits_of_frame(dlpdu, self.s["preamble_octets"])
        octets = (len(half_bits) + 7) // 8
        self.stream.send(TRANSMIT_LEVELS, f"BqqI{octets}s", LINE, now, 2 * self.s["bit_rate"], len(half_bits),
                         int(half_bits[::-1], 2).to_bytes(octets, "little"))
        self.driven_until = now + len(half_bits) * SECOND // (2 * self.s["bit_rate"])

    # ---- DLPDUs ----

    def kind_of(self, dlpdu):
        """Name of its type, and how long one of its addresses is; nothing for what is not known here."""
        control, size = dlpdu[0], len(dlpdu)
        for name, octets in (("pn", 2), ("td", 7), ("cl", 2), ("tl", 4)):
            if control == self.s["code_" + name]:
                return (name, 0) if size == octets else (None, 0)
        if not control & PRIORITY:
            return None, 0
        if control & ~(FINAL | PRIORITY) == self.s["code_pt"]:
            return ("pt", 0) if size == 4 and any(dlpdu[2:]) else (None, 0)
        width = 4 if control & LONG else 2
        for name, header in (("cd", 1 + width), ("dt1", 1 + 2 * width), ("dt3", 2 + width)):
            if control & ~(LONG | FINAL | PRIORITY) == self.s["code_" + name]:
                fits = size == header if name == "cd" else 0 <= size - header <= self.most[control & PRIORITY]
                return (name, width) if fits else (None, 0)
        return None, 0

    def take(self, dlpdu, now):
        kind, width = self.kind_of(dlpdu)
        if kind is None:
            return
        if self.state == REPLYING:  # nobody waits for the answer any more
            self.state = self.behind_answer
        if self.state == HOLDING and kind not in ("dt1", "dt3"):  # the scheduler has taken the token back
            self.state = IDLE
        first = int.from_bytes(dlpdu[1:1 + width], "big")
        if kind == "pn" and dlpdu[1] == self.node:
            self.answer(bytes([self.s["code_pr"], self.node]), now)
        elif kind == "pt" and dlpdu[1] == self.node and self.state == IDLE:
            self.least, self.state = dlpdu[0] & PRIORITY, HOLDING
            self.token_ends = now + self.octets(int.from_bytes(dlpdu[2:], "big"))
        elif kind == "cd" and self.is_mine(first) and self.state == IDLE:
            self.answer(self.published(first, dlpdu[0] & PRIORITY), now)
        elif kind == "dt1":
            self.take_data(first, int.from_bytes(dlpdu[1 + width:1 + 2 * width], "big"), dlpdu, width, now)
        elif kind == "dt3" and first in self.subscribed:
            self.tell(PUBLISHED, dlpdu, now)

    def is_mine(self, address):
        return address >> 8 & 0xFF == self.node

    def take_data(self, to, source, dlpdu, width, now):
        if to != EVERYBODY and not self.is_mine(to) or width == 4 and not self.s["supports_long_addresses"]:
            return
        data = dlpdu[1 + 2 * width:]
        if (to == EVERYBODY or to & 0xFF == ENTITY) and source & 0xFF == ENTITY and data:
            if data[0] == 1 and self.state == OFFLINE and to != EVERYBODY:
                self.state = IDLE
                self.stream.send(WRITE, "HQq", EVENT, ACTIVATED | self.node << 8, now)
            return
        self.tell(DATA, dlpdu, now)

    @staticmethod
    def written(address):
        return address.to_bytes(4 if address > 0xFFFF else 2, "big")

    def published(self, address, priority):
        data = self.buffers.get(address)
        if data is None:
            status = NOTHING_WRITTEN if address in self.buffers else UNKNOWN_ADDRESS
            return bytes([self.s["code_sr"] | FINAL, status])
        control = self.s["code_dt3"] | FINAL | priority | (LONG if address > 0xFFFF else 0)
        return bytes([control]) + self.written(address) + bytes([self.writes[address]]) + data

    def answer(self, dlpdu, now):
        self.behind_answer, self.state = self.state, REPLYING
        delay = self.octets(self.s["response_delay_slots"] * self.s["slot_time_octets"])
        self.reply, self.answer_until = dlpdu, now + delay

    # ---- the token ----

    def next_data(self):
        """The queue of the next DT1, and its octets."""
        for priority, queue in self.queues.items():
            if queue and priority >= self.least:
                address, data = queue[0]
                source = address & 0xFFFF0000 | self.node << 8 | 1
                control = self.s["code_dt1"] | priority | (LONG if address > 0xFFFF else 0)
                return queue, bytes([control]) + self.written(address) + self.written(source) + data
        return None, b""

    def use_token(self, now):
        if self.token_ends <= now:
            self.state = IDLE
        elif self.may_begin() <= now:
            queue, dt1 = self.next_data()
            if queue and now + self.frame(dt1) <= self.token_ends:
                queue.popleft()
                begin = now + self.frame(dt1) + self.octets(self.s["inter_pdu_delay_octets"])
                following, other = self.next_data()
                is_last = not following or begin + self.frame(other) > self.token_ends
                self.say(bytes([dt1[0] | (FINAL if is_last else 0)]) + dt1[1:], now)
                self.state = IDLE if is_last else HOLDING
            else:
                rt = bytes([self.s["code_rt"]])
                if now + self.frame(rt) <= self.token_ends:
                    self.say(rt, now)
                self.state = IDLE

    # ---- time ----

    def on_time(self, now):
        if self.state == HOLDING:
            self.use_token(now)
        elif self.state == REPLYING and min(self.may_begin(), self.answer_until) <= now:
            self.state = self.behind_answer
            if self.may_begin() <= now:
                self.say(self.reply, now)

    def next_time(self):
        until = {HOLDING: "token_ends", REPLYING: "answer_until"}.get(self.state)
        return min(self.may_begin(), getattr(self, until)) if until else NEVER


# ---- messages ----

def case_of(message):
    size, = struct.unpack_from("<H", message, 1)
    case, at = message[3:3 + size].decode(), 3 + size
    count, = struct.unpack_from("<xxxxxxxxH", message, at)
    at, settings = at + 10, {}
    for _ in range(count):
        size, = struct.unpack_from("<H", message, at)
        settings[message[at + 2:at + 2 + size].decode()], = struct.unpack_from("<q", message, at + 2 + size)
        at += 10 + size
    return case, settings


def pass_on(device, kind, message):
    if kind == POWER:
        device.power(*struct.unpack_from("<?q", message, 1))
    elif kind == RECEIVE_CHARACTERS:
        _, now, count = struct.unpack_from("<xBqH", message)
        data = [struct.unpack_from("<qqH", message, 12 + 19 * n)[2] for n in range(count)]
        device.request(now, bytes(data))
    elif kind == ACTIVITY:
        _, begins, now = struct.unpack("<xB?q", message)
        device.activity(now, begins)
    elif kind == RECEIVE_LEVELS:
        _, start, rate, count = struct.unpack_from("<xBqqI", message)
        device.receive(start, rate, count, message[22:])
    elif kind == ON_TIME:
        device.on_time(struct.unpack_from("<xq", message)[0])


def serve(stream):
    device = None
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            name = b"device in Python"
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH12sH9sB", 3, LEVELS_UNIT, len(name), name,
                        1, 12, b"fieldbus_dll", 9, b"ff_device", ASKS_FOR_ACTIVITY)
        elif kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
        elif kind == CASE_BEGIN:
            case, settings = case_of(message)
            if case.startswith("fieldbus_dll/"):
                device = Device(stream, settings)
                stream.send(DONE, "q", NEVER)
            else:
                stream.send(UNSUPPORTED)
        else:
            pass_on(device, kind, message)
            stream.send(DONE, "q", device.next_time())


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer))

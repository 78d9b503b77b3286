#!/usr/bin/env python3
"""A local node of the RS-485 valve bus, to be judged; harness/iut/README.md describes the messages.

On standard input and output, for --iut 'exec:python3 node.py', or, with a path, at a socket there."""
import pathlib
import signal
import socketserver
import struct
import sys

NEVER = 2**63 - 1
SECOND = 10**12  # times are picoseconds
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE, ON_TIME, CASE_END = 1, 2, 3, 4, 5, 7, 8
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, WRITE, READ, DRIVER = 129, 130, 131, 132, 133, 135, 136, 137
VALVES, LIMIT_SWITCHES = 0, 1

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

    def read(self, item, now):
        self.send(READ, "Hq", item, now)
        return struct.unpack("<xQ", self.receive())[0]

    def write(self, item, value, now):
        self.send(WRITE, "HQq", item, value, now)


class Node:
    def __init__(self, stream, settings):
        self.stream, self.settings, rate = stream, settings, settings.get("bit_rate") or 62500  # dip 2
        self.bit = SECOND // rate
        self.half = (10 if settings["characters"] == 2 else 11) * SECOND // (2 * rate)  # a character
        tens, units = settings["address_tens"], settings["address_units"]
        self.address = 10 * tens + units if max(tens, units) <= 9 else 0
        self.power(False, 0)

    def power(self, is_on, now):
        self.is_on, self.last_command = is_on, now
        self.frame, self.is_spoilt, self.busy_until = [], False, 0
        self.answer, self.steps, self.driving_until = None, [], 0

    def receive(self, _, start, busy_until, data, flags, now):  # a character that is over
        if not self.is_on:
            return
        gap = start - self.busy_until
        if self.frame and gap >= 7 * self.half:
            self.end_frame(now)
        self.answer = None  # somebody else talks
        if flags or start < self.driving_until or self.frame and gap > 3 * self.half + 1000:
            self.is_spoilt = True
        self.frame = self.frame[:5] + [data & 0xFF]  # six octets are as wrong as a hundred
        self.busy_until = busy_until

    def silence_known(self):  # a character that began within the delimiter is over by then
        return self.busy_until + 9 * self.half + self.bit if self.frame else NEVER

    def lost(self):
        limit = self.settings["loss_limit"]
        return self.last_command + limit if limit else NEVER

    def next_time(self):
        answer = self.answer[0] - self.bit if self.answer else NEVER
        step = self.steps[0][0] if self.steps else NEVER
        return min(self.silence_known(), self.lost(), answer, step) if self.is_on else NEVER

    def on_time(self, now):
        if now >= self.silence_known():
            self.end_frame(now)
        if self.answer and now >= self.answer[0] - self.bit:
            start, octets = max(self.answer[0], now + self.bit), self.answer[1]
            self.answer, self.driving_until = None, start + 6 * self.half + 2 * self.bit
            # As firmware does it: driver on, an octet whenever the UART is free, driver off; each at its time.
            self.stream.send(DRIVER, "BBq", 0, 1, now)
            self.steps = [(start + 2 * n * self.half, octet) for n, octet in enumerate(octets)]
            self.steps.append((self.driving_until, None))
        while self.steps and now >= self.steps[0][0]:
            octet = self.steps.pop(0)[1]
            if octet is None:
                self.stream.send(DRIVER, "BBq", 0, 0, now)
            else:
                ninth = 0x100 if self.settings["characters"] == 0 else 0
                self.stream.send(CHARACTERS, "BqHH", 0, now, 1, ninth | octet)
        if now >= self.lost():
            self.last_command = now
            self.stream.write(VALVES, 0, now)

    def end_frame(self, now):
        frame, is_spoilt, self.frame, self.is_spoilt = self.frame, self.is_spoilt, [], False
        if is_spoilt or len(frame) != 5 or frame[0] ^ frame[1] ^ frame[2] ^ frame[3] != frame[4]:
            return
        if frame[0] != self.address or self.address == 0:
            return
        self.last_command = now
        boards = 0xFF if self.settings["boards"] == 1 else 0xFFFF
        if frame[1] == 0:
            self.stream.write(VALVES, (frame[2] | frame[3] << 8) & boards, now)
            if self.settings["answers_writes"]:
                self.answer_with(frame[2], frame[3])
        elif frame[1] == 1:
            switches = self.stream.read(LIMIT_SWITCHES, now) & boards
            self.answer_with(switches & 0xFF, switches >> 8)

    def answer_with(self, data0, data1):
        self.answer = (self.busy_until + 7 * self.half + SECOND // 10000, [data0, data1, data0 ^ data1])


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


def serve(stream, role, make):
    """Answers the bench until its end. make(stream, settings) is called for each case."""
    device, name, role = None, f"valve {role} in Python".encode(), role.encode()
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH9sH{len(role)}s", 3, 1, len(name), name, 1, 9, b"valve_bus",
                        len(role), role)
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            case, settings = case_of(message)
            device = make(stream, settings) if case.startswith("valve_bus/") else None
        elif kind == POWER:
            device.power(*struct.unpack("<x?q", message))
        elif kind == RECEIVE:
            port, now, count = struct.unpack_from("<xBqH", message)
            for n in range(count):
                device.receive(port, *struct.unpack_from("<qqHB", message, 12 + 19 * n), now)
        elif kind == ON_TIME:
            device.on_time(struct.unpack("<xq", message)[0])
        if device is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", NEVER if kind == CASE_END else device.next_time())


class Connection(socketserver.StreamRequestHandler):
    def handle(self):
        serve(Stream(self.rfile, self.wfile), "node", Node)


def listen(path):  # cases may run side by side, each with a connection of its own
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    try:
        socketserver.ThreadingUnixStreamServer(path, Connection).serve_forever()
    except KeyboardInterrupt:
        sys.exit()
    finally:  # the next one can take the path again
        pathlib.Path(path).unlink(missing_ok=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        listen(sys.argv[1])
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), "node", Node)

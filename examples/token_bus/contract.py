# SPDX-License-Identifier: Apache-2.0
"""The messages between the bench and an implementation in a process of its own, as far as stations of the token bus
need them; harness/iut/README.md has them all.

An implementation has next_time(), power(is_on, now), on_time(now) and, as it needs them,
receive_levels(port, start, rate, count, packed), receive_characters(port, now, octets) and activity(begins, now).
Times are picoseconds."""
import argparse
import struct
import sys

NEVER = 2**63 - 1
SECOND = 10**12
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_CHARACTERS, RECEIVE_LEVELS, ON_TIME, CASE_END = range(1, 9)
ACTIVITY = 10
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, TRANSMIT_LEVELS, WRITE = range(129, 136)
VERSION, LEVELS_UNIT, ASKS_FOR_ACTIVITY = 3, 2, 1
PROTOCOL = b"token_bus"


def end_of(start, count, rate):
    """When `count` levels end that begin at `start`, as the bench rounds it: once, to the nearest picosecond."""
    return start + (2 * count * SECOND + rate) // (2 * rate)


class Stream:
    """Messages of the bench and to it."""

    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        if kind not in (WRITE, CHARACTERS, TRANSMIT_LEVELS):  # after these comes DONE
            self.sink.flush()

    def transmit_levels(self, port, start, rate, count, packed):
        self.send(TRANSMIT_LEVELS, f"BqqI{len(packed)}s", port, start, rate, count, packed)

    def write(self, item, value, now):
        self.send(WRITE, "HQq", item, value, now)


def text_at(content, at):
    """A text of a message, and where it ends."""
    end = at + 2 + struct.unpack_from("<H", content, at)[0]
    return content[at + 2:end].decode(), end


def case_of(content):
    """The id of a case, its seed and its settings."""
    name, at = text_at(content, 1)
    seed, count = struct.unpack_from("<QH", content, at)
    settings, at = {}, at + 10
    for _ in range(count):
        key, at = text_at(content, at)
        settings[key] = struct.unpack_from("<q", content, at)[0]
        at += 8
    return name, seed, settings


def pass_on(device, message):
    """One call of the bench."""
    kind = message[0]
    if kind == POWER:
        device.power(*struct.unpack_from("<?q", message, 1))
    elif kind == ON_TIME:
        device.on_time(*struct.unpack_from("<q", message, 1))
    elif kind == RECEIVE_LEVELS:
        device.receive_levels(*struct.unpack_from("<BqqI", message, 1), message[22:])
    elif kind == RECEIVE_CHARACTERS:
        port, now, count = struct.unpack_from("<BqH", message, 1)
        octets = bytes(struct.unpack_from("<qqH", message, 12 + 19 * n)[2] for n in range(count))
        device.receive_characters(port, now, octets)
    elif kind == ACTIVITY:
        device.activity(*struct.unpack_from("<?q", message, 2))


def serve(role, make, asks_for=b""):
    """Answers the bench until its end. make(stream, settings, seed) is called for each case."""
    stream, device = Stream(sys.stdin.buffer, sys.stdout.buffer), None
    name, role = f"{role} in Python".encode(), role.encode()
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH{len(PROTOCOL)}sH{len(role)}s{len(asks_for)}s", VERSION,
                        LEVELS_UNIT, len(name), name, 1, len(PROTOCOL), PROTOCOL, len(role), role, asks_for)
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            case, seed, settings = case_of(message)
            device = make(stream, settings, seed) if case.startswith("token_bus/") else None
        elif device is not None:
            pass_on(device, message)
        if device is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", NEVER if kind == CASE_END else device.next_time())


def implementation(faults, faultless):
    """What the command line asks for: `faultless`, or with --fault NAME what faults[NAME] has, (class, what it does,
    the case that finds it). --list-faults prints these."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--fault", choices=faults, help="; ".join(f"{name}: {row[1]}" for name, row in faults.items()))
    parser.add_argument("--list-faults", action="store_true", help="name, case that finds it, what it does")
    asked = parser.parse_args()
    if asked.list_faults:
        for name, (_, what, case) in faults.items():
            print(name, case, what)
        sys.exit(0)
    return faults[asked.fault][0] if asked.fault else faultless

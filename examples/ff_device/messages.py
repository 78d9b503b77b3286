# SPDX-License-Identifier: Apache-2.0
"""The messages between the bench and a station of the data link in a process of its own; harness/iut/README.md has them.

A station has power(is_on, now), on_activity(begins, now), hear(octets, begin, now) for a frame without its check,
ask(octets, now) for what its user wants, on_time(now) and next_time(). Times are picoseconds."""
import argparse
import struct
import sys
import types
from pathlib import Path

from frames import check_of, frames_in, half_bits_in, half_bits_of_frame

NEVER = 2**63 - 1
SECOND = 10**12
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_CHARACTERS, RECEIVE_LEVELS, ON_TIME, CASE_END, VALUE, ACTIVITY = range(1, 11)
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, TRANSMIT_LEVELS, WRITE, READ = range(129, 137)
VERSION, LEVELS, TELEGRAMS, ASKS_FOR_ACTIVITY = 3, 2, 3, 1
LINE, USER = 0, 2  # ports
REFUSED, EVENT = 0, 1  # items
PROTOCOL = b"fieldbus_dll"


class Stream:
    """Messages of the bench and to it."""

    def __init__(self, source, sink, unit):
        self.source, self.sink, self.unit = source, sink, unit

    def receive(self):
        head = self.source.read(4)
        return self.source.read(struct.unpack("<I", head)[0]) if len(head) == 4 else sys.exit(0)

    def send(self, kind, form="", *values):
        content = struct.pack("<" + form, *values)
        self.sink.write(struct.pack("<IB", len(content) + 1, kind) + content)
        if kind not in (WRITE, CHARACTERS, TRANSMIT_LEVELS):  # after these comes DONE
            self.sink.flush()

    def send_octets(self, port, when, octets):
        self.send(CHARACTERS, f"BqH{len(octets)}H", port, when, len(octets), *octets)

    def drive(self, when, octets, settings):
        """A frame around these octets."""
        if self.unit == TELEGRAMS:
            self.send_octets(LINE, when, octets + check_of(octets))
            return
        half_bits = half_bits_of_frame(octets, settings["preamble_octets"])
        packed = int(half_bits[::-1], 2).to_bytes((len(half_bits) + 7) // 8, "little")
        self.send(TRANSMIT_LEVELS, f"BqqI{len(packed)}s", LINE, when, 2 * settings["bit_rate"], len(half_bits), packed)

    def write(self, item, value, now):
        self.send(WRITE, "HQq", item, value, now)

    def read(self, item, now):
        self.send(READ, "Hq", item, now)
        return struct.unpack("<xQ", self.receive())[0]


def text_at(content, at):
    """A text of a message, and where it ends."""
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


def pass_characters(station, message):
    port, now, count = struct.unpack_from("<xBqH", message)
    characters = [struct.unpack_from("<qqH", message, 12 + 19 * n) for n in range(count)]
    octets = bytes(data for _, _, data in characters)
    if port == USER:
        station.ask(octets, now)
    elif len(octets) > 2 and octets[-2:] == check_of(octets[:-2]):
        preamble = (station.s["preamble_octets"] + 1) * 8 * SECOND // station.s["bit_rate"]
        station.hear(octets[:-2], characters[0][0] - preamble, now)


def pass_on(station, message):
    """One call of the bench."""
    kind = message[0]
    if kind == POWER:
        station.power(*struct.unpack("<x?q", message))
    elif kind == RECEIVE_CHARACTERS:
        pass_characters(station, message)
    elif kind == RECEIVE_LEVELS:
        start, rate, count = struct.unpack_from("<xxqqI", message)
        for octets in frames_in(half_bits_in(rate, count, message[22:], station.s["bit_rate"])):
            station.hear(octets, start, start + (count * SECOND + rate // 2) // rate)
    elif kind == ACTIVITY:
        station.on_activity(*struct.unpack("<xx?q", message))
    elif kind == ON_TIME:
        station.on_time(*struct.unpack("<xq", message))


def serve(role, make, unit=TELEGRAMS):
    """Answers the bench until its end. make(stream, settings) is called for each case."""
    stream, station, role = Stream(sys.stdin.buffer, sys.stdout.buffer, unit), None, role.encode()
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            name = role + b" in Python"
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH{len(PROTOCOL)}sH{len(role)}sB", VERSION, unit, len(name),
                        name, 1, len(PROTOCOL), PROTOCOL, len(role), role, ASKS_FOR_ACTIVITY)
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            case, settings = case_of(message)
            station = make(stream, settings) if case.startswith(PROTOCOL.decode()) else None
        elif station is not None:
            pass_on(station, message)
        if station is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", NEVER if kind == CASE_END else station.next_time())


def run(file, role, station, faults):
    """What the command line asks for: `station`, the class of that name in `file`, or with --fault NAME what it is
    after the change that faults[NAME] makes: (what it does, the case that finds it, where, text, what is there instead)."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--units", choices=("telegrams", "levels"), default="telegrams")
    parser.add_argument("--fault", choices=faults)
    parser.add_argument("--list-faults", action="store_true", help="name, case that finds it, what it does")
    asked = parser.parse_args()
    if asked.list_faults:
        for name, (what, case, *_) in faults.items():
            print(name, case, what)
        return
    where, text, instead = faults[asked.fault][2:] if asked.fault else ("", "", "")
    # All of them anew, for each takes names from those before it.
    for name in ("frames", "messages", "link_end", Path(file).stem):
        path = next(one for one in (Path(file).with_name(name + ".py"), Path(__file__).with_name(name + ".py")) if one.exists())
        source = path.read_text(encoding="utf-8")
        if name == where:
            if source.count(text) != 1:
                sys.exit(f"{path} does not have once: {text}")
            source = source.replace(text, instead)
        sys.modules[name] = module = types.ModuleType(name)
        module.__file__ = str(path)
        exec(compile(source, path, "exec"), module.__dict__)
    sys.modules["messages"].serve(role, getattr(module, station), LEVELS if asked.units == "levels" else TELEGRAMS)

#!/usr/bin/env python3
"""An INTERBUS master that hears levels: fieldproof run 'interbus/master/**' --iut 'exec:python3 master.py'

harness/iut/README.md describes the messages, protocols/interbus/README.md the master.
master_telegrams.py is the same master with telegrams; it does without the classes of levels here."""
import struct
import sys
from collections import deque

NEVER = 2**63 - 1
SECOND = 10**12  # times are picoseconds
HELLO, ECHO, CASE_BEGIN, POWER, RECEIVE_CHARACTERS, RECEIVE_LEVELS, ON_TIME = range(1, 8)
CAPABILITIES, ECHOED, DONE, UNSUPPORTED, CHARACTERS, TRANSMIT_LEVELS, WRITE = range(129, 136)
LINE, APPLICATION = 0, 1
START, STOP, ID_CYCLE, OUTPUT_WORD = 1, 2, 3, 4
OFF, READY, IDENTIFICATION, RUN, LOCATING, BUS_STOP = range(6)
STATE, DATA_CYCLES, ID_CYCLES, REJECTED, REJECTED_DATA, IN_A_ROW, QUALITY = range(7)
CYCLE_TIME, PLACE, FOUND, ENDED = range(7, 11)
SENTENCE, STATION, MESSAGES, INPUT, OUTPUT = 0x100, 0x1000, 0x2000, 0x3000, 0x4000
BRANCH, REMOTE = "branch", "remote"


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


class Frame:
    """The octets of a cycle, and the check."""
    def __init__(self, s):
        self.s, self.rate, self.bit = s, s["bit_rate"], SECOND // s["bit_rate"]
        self.table = [self.shifted(high << 8) for high in range(256)]

    def shifted(self, register):
        for _ in range(8):
            register = (register << 1) ^ (self.s["check_polynomial"] if register & 0x8000 else 0)
        return register & 0xFFFF

    def check(self, octets):
        reflected, register, table = self.s["check_is_reflected"], self.s["check_preset"], self.table
        turned = lambda value, bits: int(f"{value:0{bits}b}"[::-1], 2)
        for octet in octets:
            octet = turned(octet, 8) if reflected else octet
            register = register << 8 & 0xFFFF ^ table[register >> 8 ^ octet]
        value = (turned(register, 16) if reflected else register) ^ self.s["check_final_xor"]
        return [value & 0xFF, value >> 8] if reflected else [value >> 8, value & 0xFF]

    def cycle(self, is_id, words):
        """(is check, octet) of the telegrams that carry `words` after the loopback word."""
        octets = [octet for word in [self.s["loopback_word"]] + words for octet in (word >> 8, word & 0xFF)]
        status = self.s["status_clean"]
        behind = self.check(octets) + [status >> 8, status & 0xFF] + [0] * self.s["end_telegrams"]
        return [(0, octet) for octet in octets] + [(1, octet) for octet in behind]

    def place(self, n):
        """The bit at which telegram n of a cycle begins."""
        return n * (13000 + self.s["telegram_gap_millibits"]) // 1000


class Levels(Frame):
    """Telegrams as text, a character for each level."""
    def __init__(self, s):
        super().__init__(s)
        octets = [f"{octet:08b}"[::1 if s["most_significant_first"] else -1] for octet in range(256)]
        heads = {(is_id, is_check): self.head(is_id, is_check, True)
                 for is_id in (0, 1) for is_check in (0, 1)}
        self.kind_of = {head: kind for kind, head in heads.items()}
        self.data = {kind: ["0" + head + bits + "1" for bits in octets] for kind, head in heads.items()}
        status = ("0" + self.head(0, 0, False) + "1").ljust(s["status_pitch_bits"], "1")
        self.pause = status * 8
        self.octet_of = {bits: octet for octet, bits in enumerate(octets)}

    def head(self, is_id, is_check, is_data):
        levels = [""] * 3
        for name, level, is_set in (("select", "select_level", is_id), ("control", "control_level", is_check),
                                    ("flag", "data_flag_level", is_data)):
            levels[self.s[name + "_place"]] = str(self.s[level] if is_set else 1 - self.s[level])
        return "".join(levels)

    def text_of(self, is_id, telegrams):
        return "".join([self.data[is_id, is_check][octet].ljust(self.place(n + 1) - self.place(n), "1")
                        for n, (is_check, octet) in enumerate(telegrams)])

    def pause_of(self, count):
        """Status telegrams."""
        pitch = self.s["status_pitch_bits"]
        if len(self.pause) < count * pitch:
            self.pause = self.pause[:pitch] * count
        return self.pause[:count * pitch]


class ReturnedLevels:
    """What has come back, put together from the transmissions that were heard."""
    def __init__(self, coding):
        self.coding, self.waves, self.heard = coding, [], 0

    def add(self, start, rate, count, packed):
        self.waves.append((start, rate, f"{int.from_bytes(packed, 'little'):0{count}b}"[::-1][:count]))

    def forget(self):
        self.waves = [wave for wave in self.waves if wave[0] + len(wave[2]) * SECOND // wave[1] > self.heard]

    def lines(self, until):
        """(start, rate, levels, end) of stretches: a transmission that follows another one continues it,
        one that begins within another one, or has another rate, cuts it off."""
        lines = []
        for start, rate, levels in self.waves:
            if lines and rate == lines[-1][1]:
                begin, _, before = lines[-1]
                at = ((start - begin) * rate + SECOND // 2) // SECOND
                if at >= len(before):
                    lines[-1] = begin, rate, before.ljust(at, "1") + levels
                    continue
            lines.append((start, rate, levels))
        ends = [min(until, line[0]) for line in lines[1:]] + [until]
        return [line + (end,) for line, end in zip(lines, ends)]

    def telegrams(self, until):
        """(start, (is ID, is check), octet or None, has stop level) of those not reported yet that are over."""
        coding, bit_rate = self.coding, self.coding.rate
        flag, is_data = coding.s["flag_place"], str(coding.s["data_flag_level"])
        for origin, rate, levels, end in self.lines(until):
            samples = [(2 * n + 1) * rate // (2 * bit_rate) for n in range(13)]
            known = (end - origin) * rate // SECOND
            levels += "1" * (samples[12] + 1)
            at = max(0, -((origin - self.heard) * rate // SECOND))
            while 0 <= (at := levels.find("0", at)) < known:
                text = levels[at:at + 13] if rate == bit_rate else "".join([levels[at + n] for n in samples])
                if text[0] == "1":  # no start level
                    at += samples[0]
                    continue
                start = origin + at * SECOND // rate
                count = 12 if text[1 + flag] == is_data else 4
                if at + samples[count] >= known:
                    break
                # Behind a missing stop level the next edge counts.
                at = levels.find("1", at + samples[count])
                self.heard = origin + at * SECOND // rate
                octet = coding.octet_of[text[4:12]] if count == 12 else None
                yield start, coding.kind_of.get(text[1:4]), octet, text[count] == "1"


class Master:
    """What all masters do; in which units it is said and heard is left to others."""
    def __init__(self, stream, settings, coding, returned):
        self.stream, self.s, self.coding, self.returned, self.items = stream, settings, coding, returned, {}
        self.state, self.stations, self.last_driven = OFF, [], -NEVER
        self.inputs, self.outputs = [], []
        self.start_at = self.verdict_at = NEVER
        self.search, self.is_stopping, self.is_id_needed = None, False, False

    def put(self, item, value, now):
        if self.items.get(item, 0) != value:
            self.items[item] = value
            self.stream.send(WRITE, "HQq", item, value, now)

    def count(self, item, now):
        self.put(item, self.items.get(item, 0) + 1, now)

    def enter(self, state, now):
        self.state = state
        self.put(STATE, state, now)

    def say(self, sentence, now):
        octets = sentence.encode()[:256].ljust(256, b"\0")
        for n in range(32):
            self.put(SENTENCE + n, int.from_bytes(octets[8 * n:8 * n + 8], "little"), now)

    # ---- orders ----

    def order(self, now, characters):
        if characters[0] == START and self.state in (OFF, BUS_STOP):
            self.say("", now)
            for item in PLACE, DATA_CYCLES, ID_CYCLES, REJECTED, REJECTED_DATA:
                self.put(item, 0, now)
            self.enter(READY, now)
            self.begin_search(now)
        elif characters[0] == STOP:
            self.is_stopping = self.state == RUN
            if not self.is_stopping:
                self.silence(OFF, now)
        elif characters[0] == ID_CYCLE:
            self.is_id_needed = True
        elif characters[0] == OUTPUT_WORD and self.state == RUN and characters[1] < len(self.outputs):
            self.set_output(characters[1], characters[2], now)

    def set_output(self, word, value, now):
        self.outputs[word] = value
        self.put(OUTPUT + word, value, now)

    def silence(self, state, now):
        """Nothing is driven any more; who was to stop does."""
        state = OFF if self.is_stopping else state
        self.start_at = self.verdict_at = NEVER
        self.is_stopping = False
        for word in range(len(self.outputs)):
            self.set_output(word, 0, now)
        self.enter(state, now)

    # ---- recognition: stations join one by one, in the order of the ring ----

    def begin_search(self, now):
        """After a silence in which all stations fall into reset."""
        quiet = self.s["silence_limit"] + self.s["silence_tolerance"] + SECOND // 1000
        self.start_at, self.verdict_at = max(now, self.last_driven + quiet), NEVER
        self.found, self.open, self.search, self.tries = [], set(), self.searching(), 0
        next(self.search)

    def controls(self, stations):
        s = self.s
        return [(0 if (n, BRANCH) in self.open else s["control_local_off"]) |
                (0 if (n, REMOTE) in self.open else s["control_remote_off"]) for n in range(stations)]

    def searching(self):
        """Is sent the ID codes that each good cycle brings, in the order of the ring."""
        probes = [(-1, REMOTE)]
        while probes:
            probe = self.probe = probes.pop()
            if probe not in self.open and self.found:
                self.open.add(probe)
                yield  # what is switched on now answers in the next cycle
            newcomer = len(self.found)
            ids = yield
            if len(ids) > newcomer:
                if error := self.take(ids[-1] & 0x1FFF, probe):
                    return error
                probes += [(newcomer, REMOTE), (newcomer, BRANCH)]
        yield

    def take(self, code, probe):
        before, words = probe[0], self.s.get(f"words_of_length_code_{code >> 8}")
        at = len(self.found)
        if words is None:
            return f"station {at}: ID code {code:04X}h has no length"
        level = self.found[before][3] + (probe[1] == BRANCH) if at else 1
        self.found.append((code, words, before, level, probe[1] == BRANCH))
        if at + 1 > self.s["max_stations"]:
            return f"more than {self.s['max_stations']} stations"
        if 16 * sum(station[1] for station in self.found) > self.s["max_io_points"]:
            return f"station {at}: more than {self.s['max_io_points']} I/O points"
        if level > self.s["max_levels"]:
            return f"station {at}: more than {self.s['max_levels']} levels"

    @staticmethod
    def as_item(station):
        code, words, before, _, is_branch = station
        return code | words << 16 | before + 1 << 32 | is_branch << 48

    def end_search(self, error, now):
        self.search = None
        if self.state == LOCATING:
            return self.end_locating(now)
        expected = [self.s[f"expected_{n}"] for n in range(self.s["expected"])]
        found = [self.as_item(station) for station in self.found]
        if not error and expected and found != expected:
            error = "the ring is not the expected one"
        if error:
            self.say(error, now)
            return self.silence(BUS_STOP, now)
        if len(found) < len(self.stations):
            self.put(FOUND, len(found), now)
        for n, item in enumerate(found):
            self.put(STATION + n, item, now)
        self.put(FOUND, len(found), now)
        if self.found != self.stations:  # of the same ring the inputs hold
            self.stations = self.found
            self.set_images(now)
        self.ring_delay = self.first_returned - self.cycle_start
        telegrams = 6 + 2 * len(self.outputs) + self.s["end_telegrams"]
        pitch = 13000 + self.s["telegram_gap_millibits"]
        frame = telegrams * pitch * self.coding.bit // 1000
        shortest = frame + self.ring_delay + self.s["software_time"]
        self.cycle_time = max(self.s["cycle_time"], shortest)
        self.put(CYCLE_TIME, self.cycle_time, now)
        self.is_fault_open = False
        self.bad_cycles, self.data_cycles = deque(), 0
        self.put(IN_A_ROW, 0, now)
        self.put(QUALITY, 0, now)
        self.enter(RUN, now)

    def set_images(self, now):
        """Words count from the first station on; a cycle carries them from the last one on."""
        self.order_of_words, at = [], 0
        for _, words, *_ in self.stations:
            self.order_of_words[:0] = range(at, at + words)
            at += words
        for item, image in (INPUT, self.inputs), (OUTPUT, self.outputs):
            for word in range(len(image)):
                self.put(item + word, 0, now)
            image[:] = [0] * at

    def end_locating(self, now):
        pairs = enumerate(zip(self.stations, self.found))
        n = next((n for n, (old, new) in pairs if old != new), min(len(self.stations), len(self.found)))
        if n < len(self.stations):
            self.name_place(self.stations[n][2], n, now)
        self.silence(BUS_STOP, now)

    def name_place(self, before, to, now):
        """Between two stations; -1 is the master's output, or its input."""
        self.put(PLACE, 1 << 32 | before + 1 | to + 1 << 16, now)

    # ---- the cycle ----

    def start_cycle(self, now):
        s, coding = self.s, self.coding
        self.is_id = bool(self.search) or (self.is_id_needed and not self.is_stopping)
        if self.is_id:
            self.is_id_needed = False
            self.sent = self.controls(1 + len(self.found if self.search else self.stations))[::-1]
        else:
            self.is_last = self.is_stopping
            self.sent = [0 if self.is_last else self.outputs[word] for word in self.order_of_words]
        telegrams = coding.cycle(self.is_id, self.sent)
        frame = coding.place(len(telegrams)) * coding.bit
        if self.search:
            half_bits = s["forward_delay_half_bits"] + s["return_delay_half_bits"]
            delay = len(self.sent) * half_bits * coding.bit // 2
            delay += 2 * s["max_cable_m"] * s["cable_delay_ps_per_m"]
        else:
            delay = self.ring_delay
        # A telegram too many that begins within 13 bits after the last one is over by then.
        self.verdict_at = now + frame + frame // 64 + delay + 27 * coding.bit
        span = frame + delay + s["software_time"]
        if not self.search:
            span = -(-span // self.cycle_time) * self.cycle_time if self.is_id else self.cycle_time
        self.verdict_at = min(self.verdict_at, now + span)
        pitch = s["status_pitch_bits"] * coding.bit
        pause = max(0, span - frame) // pitch
        self.cycle_start, self.start_at = now, now + span
        self.last_driven = now + frame + pause * pitch
        self.drive(now, telegrams, pause)

    def judge(self, now):
        """The words that have come back; None when they must not be taken. The last station's come first in
        data cycles; ID codes are given in the order of the ring, however many they are."""
        coding, transfer, phase = self.coding, 2 * len(self.sent) + 2, self.is_id
        heads = [(phase, 0)] * transfer + [(phase, 1)] * (4 + self.s["end_telegrams"])
        octets, is_good = [], True
        for start, head, octet, stop in self.returned.telegrams(now):
            if not octets:
                if octet is None or start < self.cycle_start:
                    continue
                self.first_returned = start
            if len(octets) < len(heads):
                is_good &= octet is not None and stop and head == heads[len(octets)]
                octets.append(octet)
            else:
                is_good &= octet is None
        self.returned.forget()
        if not is_good or len(octets) != len(heads):
            return None
        status = octets[transfer + 2] << 8 | octets[transfer + 3]
        check = coding.check(octets[:transfer])
        if octets[transfer:transfer + 2] != check or status != self.s["status_clean"]:
            return None
        words = [octets[n] << 8 | octets[n + 1] for n in range(0, transfer, 2)]
        loopback, most = self.s["loopback_word"], len(words) - 1
        if not self.is_id:
            return words[:most] if words[most] == loopback else None
        # An ID cycle has room for one station more than are known.
        counts = [n for n in [most - 1, most, *range(most)] if words[n] == loopback]
        return words[:counts[0]][::-1] if counts else None

    def finish_cycle(self, now):
        self.verdict_at = NEVER
        words = self.judge(now)
        self.count(ID_CYCLES if self.is_id else DATA_CYCLES, now)
        if words is None:
            self.count(REJECTED, now)
            if not self.is_id:
                self.count(REJECTED_DATA, now)
        is_id, is_good = self.is_id, words is not None
        if self.search:
            self.go_on(words, now)
        elif self.is_id:
            self.finish_id_cycle(words, now)
        else:
            self.finish_data_cycle(words, now)
        self.stream.send(WRITE, "HQq", ENDED, (not is_id) + 2 * is_good, now)

    def go_on(self, ids, now):
        if self.state == BUS_STOP:  # whose silence has ended
            self.enter(LOCATING, now)
        if ids is None or not len(self.found) <= len(ids) <= len(self.found) + 1:
            self.tries += 1
            is_alone = self.state == READY and not self.found
            if not is_alone and self.tries >= self.s["stop_after_bad_cycles"]:
                self.name_place(self.probe[0], len(self.found), now)
                self.end_search(f"nothing comes back after station {self.probe[0]}", now)
            return
        self.tries = 0
        if not ids:
            return
        if self.state == READY:
            self.enter(IDENTIFICATION, now)
        try:
            self.search.send(ids)
        except StopIteration as end:
            self.read_messages(ids, now)
            self.end_search(end.value, now)

    def read_messages(self, ids, now):
        for n, code in enumerate(ids):
            fault, request = self.s["message_peripheral_fault"], self.s["message_reconfiguration"]
            self.put(MESSAGES + n, bool(code & fault) + 2 * bool(code & request), now)

    def finish_id_cycle(self, ids, now):
        if ids is None:
            return self.reject(now)
        if [code & 0x1FFF for code in ids] != [station[0] for station in self.stations]:
            return self.refuse_ring([code & 0x1FFF for code in ids], now)
        self.read_messages(ids, now)
        if self.is_fault_open:
            marked = [n for n, code in enumerate(ids) if code & self.s["message_check_error"]]
            self.name_place(marked[0] - 1 if marked else len(ids) - 1, marked[0] if marked else -1, now)
            self.is_fault_open = False

    def refuse_ring(self, codes, now):
        pairs, least = enumerate(zip(codes, self.stations)), min(len(codes), len(self.stations))
        n = next((n for n, (code, station) in pairs if code != station[0]), least)
        self.name_place(self.stations[n][2] if n < len(self.stations) else n - 1, n, now)
        if len(codes) != len(self.stations):
            self.say(f"{len(codes)} stations, not {len(self.stations)}", now)
        else:
            self.say(f"station {n} is {codes[n]:04X}h, not {self.stations[n][0]:04X}h", now)
        self.silence(BUS_STOP, now)

    def finish_data_cycle(self, words, now):
        self.data_cycles += 1
        while self.bad_cycles and self.bad_cycles[0] <= self.data_cycles - self.s["quality_window_cycles"]:
            self.bad_cycles.popleft()
        if words is None:
            self.bad_cycles.append(self.data_cycles)
        self.put(QUALITY, int(len(self.bad_cycles) >= self.s["quality_bad_cycles"]), now)
        if self.is_last:
            return self.silence(OFF, now)
        if words is None:
            return self.reject(now)
        self.put(IN_A_ROW, 0, now)
        for word, value in zip(self.order_of_words, words):
            if self.inputs[word] != value:
                self.inputs[word] = value
                self.put(INPUT + word, value, now)
        for n in range(self.s["copy"]):
            to, word = divmod(self.s[f"copy_{n}"], 1 << 16)
            if word < len(self.inputs) and to < len(self.outputs):  # of a ring that has both
                self.set_output(to, self.inputs[word], now)

    def reject(self, now):
        self.count(IN_A_ROW, now)
        self.is_id_needed = self.is_fault_open = True
        if self.items[IN_A_ROW] >= self.s["stop_after_bad_cycles"]:
            self.silence(BUS_STOP, now)
            if self.state == BUS_STOP:
                self.begin_search(now)

    # ---- time ----

    def on_time(self, now):
        if now >= self.verdict_at:
            self.finish_cycle(now)
        if now >= self.start_at:
            self.start_cycle(now)

    def next_time(self):
        return min(self.verdict_at, self.start_at)


class LevelMaster(Master):
    unit, name = 2, b"master in Python"

    def __init__(self, stream, settings):
        coding = Levels(settings)
        super().__init__(stream, settings, coding, ReturnedLevels(coding))

    def drive(self, now, telegrams, pause):
        """A cycle and the status telegrams after it."""
        levels = self.coding.text_of(self.is_id, telegrams) + self.coding.pause_of(pause)
        self.stream.send(TRANSMIT_LEVELS, f"BqqI{(len(levels) + 7) // 8}s", 0, now, self.coding.rate,
                         len(levels), int(levels[::-1], 2).to_bytes((len(levels) + 7) // 8, "little"))

    def hear(self, message):
        _, start, rate, count = struct.unpack_from("<xBqqI", message)
        self.returned.add(start, rate, count, message[22:])


def text_at(content, at):
    end = at + 2 + struct.unpack_from("<H", content, at)[0]
    return content[at + 2:end].decode(), end


def master_for(stream, content, kind_of_master):
    name, at = text_at(content, 1)
    settings, count = {}, struct.unpack_from("<8xH", content, at)[0]
    at += 10
    for _ in range(count):
        key, at = text_at(content, at)
        settings[key] = struct.unpack_from("<q", content, at)[0]
        at += 8
    return kind_of_master(stream, settings) if name.startswith("interbus/") else None


def serve(stream, kind_of_master):
    master = None
    while True:
        message = stream.receive()
        kind = message[0]
        if kind == HELLO:
            name = kind_of_master.name
            stream.send(CAPABILITIES, f"HBH{len(name)}sHH8sH6s", 3, kind_of_master.unit, len(name), name,
                        1, 8, b"interbus", 6, b"master")
            continue
        if kind == ECHO:
            stream.send(ECHOED, f"{len(message) - 1}s", message[1:])
            continue
        if kind == CASE_BEGIN:
            master = master_for(stream, message, kind_of_master)
        elif kind == RECEIVE_CHARACTERS and message[1] == APPLICATION:
            now, count = struct.unpack_from("<xxqH", message)
            master.order(now, [struct.unpack_from("<16xH", message, 12 + 19 * n)[0] for n in range(count)])
        elif kind in (RECEIVE_CHARACTERS, RECEIVE_LEVELS):
            master.hear(message)
        elif kind == ON_TIME:
            master.on_time(struct.unpack("<xq", message)[0])
        if master is None:
            stream.send(UNSUPPORTED)
        else:
            stream.send(DONE, "q", master.next_time())


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), LevelMaster)

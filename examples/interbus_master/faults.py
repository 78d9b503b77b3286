#!/usr/bin/env python3
"""The master in levels with one fault, to see the bench find it: faults.py --fault NAME."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent))
from changed_program import run

PLACE_OF = 'return n * (13000 + self.s["telegram_gap_millibits"]) // 1000'
STATUS = 'status = ("0" + self.head(0, 0, False) + "1").ljust(s["status_pitch_bits"], "1")'
HEAD = 'levels[self.s[name + "_place"]] = str(self.s[level] if is_set else 1 - self.s[level])'
CYCLE = "return [(0, octet) for octet in octets] + [(1, octet) for octet in behind]"
BEHIND = 'behind = self.check(octets) + [status >> 8, status & 0xFF] + [0] * self.s["end_telegrams"]'
OCTETS = 'octets = [octet for word in [self.s["loopback_word"]] + words for octet in (word >> 8, word & 0xFF)]'
HEADS_GOOD = "is_good &= octet is not None and stop and head == heads[len(octets)]"
LENGTH_GOOD = "if not is_good or len(octets) != len(heads):"
CHECK_GOOD = "if octets[transfer:transfer + 2] != check or status != self.s[\"status_clean\"]:"
COUNTS = "counts = [n for n in [most - 1, most, *range(most)] if words[n] == loopback]"
QUIET = 'quiet = self.s["silence_limit"] + self.s["silence_tolerance"] + SECOND // 1000'
START_AT = "self.start_at, self.verdict_at = max(now, self.last_driven + quiet), NEVER"
CONTROLS = """return [(0 if (n, BRANCH) in self.open else s["control_local_off"]) |
                (0 if (n, REMOTE) in self.open else s["control_remote_off"]) for n in range(stations)]"""
PROBES = "probes += [(newcomer, REMOTE), (newcomer, BRANCH)]"
LEVEL = "level = self.found[before][3] + (probe[1] == BRANCH) if at else 1"
AS_ITEM = "return code | words << 16 | before + 1 << 32 | is_branch << 48"
EXPECTED = "if not error and expected and found != expected:"
NEW_IMAGES = "if self.found != self.stations:  # of the same ring the inputs hold"
SHORTEST = 'shortest = frame + self.ring_delay + self.s["software_time"]'
CYCLE_TIME = 'self.cycle_time = max(self.s["cycle_time"], shortest)'
SPAN = "span = -(-span // self.cycle_time) * self.cycle_time if self.is_id else self.cycle_time"
PAUSE = "pause = max(0, span - frame) // pitch"
SENT = "self.sent = [0 if self.is_last else self.outputs[word] for word in self.order_of_words]"
VERDICT_AT = "self.verdict_at = now + frame + frame // 64 + delay + 14 * coding.bit"
TRIES = 'if not is_alone and self.tries >= self.s["stop_after_bad_cycles"]:'
MESSAGES = "self.put(MESSAGES + n, bool(code & fault) + 2 * bool(code & request), now)"
MARKED_PLACE = "self.name_place(marked[0] - 1 if marked else len(ids) - 1, marked[0] if marked else -1, now)"
SAME_RING = "if [code & 0x1FFF for code in ids] != [station[0] for station in self.stations]:"
REFUSED_PLACE = "self.name_place(self.stations[n][2] if n < len(self.stations) else n - 1, n, now)"
WINDOW = "while self.bad_cycles and self.bad_cycles[0] <= self.data_cycles - self.s[\"quality_window_cycles\"]:"
QUALITY = 'self.put(QUALITY, int(len(self.bad_cycles) >= self.s["quality_bad_cycles"]), now)'
ROW_ENDS = "        self.put(IN_A_ROW, 0, now)\n        for word, value"
INPUTS = "if self.inputs[word] != value:"
COPY = "self.set_output(copy >> 16, self.inputs[copy & 0xFFFF], now)"
COPIES = 'for n in range(self.s["copy"]):'
IN_A_ROW_STOPS = 'if self.items[IN_A_ROW] >= self.s["stop_after_bad_cycles"]:'
NEEDS_ID = "self.is_id_needed = self.is_fault_open = True"
END = 'self.stream.send(WRITE, "HQq", ENDED, (not is_id) + 2 * is_good, now)'
COUNT = "self.count(ID_CYCLES if self.is_id else DATA_CYCLES, now)"
REJECTED = "            self.count(REJECTED, now)\n"
START = "if characters[0] == START and self.state in (OFF, BUS_STOP):"
STOP = "self.is_stopping = self.state == RUN"
ID_ORDER = "            self.is_id_needed = True\n        elif characters[0] == OUTPUT_WORD"
OUTPUT_ORDER = "elif characters[0] == OUTPUT_WORD and self.state == RUN and characters[1] < len(self.outputs):"
SET_OUTPUT = "self.set_output(characters[1], characters[2], now)"
ZEROED = """        for word in range(len(self.outputs)):
            self.set_output(word, 0, now)
        self.enter(state, now)"""
LOCATED = """        if n < len(self.stations):
            self.name_place(self.stations[n][2], n, now)
        self.silence(BUS_STOP, now)

    def name_place"""
NOT_THERE = "n = next((n for n, (old, new) in pairs if old != new), min(len(self.stations), len(self.found)))"
SEARCH_AGAIN = """            if self.state == BUS_STOP:
                self.begin_search(now)"""

# name: (what it does, which case of interbus/master finds it, (line, instead)...)
FAULTS = {
    # what is driven
    "gaps_ignored": ("no gap after telegrams", "", (PLACE_OF, "return n * 13")),
    "gaps_uneven": ("gaps of 0 and of twice the mean in turn", "", (PLACE_OF, 'return n * 13 + n // 2 * 2 * self.s["telegram_gap_millibits"] // 1000')),
    "gaps_truncated": ("gaps truncated to whole bits", "", (PLACE_OF, 'return n * (13 + self.s["telegram_gap_millibits"] // 1000)')),
    "gap_before_check_doubled": ("two gaps more before the check, none after it", "", (PLACE_OF, 'return n * 13 + (n + (n == 6)) * self.s["telegram_gap_millibits"] // 1000')),
    "pitch_fixed": ("status telegrams every six bits whatever the setting", "", (STATUS, STATUS.replace('s["status_pitch_bits"]', "6")), ('        pitch = self.s["status_pitch_bits"]\n        if', "        pitch = 6\n        if"), ('pitch = s["status_pitch_bits"] * coding.bit', "pitch = 6 * coding.bit")),
    "pitch_eight_bits": ("status telegrams at a pitch of at most 255 bits", "", (STATUS, STATUS.replace('s["status_pitch_bits"]', 'min(255, s["status_pitch_bits"])')), ('        pitch = self.s["status_pitch_bits"]\n        if', '        pitch = min(255, self.s["status_pitch_bits"])\n        if'), ('pitch = s["status_pitch_bits"] * coding.bit', 'pitch = min(255, s["status_pitch_bits"]) * coding.bit')),
    "pause_silent": ("no status telegrams between cycles", "", (PAUSE, "pause = 0")),
    "pause_half": ("status telegrams in half of each pause", "", (PAUSE, PAUSE.replace("// pitch", "// pitch // 2"))),
    "pause_one_short": ("the last status telegram of each pause is missing", "", (PAUSE, "pause = max(0, max(0, span - frame) // pitch - 1)")),
    "pause_of_256": ("at most 256 status telegrams", "", (PAUSE, PAUSE.replace("max(0, span - frame) // pitch", "min(256, max(0, span - frame) // pitch)"))),
    "pause_with_select": ("status telegrams with SL", "", (STATUS, STATUS.replace("self.head(0, 0, False)", "self.head(1, 0, False)"))),
    "pause_with_control": ("status telegrams with CR", "", (STATUS, STATUS.replace("self.head(0, 0, False)", "self.head(0, 1, False)"))),
    "pause_without_stop": ("status telegrams with a short stop level", "", (STATUS, STATUS.replace('+ "1")', '+ "0")'))),
    "select_level_fixed": ("1 is SL set whatever the setting", "", (HEAD, HEAD.replace("str(", 'str(int(is_set) if name == "select" else '))),
    "control_level_fixed": ("1 is CR set whatever the setting", "", (HEAD, HEAD.replace("str(", 'str(int(is_set) if name == "control" else '))),
    "flag_place_fixed": ("FL is the third level whatever the setting", "", (HEAD, HEAD.replace('self.s[name + "_place"]', '{"select": 0, "control": 1, "flag": 2}[name]'))),
    "always_msb_first": ("most significant bit first whatever the setting", "", ('[::1 if s["most_significant_first"] else -1]', "")),
    "select_of_transfer_only": ("the check phase of an ID cycle without SL", "", ("text_of(self, is_id, telegrams):\n        return \"\".join([self.data[is_id, is_check]", "text_of(self, is_id, telegrams):\n        return \"\".join([self.data[is_id and not is_check, is_check]")),
    "loopback_fixed": ("A55Ah as loopback word whatever the setting", "", (OCTETS, OCTETS.replace('self.s["loopback_word"]', "0xA55A")), ('loopback, most = self.s["loopback_word"],', "loopback, most = 0xA55A,")),
    "octets_swapped": ("low octets first", "", (OCTETS, OCTETS.replace("(word >> 8, word & 0xFF)", "(word & 0xFF, word >> 8)"))),
    "preset_fixed": ("presets the check with FFFFh whatever the setting", "", ('self.s["check_is_reflected"], self.s["check_preset"], self.table', 'self.s["check_is_reflected"], 0xFFFF, self.table')),
    "no_final_xor": ("no final XOR", "", (' ^ self.s["check_final_xor"]', "")),
    "polynomial_fixed": ("polynomial 1021h whatever the setting", "", ('self.s["check_polynomial"] if register', "0x1021 if register")),
    "never_reflected": ("never a reflected check", "", ('reflected, register, table = self.s["check_is_reflected"]', "reflected, register, table = 0")),
    "check_without_loopback": ("the check does not cover the loopback word", "", (BEHIND, BEHIND.replace("self.check(octets)", "self.check(octets[2:])"))),
    "status_zero": ("status word 0 whatever the setting", "", ('status = self.s["status_clean"]\n        behind', "status = 0\n        behind")),
    "status_swapped": ("low octet of the status word first", "", (BEHIND, BEHIND.replace("[status >> 8, status & 0xFF]", "[status & 0xFF, status >> 8]"))),
    "no_end_telegrams": ("no end telegrams", "", (BEHIND, BEHIND.replace(' + [0] * self.s["end_telegrams"]', "")), (' + [(phase, 1)] * (4 + self.s["end_telegrams"])'[3:], "[(phase, 1)] * 4")),
    "end_telegrams_are_ff": ("FFh in end telegrams", "", (BEHIND, BEHIND.replace("[0] *", "[255] *"))),
    "words_in_ring_order": ("words of the first station first", "", ("self.order_of_words[:0] = range(at, at + words)", "self.order_of_words += range(at, at + words)")),
    "words_of_station_reversed": ("the words of a station in the other order", "", ("self.order_of_words[:0] = range(at, at + words)", "self.order_of_words[:0] = range(at + words - 1, at - 1, -1)")),
    "controls_in_ring_order": ("control word of the first station first", "", ("if self.search else self.stations))[::-1]", "if self.search else self.stations))")),
    # what comes back
    "check_not_compared": ("takes cycles with a wrong check", "", (CHECK_GOOD, 'if status != self.s["status_clean"]:')),
    "check_first_octet": ("compares the first octet of the check", "", (CHECK_GOOD, CHECK_GOOD.replace("octets[transfer:transfer + 2] != check", "octets[transfer] != check[0]"))),
    "check_second_octet": ("compares the second octet of the check", "", (CHECK_GOOD, CHECK_GOOD.replace("octets[transfer:transfer + 2] != check", "octets[transfer + 1] != check[1]"))),
    "check_of_sent": ("compares the check with the one it has sent", "", ("check = coding.check(octets[:transfer])", "check = [o for c, o in self.coding.cycle(self.is_id, self.sent) if c][:2]")),
    "status_not_compared": ("takes cycles that are marked", "", (CHECK_GOOD, 'if octets[transfer:transfer + 2] != check:')),
    "status_low_octet": ("looks at the low octet of the status word", "", (CHECK_GOOD, 'if octets[transfer:transfer + 2] != check or (status ^ self.s["status_clean"]) & 0xFF:')),
    "status_high_octet": ("looks at the high octet of the status word", "", (CHECK_GOOD, 'if octets[transfer:transfer + 2] != check or (status ^ self.s["status_clean"]) >> 8:')),
    "status_whole_mark": ("rejects a cycle with all bits of the mark only", "", (CHECK_GOOD, 'if octets[transfer:transfer + 2] != check or status & self.s["status_marked"] == self.s["status_marked"]:')),
    "status_of_zero_is_bad": ("rejects no status word but FFFFh", "", (CHECK_GOOD, 'if octets[transfer:transfer + 2] != check or status == 0xFFFF:')),
    "loopback_not_compared": ("takes data cycles without the loopback word", "", ("return words[:most] if words[most] == loopback else None", "return words[:most]")),
    "loopback_high_octet": ("compares the high octet of the loopback word", "", ("return words[:most] if words[most] == loopback else None", "return words[:most] if words[most] >> 8 == loopback >> 8 else None")),
    "loopback_anywhere": ("takes data cycles with the loopback word anywhere", "", ("return words[:most] if words[most] == loopback else None", "return words[:most] if loopback in words else None")),
    "other_ring_is_bad": ("takes the loopback word of an ID cycle in its two places only", "", (COUNTS, COUNTS.replace("[most - 1, most, *range(most)]", "[most - 1, most]"))),
    "id_without_loopback": ("takes ID cycles without the loopback word", "", (COUNTS, COUNTS + " or [most - 1]")),
    "headers_not_compared": ("takes cycles with other headers", "", (HEADS_GOOD, "is_good &= octet is not None and stop")),
    "select_not_compared": ("takes cycles with another SL", "", (HEADS_GOOD, "is_good &= octet is not None and stop and head is not None and head[1] == heads[len(octets)][1]")),
    "control_not_compared": ("takes cycles with another CR", "", (HEADS_GOOD, "is_good &= octet is not None and stop and head is not None and head[0] == heads[len(octets)][0]")),
    "headers_of_check_ignored": ("takes cycles with other headers in the check phase", "", (HEADS_GOOD, HEADS_GOOD.replace("head ==", "len(octets) >= transfer or head =="). replace("stop and len", "stop and (len") + ")")),
    "stops_not_looked_at": ("takes cycles with missing stop levels", "", (HEADS_GOOD, HEADS_GOOD.replace(" and stop", ""))),
    "stops_of_check_ignored": ("takes missing stop levels in the check phase", "", (HEADS_GOOD, HEADS_GOOD.replace("and stop", "and (stop or len(octets) >= transfer)"))),
    "last_stop_ignored": ("takes a missing stop level of the last telegram", "", (HEADS_GOOD, HEADS_GOOD.replace("and stop", "and (stop or len(octets) == len(heads) - 1)"))),
    "first_stop_ignored": ("takes a missing stop level of the first telegram", "", (HEADS_GOOD, HEADS_GOOD.replace("and stop", "and (stop or not octets)"))),
    "status_within_taken": ("takes cycles with status telegrams between their telegrams", "", ("            if len(octets) < len(heads):\n", "            if octet is None and len(octets) < len(heads):\n                continue\n            if len(octets) < len(heads):\n")),
    "more_is_good": ("takes cycles with telegrams too many", "", ("                is_good &= octet is None\n", "                pass\n")),
    "fewer_is_good": ("takes cycles without their last telegram", "", (LENGTH_GOOD, 'octets += [self.s["status_clean"] & 0xFF] * (len(octets) == len(heads) - 1)\n        ' + LENGTH_GOOD)),
    "id_codes_with_messages": ("a message makes a station another one", "", (SAME_RING, "if [code for code in ids] != [station[0] for station in self.stations]:")),
    "id_codes_twelve_bits": ("compares 12 bits of ID codes", "", (SAME_RING, "if [code & 0xFFF for code in ids] != [station[0] & 0xFFF for station in self.stations]:")),
    "id_count_only": ("compares how many stations there are, not their ID codes", "", (SAME_RING, "if len(ids) != len(self.stations):")),
    "id_codes_only": ("does not see a station more", "", (SAME_RING, "if [code & 0x1FFF for code in ids][:len(self.stations)] != [station[0] for station in self.stations]:")),
    "judged_early": ("judges a cycle without waiting for a slow return", "", (VERDICT_AT, "self.verdict_at = now + frame + delay")),
    "samples_late": ("samples each bit at its end", "", ("samples = [(2 * n + 1) * rate // (2 * bit_rate)", "samples = [(19 * n + 19) * rate // (20 * bit_rate) - (n > 0) * rate // (20 * bit_rate)")),
    "glitch_is_start": ("does not look at the start level again", "", ('if text[0] == "1":', "if False:")),
    "receives_from_cycle_start": ("begins to receive anew when a cycle begins", "", ("self.cycle_start, self.start_at = now, now + span", "self.cycle_start, self.start_at = now, now + span\n        self.returned.heard = now")),
    # recognition
    "no_silence": ("no silence before a second start", "", (QUIET, "quiet = 0")),
    "silence_without_tolerance": ("a silence of silence_limit only", "", (QUIET, 'quiet = self.s["silence_limit"]')),
    "silence_fixed": ("a silence of 27 ms whatever the settings", "", (QUIET, "quiet = 27 * SECOND // 1000")),
    "silence_before_first": ("a silence before the first start as well", "", (START_AT, START_AT.replace("max(now, self.last_driven + quiet)", "max(now + quiet, self.last_driven + quiet)"))),
    "remote_first": ("looks after OUT1 first", "", (PROBES, "probes += [(newcomer, BRANCH), (newcomer, REMOTE)]")),
    "no_branches": ("never looks after OUT2", "", (PROBES, "probes += [(newcomer, REMOTE)]")),
    "branch_of_first_only": ("looks after OUT2 of the first station only", "", (PROBES, "probes += [(newcomer, REMOTE)] + ([(newcomer, BRANCH)] if newcomer == 0 else [])")),
    "off_bits_swapped": ("takes the bits of OUT1 and OUT2 for each other", "", (CONTROLS, CONTROLS.replace("control_local_off", "x").replace("control_remote_off", "control_local_off").replace('"x"', '"control_remote_off"'))),
    "off_bits_fixed": ("bits 1 and 2 in control words whatever the settings", "", (CONTROLS, CONTROLS.replace('s["control_local_off"]', "2").replace('s["control_remote_off"]', "1"))),
    "level_of_main_line": ("counts no levels", "", (LEVEL, "level = 1")),
    "level_of_each_station": ("each station is one level further", "", (LEVEL, "level = self.found[before][3] + 1 if at else 1")),
    "one_station_fewer": ("a ring of max_stations is too long", "", ('if at + 1 > self.s["max_stations"]', 'if at + 1 >= self.s["max_stations"]')),
    "one_station_more": ("a ring of one station more than max_stations is taken", "", ('if at + 1 > self.s["max_stations"]', 'if at > self.s["max_stations"]')),
    "points_of_limit_refused": ("a ring of max_io_points is too large", "", ('> self.s["max_io_points"]:', '>= self.s["max_io_points"]:')),
    "points_as_octets": ("counts octets as I/O points", "", ("if 16 * sum(station[1]", "if 2 * sum(station[1]")),
    "levels_of_limit_refused": ("a ring of max_levels is too deep", "", ('if level > self.s["max_levels"]', 'if level >= self.s["max_levels"]')),
    "levels_not_limited": ("does not look at max_levels", "", ('if level > self.s["max_levels"]', "if False")),
    "undefined_code_is_zero": ("an undefined length code is a register of 0 words", "", ('words = probe[0], self.s.get(f"words_of_length_code_{code >> 8}")', 'words = probe[0], self.s.get(f"words_of_length_code_{code >> 8}", 0)')),
    "length_code_is_length": ("takes the length code for the length", "", ('words = probe[0], self.s.get(f"words_of_length_code_{code >> 8}")', 'words = probe[0], code >> 8 if f"words_of_length_code_{code >> 8}" in self.s else None')),
    "length_of_four_bits": ("takes four bits of the length code", "", ('self.s.get(f"words_of_length_code_{code >> 8}")', 'self.s.get(f"words_of_length_code_{code >> 8 & 15}")')),
    "before_is_last": ("takes the station found before for the one before it", "", (AS_ITEM, AS_ITEM), ("self.found.append((code, words, before, level", "self.found.append((code, words, at - 1, level")),
    "branch_not_reported": ("does not report that a station is after OUT2", "", (AS_ITEM, "return code | words << 16 | before + 1 << 32")),
    "expected_ignored": ("takes any ring for the expected one", "", (EXPECTED, "if False:")),
    "expected_count": ("compares how many stations are expected only", "", (EXPECTED, EXPECTED.replace("found != expected", "len(found) != len(expected)"))),
    "expected_codes": ("compares expected ID codes only", "", (EXPECTED, EXPECTED.replace("found != expected", "[f & 0x1FFF for f in found] != [e & 0x1FFF for e in expected]"))),
    "expected_start": ("a ring with more stations than expected is taken", "", (EXPECTED, EXPECTED.replace("found != expected", "found[:len(expected)] != expected"))),
    "expected_without_branch": ("does not compare whether a station is on a branch", "", (EXPECTED, EXPECTED.replace("found != expected", "[f & 0xFFFFFFFF for f in found] != [e & 0xFFFFFFFF for e in expected]"))),
    "gives_up_alone": ("stops when no station answers", "", (TRIES, TRIES.replace("not is_alone and ", ""))),
    "never_gives_up": ("never stops in the recognition", "", (TRIES, "if False:")),
    "gives_up_late": ("stops the recognition after one bad cycle more", "", (TRIES, TRIES.replace(">=", ">"))),
    "gives_up_at_once": ("stops the recognition after the first bad cycle", "", (TRIES, 'if not is_alone:')),
    "identification_skipped": ("does not report the state identification", "", ("            self.enter(IDENTIFICATION, now)", "            self.state = IDENTIFICATION")),
    "identification_early": ("reports identification with its order to start", "", ("            self.enter(READY, now)\n", "            self.enter(READY, now)\n            self.enter(IDENTIFICATION, now)\n            self.state = READY\n")),
    "sentence_stays": ("a start does not clear the sentence", "", ('            self.say("", now)\n', "")),
    "place_stays": ("a start does not clear the place", "", ("            self.put(PLACE, 0, now)\n", "")),
    "no_sentence": ("no sentence about a wrong ring", "", ("        if error:\n            self.say(error, now)\n", "        if error:\n")),
    "runs_with_wrong_ring": ("runs with a ring that is not the expected one", "", ("            self.say(error, now)\n            return self.silence(BUS_STOP, now)", "            self.say(error, now)")),
    "same_ring_clears_inputs": ("clears the inputs at the end of the recognition", "", (NEW_IMAGES, "if True:")),
    "count_before_stations": ("writes how many there are before them when it grows", "", ("        for n, item in enumerate(found):\n            self.put(STATION + n, item, now)\n        self.put(FOUND, len(found), now)", "        self.put(FOUND, len(found), now)\n        for n, item in enumerate(found):\n            self.put(STATION + n, item, now)")),
    # cycle time
    "request_ignored": ("always the shortest cycle time", "", (CYCLE_TIME, "self.cycle_time = shortest")),
    "request_not_limited": ("a cycle time shorter than possible is in force", "", (CYCLE_TIME, 'self.cycle_time = shortest if not self.s["cycle_time"] else self.s["cycle_time"]'), ), 
    "cycle_time_16_bits": ("a cycle time in us with 16 bits", "", (CYCLE_TIME, 'self.cycle_time = max(self.s["cycle_time"] % (65536 * 10**6), shortest)')),
    "cycle_time_in_us": ("truncates the cycle time to us", "", (CYCLE_TIME, CYCLE_TIME + " // 10**6 * 10**6")),
    "no_software_time": ("forgets the software time", "", (SHORTEST, "shortest = frame + self.ring_delay")),
    "no_ring_delay": ("forgets the delay of the ring", "", (SHORTEST, 'shortest = frame + self.s["software_time"]')),
    "cycle_time_doubled_report": ("reports the requested cycle time", "", ("self.put(CYCLE_TIME, self.cycle_time, now)", 'self.put(CYCLE_TIME, self.s["cycle_time"] or self.cycle_time, now)')),
    "id_off_the_grid": ("after an ID cycle data cycles begin off the multiples", "", (SPAN, "span = span if self.is_id else self.cycle_time")),
    "id_always_two": ("an ID cycle takes a cycle time more than it needs", "", (SPAN, SPAN.replace("* self.cycle_time if", "* self.cycle_time + self.cycle_time if"))),
    "cycles_drift": ("each cycle begins a bit late", "", (SPAN, SPAN + " + coding.bit")),
    # images
    "inputs_of_bad_cycles": ("takes the inputs of bad cycles", "", ("        if octets[transfer:transfer + 2] != check", "        if not self.is_id and octets[transfer:transfer + 2] != check and words_of(octets, transfer, self, 0):\n            return None\n        if octets[transfer:transfer + 2] != check"), ("class Frame:", "def words_of(octets, transfer, m, now):\n    words = [octets[n] << 8 | octets[n + 1] for n in range(0, transfer - 2, 2)]\n    for word, value in zip(m.order_of_words, words):\n        if m.inputs[word] != value:\n            m.inputs[word] = value\n            m.put(INPUT + word, value, m.verdict_now)\n    return True\n\n\nclass Frame:"), ("        words = self.judge(now)\n", "        self.verdict_now = now\n        words = self.judge(now)\n")),
    "inputs_of_zero_kept": ("does not take an input of 0", "", (INPUTS, "if value and self.inputs[word] != value:")),
    "inputs_15_bits": ("compares 15 bits of an input", "", (INPUTS, "if (self.inputs[word] ^ value) & 0x7FFF:")),
    "inputs_low_octet": ("takes an input whose low octet has changed", "", (INPUTS, "if (self.inputs[word] ^ value) & 0xFF:")),
    "bad_cycle_clears_inputs": ("inputs are 0 after a bad cycle", "", ("        if words is None:\n            return self.reject(now)\n        self.put(IN_A_ROW", "        if words is None:\n            for word in range(len(self.inputs)):\n                self.inputs[word] = 0\n                self.put(INPUT + word, 0, now)\n            return self.reject(now)\n        self.put(IN_A_ROW")),
    "bus_stop_clears_inputs": ("inputs are 0 after a bus stop", "", (ZEROED, "        for word in range(len(self.inputs)):\n            self.put(INPUT + word, 0, now)\n" + ZEROED)),
    "bus_stop_keeps_outputs": ("outputs stay after a bus stop", "", (ZEROED, "        for word in range(len(self.outputs) if state == OFF else 0):\n            self.set_output(word, 0, now)\n        self.enter(state, now)")),
    "stop_keeps_outputs": ("outputs stay after a stop", "", (ZEROED, "        for word in range(len(self.outputs) if state != OFF else 0):\n            self.set_output(word, 0, now)\n        self.enter(state, now)")),
    "only_first_output_cleared": ("clears the first output word only", "", (ZEROED, "        for word in range(min(1, len(self.outputs))):\n            self.set_output(word, 0, now)\n        self.enter(state, now)")),
    "first_copy_only": ("makes the first copy only", "", (COPIES, 'for n in range(min(1, self.s["copy"])):')),
    "copy_words_swapped": ("takes input and output word of a copy for each other", "", (COPY, "self.set_output(copy & 0xFFFF, self.inputs[copy >> 16], now)")),
    "copy_eight_bits": ("copies eight bits", "", (COPY, COPY.replace("0xFFFF]", "0xFFFF] & 0xFF"))),
    "copy_not_reported": ("does not report what it has copied", "", (COPY, "self.outputs[copy >> 16] = self.inputs[copy & 0xFFFF]")),
    "copy_once_late": ("copies the inputs of the cycle before", "", (COPIES, "self.later, before = list(self.inputs), getattr(self, 'later', list(self.inputs))\n        " + COPIES), (COPY, "self.set_output(copy >> 16, before[copy & 0xFFFF] if len(before) > (copy & 0xFFFF) else 0, now)")),
    "copies_in_bad_cycle": ("makes the copies in bad cycles as well", "", ("        if words is None:\n            return self.reject(now)\n        self.put(IN_A_ROW", "        if words is None:\n            for n in range(self.s['copy']):\n                copy = self.s[f'copy_{n}']\n                self.set_output(copy >> 16, self.inputs[copy & 0xFFFF], now)\n            return self.reject(now)\n        self.put(IN_A_ROW")),
    "outputs_a_cycle_late": ("drives the outputs of the cycle before", "", (SENT, "image, self.shadow = getattr(self, 'shadow', None) or list(self.outputs), list(self.outputs)\n            self.sent = [0 if self.is_last else image[word] if word < len(image) else 0 for word in self.order_of_words]")),
    # orders
    "start_in_run": ("a start in run begins anew", "", (START, "if characters[0] == START:")),
    "start_after_stop_only": ("a start in bus stop is ignored", "", (START, START.replace("(OFF, BUS_STOP)", "(OFF,)"))),
    "stop_without_zeros": ("the last cycle carries the outputs", "", (SENT, SENT.replace("0 if self.is_last else ", ""))),
    "stop_without_cycle": ("stops without a last cycle", "", (STOP, "self.is_stopping = False")),
    "stop_in_search_ignored": ("a stop in the recognition is ignored", "", ("            if not self.is_stopping:\n                self.silence(OFF, now)", "            pass")),
    "stop_goes_on": ("data cycles of 0 go on after a stop", "", ("        if self.is_last:\n            return self.silence(OFF, now)", "        if self.is_last:\n            self.is_last = False\n            self.enter(OFF, now)")),
    "stop_waits_for_good": ("a stop whose last cycle is bad is repeated", "", ("        if self.is_last:\n            return", "        if self.is_last and words is not None:\n            return")),
    "id_order_ignored": ("no ID cycle by order", "", (ID_ORDER, ID_ORDER.replace("self.is_id_needed = True", "pass"))),
    "id_order_remembered": ("an order for an ID cycle outside of run is done in run", "", (ID_ORDER, ID_ORDER), ("            self.enter(READY, now)\n            self.begin", "            self.enter(READY, now)\n            self.is_id_needed = False\n            self.begin")),
    "id_order_twice": ("two ID cycles by order", "", (ID_ORDER, ID_ORDER.replace("= True", "= 2")), ("            self.is_id_needed = False\n            self.sent", "            self.is_id_needed = self.is_id_needed is not True and self.is_id_needed == 2 and True\n            self.sent")),
    "output_outside_run": ("takes output words in bus stop", "", (OUTPUT_ORDER, OUTPUT_ORDER.replace("self.state == RUN", "self.state in (RUN, BUS_STOP, OFF)"))),
    "output_eight_bits": ("takes eight bits of an output", "", (SET_OUTPUT, "self.set_output(characters[1], characters[2] & 0xFF, now)")),
    "output_15_bits": ("takes 15 bits of an output", "", (SET_OUTPUT, "self.set_output(characters[1], characters[2] & 0x7FFF, now)")),
    "output_word_0_only": ("takes word 0 only", "", (OUTPUT_ORDER, OUTPUT_ORDER.replace("characters[1] <", "characters[1] == 0 and characters[1] <"))),
    "last_output_refused": ("does not take the last output word", "", (OUTPUT_ORDER, OUTPUT_ORDER.replace("characters[1] < len(self.outputs)", "characters[1] < len(self.outputs) - (len(self.outputs) > 1)"))),
    "output_128_words": ("takes orders for the first 128 words", "", (OUTPUT_ORDER, OUTPUT_ORDER.replace("characters[1] <", "characters[1] < 128 and characters[1] <"))),
    # what it counts
    "ids_not_counted": ("does not count ID cycles", "", (COUNT, "if not self.is_id:\n            self.count(DATA_CYCLES, now)")),
    "good_counted": ("counts good cycles only", "", (COUNT, "if words is not None:\n            " + COUNT)),
    "counters_eight_bits": ("counters of eight bits", "", ("self.put(item, self.items.get(item, 0) + 1, now)", "self.put(item, self.items.get(item, 0) + 1 & 0xFF, now)")),
    "counters_of_seven_bits": ("counters of seven bits", "", ("self.put(item, self.items.get(item, 0) + 1, now)", "self.put(item, self.items.get(item, 0) + 1 & 0x7F, now)")),
    "rejected_data_only": ("counts rejected data cycles as all rejected ones", "", (REJECTED, "            if not self.is_id:\n                self.count(REJECTED, now)\n")),
    "rejected_ids_as_data": ("counts rejected ID cycles as data cycles", "", ("            if not self.is_id:\n                self.count(REJECTED_DATA", "            if True:\n                self.count(REJECTED_DATA")),
    "row_not_ended": ("a good data cycle does not end the row", "", (ROW_ENDS, "        for word, value")),
    "row_ended_by_id": ("a good ID cycle ends the row", "", ("        self.read_messages(ids, now)\n        if self.is_fault_open:", "        self.put(IN_A_ROW, 0, now)\n        self.read_messages(ids, now)\n        if self.is_fault_open:")),
    "row_of_data": ("bad ID cycles do not count as in a row", "", ("        if ids is None:\n            return self.reject(now)", "        if ids is None:\n            self.is_id_needed = True\n            return")),
    "stops_late": ("stops the bus after one bad cycle more", "", (IN_A_ROW_STOPS, IN_A_ROW_STOPS.replace(">=", ">"))),
    "stops_early": ("stops the bus after one bad cycle fewer", "", (IN_A_ROW_STOPS, IN_A_ROW_STOPS.replace(">= self.s[", ">= -1 + self.s["))),
    "stops_after_ten": ("stops the bus after ten whatever the setting", "", (IN_A_ROW_STOPS, "if self.items[IN_A_ROW] >= 10:")),
    "never_stops": ("never stops the bus", "", (IN_A_ROW_STOPS, "if False:")),
    "quality_late": ("the quality bit needs one more", "", (QUALITY, QUALITY.replace(">=", ">"))),
    "quality_stays": ("the quality bit is never cleared", "", (QUALITY, QUALITY.replace("int(len", "int(self.items.get(QUALITY, 0) or len"))),
    "quality_window_ignored": ("counts rejected cycles of all times", "", (WINDOW, "while False:")),
    "quality_window_long": ("the window is one cycle longer", "", (WINDOW, WINDOW.replace("<=", "<"))),
    "quality_window_short": ("the window is one cycle shorter", "", (WINDOW, WINDOW.replace("<= self.data", "<= 1 + self.data"))),
    "quality_by_blocks": ("counts in blocks of the window's length", "", (WINDOW, 'if self.data_cycles % self.s["quality_window_cycles"] == 0:\n            self.bad_cycles.clear()\n        while False:')),
    "ended_before_changes": ("says that a cycle has ended before what it has changed", "", ("        if self.search:\n            self.go_on(words, now)", "        " + END + "\n        if self.search:\n            self.go_on(words, now)"), ("            self.finish_data_cycle(words, now)\n        " + END, "            self.finish_data_cycle(words, now)")),
    "ended_when_changed": ("says that a cycle has ended when that value changes only", "", (END, "self.put(ENDED, (not is_id) + 2 * is_good, now)")),
    "ended_of_data_only": ("does not say that an ID cycle has ended", "", (END, "if not is_id:\n            " + END)),
    "ended_always_good": ("each cycle has ended good", "", (END, END.replace("2 * is_good", "2"))),
    # faults of the ring
    "no_id_after_bad": ("no ID cycle after a bad one", "", (NEEDS_ID, "self.is_fault_open = True")),
    "one_id_after_bad": ("one ID cycle after a bad data cycle, whatever becomes of it", "", (NEEDS_ID, "self.is_id_needed, self.is_fault_open = not self.is_id, True")),
    "place_of_last_marked": ("the place is before the last station with a message", "", (MARKED_PLACE, MARKED_PLACE.replace("marked[0]", "marked[-1]"))),
    "place_one_late": ("the place is after the station with a message", "", (MARKED_PLACE, "self.name_place(marked[0] if marked else len(ids) - 1, marked[0] + 1 if marked and marked[0] + 1 < len(ids) else -1, now)")),
    "place_in_tree": ("the place is between a station and the one before it on its branch", "", (MARKED_PLACE, MARKED_PLACE.replace("marked[0] - 1 if", "self.stations[marked[0]][2] if"))),
    "place_needs_message": ("no place without a message", "", (MARKED_PLACE, "if marked:\n                " + MARKED_PLACE)),
    "place_of_first_fault": ("the place of the first fault stays", "", (MARKED_PLACE, "if not self.items.get(PLACE):\n                " + MARKED_PLACE)),
    "place_of_any_message": ("any message counts for the place", "", ('if code & self.s["message_check_error"]]', "if code & 0xE000]")),
    "messages_swapped": ("takes peripheral fault and reconfiguration for each other", "", (MESSAGES, "self.put(MESSAGES + n, 2 * bool(code & fault) + bool(code & request), now)")),
    "messages_latched": ("messages stay", "", (MESSAGES, "self.put(MESSAGES + n, self.items.get(MESSAGES + n, 0) | bool(code & fault) + 2 * bool(code & request), now)")),
    "messages_of_first": ("messages of the first station only", "", ("        for n, code in enumerate(ids):\n            fault", "        for n, code in enumerate(ids[:1]):\n            fault")),
    "messages_not_in_recognition": ("does not report the messages of the recognition", "", ("            self.read_messages(ids, now)\n            self.end_search", "            self.end_search")),
    "messages_fixed": ("takes fixed bits for messages", "", ('fault, request = self.s["message_peripheral_fault"], self.s["message_reconfiguration"]', "fault, request = 0x8000, 0x2000")),
    "other_ring_runs": ("goes on with another ring", "", ("            return self.refuse_ring([code & 0x1FFF for code in ids], now)", "            pass")),
    "other_ring_silent": ("no sentence about another ring", "", ("            self.say(f\"{len(codes)} stations, not {len(self.stations)}\", now)", "            pass"), ('            self.say(f"station {n} is {codes[n]:04X}h, not {self.stations[n][0]:04X}h", now)', "            pass")),
    "other_ring_is_located": ("another ring is located", "", ("            self.say(f\"station {n} is {codes[n]:04X}h, not {self.stations[n][0]:04X}h\", now)\n        self.silence(BUS_STOP, now)", "            self.say(f\"station {n} is {codes[n]:04X}h, not {self.stations[n][0]:04X}h\", now)\n        self.silence(BUS_STOP, now)\n        self.begin_search(now)")),
    "other_ring_place_zero": ("the place of another ring is the master's output", "", (REFUSED_PLACE, "self.name_place(-1, 0, now)")),
    "other_ring_by_order": ("the station before the place is the one before in the ring", "", (REFUSED_PLACE, "self.name_place(n - 1, n, now)")),
    "stations_cleared": ("forgets the stations at a bus stop", "", (ZEROED, "        if state == BUS_STOP:\n            self.put(FOUND, 0, now)\n" + ZEROED)),
    "not_located": ("does not locate after a bus stop", "", (SEARCH_AGAIN, "            pass")),
    "locating_not_reported": ("does not report the state locating", "", ("            self.enter(LOCATING, now)", "            self.state = LOCATING")),
    "locating_early": ("reports locating with the bus stop", "", (SEARCH_AGAIN, "            if self.state == BUS_STOP:\n                self.begin_search(now)\n                self.enter(LOCATING, now)")),
    "locating_runs": ("runs again after locating a ring that is whole", "", ("        if self.state == LOCATING:\n            return self.end_locating(now)", "        if self.state == LOCATING and self.found != self.stations:\n            return self.end_locating(now)")),
    "located_one_early": ("locates the last station that is there", "", (NOT_THERE, NOT_THERE + "\n        n = max(0, n - 1)")),
    "located_by_order": ("the station before the place is the one before in the ring", "", (LOCATED, LOCATED.replace("self.stations[n][2], n", "n - 1, n"))),
    "located_by_count": ("does not see another station when locating", "", (NOT_THERE, "n = min(len(self.stations), len(self.found))")),
    "located_nothing": ("names no place when locating", "", (LOCATED, LOCATED.replace("if n < len(self.stations):", "if False:"))),
    "stays_locating": ("no bus stop after locating", "", (LOCATED, LOCATED.replace("        self.silence(BUS_STOP, now)\n", "        self.start_at = self.verdict_at = NEVER\n"))),
    "second_start_keeps_row": ("a second start goes on with the row of bad cycles", "", ("        self.put(IN_A_ROW, 0, now)\n        self.put(QUALITY, 0, now)\n        self.enter(RUN", "        self.put(QUALITY, 0, now)\n        self.enter(RUN")),
    "second_start_keeps_quality": ("a second start goes on with the window", "", ("self.bad_cycles, self.data_cycles = deque(), 0", "self.bad_cycles, self.data_cycles = getattr(self, 'bad_cycles', deque()), getattr(self, 'data_cycles', 0)")),
    "second_start_keeps_open": ("a second start begins with all interfaces as before", "", ("self.found, self.open, self.search, self.tries = [], set(), self.searching(), 0", "self.found, self.open, self.search, self.tries = [], getattr(self, 'open', set()), self.searching(), 0")),
    "second_start_keeps_stop": ("a stop that was ordered in bus stop is done after the next start", "", (STOP, "self.is_stopping = self.state in (RUN, BUS_STOP)")),
    "second_start_keeps_fault": ("a fault before a start is located after it", "", ("        self.is_fault_open = False\n        self.bad_cycles", "        self.is_fault_open = getattr(self, 'is_fault_open', False)\n        self.is_id_needed |= self.is_fault_open\n        self.bad_cycles")),
    "second_fault_not_located": ("locates the first fault after a start only", "", (SEARCH_AGAIN, "            if self.state == BUS_STOP and not getattr(self, 'was', 0):\n                self.was = 1\n                self.begin_search(now)")),
    "second_start_old_delay": ("keeps the delay of the first ring", "", ("self.ring_delay = self.first_returned - self.cycle_start", "self.ring_delay = getattr(self, 'ring_delay', self.first_returned - self.cycle_start)")),
    "every_256th_not_taken": ("takes no inputs in each 256th good cycle", "", ("        for word, value in zip(self.order_of_words, words):", "        for word, value in zip(self.order_of_words, words) if self.data_cycles % 256 else ():")),
}

if __name__ == "__main__":
    run(FOLDER, ["master"], FAULTS)

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Nodes with one fault each, to see the bench find it: --iut 'exec:python3 node_faults.py --fault NAME'."""
import pathlib

from edits import run

MOVES = "self.stream.write(VALVES, (frame[2] | frame[3] << 8) & boards, now)"
VALUE = "(frame[2] | frame[3] << 8) & boards"
SWITCHES = "switches = self.stream.read(LIMIT_SWITCHES, now) & boards"
CHECK = "frame[0] ^ frame[1] ^ frame[2] ^ frame[3] != frame[4]"
MINE = "if frame[0] != self.address or self.address == 0:"
ADDRESS = "10 * tens + units if max(tens, units) <= 9 else 0"
COUNTS = "        self.last_command = now\n        boards"
ANSWER = "[data0, data1, data0 ^ data1])"
AT = "self.busy_until + 7 * self.half + SECOND // 10000"
GAP = "self.frame and gap > 3 * self.half + 1000"
SPOILT = "if flags or start"
TAKE = "self.frame = self.frame[:5] + [data & 0xFF]"
KNOWN = "self.busy_until + 9 * self.half + self.bit if"
RESET = "self.frame, self.is_spoilt, self.busy_until = [], False, 0"
READS = "elif frame[1] == 1:"
WRITES = "if frame[1] == 0:"
CANCELS = "self.answer = None  # somebody else talks"
FRAME_OVER = "frame, is_spoilt, self.frame, self.is_spoilt = self.frame, self.is_spoilt, [], False"
LATER = """        if getattr(self, "later", None) and now >= self.later[0][0]:
            self.stream.write(VALVES, self.later.pop(0)[1], now)
        if now >= self.lost():"""
LATER_TIME = "return min(self.silence_known(), self.lost(), answer, step)"
LATER_TIME_TOO = """later = self.later[0][0] if getattr(self, "later", None) else NEVER
        return min(self.silence_known(), self.lost(), answer, step, later)"""
LOST = "        if now >= self.lost():"


def later(*steps):
    """Valves move in steps: (delay, value)."""
    moves = ", ".join(f"(now + {delay}, {value})" for delay, value in steps)
    return MOVES, f"self.later = [{moves}]", LOST, LATER, LATER_TIME, LATER_TIME_TOO


FAULTS = {name: (what, "?", *edits) for name, what, *edits in [
    # ---- what is written ----
    ("valves_swapped", "DATA0 drives the second board", VALUE, "(frame[3] | frame[2] << 8) & boards"),
    ("valve_0_dead", "bit 0 of the valves stays 0", VALUE, VALUE + " & 0xFFFE"),
    ("valve_7_dead", "bit 7 stays 0", VALUE, VALUE + " & 0xFF7F"),
    ("valve_8_dead", "bit 8 stays 0", VALUE, VALUE + " & 0xFEFF"),
    ("valve_15_dead", "bit 15 stays 0", VALUE, VALUE + " & 0x7FFF"),
    ("valve_4_short", "valve 4 follows valve 3", VALUE, "(lambda v: v & ~16 | v << 1 & 16)(" + VALUE + ")"),
    ("valves_add_up", "valves are never switched off by a write", MOVES,
     "self.v = getattr(self, 'v', 0) | " + VALUE + "; self.stream.write(VALVES, self.v, now)"),
    ("valves_toggle", "a write toggles", MOVES,
     "self.v = getattr(self, 'v', 0) ^ " + VALUE + "; self.stream.write(VALVES, self.v, now)"),
    ("data0_signed", "DATA0 from 80h is extended by its sign", VALUE,
     "(frame[2] | frame[3] << 8 | (0xFF00 if frame[2] > 127 else 0)) & boards"),
    ("zero_ignored", "a write of 00 00 is ignored", WRITES, "if frame[1] == 0 and not (frame[2] or frame[3]):\n            pass\n        elif frame[1] == 0:"),
    ("ones_ignored", "a write of FF FF is ignored", WRITES, "if frame[1] == 0 and frame[2] & frame[3] == 0xFF:\n            pass\n        elif frame[1] == 0:"),
    ("low_zero_ignored", "DATA0 of 0 leaves the first board", MOVES, "self.v = " + VALUE + " or 0; frame[2] or self.stream.write(VALVES, (getattr(self, 'w', 0) & 0xFF | self.v) & boards, now); self.w = self.v if frame[2] else getattr(self, 'w', 0); frame[2] and self.stream.write(VALVES, self.v, now)"),
    ("second_write_lost", "the second write after power-up is lost", MOVES,
     "self.n = getattr(self, 'n', 0) + 1; self.n != 2 and " + MOVES),
    ("write_256_lost", "each 256th write is lost", MOVES,
     "self.n = getattr(self, 'n', 0) + 1; self.n % 256 and " + MOVES),
    ("write_1000_lost", "the thousandth write is lost", MOVES,
     "self.n = getattr(self, 'n', 0) + 1; self.n != 1000 and " + MOVES),
    ("valves_late", "valves move 2.5 ms after the delimiter", *later((2500000000, VALUE))),
    ("valves_little_late", "valves move 2.1 ms after the delimiter was known", *later((2100000000, VALUE))),
    ("valves_in_steps", "the second board moves 5 us later", *later((0, "frame[2] | getattr(self, 'v', 0) & 0xFF00 & boards"), (5000000, VALUE))),
    ("valves_through_zero", "valves go off for 2 us before they move", *later((0, "0"), (2000000, VALUE))),
    ("valves_at_last_octet", "valves move with the fifth octet, without the delimiter", "        self.busy_until = busy_until\n",
     "        self.busy_until = busy_until\n        if len(self.frame) == 5 and not self.is_spoilt and not self.frame[1] and self.frame[0] == self.address and not self.frame[0] ^ self.frame[2] ^ self.frame[3] ^ self.frame[4]:\n            self.stream.write(VALVES, (self.frame[2] | self.frame[3] << 8) & (0xFF if self.settings['boards'] == 1 else 0xFFFF), now)\n"),
    ("valves_off_by_read", "a read takes the valves off", READS, READS + "\n            self.stream.write(VALVES, 0, now)"),
    ("undefined_takes_off", "an undefined COMMAND takes the valves off", "        elif frame[1] == 1:", "        elif frame[1] > 1:\n            self.stream.write(VALVES, 0, now)\n        elif frame[1] == 1:"),
    ("one_board_drives_two", "one board, and DATA1 reaches valves", "boards = 0xFF if self.settings[\"boards\"] == 1 else 0xFFFF", "boards = 0xFFFF"),
    ("one_board_reads_two", "one board, and DATA1 of a response is not 0", "_SWITCHES_", ""),
    ("boards_ignored", "always takes one board", "== 1 else 0xFFFF", ">= 1 else 0xFFFF"),
    # ---- what is read ----
    ("switches_swapped", "DATA0 and DATA1 of a response are swapped", "self.answer_with(switches & 0xFF, switches >> 8)", "self.answer_with(switches >> 8, switches & 0xFF)"),
    ("switch_0_dead", "limit switch 0 is never 1", SWITCHES, SWITCHES + " & 0xFFFE"),
    ("switch_7_dead", "limit switch 7 is never 1", SWITCHES, SWITCHES + " & 0xFF7F"),
    ("switch_15_dead", "limit switch 15 is never 1", SWITCHES, SWITCHES + " & 0x7FFF"),
    ("switch_9_stuck", "limit switch 9 is always 1", SWITCHES, SWITCHES + " | 0x200 & boards"),
    ("switches_once", "reads the switches at the first read only", SWITCHES, "switches = self.s = self.stream.read(LIMIT_SWITCHES, now) & boards if not hasattr(self, 's') else self.s"),
    ("switches_stale", "answers with the switches of the read before", SWITCHES, SWITCHES + "\n            switches, self.s = getattr(self, 's', switches), switches"),
    ("switches_debounced", "answers with the and of two reads", SWITCHES, SWITCHES + "\n            switches, self.s = getattr(self, 's', switches) & switches, switches"),
    ("two_instants", "DATA1 is read when the driver goes on", "start, octets = max(self.answer[0], now + self.bit), self.answer[1]", "start, octets = max(self.answer[0], now + self.bit), self.answer[1]\n            if self.settings['boards'] == 2: octets[1] = self.stream.read(LIMIT_SWITCHES, now) >> 8; octets[2] = octets[0] ^ octets[1]"),
    ("read_echoes_data", "a read with data is answered with them", SWITCHES, SWITCHES + "\n            switches = switches if not frame[2] and not frame[3] else frame[2] | frame[3] << 8"),
    ("read_needs_zeros", "answers reads with data 00 00 only", READS, "elif frame[1] == 1 and not frame[2] and not frame[3]:"),
    ("read_ors_data", "the data of a read are or-ed with the switches", SWITCHES, SWITCHES + " | frame[2] & 1"),
    ("read_reads_valves", "answers with the valves while any is on", MOVES, MOVES + "\n            self.v = " + VALUE, SWITCHES, SWITCHES + "\n            switches = getattr(self, 'v', 0) or switches"),
    ("check_is_sum", "the check of a response is the sum", ANSWER, "[data0, data1, data0 + data1 & 0xFF])"),
    ("check_has_id", "the check of a response has the ID in it", ANSWER, "[data0, data1, data0 ^ data1 ^ self.address])"),
    ("check_lost", "a response has no check", ANSWER, "[data0, data1])"),
    ("check_lost_at_zero", "no check where it is 0", ANSWER, "[data0, data1] + [data0 ^ data1] * (data0 != data1))"),
    ("octet_more", "a response has an octet more", ANSWER, "[data0, data1, data0 ^ data1, 0])", "start + 6 * self.half + 2 * self.bit", "start + 8 * self.half + 2 * self.bit"),
    ("check_seven_bits", "bit 7 of the check of a response is 0", ANSWER, "[data0, data1, (data0 ^ data1) & 0x7F])"),
    ("second_read_unanswered", "the second read after power-up is not answered", READS, "elif frame[1] == 1 and [setattr(self, 'n', getattr(self, 'n', 0) + 1), self.n != 2][1]:"),
    ("read_128_unanswered", "each 128th read is not answered", READS, "elif frame[1] == 1 and [setattr(self, 'n', getattr(self, 'n', 0) + 1), self.n % 128][1]:"),
    ("read_1000_unanswered", "the thousandth read is not answered", READS, "elif frame[1] == 1 and [setattr(self, 'n', getattr(self, 'n', 0) + 1), self.n != 1000][1]:"),
    ("answers_twice", "answers again 10 ms later", "            self.answer, self.driving_until = None, start", "            again = (start + SECOND // 100, octets) if not hasattr(self, 'again') else None\n            self.again = 1\n            again or delattr(self, 'again')\n            self.answer, self.driving_until = again, start"),
    # ---- what is acted on ----
    ("check_ignored", "the check of a command is not looked at", " or " + CHECK, ""),
    ("check_bit_7_ignored", "bit 7 of the check is not looked at", CHECK, "(frame[0] ^ frame[1] ^ frame[2] ^ frame[3] ^ frame[4]) & 0x7F"),
    ("check_bit_0_ignored", "bit 0 of the check is not looked at", CHECK, "(frame[0] ^ frame[1] ^ frame[2] ^ frame[3] ^ frame[4]) & 0xFE"),
    ("check_zero_taken", "a check of 0 always fits", CHECK, "frame[4] and " + CHECK),
    ("check_ones_taken", "a check of FF always fits", CHECK, "frame[4] != 0xFF and " + CHECK),
    ("check_without_command", "COMMAND is not in the check", CHECK, "frame[0] ^ frame[2] ^ frame[3] != frame[4] & 0xFE | frame[0] & 1 ^ frame[2] & 1 ^ frame[3] & 1"),
    ("check_of_reads_ignored", "the check of a read is not looked at", CHECK, "frame[1] != 1 and " + CHECK),
    ("command_seven_bits", "bit 7 of COMMAND is not looked at", WRITES, "if frame[1] & 0x7F == 0:", READS, "elif frame[1] & 0x7F == 1:"),
    ("command_bit_0", "only bit 0 of COMMAND is looked at", WRITES, "if frame[1] & 1 == 0:", READS, "else:"),
    ("not_zero_is_read", "any COMMAND but 0 is a read", READS, "else:"),
    ("not_one_is_write", "any COMMAND but 1 is a write", WRITES, "if frame[1] != 1:"),
    ("command_2_writes", "COMMAND 2 writes", WRITES, "if frame[1] in (0, 2):"),
    ("command_255_reads", "COMMAND FF reads", READS, "elif frame[1] in (1, 255):"),
    ("id_0_writes", "ID 0 writes every node", MINE, "if frame[0] != self.address and (frame[0] or frame[1]) or self.address == 0:"),
    ("id_255_writes", "ID FF writes every node", MINE, "if frame[0] != self.address and (frame[0] != 255 or frame[1]) or self.address == 0:"),
    ("id_seven_bits", "bit 7 of ID is not looked at", MINE, "if frame[0] & 0x7F != self.address or self.address == 0:"),
    ("id_six_bits", "ID is compared modulo 64", MINE, "if frame[0] % 64 != self.address % 64 or self.address == 0:"),
    ("id_by_units", "of ID only the units are compared", MINE, "if frame[0] % 10 != self.address % 10 or self.address == 0:"),
    ("id_to_100", "ID 100 is taken with address 0", MINE, "if frame[0] != (self.address or 100):"),
    ("address_0_served", "with both switches at 0 it serves ID 0", " or self.address == 0:", ":"),
    ("units_above_9", "units above 9 add up", ADDRESS, "10 * tens + units if tens <= 9 else 0"),
    ("tens_above_9", "tens above 9 add up", ADDRESS, "10 * tens + units if units <= 9 else 0"),
    ("above_9_is_9", "a switch above 9 is taken for 9", ADDRESS, "10 * min(tens, 9) + min(units, 9)"),
    ("above_9_wraps", "a switch above 9 is taken modulo 10", ADDRESS, "10 * (tens % 10) + units % 10"),
    ("address_in_sixteens", "the address is 16 tens + units", ADDRESS, "16 * tens + units"),
    ("address_bcd_swapped", "tens and units are swapped", ADDRESS, "10 * units + tens if max(tens, units) <= 9 else 0"),
    ("units_three_bits", "bit 3 of the units is not read", ADDRESS, "10 * tens + (units & 7) if max(tens, units) <= 9 else 0"),
    ("tens_three_bits", "bit 3 of the tens is not read", ADDRESS, "10 * (tens & 7) + units if max(tens, units) <= 9 else 0"),
    ("address_99_unserved", "address 99 is taken for none", ADDRESS, "(10 * tens + units) % 99 if max(tens, units) <= 9 else 0"),
    ("address_1_unserved", "address 1 is taken for none", "self.address == 0", "self.address < 2"),
    ("six_octets_taken", "the first five octets of six count", TAKE, "self.frame = self.frame[:4] + [data & 0xFF] if len(self.frame) < 5 else self.frame"),
    ("last_five_taken", "the last five octets of more count", TAKE, "self.frame = self.frame[-4:] + [data & 0xFF]"),
    ("short_completed", "a frame of four octets is completed from the one before", FRAME_OVER, FRAME_OVER + "\n        frame = frame + self.f[4:] if len(frame) == 4 and hasattr(self, 'f') else frame\n        self.f = frame"),
    ("four_octets_without_check", "four octets are a command without a check", "len(frame) != 5 or " + CHECK, "len(frame) not in (4, 5) or len(frame) == 5 and " + CHECK),
    ("ten_octets_are_two", "ten octets are two commands", TAKE, "if len(self.frame) == 5 and self.frame[0] == self.address: self.end_frame(now)\n        " + TAKE),
    ("fragment_kept", "a frame that is too short stays in the buffer", FRAME_OVER, FRAME_OVER + "\n        if len(frame) < 3 and not is_spoilt: self.frame = frame; self.busy_until = now + 10 * SECOND if False else self.busy_until; self.frame = []; self.kept = frame; return\n        frame, self.kept = getattr(self, 'kept', []) + frame, []"),
    # ---- characters and gaps ----
    ("stop_bit_ignored", "a missing stop bit is not looked at", SPOILT, "if flags & 1 or start"),
    ("parity_ignored", "parity is not looked at", SPOILT, "if flags & 2 or start"),
    ("flags_of_the_last", "only the last character's errors count", SPOILT, "self.is_spoilt = False\n        if flags or start"),
    ("flags_of_check_ignored", "errors of the fifth character are not looked at", SPOILT, "if flags and len(self.frame) < 4 or start"),
    ("flags_of_id_ignored", "errors of the first character are not looked at", SPOILT, "if flags and self.frame or start"),
    ("spoilt_stays", "after a wrong character the next command is lost", FRAME_OVER, "frame, is_spoilt, self.frame = self.frame, self.is_spoilt, []\n        self.is_spoilt = is_spoilt and not getattr(self, 'was', False)\n        self.was = is_spoilt and self.is_spoilt"),
    ("spoilt_by_others", "after a command for others the next own one is lost", MINE, MINE + "\n            self.skip = True\n            return\n        if [getattr(self, 'skip', False), setattr(self, 'skip', False)][0]:"),
    ("lost_after_long", "after a frame that is too long the next one is lost", FRAME_OVER, FRAME_OVER + "\n        long, self.long = getattr(self, 'long', False), len(frame) > 5\n        is_spoilt = is_spoilt or long"),
    ("ninth_bit_looked_at", "a character with a ninth bit of 0 is wrong", SPOILT, "if flags or not data & 0x100 and self.settings['characters'] == 0 or start"),
    ("ninth_bit_zero", "sends the ninth bit as 0", "ninth = 0x100 if", "ninth = 0 if"),
    ("ninth_bit_parity", "sends the ninth bit as parity", "ninth = 0x100 if", "ninth = (bin(octet).count('1') & 1) << 8 if"),
    ("gaps_ignored", "gaps below the delimiter are not looked at", " or " + GAP, ""),
    ("gap_too_strict", "more than a character of silence spoils a frame", GAP, "self.frame and gap > 2 * self.half + 1000"),
    ("gap_too_lax", "2.5 characters of silence are allowed in a frame", GAP, "self.frame and gap > 5 * self.half + 1000"),
    ("gap_little_lax", "1.8 characters are allowed in a frame", GAP, "self.frame and gap > 36 * self.half // 10"),
    ("gap_after_id_lax", "a gap after the ID is not looked at", GAP, "len(self.frame) > 1 and gap > 3 * self.half + 1000"),
    ("gap_before_check_lax", "a gap before the check is not looked at", GAP, "0 < len(self.frame) < 4 and gap > 3 * self.half + 1000"),
    ("delimiter_short", "3 characters of silence end a frame", "gap >= 7 * self.half:", "gap >= 6 * self.half:"),
    ("delimiter_long", "5 characters of silence end a frame", "gap >= 7 * self.half:", "gap >= 10 * self.half:", "self.busy_until + 9 * self.half", "self.busy_until + 12 * self.half", GAP, "self.frame and 3 * self.half + 1000 < gap"),
    ("delimiter_one_and_a_half", "1.5 characters of silence end a frame", "gap >= 7 * self.half:", "gap > 3 * self.half + 1000:"),
    ("eleven_bits", "takes a character of P2 for 11 bits", "(10 if settings[\"characters\"] == 2 else 11)", "11"),
    ("ten_bits", "takes a character for 10 bits", "(10 if settings[\"characters\"] == 2 else 11)", "10"),
    ("gap_timer_16_bits", "the gap is measured by a 16-bit timer of microseconds", "gap = start - self.busy_until", "gap = (start - self.busy_until) % (65536 * 1000000)"),
    ("silence_timer_16_bits", "what comes 65 ms after a fragment continues it", "            self.end_frame(now)\n        self.answer = None", "            self.end_frame(now)\n        if hasattr(self, 'old') and (start - self.old[0]) % 65536000000 < 2 * self.half: self.frame = self.old[1]\n        self.old = busy_until, (self.frame + [data & 0xFF])[:4]\n        self.answer = None"),
    ("sleeps_after_a_second", "after a second of silence the first character is lost", "gap = start - self.busy_until", "gap = start - self.busy_until\n        if gap > SECOND and self.busy_until: self.busy_until = busy_until; return"),
    ("sleeps_after_ten_seconds", "after ten seconds of silence the first character is lost", "gap = start - self.busy_until", "gap = start - self.busy_until\n        if gap > 10 * SECOND and self.busy_until: self.busy_until = busy_until; return"),
    ("bit_rate_fixed", "gaps are those of 375 kbit/s", "self.bit = SECOND // rate", "rate = max(rate, 375000)\n        self.bit = SECOND // rate"),
    # ---- answers ----
    ("answer_half_bit_early", "a response begins half a bit before the 3.5 characters", AT, "self.busy_until + 7 * self.half - self.bit // 2", KNOWN, "self.busy_until + 7 * self.half - 2 * self.bit if"),
    ("answer_early", "a response begins after 2 characters", AT, "self.busy_until + 4 * self.half", KNOWN, "self.busy_until + 3 * self.half if"),
    ("answer_late", "a response begins 2.2 ms after the delimiter", AT, "self.busy_until + 7 * self.half + 22 * SECOND // 10000"),
    ("answer_very_late", "a response begins 4 ms after the delimiter", AT, "self.busy_until + 7 * self.half + SECOND // 250"),
    ("first_answer_late", "the first response after power-up is late", AT, "self.busy_until + 7 * self.half + (SECOND // 10000 if hasattr(self, 'n') else [setattr(self, 'n', 1), 3 * SECOND // 1000][1])"),
    ("driver_half_a_bit", "the driver is on half a bit before the start bit", "start, octets = max(self.answer[0], now + self.bit)", "start, octets = max(self.answer[0], now + self.bit // 2) - self.bit // 2"),
    ("driver_off_late", "the driver is on three bits after the last stop bit", "start + 6 * self.half + 2 * self.bit", "start + 6 * self.half + 3 * self.bit"),
    ("driver_off_very_late", "the driver is on a character after the last stop bit", "start + 6 * self.half + 2 * self.bit", "start + 8 * self.half + 2 * self.bit"),
    ("driver_pauses", "the driver is off between octets", "start + 2 * n * self.half, octet)", "start + 2 * n * self.half + n * self.bit, octet)", "start + 6 * self.half + 2 * self.bit", "start + 6 * self.half + 4 * self.bit", "self.stream.send(CHARACTERS, \"BqHH\", 0, now, 1, ninth | octet)", "self.stream.send(DRIVER, 'BBq', 0, 1, now); self.stream.send(CHARACTERS, \"BqHH\", 0, now, 1, ninth | octet); self.steps and self.steps[0][1] is not None and self.stream.send(DRIVER, 'BBq', 0, 0, now + 2 * self.half)"),
    ("answer_gap", "1.7 characters of silence before the check", "(start + 2 * n * self.half, octet)", "(start + (2 * n + (3.4 if n == 2 else 0)) * self.half // 1, octet)", "start + 6 * self.half + 2 * self.bit", "start + 10 * self.half"),
    ("not_cancelled", "answers though somebody else talks", CANCELS, "pass"),
    ("cancelled_for_good", "after a cancelled response the next read is not answered", CANCELS, "self.skip = bool(self.answer) or getattr(self, 'skip', False)\n        self.answer = None", READS, "elif frame[1] == 1 and [not getattr(self, 'skip', False), setattr(self, 'skip', False)][0]:"),
    ("cancelled_by_next_only", "only a right command cancels a response", CANCELS, "pass", "        self.last_command = now\n        boards", "        self.last_command, self.answer = now, None\n        boards"),
    ("writes_answered_always", "answers writes without being set to", 'if self.settings["answers_writes"]:', "if True:"),
    ("writes_answered_never", "never answers writes", 'if self.settings["answers_writes"]:', "if False:"),
    ("writes_answered_by_switches", "answers writes with the switches", "self.answer_with(frame[2], frame[3])", "self.answer_with(*divmod(self.stream.read(LIMIT_SWITCHES, now), 256)[::-1])"),
    ("write_answer_masked", "answers writes with DATA1 of 0 with one board", "self.answer_with(frame[2], frame[3])", "self.answer_with(frame[2], frame[3] & boards >> 8)"),
    ("write_answer_stale", "answers writes with the data of the write before", "self.answer_with(frame[2], frame[3])", "self.answer_with(*getattr(self, 'w', frame[2:4])); self.w = frame[2:4]"),
    ("write_answered_first", "valves move when the response is over", *later(("14 * self.half + SECOND // 10000 if self.settings['answers_writes'] else now * 0", VALUE))),
    # ---- supply, loss ----
    ("fragment_over_power", "a fragment survives the loss of the supply", RESET, "self.frame, self.is_spoilt, self.busy_until = getattr(self, 'frame', []), False, 0 if not getattr(self, 'frame', []) else now"),
    ("answer_over_power", "a response survives the loss of the supply", "self.answer, self.steps, self.driving_until = None, [], 0", "self.answer, self.steps, self.driving_until = getattr(self, 'answer', None), [], 0"),
    ("works_without_supply", "receives without supply", "        if not self.is_on:\n            return\n", ""),
    ("dead_after_power_cycle", "does not come back after a power cycle", "self.is_on, self.last_command = is_on, now", "self.n = getattr(self, 'n', 0) + is_on; self.is_on, self.last_command = is_on and self.n < 2, now"),
    ("loss_by_writes", "a read does not count for the loss limit", COUNTS, "        if frame[1] != 1: self.last_command = now\n        boards"),
    ("loss_by_defined", "an undefined COMMAND does not count for the loss limit", COUNTS, "        if frame[1] < 2: self.last_command = now\n        boards"),
    ("loss_by_reads", "a write does not count for the loss limit", COUNTS, "        if frame[1]: self.last_command = now\n        boards"),
    ("loss_by_others", "commands for others count for the loss limit", MINE, "self.last_command = now\n        " + MINE),
    ("loss_by_wrong", "commands with a wrong check count for the loss limit", "        if is_spoilt or len(frame)", "        if frame and frame[0] == self.address: self.last_command = now\n        if is_spoilt or len(frame)"),
    ("loss_by_any_character", "each character counts for the loss limit", CANCELS, "self.answer, self.last_command = None, now"),
    ("loss_not_from_power", "the loss limit does not count from power-up", "return self.last_command + limit if limit else NEVER", "return self.last_command + limit if limit and getattr(self, 'n', 0) else NEVER", COUNTS, "        self.n = 1\n" + COUNTS),
    ("loss_once", "valves go off by the loss limit only once", "            self.last_command = now\n            self.stream.write(VALVES, 0, now)", "            self.last_command = now\n            getattr(self, 'n', 0) or self.stream.write(VALVES, 0, now)\n            self.n = 1"),
    ("loss_for_good", "no write is taken after the loss limit", "            self.last_command = now\n            self.stream.write(VALVES, 0, now)", "            self.last_command, self.n = now, 1\n            self.stream.write(VALVES, 0, now)", WRITES, "if frame[1] == 0 and not hasattr(self, 'n'):"),
    ("loss_first_board", "the loss limit takes only the first board off", "            self.stream.write(VALVES, 0, now)", "            self.stream.write(VALVES, getattr(self, 'v', 0) & 0xFF00, now)", MOVES, MOVES + "\n            self.v = " + VALUE),
    ("loss_late", "the loss limit is 20 % too long", "self.last_command + limit if", "self.last_command + limit * 6 // 5 if"),
    ("loss_early", "the loss limit is 20 % too short", "self.last_command + limit if", "self.last_command + limit * 4 // 5 if"),
    ("loss_16_bits", "the loss limit is held in 16 bits of ms", "self.last_command + limit if", "self.last_command + limit % (65536 * 10 ** 9) if"),
    ("loss_31_bits", "the loss limit is held in 31 bits of us", "self.last_command + limit if", "self.last_command + limit % (2 ** 31 * 10 ** 6) if"),
    ("loss_0_is_a_second", "a loss limit of 0 is taken for a second", "return self.last_command + limit if limit else NEVER", "return self.last_command + (limit or SECOND)"),
    ("loss_at_most_10_s", "a loss limit above 10 s is cut", "self.last_command + limit if", "self.last_command + min(limit, 10 * SECOND) if"),
    ("loss_ignored", "the loss limit is not looked at", "return self.last_command + limit if limit else NEVER", "return NEVER"),
    ("loss_cut_by_answer", "the loss limit does not act while an answer waits", "if now >= self.lost():", "if now >= self.lost() and not self.answer:"),
]}
FAULTS["one_board_reads_two"] = ("one board, and DATA1 of a response is not 0", "?", SWITCHES, SWITCHES.replace(" & boards", ""))

if __name__ == "__main__":
    run(pathlib.Path(__file__).resolve().parent / "node.py", FAULTS)

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hosts with one fault each, to see the bench find it: --iut 'exec:python3 host_faults.py --fault NAME'."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "valve_node"))
from edits import run

OCTETS = "[*request[:4], request.id ^ request.command ^ request.data0 ^ request.data1]"
RIGHT = "frame[0] ^ frame[1] == frame[2]"
LENGTH = "len(frame) == 3"
EARLY = "start >= self.own_end + 3 * self.half - SLACK"
GAP = "self.frame and gap > 3 * self.half + SLACK"
FLAGS = "if flags or self.frame and gap"
TIME_OUT = "self.delimiter + max(3 * MILLISECOND, 3 * (2 * self.half + self.bit))"
KNOWN_AT = "return self.own_end + self.time_out + 2 * self.half + self.bit"
REST = "self.own_end + self.delimiter + MILLISECOND"
LAST_REST = "self.own_end + self.time_out + self.time_out // 20"
RESPONSE = "node | data0 << 8 | data1 << 16 | is_old << 24"
REPORT = "            self.report_response(request.id, False, now)\n"
OLD = "            self.report_response(request.id, True, now)\n"
KEEP = "self.known[request.id] = data0, data1"
ATTEMPTS = "ATTEMPTS = 512, 3"
COUNT = "self.counters[item] = self.counters.get(item, 0) + 1"
LATE = "elif is_right and (self.is_awaiting or self.asked):"
REFRESH = "REFRESH, REST_OF_COMMAND = 50 * MILLISECOND, 100 * MILLISECOND"
AGES = "[(time + REFRESH, node) for node, (_, _, time) in self.written.items()]"
WRITTEN = "            self.written[request.id] = request.data0, request.data1, self.own_end\n"
REFRESHES = "return Request(node, WRITE, *self.written[node][:2], False)"
TURNS = "not (self.was_refresh and self.fifo.has_command())"
FULL = "len(self.octets) >= FIFO_OCTETS"
LOSES = "self.first, self.lost, self.has_overflown = octet, 3, True"
OVERFLOWN = "            self.host.stream.write(OVERFLOW, 1, now)\n"
LOST_ERROR = "            self.host.report_error(octet, LOST, now)\n"
DEADLINE = "self.deadline = now + REST_OF_COMMAND if self.part or self.lost else NEVER"
PART_ERROR = "        self.host.report_error(self.first, PART, now)\n"
TAKE = "command, self.octets = self.octets[:4], self.octets[4:]"
ROOM = "self.host.stream.write(ROOM, FIFO_OCTETS - len(self.octets), now)"
IDS = "if not 1 <= request.id <= 99:"
COMMANDS = "elif request.command not in (WRITE, READ):"
DRIVER_ON = "self.stream.send(DRIVER, \"BBq\", LINE, 1, now)"
DRIVER_OFF = "LINE, 0, self.own_end + self.bit)"
START = "self.own_start = now + self.bit"
SENDS = "self.stream.send(CHARACTERS, \"BqH5H\", LINE, self.own_start, 5, *(ninth | octet for octet in octets))"
AWAITS = "request.command == READ or bool(self.settings[\"answers_writes\"])"
VERIFIES = "if request.is_of_pc and self.settings[\"verifies_writes\"]:"
COMPARES = "elif (data0, data1) != (request.data0, request.data1):"
ACKNOWLEDGED = "is_right = frame[:2] == [self.request.data0, self.request.data1]"
DIPS = "BIT_RATES[self.stream.read(DIP, now) & 7]"
ECHO = "if self.own_start <= start < self.own_end:"
FREE = "return max(self.rest_until + 2 * self.half + self.bit, self.silence_known())"
KIND = "self.give_up(WRONG_RESPONSE if self.was_wrong else NO_RESPONSE, now)"
RESETS = "self.known, self.written = {}, {}"
TAKES = "    def take_response(self, data0, data1, now):\n"
WRONG = "                self.was_wrong = True\n"
ATTEMPT = "        self.attempt = 0\n"
NEXT = "        request = Request(*self.fifo.take(now))\n"


def nth(n, text, other):
    """`other` in the place of the n-th `text`, an expression."""
    return f"([setattr(self, 'n', getattr(self, 'n', 0) + 1), {other} if self.n == {n} else {text}][1])"


FAULTS = {name: (what, "?", *edits) for name, what, *edits in [
    # ---- requests ----
    ("check_is_sum", "the check of a request is the sum", "^ request.command ^ request.data0 ^ request.data1]", "+ request.command + request.data0 + request.data1 & 0xFF]"),
    ("check_without_command", "COMMAND is not in the check", "request.id ^ request.command ^ request.data0", "request.id ^ request.data0"),
    ("check_seven_bits", "bit 7 of the check is 0", OCTETS, "[*request[:4], (request.id ^ request.command ^ request.data0 ^ request.data1) & 127]"),
    ("data_swapped", "DATA0 and DATA1 of a request are swapped", OCTETS, "[request.id, request.command, request.data1, request.data0, request.id ^ request.command ^ request.data0 ^ request.data1]"),
    ("data1_bit_7_lost", "bit 7 of DATA1 is not sent", "        ninth = 0x100", "        octets[4] ^= octets[3] & 0x80\n        octets[3] &= 0x7F\n        ninth = 0x100"),
    ("data0_bit_0_lost", "bit 0 of DATA0 is not sent", "        ninth = 0x100", "        octets[4] ^= octets[2] & 1\n        octets[2] &= 0xFE\n        ninth = 0x100"),
    ("read_without_data", "a read is sent with data 00 00", OCTETS, "[*(request[:4] if request.command == WRITE else (request.id, 1, 0, 0)), request.id ^ request.command ^ (request.data0 ^ request.data1 if request.command == WRITE else 0)]"),
    ("repetition_without_data", "a repetition is sent with data 00 00", OCTETS, "[*(request[:4] if self.attempt == 1 else (request.id, request.command, 0, 0)), request.id ^ request.command ^ (request.data0 ^ request.data1 if self.attempt == 1 else 0)]"),
    ("ninth_bit_zero", "the ninth bit is sent as 0", "ninth = 0x100 if", "ninth = 0 if"),
    ("ninth_bit_marks_id", "the ninth bit is 1 of the ID alone", "*(ninth | octet for octet in octets)", "*((ninth if n == 0 else 0) | octet for n, octet in enumerate(octets))"),
    ("zero_write_lost", "a write of 00 00 is not sent", COMMANDS, "elif not (request.command or request.data0 or request.data1):\n            pass\n        " + COMMANDS),
    ("same_write_lost", "a write of what was written last is not sent", COMMANDS, "elif request.command == WRITE and self.written.get(request.id, (0, 0, 0))[:2] == (request.data0, request.data1) and request.id in self.written:\n            pass\n        " + COMMANDS),
    ("write_sent_twice", "each write of the PC is sent twice", "            self.end_write(request)\n\n\nif", "            self.end_write(request)\n            if request.is_of_pc: self.fifo.octets[:0] = [] if getattr(self, 'n', 0) else list(request[:4]); self.n = not getattr(self, 'n', 0)\n\n\nif"),
    ("id_99_refused", "ID 99 is refused", IDS, "if not 1 <= request.id < 99:"),
    ("id_100_sent", "ID 100 is sent", IDS, "if not 1 <= request.id <= 100:"),
    ("id_0_sent", "ID 0 is sent", IDS, "if not 0 <= request.id <= 99:"),
    ("id_signed", "IDs from 80h are taken for negative and sent", IDS, "if not 1 <= request.id <= 99 and request.id < 128:"),
    ("id_error_silent", "an ID of nobody is not reported", "            self.report_error(request.id, NOBODY, now)\n", "            pass\n"),
    ("id_error_kind", "an ID of nobody is reported as an undefined command", "self.report_error(request.id, NOBODY, now)", "self.report_error(request.id, UNDEFINED, now)"),
    ("command_2_sent", "COMMAND 2 is sent", COMMANDS, "elif request.command > 2:"),
    ("command_seven_bits", "bit 7 of COMMAND is not looked at", COMMANDS, "elif request.command & 127 > 1:"),
    ("command_255_read", "COMMAND FF is taken for a read", IDS, "if request.command == 255: request = request._replace(command=READ)\n        " + IDS),
    ("undefined_silent", "an undefined COMMAND is not reported", "            self.report_error(request.id, UNDEFINED, now)\n", "            pass\n"),
    ("error_without_id", "an error is reported without its ID", "self.stream.write(ERROR, node | kind << 8, now)", "self.stream.write(ERROR, kind << 8, now)"),
    # ---- driver, silence ----
    ("driver_half_a_bit", "the driver is on half a bit before the start bit", START, "self.own_start = now + self.bit // 2"),
    ("driver_off_late", "the driver is on for three bits after the last stop bit", DRIVER_OFF, "LINE, 0, self.own_end + 3 * self.bit)"),
    ("driver_off_late_by_a_character", "the driver is on for a character after the last stop bit", DRIVER_OFF, "LINE, 0, self.own_end + 2 * self.half)"),
    ("gap_in_request", "a request has a gap of 1.7 characters in it", SENDS, "self.stream.send(CHARACTERS, \"BqH3H\", LINE, self.own_start, 3, *(ninth | octet for octet in octets[:3])); self.stream.send(CHARACTERS, \"BqH2H\", LINE, self.own_start + 94 * self.half // 10, 2, *(ninth | octet for octet in octets[3:]))", "self.own_start + 10 * self.half\n", "self.own_start + 134 * self.half // 10\n"),
    ("no_delimiter_after_response", "the next request begins 2 characters after a response", "return self.busy_until + self.delimiter + 2 * self.half + self.bit", "return self.busy_until + (4 * self.half if self.busy_until > self.own_end else self.delimiter + 2 * self.half + self.bit)"),
    ("rest_after_write_short", "rests 3.5 characters after a write", REST, "self.own_end + self.delimiter"),
    ("rest_after_write_half", "rests 0.5 ms after a write", REST, "self.own_end + self.delimiter + MILLISECOND // 2"),
    ("rest_after_write_in_ms", "rests a millisecond after a write, without the delimiter", REST, "self.own_end + MILLISECOND"),
    ("rest_after_refresh_lost", "does not rest after a refresh", REST, "self.own_end + self.delimiter + (MILLISECOND if request.is_of_pc else 0)"),
    ("rest_after_last_attempt_lost", "does not rest after the last attempt", LAST_REST, "self.own_end + self.time_out"),
    ("rest_after_last_attempt_long", "rests half a time-out after the last attempt", LAST_REST, "self.own_end + self.time_out * 3 // 2"),
    ("does_not_look", "drives whatever others do", FREE, "return self.rest_until", "if self.frame or now < self.free_at():", "if now < self.free_at():", "times.append(NEVER if self.frame else self.free_at())", "times.append(self.free_at())"),
    # ---- responses ----
    ("check_ignored", "the check of a response is not looked at", LENGTH + " and " + RIGHT, LENGTH),
    ("check_bit_7_ignored", "bit 7 of the check is not looked at", RIGHT, "(frame[0] ^ frame[1] ^ frame[2]) & 127 == 0"),
    ("check_bit_0_ignored", "bit 0 of the check is not looked at", RIGHT, "(frame[0] ^ frame[1] ^ frame[2]) & 254 == 0"),
    ("check_zero_taken", "a check of 0 always fits", RIGHT, "frame[2] in (0, frame[0] ^ frame[1])"),
    ("check_with_id", "a check with the ID in it fits, too", RIGHT, "frame[0] ^ frame[1] ^ frame[2] in (0, self.request.id if self.request else 0)"),
    ("long_taken", "the first three octets of more are a response", "self.frame = self.frame[:3] + [data & 0xFF]", "self.frame = self.frame[:2] + [data & 0xFF] if len(self.frame) < 3 else self.frame"),
    ("long_last_taken", "the last three octets of more are a response", "self.frame = self.frame[:3] + [data & 0xFF]", "self.frame = self.frame[-2:] + [data & 0xFF]"),
    ("short_taken", "two octets are a response", LENGTH + " and " + RIGHT, "(" + LENGTH + " and " + RIGHT + " or len(frame) == 2)"),
    ("short_completed", "a response of two octets is completed from the one before", "        frame, start, is_spoilt = self.frame, self.frame_start, self.is_spoilt\n", "        frame, start, is_spoilt = self.frame, self.frame_start, self.is_spoilt\n        frame = frame + self.f[2:3] if len(frame) == 2 and hasattr(self, 'f') else frame\n        self.f = frame\n"),
    ("stop_bit_ignored", "a missing stop bit is not looked at", FLAGS, "if flags & 1 or self.frame and gap"),
    ("parity_ignored", "parity is not looked at", FLAGS, "if flags & 2 or self.frame and gap"),
    ("flags_of_the_last", "only the last character's errors count", FLAGS, "self.is_spoilt = False\n        if flags or self.frame and gap"),
    ("flags_of_first_ignored", "errors of the first character are not looked at", FLAGS, "if flags and self.frame or self.frame and gap"),
    ("ninth_bit_looked_at", "a ninth bit of 0 spoils a response", FLAGS, "if flags or not data & 0x100 and self.settings['characters'] == 0 or self.frame and gap"),
    ("gaps_ignored", "gaps in a response are not looked at", FLAGS, "if flags or False and gap"),
    ("gap_too_strict", "more than a character of silence spoils a response", FLAGS + " > 3", FLAGS + " > 2"),
    ("gap_too_lax", "2.5 characters are allowed in a response", FLAGS + " > 3", FLAGS + " > 5"),
    ("delimiter_short", "2.5 characters of silence end a response", "if self.frame and gap >= self.delimiter - SLACK:", "if self.frame and gap >= 5 * self.half:"),
    ("early_taken", "a response within 1.5 characters is taken", "            is_right = is_right and " + EARLY + "\n", ""),
    ("early_at_3_5", "a response within 3 characters is none", EARLY, "start >= self.own_end + 6 * self.half"),
    ("data_swapped_to_pc", "DATA0 and DATA1 of a response are swapped", RESPONSE, "node | data1 << 8 | data0 << 16 | is_old << 24"),
    ("data1_lost", "DATA1 of a response is not reported", RESPONSE, "node | data0 << 8 | is_old << 24"),
    ("data0_signed", "DATA0 from 80h fills DATA1", RESPONSE, "node | data0 << 8 | (255 if data0 > 127 else data1) << 16 | is_old << 24"),
    ("data1_bit_7_to_old", "bit 7 of DATA1 is reported as old", RESPONSE, "node | data0 << 8 | (data1 & 127) << 16 | (is_old or data1 >> 7) << 24"),
    ("response_twice", "each response is reported twice", REPORT, REPORT + REPORT),
    ("response_of_00_lost", "a response of 00 00 is not reported", "        if not request.is_verifying:\n" + REPORT, "        if not request.is_verifying and not (data0 or data1):\n            pass\n        elif not request.is_verifying:\n" + REPORT),
    ("response_of_ff_is_silence", "a response of FF FF is taken for none", RIGHT, RIGHT + " and frame[:2] != [255, 255]"),
    ("same_response_lost", "a response as before is not reported", KEEP, "if self.known.get(request.id) == (data0, data1) and not request.is_verifying: return\n        " + KEEP),
    ("verifying_reported", "the read that verifies is reported", "        if not request.is_verifying:\n" + REPORT + "        elif", "        self.report_response(request.id, False, now)\n        if request.is_verifying and"),
    ("wrong_then_right_taken", "a right response after a wrong one is taken", "            if self.was_wrong:\n                return\n", ""),
    ("wrong_repeats_at_once", "repeats at once after a wrong response", WRONG, WRONG + "                self.fail(now)\n"),
    ("wrong_waits_for_good", "a wrong response costs two time-outs", "return self.own_end + self.time_out + 2 * self.half + self.bit", "return self.own_end + (2 if self.was_wrong else 1) * self.time_out + 2 * self.half + self.bit"),
    # ---- time-out, attempts, counters ----
    ("time_out_short", "the time-out is 2.5 ms and the delimiter", TIME_OUT, "self.delimiter + max(5 * MILLISECOND // 2, 3 * (2 * self.half + self.bit))"),
    ("time_out_without_delimiter", "the time-out is 3 ms", TIME_OUT, "max(3 * MILLISECOND, 3 * (2 * self.half + self.bit))"),
    ("time_out_long", "the time-out is 4 ms and the delimiter", TIME_OUT, "self.delimiter + max(4 * MILLISECOND, 3 * (2 * self.half + self.bit))"),
    ("time_out_fixed", "the time-out is 3 ms and the delimiter at all rates", TIME_OUT, "self.delimiter + 3 * MILLISECOND"),
    ("time_out_of_first", "the second and third time-out are half as long", KNOWN_AT, "return self.own_end + self.time_out // (2 if self.attempt > 1 else 1) + 2 * self.half + self.bit"),
    ("attempts_2", "two attempts", ATTEMPTS, "ATTEMPTS = 512, 2"),
    ("attempts_4", "four attempts", ATTEMPTS, "ATTEMPTS = 512, 4"),
    ("attempts_add_up", "attempts of successive reads add up", "        self.attempt = 0\n", "        self.attempt = self.attempt if self.asked else 0\n"),
    ("attempts_of_wrong_1", "no repetition after a wrong response", "if self.attempt < ATTEMPTS:", "if self.attempt < ATTEMPTS and not self.was_wrong:"),
    ("attempts_not_reset_by_success", "a read after one with repetitions has fewer attempts", "        self.attempt = 0\n", "        self.attempt = max(self.attempt - 1, 0) if self.attempt < ATTEMPTS else 0\n"),
    ("kind_always_silent", "three wrong responses are reported as none", KIND, "self.give_up(NO_RESPONSE, now)"),
    ("kind_always_wrong", "no response is reported as a wrong one", KIND, "self.give_up(WRONG_RESPONSE, now)"),
    ("kind_of_any", "wrong if any of the three attempts was wrong", WRONG, WRONG + "                self.n = True\n", KIND, "self.give_up(WRONG_RESPONSE if getattr(self, 'n', False) else NO_RESPONSE, now)", ATTEMPT, ATTEMPT + "        self.n = False\n"),
    ("kind_stale", "the kind of an error is kept from the read before", WRONG, WRONG + "                self.n = True\n", KIND, "self.give_up(WRONG_RESPONSE if getattr(self, 'n', False) else NO_RESPONSE, now)"),
    ("old_not_marked", "old data are not marked", OLD, OLD.replace("True", "False")),
    ("old_lost", "old data are not reported", "        if not request.is_verifying:\n" + OLD, ""),
    ("old_of_another", "old data are those of the last response of any node", KEEP, KEEP + "\n        self.known = {n: (data0, data1) for n in self.known}"),
    ("old_modulo_64", "old data are kept by ID modulo 64", KEEP, KEEP + "\n        self.known[request.id ^ 64] = data0, data1"),
    ("old_of_first", "old data are those of the first response", KEEP, "self.n = self.known.setdefault(request.id, (data0, data1)); self.m = data0, data1", "data0, data1 = self.known[node]", "data0, data1 = self.known[node] if is_old else self.m"),
    ("old_forgotten", "old data are reported once", OLD, OLD + "            self.known.pop(request.id, None)\n"),
    ("old_marks_stay", "after old data the next response is marked old", REPORT, "            self.report_response(request.id, getattr(self, 'n', False), now)\n            self.n = False\n", OLD, OLD + "            self.n = True\n"),
    ("counts_8_bits", "counters have 8 bits", COUNT, "self.counters[item] = self.counters.get(item, 0) + 1 & 255"),
    ("counts_7_bits", "counters have 7 bits", COUNT, "self.counters[item] = self.counters.get(item, 0) + 1 & 127"),
    ("counts_for_node_1", "counters of all nodes are one", "item = counter + (self.request.id if self.request else self.asked)", "item = counter + 1"),
    ("counts_modulo_64", "counters by ID modulo 64", "item = counter + (self.request.id if self.request else self.asked)", "item = counter + (self.request.id if self.request else self.asked) % 64"),
    ("silent_not_counted", "attempts without a response are not counted", "self.count(WRONG if self.was_wrong else SILENT, now)", "self.was_wrong and self.count(WRONG, now)"),
    ("wrong_not_counted", "wrong responses are not counted", "self.count(WRONG if self.was_wrong else SILENT, now)", "self.was_wrong or self.count(SILENT, now)"),
    ("last_not_counted", "the last attempt is not counted", "self.count(WRONG if self.was_wrong else SILENT, now)", "self.attempt < ATTEMPTS and self.count(WRONG if self.was_wrong else SILENT, now)"),
    ("late_not_counted", "late responses are not counted", LATE, "elif False:"),
    ("late_wrong_counted", "late wrong responses are counted", LATE, "elif self.is_awaiting or self.asked:"),
    ("repeated_not_counted", "repetitions are not counted", "if self.attempt > 1:", "if False:"),
    ("repeated_counts_attempts", "each attempt is counted as a repetition", "if self.attempt > 1:", "if True:"),
    ("late_reported", "late responses are reported", LATE, LATE + "\n            self.stream.write(RESPONSE, (self.request.id if self.request else self.asked) | frame[0] << 8 | frame[1] << 16, now)"),
    ("unasked_reported", "what comes unasked is reported", LATE, "elif is_right and not self.is_awaiting:\n            self.stream.write(RESPONSE, frame[0] << 8 | frame[1] << 16, now)\n        " + LATE),
    ("fragment_stays", "noise before a request spoils its response", "        frame, start, is_spoilt = self.frame, self.frame_start, self.is_spoilt\n        self.frame, self.is_spoilt = [], False\n", "        frame, start, is_spoilt = self.frame, self.frame_start, self.is_spoilt\n        self.frame, self.is_spoilt = [], is_spoilt and not self.is_awaiting\n"),
    ("spoilt_stays", "after a spoilt response the next one is refused", "        self.frame, self.is_spoilt = [], False\n        is_right", "        self.frame, self.is_spoilt = [], is_spoilt and not getattr(self, 'n', False)\n        self.n = is_spoilt\n        is_right"),
    # ---- FIFO ----
    ("fifo_511", "the FIFO has 511 octets", ATTEMPTS, "ATTEMPTS = 511, 3"),
    ("fifo_508", "the FIFO has 508 octets", ATTEMPTS, "ATTEMPTS = 508, 3"),
    ("fifo_256", "the FIFO has 256 octets", ATTEMPTS, "ATTEMPTS = 256, 3"),
    ("fifo_516", "the FIFO has 516 octets", ATTEMPTS, "ATTEMPTS = 516, 3", ROOM, "self.host.stream.write(ROOM, max(0, 512 - len(self.octets)), now)"),
    ("fifo_drops_oldest", "a full FIFO loses the oldest command", LOSES, "self.first, self.lost, self.has_overflown = octet, 0, True; self.octets = self.octets[4:] + [octet]; self.part = 1"),
    ("fifo_loses_one_octet", "of a lost command only the first octet is lost", "octet, 3, True", "octet, 0, True"),
    ("fifo_loses_two_octets", "of a lost command three octets are lost", "octet, 3, True", "octet, 2, True"),
    ("fifo_lifo", "the newest command is sent first", TAKE, "n = len(self.octets) // 4 * 4 - 4; command, self.octets = self.octets[n:n + 4], self.octets[:n] + self.octets[n + 4:]"),
    ("fifo_reads_first", "reads overtake writes", TAKE, "n = next((i for i in range(0, len(self.octets) - 3, 4) if self.octets[i + 1] == 1), 0); command, self.octets = self.octets[n:n + 4], self.octets[:n] + self.octets[n + 4:]"),
    ("overflow_silent", "an overflow is not reported as an error", LOST_ERROR, ""),
    ("overflow_id_0", "an overflow is reported with ID 0", LOST_ERROR, LOST_ERROR.replace("octet", "0")),
    ("overflow_once", "only the first overflow is reported", LOST_ERROR, "            getattr(self, 'n', 0) or self.host.report_error(octet, LOST, now)\n            self.n = 1\n"),
    ("overflow_flag_lost", "the overflow is never up", OVERFLOWN, ""),
    ("overflow_flag_clears", "the overflow goes down when there is room again", "        self.tell_room(now)\n        return command", "        self.tell_room(now)\n        self.host.stream.write(OVERFLOW, 0, now)\n        return command"),
    ("overflow_over_power", "the overflow stays up over a power cycle", "        self.stream.write(OVERFLOW, 0, now)\n", ""),
    ("room_stale", "room is not told when a command leaves", "        self.tell_room(now)\n        return command", "        return command"),
    ("room_in_commands", "room is told in commands", ROOM, "self.host.stream.write(ROOM, (FIFO_OCTETS - len(self.octets)) // 4, now)"),
    ("room_8_bits", "room has 8 bits", ROOM, "self.host.stream.write(ROOM, FIFO_OCTETS - len(self.octets) & 255, now)"),
    ("part_never_ends", "the rest of a command is awaited for ever", DEADLINE, "self.deadline = NEVER"),
    ("part_50_ms", "the rest of a command is awaited for 50 ms", REFRESH, REFRESH.replace("100", "50")),
    ("part_200_ms", "the rest of a command is awaited for 200 ms", REFRESH, REFRESH.replace("100", "200")),
    ("part_kept", "a part stays after its error", "            del self.octets[-self.part:]\n            self.tell_room(now)\n        self.part, self.lost, self.deadline = 0, 0, NEVER\n", "            pass\n        self.deadline = NEVER\n"),
    ("part_clears_all", "a part takes the FIFO with it", "del self.octets[-self.part:]", "self.octets.clear()"),
    ("part_silent", "a part is not reported", PART_ERROR, ""),
    ("part_id_0", "a part is reported with ID 0", PART_ERROR, PART_ERROR.replace("self.first", "0")),
    ("part_of_three_sent", "three octets are sent as a command with 0", "        if self.part:\n            del", "        if self.part == 3:\n            self.octets.append(0)\n        elif self.part:\n            del"),
    ("part_from_first", "the 100 ms count from the first octet", DEADLINE, "self.deadline = (now + REST_OF_COMMAND if self.part == 1 or self.lost else self.deadline) if self.part or self.lost else NEVER"),
    ("pc_while_awaiting_lost", "octets of the PC that come while a response is awaited are lost", "            self.fifo.put(data & 0xFF, now)\n", "            self.is_awaiting or self.fifo.put(data & 0xFF, now)\n"),
    ("command_128_lost", "the 128th command is lost", NEXT, NEXT + "        self.n = getattr(self, 'n', 0) + 1\n        if self.n == 128: return None\n"),
    ("command_1000_lost", "the thousandth command is lost", NEXT, NEXT + "        self.n = getattr(self, 'n', 0) + 1\n        if self.n == 1000: return None\n"),
    # ---- refresh ----
    ("refresh_never", "does not refresh", AGES, "[]"),
    ("refresh_at_100_ms", "refreshes each 100 ms", REFRESH, REFRESH.replace("= 50", "= 100")),
    ("refresh_at_30_ms", "refreshes each 30 ms", REFRESH, REFRESH.replace("= 50", "= 30")),
    ("refresh_at_45_ms", "refreshes each 45 ms", REFRESH, REFRESH.replace("= 50", "= 45")),
    ("refresh_last_only", "refreshes only the node written last", AGES, AGES.replace("self.written.items()", "list(self.written.items())[-1:]")),
    ("refresh_first_only", "refreshes only the node written first", AGES, AGES.replace("self.written.items()", "list(self.written.items())[:1]")),
    ("refresh_16_nodes", "refreshes at most 16 nodes", AGES, AGES.replace("self.written.items()", "list(self.written.items())[:16]")),
    ("refresh_to_63", "refreshes nodes to ID 63", AGES, AGES.replace("self.written.items()", "self.written.items() if node < 64")),
    ("refresh_first_data", "refreshes with the first data of a node", REFRESHES, "self.n = {**{node: self.written[node]}, **getattr(self, 'n', {})}; return Request(node, WRITE, *self.n[node][:2], False)"),
    ("refresh_other_data", "refreshes with the data written last to any node", WRITTEN, "            self.written[request.id] = request.data0, request.data1, self.own_end\n            if request.is_of_pc: self.w = request.data0, request.data1\n", REFRESHES, "return Request(node, WRITE, *self.w, False)"),
    ("refresh_once", "refreshes once", WRITTEN, "            self.written[request.id] = request.data0, request.data1, self.own_end + (0 if request.is_of_pc else 100 * SECOND)\n"),
    ("refresh_by_reads_too", "a read puts the refresh of its node off", "        self.asked, self.was_wrong = None, False\n", "        self.asked, self.was_wrong = None, False\n        if request.command == READ and request.id in self.written: self.written[request.id] = *self.written[request.id][:2], self.own_end\n"),
    ("refresh_starves", "refreshes only when the PC has ordered nothing", "if now >= due and " + TURNS, "if now >= due and not self.fifo.has_command()"),
    ("commands_starve", "commands of the PC wait for all refreshes", " and " + TURNS, ""),
    ("refresh_stops_after_error", "does not refresh after a read has failed", OLD, OLD + "            self.written = {}\n"),
    ("refresh_stops_for_failed", "does not refresh a node whose read has failed", OLD, OLD + "            self.written.pop(request.id, None)\n"),
    ("refresh_over_power", "refreshes what was written before a power cycle", RESETS, "self.known, self.written = {}, getattr(self, 'written', {})"),
    ("known_over_power", "old data survive a power cycle", RESETS, "self.known, self.written = getattr(self, 'known', {}), {}"),
    ("counters_over_power", "counters survive a power cycle", "        for item, value in self.counters.items():\n            if value:\n                self.stream.write(item, 0, now)\n        self.counters = {}\n", ""),
    ("counters_reset_silently", "counters are not shown as 0 after a power cycle", "                self.stream.write(item, 0, now)\n", "                pass\n"),
    ("fifo_over_power", "the FIFO survives a power cycle", "        self.fifo = Fifo(self)\n", "        self.fifo = getattr(self, 'fifo', None) or Fifo(self)\n"),
    ("request_over_power", "a read goes on after a power cycle", "self.request, self.verification, self.attempt = None, None, 0", "self.request, self.verification, self.attempt = getattr(self, 'request', None), None, 0"),
    # ---- DIP, options ----
    ("dip_at_start_only", "DIP switches are read at the first power-up only", DIPS, "self.r; ", ),
    ("dip_two_bits", "only two DIP switches are read", DIPS, DIPS.replace("& 7", "& 3")),
    ("dip_inverted", "DIP switches are read inverted", DIPS, DIPS.replace("& 7", "& 7 ^ 7")),
    ("dip_4_as_19200", "position 4 is 19200 bit/s", "20833,", "19200,"),
    ("dip_7_as_2400", "position 7 is 2451 bit/s", "2404\n", "2451\n"),
    ("p2_as_p1", "takes a character of P2 for 11 bits", "10 if self.settings[\"characters\"] == 2 else 11", "11"),
    ("echo_not_ignored", "takes its own echo for a response", "        if " + ECHO[3:], "        if False and self.own_start <= start < self.own_end:"),
    ("verifies_never", "does not verify writes", VERIFIES, "if False:"),
    ("verifies_always", "verifies without being set to", VERIFIES, "if request.is_of_pc:"),
    ("verifies_refreshes", "verifies refreshes too", VERIFIES, "if self.settings[\"verifies_writes\"]:"),
    ("verify_data0_only", "compares DATA0 only", COMPARES, "elif data0 != request.data0:"),
    ("verify_data1_only", "compares DATA1 only", COMPARES, "elif data1 != request.data1:"),
    ("verify_silent", "does not report another value", COMPARES, "elif False:"),
    ("verify_later", "verifies after the next command", "        if self.verification:\n            request", "        if self.verification and not self.fifo.has_command():\n            request"),
    ("acknowledge_not_awaited", "does not wait for the response to a write", AWAITS, "request.command == READ"),
    ("acknowledge_data_ignored", "any response acknowledges a write", "            if is_right and self.request.command == WRITE:\n                " + ACKNOWLEDGED + "\n", ""),
    ("acknowledge_data0_only", "DATA1 of an acknowledge is not looked at", ACKNOWLEDGED, "is_right = frame[0] == self.request.data0"),
    ("acknowledge_reported", "an acknowledge is reported as a response", "        if request.command == WRITE:\n            self.end_write(request)\n            return\n        self.known", "        if request.command == WRITE:\n            self.end_write(request)\n            self.stream.write(RESPONSE, request.id | data0 << 8 | data1 << 16, now)\n            return\n        self.known"),
    ("acknowledge_once", "a write that is not acknowledged is not repeated", "if self.attempt < ATTEMPTS:", "if self.attempt < ATTEMPTS and self.request.command == READ:"),
    ("acknowledge_error_kind", "a write that is not acknowledged is reported as no response", "kind if kind == LINE_BUSY else NOT_ACKNOWLEDGED", "kind"),
    ("acknowledge_error_silent", "a write that is not acknowledged is not reported", "            self.report_error(request.id, kind if kind == LINE_BUSY else NOT_ACKNOWLEDGED, now)\n", ""),
    ("acknowledge_known", "an acknowledge is kept as the last response", "        if request.command == WRITE:\n            self.end_write(request)\n            return\n        self.known", "        if request.command == WRITE:\n            self.end_write(request)\n            self.known[request.id] = data0, data1\n            return\n        self.known"),
    ("refresh_not_acknowledged", "the response to a refresh is not awaited", AWAITS, "request.command == READ or bool(self.settings[\"answers_writes\"]) and request.is_of_pc"),
    ("rest_after_acknowledge", "rests a millisecond after an acknowledge", "        if request.command == WRITE:\n            self.end_write(request)\n            return\n        self.known", "        if request.command == WRITE:\n            self.end_write(request)\n            self.rest_until = self.busy_until + self.delimiter + 3 * MILLISECOND\n            return\n        self.known"),
    ("busy_silent", "a line that is not silent is not reported", "            self.report_error(request.id, kind if kind == LINE_BUSY else", "            if kind == LINE_BUSY: return\n            self.report_error(request.id, kind if kind == LINE_BUSY else", "        self.report_error(request.id, kind, now)\n", "        if kind == LINE_BUSY: return\n        self.report_error(request.id, kind, now)\n"),
    ("busy_kind", "a line that is not silent is reported as no response", "        self.report_error(request.id, kind, now)\n", "        self.report_error(request.id, NO_RESPONSE if kind == LINE_BUSY else kind, now)\n"),
    ("busy_hangs", "waits for ever for a line that is not silent", "            elif now >= self.response_known() + self.time_out:\n                self.give_up(LINE_BUSY, now)\n", "", "self.time_out if self.is_being_answered() else 0)", "10000 * SECOND if self.is_being_answered() else 0)"),
]}
del FAULTS["dip_at_start_only"]
FAULTS["dip_at_start_only"] = ("DIP switches are read at the first power-up only", "?", DIPS, "BIT_RATES[self.stream.read(DIP, now) & 7 if not hasattr(self, 'd') else self.d]", "        bits = 10", "        self.d = BIT_RATES.index(rate)\n        bits = 10")

if __name__ == "__main__":
    run(HERE / "host.py", FAULTS)

#!/usr/bin/env python3
"""The slave in levels with one fault, to see the bench find it: faults.py --fault NAME."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent))
from changed_program import run

SAMPLE = "self.level(edge + self.bit // 2 + n * self.bit)"
CLEAR_IN_RESET = 'self.is_supervised, self.is_active, self.phase = False, False, "pause"'
POWER = "slave = kind_of_slave(stream, settings)\n"
OUTPUTS = "self.stream.send(WRITE, \"HQq\", OUTPUT + n, word, max(end, self.now))"
LENGTH = "self.is_wrong |= len(self.received) < self.length + 2"
CHECKED = "self.is_wrong |= octet != self.expected[n]"
STATUS = 'self.is_clean &= octet == self.s["status_clean"] >> shift & 0xFF'
MARK = 'octet |= self.s["status_marked"] >> shift & 0xFF'
LOAD_WORDS = 'words = [self.stream.read(INPUT + n, when) for n in range(self.s["words"])]'
ON = """on = tuple(p for p in ports if when >= self.off_until and not word & bits[p]
                   and self.stream.read(PLUGGED[p], when))"""
OFF_UNTIL = 'self.off_until = when + s["silence_limit"] + s["silence_tolerance"]'
LIMIT = 'return self.last + self.s["silence_limit"] if self.is_supervised else NEVER'
LAST = "self.last, self.is_supervised = start + self.time_of(telegram), True"
HALF_BITS = 'half_bits = self.s["forward_delay_half_bits"] if source == UPSTREAM else 0'
MORE_HALF_BITS = 'half_bits += self.s["return_delay_half_bits"] if port == UPSTREAM else 0'
SENT_AT = "start = max(start + half_bits * self.bit // 2, self.now, self.driven_until[port])"
SAY = "self.say(port, start, telegram)\n\n    def say"
CONTROL_BITS = 'bits = {REMOTE: s["control_remote_off"], BRANCH: s["control_local_off"]}'
ID_WORD = 'words, self.messages_read = [s["id_code"] | self.messages], self.messages'
ACTIVE = "elif self.is_active:"
REJECT = 'self.messages |= self.s["message_check_error"]'
TAKE = "self.take(port, start, self.telegram(levels), levels[-1])"
FINISH = "self.finish(is_id, when + 13 * self.bit)"
NEW_CYCLE = """if self.phase != ("transfer", is_id):
            if self.phase != "pause":
                self.reject()"""
STRAY_CHECK = """elif self.phase != ("check", is_id):
            if self.phase != "pause":
                self.reject()
            return octet"""

# name: (what it does, which case of interbus/slave finds it, (line, instead)...)
FAULTS = {
    # the receiver of levels
    "samples_late": ("samples each bit at 9/10 of it", "", (SAMPLE, SAMPLE.replace("self.bit // 2", "self.bit * 9 // 10"))),
    "samples_early": ("samples each bit at 1/10 of it", "", (SAMPLE, SAMPLE.replace("self.bit // 2", "self.bit // 10"))),
    "glitch_is_start": ("does not look at the start level again", "", ("if sample(0):", "if False:")),
    "glitch_blinds": ("after a glitch it is deaf for four bits", "", ("self.at = edge + self.bit // 2\n                continue", "self.at = edge + 4 * self.bit\n                continue")),
    "low_stop_is_start": ("takes a missing stop level for the next start level", "", ("if time >= self.at and self.level(time - 1):", "if time >= self.at:")),
    "deaf_after_missing_stop": ("loses the telegram after a missing stop level", "", ("self.at = edge + count * self.bit + self.bit // 2", "self.at = edge + count * self.bit + self.bit // 2 + (0 if levels[-1] else 8 * self.bit)")),
    "status_stop_is_error": ("counts a missing stop level of a status telegram as an error", "", ("        if telegram & DATA:\n            take =", "        if not telegram & DATA and not stop and self.phase != \"pause\":\n            self.is_wrong = True\n        if telegram & DATA:\n            take =")),
    "status_without_stop_is_lost": ("does not pass on a status telegram without a stop level", "", (TAKE, "if levels[-1] or len(levels) > 4:\n                " + TAKE)),
    "data_without_stop_is_lost": ("does not pass on a data telegram without a stop level", "", (TAKE, "if levels[-1] or len(levels) == 4:\n                " + TAKE)),
    "stop_ignored_in_data": ("does not see a missing stop level in the transfer phase", "", ("        self.is_wrong |= not stop\n        self.register.append", "        self.register.append")),
    "stop_ignored_in_check": ("does not see a missing stop level in the check phase", "", ("        self.is_wrong |= not stop\n        n, self.count", "        n, self.count")),
    "last_stop_ignored": ("does not see a missing stop level of the last telegram of a cycle", "", ("        self.is_wrong |= not stop\n        n, self.count", "        self.is_wrong |= not stop and self.count < 3\n        n, self.count")),
    "first_stop_ignored": ("does not see a missing stop level of the first telegram of a cycle", "", ("        self.is_wrong |= not stop\n        self.register.append", "        self.is_wrong |= not stop and bool(self.received)\n        self.register.append")),
    "id_stop_ignored": ("does not see a missing stop level in an ID cycle", "", ("        self.is_wrong |= not stop\n        self.register.append", "        self.is_wrong |= not stop and not is_id\n        self.register.append")),
    "stop_of_branch_is_error": ("counts a missing stop level that comes back from a branch", "", ("        if port != UPSTREAM:\n            if port in self.back:", "        if port != UPSTREAM:\n            self.is_wrong = getattr(self, \"is_wrong\", False) or not stop\n            if port in self.back:")),
    # headers
    "flag_place_fixed": ("looks for FL at the third place whatever the setting", "", ('flag = settings["flag_place"], settings["data_flag_level"]', 'flag = 2, settings["data_flag_level"]')),
    "select_level_fixed": ("takes 1 for SL set whatever the setting", "", ('(settings["select_place"], settings["select_level"], SELECT)', '(settings["select_place"], 1, SELECT)')),
    "control_level_fixed": ("takes 1 for CR set whatever the setting", "", ('(settings["control_place"], settings["control_level"], CONTROL)', '(settings["control_place"], 1, CONTROL)')),
    "always_msb_first": ("most significant bit first whatever the setting", "", ('range(7, -1, -1) if self.s["most_significant_first"] else range(8)', "range(7, -1, -1)")),
    "select_lost_in_check": ("passes telegrams of the check phase on without SL", "", (SAY, "telegram &= ~SELECT if telegram & CONTROL else -1\n        " + SAY)),
    "select_lost_in_status": ("passes status telegrams on without SL", "", (SAY, "telegram &= -1 if telegram & DATA else ~SELECT\n        " + SAY)),
    "control_lost_in_status": ("passes status telegrams on without CR", "", (SAY, "telegram &= -1 if telegram & DATA else ~CONTROL\n        " + SAY)),
    "ff_passed_as_fe": ("passes on octets FFh of stray checks as 7Fh", "", ("            return octet\n        self.is_wrong", "            return octet & 0x7F\n        self.is_wrong")),
    # the way of a telegram
    "delay_truncated": ("truncates delays to whole bits", "", (SENT_AT, SENT_AT.replace("half_bits * self.bit // 2", "half_bits // 2 * self.bit"))),
    "delay_eight_bits": ("takes delays modulo 256 half bits", "", (SENT_AT, SENT_AT.replace("half_bits * self.bit", "(half_bits & 0xFF) * self.bit"))),
    "delay_half_bit_early": ("passes on half a bit early", "", (SENT_AT, SENT_AT.replace("half_bits *", "max(0, half_bits - 1) *"))),
    "delay_half_bit_late": ("passes on half a bit late", "", (SENT_AT, SENT_AT.replace("half_bits *", "(half_bits + 1) *"))),
    "status_undelayed": ("passes status telegrams on without a delay", "", (SENT_AT, SENT_AT.replace("half_bits *", "(half_bits if telegram & DATA else 0) *"))),
    "forward_costs_both": ("adds the return delay on the way out as well", "", (MORE_HALF_BITS, MORE_HALF_BITS.replace("port == UPSTREAM", "source == UPSTREAM or port == UPSTREAM"))),
    "no_return_delay_from_remote": ("no return delay from port 2", "", (MORE_HALF_BITS, MORE_HALF_BITS.replace("port == UPSTREAM", "port == UPSTREAM and source != REMOTE"))),
    "no_return_delay_from_branch": ("no return delay from port 1", "", (MORE_HALF_BITS, MORE_HALF_BITS.replace("port == UPSTREAM", "port == UPSTREAM and source != BRANCH"))),
    "no_return_delay_from_branch": ("no return delay from port 1 to port 2 or 0", "", (HALF_BITS, HALF_BITS + "\n        half_bits -= self.s[\"return_delay_half_bits\"] if source == BRANCH else 0")),
    "branch_to_remote_delayed": ("from port 1 to port 2 it costs the forward delay", "", (HALF_BITS, HALF_BITS.replace("source == UPSTREAM", "port == REMOTE"))),
    "return_costs_forward": ("the way back costs the forward delay", "", (MORE_HALF_BITS, 'half_bits += self.s["forward_delay_half_bits"] if port == UPSTREAM else 0')),
    "ways_share_a_queue": ("waits for what any port drives", "", ("self.driven_until[port] = start + self.time_of(telegram)", "self.driven_until = [start + self.time_of(telegram)] * 3")),
    "remote_before_branch": ("passes to port 2 first, then to port 1", "", ("if source == UPSTREAM and BRANCH in ways:\n            return BRANCH\n        return REMOTE if source != REMOTE and REMOTE in ways else UPSTREAM", "if source != REMOTE and source != BRANCH and REMOTE in ways:\n            return REMOTE\n        return BRANCH if source != BRANCH and BRANCH in ways else UPSTREAM")),
    "branch_returns_upstream": ("what comes back from the branch never goes to port 2", "", ("return REMOTE if source != REMOTE and REMOTE in ways else UPSTREAM", "return REMOTE if source == UPSTREAM and REMOTE in ways else UPSTREAM")),
    "off_ports_pass": ("passes on what comes back at an interface that is off", "", ("            if port in self.back:\n                self.send_on", "            if True:\n                self.send_on")),
    "off_ports_pass_status": ("passes on status telegrams that come back at an interface that is off", "", ("            if port in self.back:\n                self.send_on", "            if port in self.back or not telegram & DATA:\n                self.send_on")),
    # switching of interfaces
    "forward_at_once": ("switches the way out at the last telegram of the ID cycle", "", ("self.is_switching = on != self.on\n        self.on = on", "self.is_switching = on != self.on\n        self.on = self.forward = on")),
    "back_at_once": ("switches the way back at the last telegram of the ID cycle", "", ("self.is_switching = on != self.on\n        self.on = on", "self.is_switching = on != self.on\n        self.on = self.back = on")),
    "forward_at_transfer": ("switches the way out at the next transfer telegram only", "", ("if self.is_switching and not is_check:", "if self.is_switching and not is_check and telegram & DATA:")),
    "back_at_status": ("switches the way back with the way out", "", ("self.forward, self.is_switching = self.on, False", "self.forward, self.is_switching = self.on, False\n            self.back = self.on")),
    "back_at_id_only": ("switches the way back at the next ID cycle only", "", ("            self.back = self.on\n            self.phase", "            self.back = self.on if is_id else self.back\n            self.phase")),
    "off_is_late": ("switches the way out off at the next transfer phase only", "", ("if self.is_switching and not is_check:", "if self.is_switching and not is_check and (telegram & DATA or len(self.on) >= len(self.forward)):")),
    # control word
    "remote_off_ignored": ("OUT1 stays on", "", (CONTROL_BITS, 'bits = {REMOTE: 0, BRANCH: s["control_local_off"]}')),
    "local_off_ignored": ("OUT2 stays on", "", (CONTROL_BITS, 'bits = {REMOTE: s["control_remote_off"], BRANCH: 0}')),
    "off_bits_swapped": ("takes the bits of OUT1 and OUT2 for each other", "", (CONTROL_BITS, 'bits = {BRANCH: s["control_remote_off"], REMOTE: s["control_local_off"]}')),
    "off_bits_fixed": ("takes 1 and 2 for the bits whatever the settings", "", (CONTROL_BITS, "bits = {REMOTE: 1, BRANCH: 2}")),
    "off_needs_all_bits": ("an interface whose setting has several bits is off with all of them only", "", (ON, ON.replace("not word & bits[p]", "word & bits[p] != bits[p]"))),
    "plug_of_remote_ignored": ("OUT1 is on with nothing plugged in", "", (ON, ON.replace("self.stream.read(PLUGGED[p], when)", "(p == REMOTE or self.stream.read(PLUGGED[p], when))"))),
    "plug_of_branch_ignored": ("OUT2 is on with nothing plugged in", "", (ON, ON.replace("self.stream.read(PLUGGED[p], when)", "(p == BRANCH or self.stream.read(PLUGGED[p], when))"))),
    "plug_read_once": ("reads once what is plugged in", "", (ON, ON.replace("self.stream.read(PLUGGED[p], when)", "self.__dict__.setdefault(f\"plug{p}\", self.stream.read(PLUGGED[p], when))"))),
    "branch_always_there": ("has a branch whatever the setting", "", ('ports = [REMOTE, BRANCH] if s["has_branch"] else [REMOTE]', "ports = [REMOTE, BRANCH]")),
    "unknown_bits_refuse": ("ignores a control word with a bit without a meaning", "", ('        if word & s["control_acknowledge"]:', '        if word & 0xFF00:\n            return\n        if word & s["control_acknowledge"]:')),
    "control_eight_bits": ("takes the low octet of the control word only", "", ('        if word & s["control_acknowledge"]:', '        word &= 0xFF\n        if word & s["control_acknowledge"]:')),
    "reset_ignored": ("ignores control_reset", "", (OFF_UNTIL, "pass")),
    "reset_without_tolerance": ("keeps the interfaces off for silence_limit only", "", (OFF_UNTIL, 'self.off_until = when + s["silence_limit"]')),
    "reset_too_long": ("keeps the interfaces off a millisecond too long", "", (OFF_UNTIL, OFF_UNTIL + " + SECOND // 1000")),
    "reset_time_fixed": ("keeps the interfaces off for 26 ms whatever the settings", "", (OFF_UNTIL, "self.off_until = when + 26 * SECOND // 1000")),
    "second_reset_in_time_ignored": ("another control_reset within its time does not begin it again", "", (OFF_UNTIL, "self.off_until = self.off_until if when < self.off_until else " + OFF_UNTIL.split(" = ")[1])),
    "reset_once": ("a later control_reset is ignored", "", (OFF_UNTIL, "self.off_until = self.off_until if self.off_until > 0 else " + OFF_UNTIL.split(" = ")[1])),
    "reset_of_remote_only": ("control_reset switches OUT1 off only", "", (ON, ON.replace("when >= self.off_until", "(when >= self.off_until or p == BRANCH)"))),
    "reset_comes_back_by_itself": ("switches on by itself at the end of a reset", "", ("        self.on = on\n", "        self.on = on\n        self.later = tuple(p for p in ports if not word & bits[p])\n"), ("        is_check = telegram & (DATA | CONTROL) == DATA | CONTROL\n", "        is_check = telegram & (DATA | CONTROL) == DATA | CONTROL\n        if 0 <= self.off_until < start and not self.on:\n            self.on, self.off_until, self.is_switching = self.later, -1, True\n")),
    "reset_ended_by_id": ("an ID cycle without control_reset ends its time", "", ('        if word & s["control_reset"]:\n', '        self.off_until = -1\n        if word & s["control_reset"]:\n')),
    # silence
    "silence_early": ("resets two tolerances early", "", (LIMIT, LIMIT.replace('self.s["silence_limit"]', '(self.s["silence_limit"] - 2 * self.s["silence_tolerance"])'))),
    "silence_late": ("resets two tolerances late", "", (LIMIT, LIMIT.replace('self.s["silence_limit"]', '(self.s["silence_limit"] + 2 * self.s["silence_tolerance"])'))),
    "silence_fixed": ("resets after 25 ms whatever the setting", "", (LIMIT, LIMIT.replace('self.s["silence_limit"]', "SECOND // 40"))),
    "silence_sixteen_bits": ("counts silence in us with 16 bits", "", (LIMIT, LIMIT.replace('self.s["silence_limit"]', 'self.s["silence_limit"] % (65536 * 10**6)'))),
    "silence_of_data_only": ("status telegrams do not end silence", "", (LAST, "if telegram & DATA or not self.is_supervised:\n            " + LAST)),
    "silence_of_all_ports": ("what comes back at ports 1 and 2 ends silence, too", "", ("        if port != UPSTREAM:\n            if port in self.back:", "        if port != UPSTREAM:\n            self.last = start\n            if port in self.back:")),
    "silence_from_power_up": ("counts silence from power-up on", "", (POWER, POWER + "                slave.last, slave.is_supervised = now, True\n")),
    "silence_keeps_outputs": ("outputs stay in a reset by silence", "", ("        self.is_switching = False\n        self.clear()", "        self.is_switching = False")),
    "silence_clears_first_output": ("clears the first output only in a reset", "", ("        self.is_switching = False\n        self.clear()", "        self.is_switching = False\n        if self.s[\"words\"]:\n            self.stream.send(WRITE, \"HQq\", OUTPUT, 0, self.now)")),
    "silence_keeps_interfaces": ("interfaces stay on in a reset by silence", "", ("        self.on = self.forward = self.back = ()\n        self.is_switching = False\n", "")),
    "silence_keeps_way_back": ("the way back stays on in a reset by silence", "", ("        self.on = self.forward = self.back = ()\n        self.is_switching = False\n", "        self.on = self.forward = ()\n        self.is_switching = False\n")),
    "silence_keeps_switching": ("what an ID cycle has switched on comes on after the silence", "", ("        self.on = self.forward = self.back = ()\n        self.is_switching = False\n", "        self.forward = self.back = ()\n        self.is_switching = True\n")),
    "silence_keeps_active": ("moves outputs after a silence without an ID cycle", "", (CLEAR_IN_RESET, 'self.is_supervised, self.phase = False, "pause"')),
    "silence_keeps_cycle": ("goes on with the cycle after a silence in it", "", (CLEAR_IN_RESET, "self.is_supervised, self.is_active = False, False")),
    "silence_rejects_cycle": ("a cycle dropped by a silence is a check error", "", (CLEAR_IN_RESET, 'if self.phase != "pause":\n            self.reject()\n        ' + CLEAR_IN_RESET)),
    "silence_clears_message": ("a silence clears the message of a check error", "", (CLEAR_IN_RESET, "self.messages = 0\n        " + CLEAR_IN_RESET)),
    "silence_ends_control_reset": ("a silence ends the time of control_reset", "", (CLEAR_IN_RESET, "self.off_until = -1\n        " + CLEAR_IN_RESET)),
    "silence_once": ("sees the first silence only", "", (LIMIT, LIMIT.replace("self.is_supervised", "self.is_supervised and not getattr(self, \"was\", 0)")), (CLEAR_IN_RESET, "self.was = 1\n        " + CLEAR_IN_RESET)),
    "silence_again": ("resets again and again while it is silent", "", (CLEAR_IN_RESET, 'self.is_active, self.phase, self.last = False, "pause", self.now')),
    # supply
    "power_keeps_active": ("moves outputs after power-up without an ID cycle", "", (POWER, "active = slave.is_active\n                " + POWER + "                slave.is_active = active\n")),
    "power_keeps_messages": ("has a check error message after power-up", "", (POWER, "messages = slave.messages\n                " + POWER + "                slave.messages = messages\n")),
    "power_keeps_interfaces": ("interfaces are on after power-up", "", (POWER, "ways = slave.on, slave.forward, slave.back\n                " + POWER + "                slave.on, slave.forward, slave.back = ways\n")),
    "power_keeps_reset": ("the time of control_reset goes on after power-up", "", (POWER, "until = slave.off_until\n                " + POWER + "                slave.off_until = until\n")),
    "power_keeps_cycle": ("goes on with its cycle after power-up", "", (POWER, "old = {**slave.__dict__}\n                " + POWER + "                slave.__dict__.update({k: v for k, v in old.items() if k in ('phase', 'is_wrong', 'received', 'sent', 'register', 'length', 'count', 'expected', 'check_sent', 'is_clean')})\n")),
    # the cycle
    "check_ignored_in_data": ("takes data cycles with a wrong check", "", (CHECKED, "self.is_wrong |= is_id != 0 and octet != self.expected[n]")),
    "check_ignored_in_id": ("takes ID cycles with a wrong check", "", (CHECKED, "self.is_wrong |= is_id == 0 and octet != self.expected[n]")),
    "check_high_octet_only": ("compares the first octet of the check only", "", (CHECKED, "self.is_wrong |= n == 0 and octet != self.expected[n]")),
    "check_low_octet_only": ("compares the second octet of the check only", "", (CHECKED, "self.is_wrong |= n == 1 and octet != self.expected[n]")),
    "check_seven_bits": ("does not compare the highest bit of the check", "", (CHECKED, "self.is_wrong |= n == 0 and octet & 0x7F != self.expected[n] & 0x7F or n == 1 and octet != self.expected[n]")),
    "check_passed_on": ("passes the received check on", "", ("return self.check_sent[n]", "return octet")),
    "check_of_received": ("sends the check of what came in", "", ("self.crc(self.received), self.crc(self.sent)", "self.crc(self.received), self.crc(self.received)")),
    "preset_fixed": ("presets the check with FFFFh whatever the setting", "", ('register = self.s["check_is_reflected"], self.s["check_preset"]', 'register = self.s["check_is_reflected"], 0xFFFF')),
    "no_final_xor": ("no final XOR", "", (' ^ self.s["check_final_xor"]', "")),
    "reflected_octets_swapped": ("sends a reflected check high octet first", "", ("return [value & 0xFF, value >> 8] if reflected else [value >> 8, value & 0xFF]", "return [value >> 8, value & 0xFF]")),
    "good_check_repairs": ("a wrong check is passed on as a right one without a mark", "", (MARK, "pass")),
    "marks_low_octet_only": ("marks the low octet of the status word only", "", (MARK, MARK.replace("octet |=", "octet |= 0 if n == 2 else"))),
    "marks_high_octet_only": ("marks the high octet of the status word only", "", (MARK, MARK.replace("octet |=", "octet |= 0 if n == 3 else"))),
    "mark_replaces": ("puts its mark in place of the status word", "", (MARK, MARK.replace("octet |=", "octet ="))),
    "mark_fixed": ("marks with FFFFh whatever the setting", "", (MARK, "octet = 0xFF")),
    "clean_is_zero": ("takes 0 for a clean status word whatever the setting", "", (STATUS, "self.is_clean &= octet == 0")),
    "clean_low_octet": ("looks at the low octet of the status word only", "", (STATUS, "self.is_clean &= n == 2 or octet == self.s[\"status_clean\"] & 0xFF")),
    "clean_high_octet": ("looks at the high octet of the status word only", "", (STATUS, "self.is_clean &= n == 3 or octet == self.s[\"status_clean\"] >> 8")),
    "clean_needs_whole_mark": ("rejects with all bits of the mark only", "", (STATUS, 'self.is_clean &= octet != self.s["status_marked"] >> shift & 0xFF or not octet')),
    "status_ignored": ("takes cycles that others have marked", "", (STATUS, "pass")),
    "status_cleaned": ("passes a marked status word on as clean", "", (STATUS, STATUS + "\n        octet = self.s[\"status_clean\"] >> shift & 0xFF")),
    "marked_is_message": ("a mark of others sets its message", "", ("        if not self.is_clean:\n            return", "        if not self.is_clean:\n            return self.reject()")),
    "no_message": ("a wrong cycle sets no message", "", (REJECT, "pass")),
    "message_of_data_only": ("a wrong ID cycle sets no message", "", ("        if self.is_wrong:\n            return self.reject()", "        if self.is_wrong:\n            return None if is_id else self.reject()")),
    "short_cycle_is_good": ("takes cycles with too few telegrams", "", (LENGTH, "pass")),
    "short_by_one_is_good": ("takes cycles that lack one telegram", "", (LENGTH, LENGTH.replace("+ 2", "+ 1"))),
    "no_loopback_is_good": ("takes cycles without a loopback word", "", (LENGTH, LENGTH.replace(" + 2", ""))),
    "long_cycle_is_bad": ("rejects cycles with more telegrams than its own", "", (LENGTH, LENGTH.replace("<", "!="))),
    "cycle_of_255": ("rejects cycles of more than 255 octets", "", (LENGTH, LENGTH + " or len(self.received) > 255")),
    "new_cycle_is_no_error": ("a cycle that begins within another one is no error", "", (NEW_CYCLE, 'if self.phase != ("transfer", is_id):')),
    "new_cycle_lost": ("rejects a cycle that begins within another one as well", "", (NEW_CYCLE, 'if self.phase != ("transfer", is_id):\n            is_new = self.phase != "pause"\n            if is_new:\n                self.reject()'), ('self.phase, self.is_wrong, self.received, self.sent = ("transfer", is_id), False, [], []', 'self.phase, self.is_wrong, self.received, self.sent = ("transfer", is_id), is_new, [], []')),
    "stray_check_ends_cycle_silently": ("a check of the other kind in a cycle is no error", "", (STRAY_CHECK, 'elif self.phase != ("check", is_id):\n            return octet')),
    "stray_check_kind_ignored": ("takes a check of the other kind for its own", "", ('        if self.phase == ("transfer", is_id):\n            self.phase, self.count', '        if self.phase[0] == "transfer":\n            is_id = self.phase[1]\n            self.phase, self.count')),
    "status_ends_cycle": ("a status telegram within a cycle ends it", "", ("        if telegram & DATA:\n            take =", "        if not telegram & DATA:\n            self.phase = \"pause\"\n        if telegram & DATA:\n            take =")),
    "check_phase_starts_again": ("a second check phase is taken for one of the cycle before", "", ('        self.phase = "pause"\n        if self.is_wrong:\n            return self.reject()', '        self.phase = ("transfer", is_id)\n        if self.is_wrong:\n            return self.reject()')),
    "last_cycle_inputs": ("sends the inputs of the cycle before", "", (LOAD_WORDS, "words = getattr(self, \"stale\", [0] * self.s[\"words\"])\n            self.stale" + LOAD_WORDS[5:])),
    "inputs_read_once": ("reads its inputs once after power-up", "", (LOAD_WORDS, "words = self.__dict__.setdefault(\"stale\", [self.stream.read(INPUT + n, when) for n in range(self.s[\"words\"])])")),
    "input_words_reversed": ("sends its words in the other order", "", (LOAD_WORDS, LOAD_WORDS + "[::-1]")),
    "output_words_reversed": ("writes its words in the other order", "", ("for n in range(0, self.length, 2)]", "for n in range(0, self.length, 2)]\n        words = words[::-1]")),
    "octets_swapped": ("sends low octets first", "", ("for octet in (word >> 8, word & 0xFF)]\n        self.length", "for octet in (word & 0xFF, word >> 8)]\n        self.length")),
    "words_seven_bits": ("has at most 127 words", "", (LOAD_WORDS, LOAD_WORDS.replace('self.s["words"]', 'min(127, self.s["words"])'))),
    "words_eight_bits": ("has words modulo 256", "", (LOAD_WORDS, LOAD_WORDS.replace('self.s["words"]', 'self.s["words"] & 0xFF'))),
    "id_code_twelve_bits": ("sends 12 bits of its ID code", "", (ID_WORD, ID_WORD.replace('s["id_code"] |', 's["id_code"] & 0xFFF |'))),
    "id_code_low_bit": ("sends bit 0 of its ID code as 0", "", (ID_WORD, ID_WORD.replace('s["id_code"] |', 's["id_code"] & 0x1FFE |'))),
    "messages_fixed": ("sends the messages at fixed bits", "", (REJECT, "self.messages |= 0x4000")),
    "message_cleared_early": ("clears its messages when they are read", "", (ID_WORD, ID_WORD + "\n            self.messages = 0")),
    "message_never_cleared": ("keeps the message of a check error", "", ("            self.messages &= ~self.messages_read\n", "")),
    "message_cleared_by_data": ("a good data cycle clears its message", "", (ACTIVE, "elif self.messages or True:\n            self.messages = 0\n            if not self.is_active:\n                return")),
    "fault_latched": ("a peripheral fault stays when it has gone", "", ('            self.messages &= ~(s["message_peripheral_fault"] | s["message_reconfiguration"])\n', ""), ("            self.messages &= ~self.messages_read\n", "            self.messages &= ~self.s[\"message_check_error\"]\n")),
    "fault_hides_request": ("sends one message at a time", "", ("        if self.stream.read(RECONFIGURATION, when):" , "        if self.stream.read(RECONFIGURATION, when) and not self.messages:")),
    "outputs_without_id": ("moves outputs before an ID cycle", "", (ACTIVE, "else:")),
    "outputs_late": ("moves outputs 60 us after the cycle", "", (OUTPUTS, OUTPUTS.replace("max(end, self.now)", "max(end, self.now) + 60 * 10**6"))),
    "outputs_early": ("moves outputs at the start of the last telegram", "", (FINISH, "self.finish(is_id, when)")),
    "zeros_not_written": ("does not write an output that is 0", "", (OUTPUTS, "if word:\n                    " + OUTPUTS)),
    "ffff_not_written": ("does not write an output that is FFFFh", "", (OUTPUTS, "if word != 0xFFFF:\n                    " + OUTPUTS)),
    "first_word_only": ("moves the first 16 output words only", "", (OUTPUTS, "if n < 16:\n                    " + OUTPUTS)),
    "outputs_signed": ("limits outputs to 7FFFh", "", (OUTPUTS, OUTPUTS.replace(", word,", ", min(word, 0x7FFF),"))),
    "bad_cycle_clears": ("outputs are 0 after a bad cycle", "", ("        if self.is_wrong:\n            return self.reject()", "        if self.is_wrong:\n            self.clear()\n            return self.reject()")),
    "marked_cycle_clears": ("outputs are 0 after a cycle that others have marked", "", ("        if not self.is_clean:\n            return", "        if not self.is_clean:\n            self.clear()\n            return")),
    "bad_cycle_deactivates": ("after a bad cycle it needs an ID cycle", "", (REJECT, REJECT + "\n        self.is_active = False")),
    "bad_id_activates": ("a bad ID cycle ends a reset as well", "", ("        if self.is_wrong:\n            return self.reject()", "        self.is_active |= bool(is_id)\n        if self.is_wrong:\n            return self.reject()")),
    "marked_id_activates": ("an ID cycle that others have marked ends a reset", "", ("        if not self.is_clean:\n            return", "        if not self.is_clean:\n            self.is_active |= bool(is_id)\n            return")),
    "bad_id_controls": ("takes the control word of a bad ID cycle", "", ("        if self.is_wrong:\n            return self.reject()", "        if self.is_wrong:\n            if is_id:\n                self.control(self.register[0] << 8 | self.register[1], max(end, self.now))\n            return self.reject()")),
    "marked_id_controls": ("takes the control word of an ID cycle that others have marked", "", ("        if not self.is_clean:\n            return", "        if not self.is_clean:\n            if is_id:\n                self.control(self.register[0] << 8 | self.register[1], max(end, self.now))\n            return")),
    "marked_id_clears": ("an ID cycle that others have marked clears its message", "", ("        if not self.is_clean:\n            return", "        if not self.is_clean:\n            self.messages &= 0 if is_id else -1\n            return")),
    "every_256th_lost": ("moves no outputs in each 256th good cycle", "", (ACTIVE, "elif self.is_active and (n := self.__dict__.get('good', 0) + 1) and not self.__dict__.update(good=n) and n % 256:")),
    "id_moves_outputs": ("an ID cycle writes its control word to output 0", "", ("            self.control(words[0], max(end, self.now))", "            self.control(words[0], max(end, self.now))\n            if self.s[\"words\"]:\n                self.stream.send(WRITE, \"HQq\", OUTPUT, words[0], max(end, self.now))")),
    "error_remembered": ("an error marks the next cycle as well", "", ('("transfer", is_id), False, [], []', '("transfer", is_id), getattr(self, "is_wrong", False) and not getattr(self, "again", True), [], []\n            self.again = self.is_wrong')),
}

if __name__ == "__main__":
    run(FOLDER, ["slave_telegrams", "slave"], FAULTS)

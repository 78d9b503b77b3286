#!/usr/bin/env python3
"""The slave in levels with one fault, to see the bench find it: faults.py --fault NAME."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent))
from changed_program import run

CLEAR_IN_RESET = 'self.is_supervised, self.is_active, self.phase = False, False, "pause"'
POWER = "slave = kind_of_slave(stream, settings)\n"
MARK = 'octet |= self.s["status_marked"] >> shift & 0xFF'
OFF_UNTIL = 'self.off_until = when + s["silence_limit"] + s["silence_tolerance"]'
MORE_HALF_BITS = 'half_bits += self.s["return_delay_half_bits"] if port == UPSTREAM else 0'
SENT_AT = "start = max(start + half_bits * self.bit // 2, self.now, self.driven_until[port])"
ID_WORD = 'words, self.messages_read = [s["id_code"] | self.messages], self.messages'

# name: (what it does, which case of interbus/slave finds it, line, instead, ...)
FAULTS = {
    "select_level_fixed": ("takes 1 for SL set whatever the setting", "compared/other_codings", '(settings["select_place"], settings["select_level"], SELECT)', '(settings["select_place"], 1, SELECT)'),
    "delay_half_bit_early": ("passes on half a bit early", "compared/each_value_of_each_word", SENT_AT, SENT_AT.replace("half_bits *", "max(0, half_bits - 1) *")),
    "no_return_delay_from_remote": ("no return delay from port 2", "compared/each_value_of_each_word", MORE_HALF_BITS, MORE_HALF_BITS.replace("port == UPSTREAM", "port == UPSTREAM and source != REMOTE")),
    "branch_returns_upstream": ("what comes back from the branch never goes to port 2", "compared/each_value_of_each_word", "return REMOTE if source != REMOTE and REMOTE in ways else UPSTREAM", "return REMOTE if source == UPSTREAM and REMOTE in ways else UPSTREAM"),
    "off_ports_pass": ("passes on what comes back at an interface that is off", "compared/each_value_of_each_word", "            if port in self.back:\n                self.send_on", "            if True:\n                self.send_on"),
    "status_stop_is_error": ("counts a missing stop level of a status telegram as an error", "compared/each_fault_of_a_data_cycle", "        if telegram & DATA:\n            take =", "        if not telegram & DATA and not stop and self.phase != \"pause\":\n            self.is_wrong = True\n        if telegram & DATA:\n            take ="),
    "second_reset_in_time_ignored": ("another control_reset within its time does not begin it again", "compared/within_a_reset_of_the_outgoing_bus", OFF_UNTIL, "self.off_until = self.off_until if when < self.off_until else " + OFF_UNTIL.split(" = ")[1]),
    "silence_clears_message": ("a silence clears the message of a check error", "compared/around_a_reset", CLEAR_IN_RESET, "self.messages = 0\n        " + CLEAR_IN_RESET),
    "power_keeps_cycle": ("goes on with its cycle after power-up", "compared/around_a_reset", POWER, "old = {**slave.__dict__}\n                " + POWER + "                slave.__dict__.update({k: v for k, v in old.items() if k in ('phase', 'is_wrong', 'received', 'sent', 'register', 'length', 'count', 'expected', 'check_sent', 'is_clean')})\n"),
    "mark_replaces": ("puts its mark in place of the status word", "compared/other_codings", MARK, MARK.replace("octet |=", "octet =")),
    "stray_check_kind_ignored": ("takes a check of the other kind for its own", "compared/each_fault_of_a_data_cycle", '        if self.phase == ("transfer", is_id):\n            self.phase, self.count', '        if self.phase[0] == "transfer":\n            is_id = self.phase[1]\n            self.phase, self.count'),
    "bad_id_controls": ("takes the control word of a bad ID cycle", "compared/each_value_of_each_word", "        if self.is_wrong:\n            return self.reject()", "        if self.is_wrong:\n            if is_id:\n                self.control(self.register[0] << 8 | self.register[1], max(end, self.now))\n            return self.reject()"),
    "id_code_twelve_bits": ("sends 12 bits of its ID code", "compared/many_words", ID_WORD, ID_WORD.replace('s["id_code"] |', 's["id_code"] & 0xFFF |')),
}

if __name__ == "__main__":
    run(FOLDER, ["slave_telegrams", "slave"], FAULTS)

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Nodes with one fault each, to see the bench find it: --iut 'exec:python3 node_faults.py --fault NAME'."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))
from changed_program import run

SWITCHES = "switches = self.stream.read(LIMIT_SWITCHES, now) & boards"

# name: what it does, which case of valve_bus/node finds it, what is edited.
FAULTS = {
    "data0_signed": ("extends DATA0 from 80h by its sign", "write/drives_the_valves",
                     "(frame[2] | frame[3] << 8) & boards",
                     "(frame[2] | frame[3] << 8 | (0xFF00 if frame[2] > 127 else 0)) & boards"),
    "switches_stale": ("answers with the switches of the read before", "read/is_answered", SWITCHES,
                       SWITCHES + "\n            switches, self.s = getattr(self, 's', switches), switches"),
    "check_bit_0_ignored": ("does not look at bit 0 of the check", "check/single_bit_errors_are_refused",
                            "frame[0] ^ frame[1] ^ frame[2] ^ frame[3] != frame[4]",
                            "(frame[0] ^ frame[1] ^ frame[2] ^ frame[3] ^ frame[4]) & 0xFE"),
    "id_six_bits": ("compares IDs modulo 64", "address/only_its_own_id_acts", "if frame[0] != self.address or",
                    "if frame[0] % 64 != self.address % 64 or"),
    "units_above_9": ("adds units above 9 up", "address/switches_0A_never_answer", "if max(tens, units) <= 9 else 0",
                      "if tens <= 9 else 0"),
    "spoilt_by_others": ("loses the command after one for others", "address/only_its_own_id_acts",
                         "if frame[0] != self.address or self.address == 0:",
                         "skips, self.skips = getattr(self, 'skips', False), frame[0] != self.address\n"
                         "        if skips or frame[0] != self.address or self.address == 0:"),
    "gap_after_id_lax": ("does not look at a gap after the ID", "framing/gaps_inside_a_frame",
                         "self.frame and gap > 3", "len(self.frame) > 1 and gap > 3"),
    "sleeps": ("loses the first character after ten seconds of silence", "framing/long_silences_end_a_frame",
               "gap = start - self.busy_until",
               "gap = start - self.busy_until\n"
               "        if gap > 10 * SECOND and self.busy_until:\n"
               "            self.busy_until = busy_until\n            return"),
    "eleven_bits": ("takes a character of P2 for 11 bits", "settings/serves_characters_of_ten_bits",
                    "(10 if settings[\"characters\"] == 2 else 11)", "11"),
    "answer_half_bit_early": ("answers half a bit early", "read/is_answered",
                              "self.busy_until + 7 * self.half + SECOND // 10000",
                              "self.busy_until + 7 * self.half - self.bit // 2",
                              "self.busy_until + 9 * self.half + self.bit if",
                              "self.busy_until + 7 * self.half - 2 * self.bit if"),
    "not_cancelled": ("answers though somebody else talks", "timing/what_follows_cancels_an_answer",
                      "self.answer = None  # somebody", "pass  # somebody"),
    "loss_by_writes": ("takes a read for no sign of life", "loss/commands_to_it_are_signs_of_life",
                       "        self.last_command = now\n        boards",
                       "        self.last_command = self.last_command if frame[1] == 1 else now\n        boards"),
    "loss_16_bits": ("holds the loss limit in 16 bits of milliseconds", "loss/limit_of_70_seconds",
                     "self.last_command + limit if", "self.last_command + limit % (65_536 * 10**9) if"),
}

if __name__ == "__main__":
    run(FOLDER, ["node"], FAULTS)

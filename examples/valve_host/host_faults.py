#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hosts with one fault each, to see the bench find it: --iut 'exec:python3 host_faults.py --fault NAME'."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))
from changed_program import run

KEEPS = "self.known[request.id] = data0, data1"
WRONG = "                self.was_wrong = True\n"
NEXT_REFRESH = "[(time + REFRESH, node) for node, (_, _, time) in self.written.items()]"

# name: what it does, which case of valve_bus/host finds it, what is edited.
FAULTS = {
    "id_signed": ("takes IDs from 80h for negative, and sends them", "request/ids_1_to_99_are_sent",
                  "if not 1 <= request.id <= 99:", "if not 1 <= request.id <= 99 and request.id < 128:"),
    "same_write_lost": ("does not send a write of what was written last", "memory/boundary_data_are_sent",
                        "elif request.command not in (WRITE, READ):",
                        "elif self.written.get(request.id, (0, 0, 0))[:2] == request[2:4] and request.command == WRITE:\n"
                        "            pass\n        elif request.command not in (WRITE, READ):"),
    "rest_after_write_half": ("rests half a millisecond after a write", "timing/write_is_left_alone",
                              "self.own_end + self.delimiter + MILLISECOND",
                              "self.own_end + self.delimiter + MILLISECOND // 2"),
    "long_last_taken": ("takes the last three octets of more for a response", "response/other_lengths_are_refused",
                        "self.frame = self.frame[:3] + [data & 0xFF]", "self.frame = self.frame[-2:] + [data & 0xFF]"),
    "time_out_fixed": ("has the time-out of 375 kbit/s", "timing/latest_response_is_taken_at_all_rates",
                       "max(3 * MILLISECOND, 3 * (2 * self.half + self.bit))", "3 * MILLISECOND"),
    "wrong_repeats_at_once": ("repeats at once after a wrong response", "memory/each_read_has_its_own_outcome", WRONG,
                              WRONG + "                self.fail(now)\n"),
    "old_modulo_64": ("keeps what it read by ID modulo 64", "memory/each_read_has_its_own_outcome", KEEPS,
                      KEEPS + "\n            self.known[request.id ^ 64] = data0, data1"),
    "counts_8_bits": ("has counters of 8 bits", "memory/counters_go_beyond_8_bits",
                      "self.counters.get(item, 0) + 1", "self.counters.get(item, 0) + 1 & 255"),
    "known_over_power": ("reports what it read before its supply was off", "memory/nothing_survives_power",
                         "self.known, self.written = {}, {}", "self.known, self.written = getattr(self, 'known', {}), {}"),
    "fifo_508": ("has a FIFO of 508 octets", "fifo/full_fifo_keeps_the_oldest", "ATTEMPTS = 512, 3", "ATTEMPTS = 508, 3"),
    "refresh_starves": ("refreshes when the PC has ordered nothing", "refresh/goes_on_beside_reads",
                        "not (self.was_refresh and self.fifo.has_command())", "not self.fifo.has_command()"),
    "refresh_16_nodes": ("refreshes 16 nodes", "refresh/reaches_each_node", NEXT_REFRESH,
                         NEXT_REFRESH.replace("self.written.items()", "list(self.written.items())[:16]")),
    "acknowledge_data0_only": ("does not look at DATA1 of an acknowledge", "cycle/acknowledge_is_looked_at",
                               "is_right = frame[:2] == [self.request.data0, self.request.data1]",
                               "is_right = frame[0] == self.request.data0"),
    "verifies_refreshes": ("reads back refreshes, too", "cycle/verification_comes_first",
                           "if request.is_of_pc and self.settings[\"verifies_writes\"]:",
                           "if self.settings[\"verifies_writes\"]:"),
    "late_after_wrong": ("counts late what comes after a wrong response",
                         "attempts/nothing_is_late_after_a_wrong_response",
                         "None if self.was_wrong else self.request.id", "self.request.id"),
    "refresh_from_end": ("counts the time to a refresh from the end of a write", "endurance/period_at_the_lowest_bit_rate",
                         "request.data0, request.data1, self.own_start", "request.data0, request.data1, self.own_end"),
    "no_rest_after_wrong": ("rests after a last attempt that nothing answered only", "attempts/rest_follows_wrong_responses",
                            "self.time_out + self.time_out // 20",
                            "self.time_out + (0 if self.was_wrong else self.time_out // 20)"),
    "busy_write_forgotten": ("forgets a write that found no silent line", "line/busy_write_is_kept",
                             "if kind == LINE_BUSY and request.command == WRITE:",
                             "if kind == LINE_BUSY and not request.is_of_pc:"),
    "late_of_three_octets": ("counts late frames of three octets only", "attempts/each_late_frame_is_counted",
                             "elif not is_spoilt and", "elif is_right and"),
}

if __name__ == "__main__":
    run(FOLDER, ["host"], FAULTS)

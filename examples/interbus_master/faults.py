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
HEADS_GOOD = "is_good &= octet is not None and stop and head == heads[len(octets)]"
EXPECTED = "if not error and expected and found != expected:"
PAUSE = "pause = max(0, span - frame) // pitch"
IN_A_ROW_STOPS = 'if self.items[IN_A_ROW] >= self.s["stop_after_bad_cycles"]:'
ZEROED = """        for word in range(len(self.outputs)):
            self.set_output(word, 0, now)
        self.enter(state, now)"""

# name: (what it does, which case of interbus/master finds it, line, instead, ...)
FAULTS = {
    "gaps_uneven": ("gaps of 0 and of twice the mean in turn", "compared/each_value_of_each_word", PLACE_OF, 'return n * 13 + n // 2 * 2 * self.s["telegram_gap_millibits"] // 1000'),
    "pause_one_short": ("the last status telegram of each pause is missing", "compared/each_value_of_each_word", PAUSE, "pause = max(0, max(0, span - frame) // pitch - 1)"),
    "pause_with_select": ("status telegrams with SL", "compared/each_value_of_each_word", STATUS, STATUS.replace("self.head(0, 0, False)", "self.head(1, 0, False)")),
    "flag_place_fixed": ("FL is the third level whatever the setting", "compared/other_codings", HEAD, HEAD.replace('self.s[name + "_place"]', '{"select": 0, "control": 1, "flag": 2}[name]')),
    "no_final_xor": ("no final XOR", "compared/other_codings", ' ^ self.s["check_final_xor"]', ""),
    "headers_not_compared": ("takes cycles with other headers", "compared/each_fault_on_the_way_back", HEADS_GOOD, "is_good &= octet is not None and stop"),
    "expected_count": ("compares how many stations are expected only", "compared/each_value_of_each_word", EXPECTED, EXPECTED.replace("found != expected", "len(found) != len(expected)")),
    "row_ended_by_id": ("a good ID cycle ends the row", "compared/each_value_of_each_word", "        self.read_messages(ids, now)\n        if self.is_fault_open:", "        self.put(IN_A_ROW, 0, now)\n        self.read_messages(ids, now)\n        if self.is_fault_open:"),
    "stops_after_ten": ("stops the bus after ten whatever the setting", "compared/other_times", IN_A_ROW_STOPS, "if self.items[IN_A_ROW] >= 10:"),
    "second_start_keeps_quality": ("a second start goes on with the window", "compared/run_after_run", "self.bad_cycles, self.data_cycles = deque(), 0", "self.bad_cycles, self.data_cycles = getattr(self, 'bad_cycles', deque()), getattr(self, 'data_cycles', 0)"),
    "bus_stop_keeps_outputs": ("outputs stay after a bus stop", "compared/each_value_of_each_word", ZEROED, "        for word in range(len(self.outputs) if state == OFF else 0):\n            self.set_output(word, 0, now)\n        self.enter(state, now)"),
    "rejected_ids_as_data": ("counts rejected ID cycles as data cycles", "compared/each_value_of_each_word", "            if not self.is_id:\n                self.count(REJECTED_DATA", "            if True:\n                self.count(REJECTED_DATA"),
}

if __name__ == "__main__":
    run(FOLDER, ["master"], FAULTS)

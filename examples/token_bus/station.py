#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A station of the token bus of IEEE 802.4 on the line of IEEE 802.3:
fieldproof run 'token_bus/station/**' --iut 'exec:python3 station.py'

protocols/token_bus/README.md describes it. Here is what the bench calls; station_machine.py has the access control
machine, station_line.py its supply, user, line and time, station_frames.py the frames and their levels. --fault NAME
gives it a fault of station_faults.py."""
import station_frames as frames
from contract import ASKS_FOR_ACTIVITY, CHARACTERS, end_of, implementation, serve
from station_faults import FAULTS
from station_machine import Machine

LINE, USER = 0, 2  # ports
REFUSED, EVENT = 0, 1  # items
TELL_DATA = 1  # to the user: a data frame follows


class Outside:
    """What a machine has around it: its line, its user, its reports."""

    def __init__(self, stream, half_bit_rate):
        self.stream, self.half_bit_rate = stream, half_bit_rate

    def drive(self, now, half_bits):
        self.stream.transmit_levels(LINE, now, self.half_bit_rate, len(half_bits), frames.packed(half_bits))

    def tell(self, now, octets):
        self.stream.send(CHARACTERS, f"BqH{len(octets) + 1}H", USER, now, len(octets) + 1, TELL_DATA, *octets)

    def report(self, now, kind, address):
        self.stream.write(EVENT, kind | address << 8, now)

    def refuse(self, now):
        self.stream.write(REFUSED, 1, now)

    def count(self, now, item, value):
        self.stream.write(item, value, now)


class Station:
    """The calls of the bench, as a machine has them."""

    def __init__(self, machine, stream, settings, seed):
        self.machine = machine(Outside(stream, 2 * settings["phy_bit_rate"]), settings, seed)
        self.power, self.on_time, self.next_time = self.machine.power, self.machine.on_time, self.machine.next_time

    def receive_characters(self, port, now, octets):
        if port == USER:
            self.machine.ask(now, octets)

    def receive_levels(self, _, start, rate, count, packed):
        half_bits = frames.unpacked(packed, count, rate, self.machine.half_bit_rate)
        self.machine.hear(start, end_of(start, count, rate), half_bits)

    def activity(self, begins, now):
        self.machine.activity(begins, now)


if __name__ == "__main__":
    machine = implementation(FAULTS, Machine)
    serve("station", lambda *case: Station(machine, *case), bytes([ASKS_FOR_ACTIVITY]))

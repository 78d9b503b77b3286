# SPDX-License-Identifier: Apache-2.0
"""Stations with one fault each, to see the bench find it: station.py --fault NAME."""
from station_frames import SOLICIT_SUCCESSOR_2, Reception
from station_line import NEVER
from station_machine import Machine, State


class ClaimsEarly(Machine):
    def claim_time(self):
        time = super().claim_time()
        return time if time == NEVER else time - self.slot


class Compares32Bits(Machine):
    def is_between(self, low, high):
        return low & 0xFFFFFFFF < self.address & 0xFFFFFFFF < high & 0xFFFFFFFF


class OneWindowOfLowest(Machine):
    def open_windows(self, control, destination, windows, data=b""):
        super().open_windows(control, destination, 1 if control == SOLICIT_SUCCESSOR_2 else windows, data)


class RotationGoesOn(Machine):
    def begin_service(self):
        begun = self.served_at[self.service]
        super().begin_service()
        if begun is not None and not self.queues[self.service]:
            self.served_at[self.service] = begun


class RepetitionsAddUp(Machine):
    def begin_request(self, datum):
        repetitions = self.repetitions
        super().begin_request(datum)
        self.repetitions = repetitions


class LeavesWithData(Machine):
    def pass_token(self):
        if self.in_ring_desired:
            return super().pass_token()
        self.become(State.PASS_TOKEN)
        self.leave()


class DataSurvive(Machine):
    def forget(self, now):
        data = getattr(self, "queues", None)
        super().forget(now)
        self.queues = data or self.queues


class EBitIgnored(Machine):
    class reception(Reception):
        def _judged(self, octets, is_ended, has_error):
            return super()._judged(octets, is_ended, False)


# name: (machine, what it does, which case of token_bus/station finds it)
FAULTS = {
    "claims_early": (ClaimsEarly, "claims a slot time too early", "initialisation/first_claim_after_seven_slots"),
    "compares_32_bits": (Compares32Bits, "of 48-bit addresses compares the low 32 bits",
                         "long_addresses/ranges_have_48_bits"),
    "one_window_of_lowest": (OneWindowOfLowest, "gives solicit_successor_2 one window",
                             "passing/the_lowest_opens_two_windows"),
    "rotation_goes_on": (RotationGoesOn, "begins no rotation timer anew of a class without data",
                         "holding/rotation_counts_from_the_service_of_a_class"),
    "repetitions_add_up": (RepetitionsAddUp, "counts the repetitions of all requests together",
                           "anew/each_request_has_its_repetitions"),
    "leaves_with_data": (LeavesWithData, "leaves the ring though data wait",
                         "user/it_stays_until_its_data_are_sent"),
    "data_survive": (DataSurvive, "keeps its data when the supply is lost", "supply/waiting_data_are_gone"),
    "e_bit_ignored": (EBitIgnored, "receives frames with an E bit of 1",
                      "reception/frames_with_the_error_bit_are_left"),
}

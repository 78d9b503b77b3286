# SPDX-License-Identifier: Apache-2.0
"""A station's end of the line: how long frames are, when it may begin to drive, and whom it receives."""
from messages import NEVER, REFUSED, SECOND


class LinkEnd:
    def __init__(self, stream, settings):
        self.stream, self.s, self.now = stream, settings, 0
        self.octet = 8 * SECOND // settings["bit_rate"]
        self.code = {key[5:]: value for key, value in settings.items() if key.startswith("code_")}
        self.is_on = self.is_active = False
        self.heard_until = self.driven_until = 0

    def octets(self, name):
        """How long the octets last that a setting has."""
        return self.s[name + "_octets"] * self.octet

    def time_of(self, octets):
        """Of a frame around these octets: preamble, two delimiters, the check."""
        return (len(octets) + 2 + self.s["preamble_octets"] + 2) * self.octet

    def may_begin(self):
        if self.is_active:
            return NEVER
        return max(self.heard_until, self.driven_until) + self.octets("inter_pdu_delay")

    def drive(self, octets):
        self.driven_until = self.now + self.time_of(octets)
        self.stream.drive(self.now, octets, self.s)

    def on_activity(self, is_active, now):
        self.now, self.is_active = now, is_active
        if not is_active:
            self.heard_until = now

    def hear(self, octets, begin, now):
        self.now = now
        if self.is_on and begin >= self.driven_until:
            self.take(octets)

    def power(self, is_on, now):
        self.now = now
        if not is_on:
            self.forget()
        greatest = min(120, (self.s["response_delay_slots"] - 1) * self.s["slot_time_octets"])
        self.is_on = is_on and self.s["inter_pdu_delay_octets"] <= greatest
        if is_on and not self.is_on:
            self.stream.write(REFUSED, 1, now)

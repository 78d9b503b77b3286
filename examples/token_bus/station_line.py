# SPDX-License-Identifier: Apache-2.0
"""What surrounds the access control machine of a station: supply, user, line, time."""
import random

import station_frames as frames
from contract import NEVER, SECOND

SUBMIT, SET_IN_RING_DESIRED, SET_RESPONSE = 1, 2, 3  # what the user asks for
HIGHEST_CLASS, CLASSES = 0, (6, 4, 2, 0)  # in the order of their service


class Datum:
    """What the user has asked to be sent."""

    def __init__(self, action, priority, destination, data):
        self.action, self.priority, self.destination, self.data = action, priority, destination, data


class StationLine:
    """A station without its decisions. A subclass has these:

    start()           the supply has come
    take(frame)       a frame was received, of which the user has its data already
    take_noise()      something else was received
    claim_time()      when silence will have been long enough to claim the token, or NEVER
    claim()           that time has come

    A decision is put off with `wait` until a time of silence is over, or with `plan` for the gap in front of a
    transmission. While others drive the line both stand still; what has been received is looked at first."""

    reception = frames.Reception  # how a transmission is read

    def __init__(self, outside, settings, seed):
        self.outside, self.s, self.random = outside, settings, random.Random(seed)
        self.half_bit_rate = 2 * settings["phy_bit_rate"]
        self.address, self.address_length = settings["address"], settings["address_length"]
        self.slot = self.octets(settings["slot_time_octets"])
        self.gap = self.octets(settings["response_gap_octets"])
        self.blanking = self.octets(settings["blanking_symbols"]) // 8
        self.counters = dict.fromkeys(range(frames.NON_SILENCE, frames.TOO_LONG + 1), 0)
        self.is_on = False
        self.forget(0)

    def octets(self, count):
        """The time of octets: of eight symbols, each of two bits of the line."""
        return count * 16 * SECOND // self.s["phy_bit_rate"]

    # ---- supply ----

    def forget(self, now):
        """What a loss of the supply does."""
        self.now, self.is_online = now, False
        self.queues = [[] for _ in CLASSES]
        self.response = None
        self.planned = self.waited = None  # (time, what is done then)
        self.is_active = self.is_heard = False
        self.silent_since = self.driven_until = self.blanked_until = now
        self.in_ring_desired = bool(self.s["in_ring_desired"])

    def power(self, is_on, now):
        """The supply comes or goes."""
        if is_on == self.is_on:
            return
        self.is_on = is_on
        self.forget(now)
        if is_on:
            self.is_online = True
            for item, value in self.counters.items():
                if value:
                    self.counters[item] = 0
                    self.outside.count(now, item, 0)
            self.start()

    def go_offline(self):
        """Until the supply comes again."""
        self.is_online = False
        self.planned = self.waited = None

    def report(self, kind, address):
        self.outside.report(self.now, kind, address)

    # ---- user ----

    def fits(self, data):
        return 1 + 2 * self.address_length + len(data) + frames.FCS_OCTETS <= self.s["most_octets"]

    def ask(self, now, asked):
        """A request of the user."""
        self.now = now
        if not self.is_online or not self.is_taken(asked[0], asked[1:]):
            self.outside.refuse(now)

    def is_taken(self, kind, content):
        if kind == SUBMIT:
            action, priority, destination = content[0], content[1], int.from_bytes(content[2:8], "big")
            with_response = action == frames.REQUEST_WITH_RESPONSE
            if priority > 7 or not self.fits(content[8:]) or with_response and frames.is_group(destination):
                return False
            destination &= (1 << 8 * self.address_length) - 1
            self.queues[3 - priority // 2].append(Datum(action, priority, destination, content[8:]))
        elif kind == SET_IN_RING_DESIRED:
            self.in_ring_desired = bool(content[0])
        elif kind == SET_RESPONSE and self.fits(content):
            self.response = content
        else:
            return False
        return True

    def wants_ring(self):
        """Whether it is to be in the ring, or has to be to send its data."""
        return self.in_ring_desired or any(self.queues)

    def tell(self, frame):
        self.outside.tell(self.now, frame.octets(self.address_length))

    # ---- line ----

    def activity(self, begins, now):
        """Others begin to drive the line, or cease."""
        self.now, self.is_active = now, begins
        if begins:
            self.is_heard = False
        elif self.is_heard:
            self.silent_since = now
            if self.planned:
                self.planned = max(self.planned[0], now + self.gap), self.planned[1]

    def hear(self, start, end, half_bits):
        """A transmission that is over. What ends while the receiver is blanked was silence."""
        self.now = end
        if not self.is_online or end <= self.blanked_until or "0" not in half_bits:
            return
        if start < self.blanked_until:
            half_bits = half_bits[-(-(self.blanked_until - start) * self.half_bit_rate // SECOND):]
        self.is_heard, self.silent_since = True, end
        reception = self.reception(half_bits, self.address_length, self.s["most_octets"])
        if reception.says_nothing_follows:
            self.blanked_until = end + self.blanking
        for part in reception.parts:
            if not self.is_online:
                return
            if isinstance(part, frames.Frame):
                self.take_any(part)
            else:
                self.counters[part] += 1
                self.outside.count(end, part, self.counters[part])
                if self.planned:
                    self.planned = end + self.gap, self.planned[1]
                self.take_noise()

    def take_any(self, frame):
        """Data go to the user whatever becomes of the token; what comes from a group is nothing."""
        if frames.is_group(frame.source):
            return
        if frame.source != self.address and frame.is_data() and frame.action() <= frames.RESPONSE:
            if frame.destination == self.address or frames.is_group(frame.destination):
                self.tell(frame)
        self.take(frame)

    def transmit(self, frame):
        """Drives the line now."""
        half_bits = frames.half_bits_of(frame.octets(self.address_length), self.s["preamble_octets"])
        self.outside.drive(self.now, half_bits)
        self.driven_until = self.silent_since = self.now + len(half_bits) * SECOND // self.half_bit_rate
        self.blanked_until = self.driven_until + self.blanking

    def send_control(self, control, destination, data=b""):
        self.transmit(frames.Frame(control, destination, self.address, data))

    def written(self, address):
        """An address as data of a frame."""
        return address.to_bytes(self.address_length, "little")

    # ---- time ----

    def plan(self, action, delay=0):
        """A gap from now, after a delay if there is one."""
        self.planned, self.waited = (self.now + delay + self.gap, action), None

    def wait(self, time, action):
        """For a time of silence from the end of the own transmission, or from now."""
        self.planned, self.waited = None, (max(self.now, self.driven_until) + time, action)

    def wait_slots(self, slots, action):
        self.wait(slots * self.slot, action)

    def next_time(self):
        """When a call is wanted."""
        if not self.is_online or self.is_active:
            return NEVER
        due = self.planned or self.waited
        return due[0] if due else self.claim_time()

    def on_time(self, now):
        """What is due is done."""
        self.now = now
        if self.next_time() > now:
            return
        due = self.planned or self.waited
        self.planned = self.waited = None
        due[1]() if due else self.claim()

# SPDX-License-Identifier: Apache-2.0
"""The access control machine of a station of the token bus: states, windows, the ring.

protocols/token_bus/README.md has its rules; station_line.py what surrounds it."""
from enum import Enum, auto

from station_frames import (CLAIM_TOKEN, REQUEST_WITH_RESPONSE, RESOLVE_CONTENTION, RESPONSE, SET_SUCCESSOR,
                            SOLICIT_SUCCESSOR_1, SOLICIT_SUCCESSOR_2, TOKEN, WHO_FOLLOWS, Frame, is_group)
from station_line import CLASSES, HIGHEST_CLASS, NEVER, StationLine

(JOINED, LEFT, SOLE_STATION, SUCCESSOR_CHANGED, PASS_FAILED, UNEXPECTED_FRAME, RESPONSE_MISSING, DUPLICATE_ADDRESS,
 FAULTY_TRANSMITTER) = range(9)  # events
PASS, PASS_AGAIN, ASK_WHO_FOLLOWS, ASK_AGAIN, SOLICIT_ANY, GIVE_UP = range(6)  # stages of a pass
TO_ANYBODY = 0  # destination of claim_token
WINDOWS_OF_WHO_FOLLOWS, WINDOWS_OF_CONTEST = 3, 4


class State(Enum):
    """USE_TOKEN has check_access_class in it, OFFLINE is `is_online` of the line."""
    IDLE = auto()
    DEMAND_IN = auto()
    DEMAND_DELAY = auto()
    CLAIM_TOKEN = auto()
    USE_TOKEN = auto()
    AWAIT_IFM_RESPONSE = auto()
    PASS_TOKEN = auto()
    CHECK_TOKEN_PASS = auto()
    AWAIT_RESPONSE = auto()


HOLDING = {State.USE_TOKEN, State.AWAIT_IFM_RESPONSE, State.PASS_TOKEN, State.AWAIT_RESPONSE}


class Machine(StationLine):
    """Decisions of a station."""

    def start(self):
        self.state, self.is_member, self.is_sole, self.is_leaving = State.IDLE, False, False, False
        self.predecessor = self.successor = None
        self.offered_successor = None  # of one that has answered a solicitation
        self.failures = 0
        self.tokens_to_window = 0  # counted from when it joins, and from each window
        self.served_at = [None for _ in CLASSES]  # when the service of a class began last
        self.maintained_at = self.now if self.s["solicits_at_first"] else None
        self.repetitions = self.contests = 0

    def pair(self, n):
        """The n-th two bits of the address, the most significant first; random ones behind the last."""
        shift = 8 * self.address_length - 2 * (n + 1)
        return self.random.randrange(4) if shift < 0 else self.address >> shift & 3

    def pairs(self):
        return 4 * self.address_length + 1

    def become(self, state):
        self.state = state

    def go_idle(self):
        self.become(State.IDLE)
        self.planned = self.waited = self.offered_successor = None

    # ---- what is received ----

    def take(self, frame):
        if frame.source == self.address:
            self.report(DUPLICATE_ADDRESS, self.address)
            return self.go_offline()
        if self.state == State.AWAIT_RESPONSE and self.is_answer(frame):
            self.set_successor(frame.named())
            return self.pass_from(PASS)
        if self.state == State.AWAIT_IFM_RESPONSE and self.waited and self.is_response(frame):
            return self.use_next()
        if self.state == State.DEMAND_IN and self.kind(frame) == RESOLVE_CONTENTION:
            return self.contest()
        if self.state == State.DEMAND_IN and self.is_token(frame):
            return self.take_token(frame)
        if self.state == State.CHECK_TOKEN_PASS:
            self.pass_succeeded()
        elif self.state in HOLDING:
            self.report(UNEXPECTED_FRAME, frame.source)
        self.go_idle()
        self.take_idle(frame)

    def take_noise(self):
        if self.state in (State.CLAIM_TOKEN, State.DEMAND_DELAY):
            self.go_idle()
        elif self.state == State.AWAIT_RESPONSE:
            self.resolve()
        elif self.state == State.CHECK_TOKEN_PASS and self.noise_followed:
            self.pass_succeeded()
            self.go_idle()
        elif self.state == State.CHECK_TOKEN_PASS:
            self.noise_followed = True
            self.wait_slots(self.s["noise_wait_slots"], self.nobody_took)

    def kind(self, frame):
        return frame.control_kind(self.address_length)

    def is_token(self, frame):
        return self.kind(frame) == TOKEN and frame.destination == self.address

    def is_answer(self, frame):
        is_mine = self.kind(frame) == SET_SUCCESSOR and frame.destination == self.address
        return is_mine and not is_group(frame.named())

    def is_response(self, frame):
        return frame.is_data() and frame.action() == RESPONSE and frame.destination == self.address

    def take_idle(self, frame):
        kind = self.kind(frame)
        if self.is_token(frame):
            self.take_token(frame)
        elif kind in (SOLICIT_SUCCESSOR_1, SOLICIT_SUCCESSOR_2):
            self.consider(frame)
        elif kind == WHO_FOLLOWS and self.is_member and frame.named() == self.predecessor:
            self.answer(frame.source, None)
        elif kind == SET_SUCCESSOR and self.is_member and self.is_answer(frame):
            self.set_successor(frame.named())
        elif frame.is_data() and frame.action() == REQUEST_WITH_RESPONSE and frame.destination == self.address:
            if self.response is not None:
                response = Frame.of_data(RESPONSE, frame.priority(), frame.source, self.address, self.response)
                self.plan(lambda: self.transmit(response))

    # ---- joining ----

    def consider(self, frame):
        """A solicitation: the window of this address, if there is one."""
        if not self.wants_ring():
            return
        sender, destination = frame.source, frame.destination
        if self.kind(frame) == SOLICIT_SUCCESSOR_1:
            if self.is_between(destination, sender):
                self.answer(sender, destination)
        elif self.address < sender:
            self.answer(sender, destination)
        elif self.address > destination:
            self.answer(sender, destination, self.slot)

    def is_between(self, low, high):
        return low < self.address < high

    def answer(self, sender, offered_successor, delay=0):
        self.become(State.DEMAND_DELAY)
        self.asked_by, self.offered_successor, self.contests = sender, offered_successor, 0
        self.plan(self.send_answer, delay)

    def send_answer(self):
        self.become(State.DEMAND_IN)
        self.send_control(SET_SUCCESSOR, self.asked_by, self.written(self.address))
        self.wait_slots(self.s["demand_wait_slots"], self.go_idle)

    def contest(self):
        """Others have answered, too."""
        self.become(State.DEMAND_DELAY)
        self.plan(self.send_answer, (3 - self.pair(self.contests)) * self.slot)
        self.contests += 1

    def take_token(self, frame):
        self.predecessor = frame.source
        if not self.is_member:
            self.is_member = True
            self.tokens_to_window = self.s["max_inter_solicit_count"]
            self.successor = frame.source if self.offered_successor is None else self.offered_successor
            self.report(JOINED, frame.source)
        self.offered_successor = None
        self.use_token()

    def set_successor(self, address):
        if address != self.successor:
            self.successor, self.is_sole = address, False
            self.report(SUCCESSOR_CHANGED, address)

    # ---- the claim ----

    def claim_time(self):
        if self.state != State.IDLE or not self.wants_ring():
            return NEVER
        is_lowest = self.is_member and self.successor >= self.address
        slots = self.s["lowest_bus_idle_slots" if is_lowest else "bus_idle_slots"]
        return self.silent_since + slots * self.slot + self.gap

    def claim(self):
        self.become(State.CLAIM_TOKEN)
        self.claims = 0
        self.send_claim()

    def send_claim(self):
        self.send_control(CLAIM_TOKEN, TO_ANYBODY, bytes(2 * self.pair(self.claims) * self.s["slot_time_octets"]))
        self.wait_slots(1, self.claim_was_silent)

    def claim_was_silent(self):
        self.claims += 1
        if self.claims < self.pairs():
            return self.plan(self.send_claim)
        self.is_member, self.is_sole, self.predecessor, self.successor = True, False, None, self.address
        self.use_token()

    # ---- data ----

    def use_token(self):
        self.become(State.USE_TOKEN)
        self.service = HIGHEST_CLASS
        self.service_until = self.now + self.octets(self.s["high_priority_hold_octets"])
        self.use_next()

    def use_next(self):
        self.become(State.USE_TOKEN)
        self.plan(self.send_next)

    def send_next(self):
        """The next datum, or what follows when no class may send any more."""
        while not self.queues[self.service] or self.service_until <= self.now:
            self.service += 1
            if self.service == len(CLASSES):
                return self.pass_token()
            self.begin_service()
        self.begin_request(self.queues[self.service].pop(0))

    def begin_request(self, datum):
        self.request = Frame.of_data(datum.action, datum.priority, datum.destination, self.address, datum.data)
        self.repetitions = 0
        self.send_request()

    def begin_service(self):
        begun, self.served_at[self.service] = self.served_at[self.service], self.now
        target = self.octets(self.s[f"target_rotation_octets_{2 - CLASSES[self.service] // 2}"])
        self.service_until = self.now if begun is None else begun + target

    def send_request(self):
        self.transmit(self.request)
        if self.request.action() == REQUEST_WITH_RESPONSE:
            self.become(State.AWAIT_IFM_RESPONSE)
            self.wait_slots(self.s["response_wait_slots"], self.nobody_responded)
        else:
            self.wait(0, self.use_next)

    def nobody_responded(self):
        if self.repetitions < self.s["max_retry_limit"]:
            self.repetitions += 1
            return self.plan(self.send_request)
        self.report(RESPONSE_MISSING, self.request.destination)
        self.use_next()

    # ---- windows ----

    def pass_token(self):
        self.become(State.PASS_TOKEN)
        begun, self.maintained_at = self.maintained_at, self.now
        if not self.wants_ring():
            return self.leave()
        if self.successor == self.address:
            return self.solicit()
        self.tokens_to_window -= 1
        maintenance = self.octets(self.s["ring_maintenance_octets"])
        if self.tokens_to_window < 0 and begun is not None and self.now < begun + maintenance:
            return self.solicit()
        self.stage = PASS
        self.send_stage()

    def solicit(self):
        self.stage, self.contests = None, 0
        self.tokens_to_window = self.s["max_inter_solicit_count"] & ~3 | self.random.randrange(4)
        if self.successor < self.address:
            self.open_windows(SOLICIT_SUCCESSOR_1, self.successor, 1)
        else:
            self.open_windows(SOLICIT_SUCCESSOR_2, self.successor, 2)

    def open_windows(self, control, destination, windows, data=b""):
        self.become(State.AWAIT_RESPONSE)
        self.send_control(control, destination, data)
        self.wait_slots(windows, self.nobody_answered)

    def resolve(self):
        self.become(State.PASS_TOKEN)
        if self.contests == self.pairs():
            return self.nobody_answered()
        self.contests += 1
        self.plan(lambda: self.open_windows(RESOLVE_CONTENTION, self.address, WINDOWS_OF_CONTEST))

    def nobody_answered(self):
        if self.stage is not None:
            self.nobody_took()
        elif self.successor != self.address:
            self.pass_from(PASS)
        else:
            if not self.is_sole:
                self.is_sole = True
                self.report(SOLE_STATION, self.address)
            self.use_token()

    # ---- the pass ----

    def pass_from(self, stage):
        self.become(State.PASS_TOKEN)
        self.stage, self.contests = stage, 0
        self.plan(self.send_stage)

    def send_stage(self):
        if self.stage in (PASS, PASS_AGAIN):
            self.become(State.CHECK_TOKEN_PASS)
            self.noise_followed = False
            self.send_control(TOKEN, self.successor)
            self.wait_slots(1, self.nobody_took)
        elif self.stage in (ASK_WHO_FOLLOWS, ASK_AGAIN):
            self.open_windows(WHO_FOLLOWS, self.successor, WINDOWS_OF_WHO_FOLLOWS, self.written(self.successor))
        else:
            self.open_windows(SOLICIT_SUCCESSOR_2, self.address, 2)

    def nobody_took(self):
        if self.stage + 1 < GIVE_UP:
            return self.pass_from(self.stage + 1)
        self.is_leaving = False
        self.leave_ring()
        self.failures += 1
        if self.failures < self.s["transmitter_fault_limit"]:
            self.report(PASS_FAILED, self.address)
            self.go_idle()
        else:
            self.report(FAULTY_TRANSMITTER, self.address)
            self.go_offline()

    def pass_succeeded(self):
        self.failures = 0
        if self.is_leaving:
            self.has_left()

    # ---- leaving ----

    def leave(self):
        if self.successor == self.address:
            self.has_left()
            return self.go_idle()
        self.is_leaving, self.stage = True, PASS
        if self.predecessor is None:
            return self.send_stage()
        self.send_control(SET_SUCCESSOR, self.predecessor, self.written(self.successor))
        self.wait(0, lambda: self.pass_from(PASS))

    def has_left(self):
        self.is_leaving = False
        self.leave_ring()
        self.report(LEFT, self.address)

    def leave_ring(self):
        self.is_member = self.is_sole = False
        self.predecessor = self.successor = None

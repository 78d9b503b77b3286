#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The host module of the RS-485 valve bus: fieldproof run 'valve_bus/host/**' --iut 'exec:python3 host.py'

Written from protocols/valve_bus/README.md. The messages are those of the node."""
import pathlib
import sys
from collections import namedtuple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "valve_node"))
from node import CHARACTERS, DRIVER, NEVER, SECOND, Stream, serve

LINE, PC = 0, 1  # ports
DIP, RESPONSE, ERROR, ROOM, OVERFLOW = range(5)  # items
SILENT, WRONG, LATE, REPEATED = 0x100, 0x200, 0x300, 0x400  # counters, each with an ID
NOBODY, UNDEFINED, NO_RESPONSE, WRONG_RESPONSE, NOT_ACKNOWLEDGED, READ_BACK, LINE_BUSY, LOST, PART = range(9)  # errors
WRITE, READ = 0, 1  # commands
BIT_RATES = 375000, 187500, 62500, 31250, 20833, 10417, 4808, 2404
FIFO_OCTETS, ATTEMPTS = 512, 3
MILLISECOND = SECOND // 1000
REFRESH, REST_OF_COMMAND = 50 * MILLISECOND, 100 * MILLISECOND
SLACK = 1000  # what rounding may take of a gap

Request = namedtuple("Request", "id command data0 data1 is_of_pc is_verifying", defaults=(True, False))


class Fifo:
    """What the PC has ordered and the host has not yet begun."""

    def __init__(self, host):
        self.host, self.octets, self.has_overflown = host, [], False
        self.part = self.lost = 0  # octets of a command that is not complete; those to come of one that is lost
        self.first, self.deadline = 0, NEVER

    def put(self, octet, now):
        if self.lost:
            self.lost -= 1
        elif len(self.octets) >= FIFO_OCTETS:
            self.first, self.lost, self.has_overflown = octet, 3, True
            self.host.stream.write(OVERFLOW, 1, now)
            self.host.report_error(octet, LOST, now)
        else:
            self.first = self.first if self.part else octet
            self.part = (self.part + 1) % 4
            self.octets.append(octet)
            self.tell_room(now)
        self.deadline = now + REST_OF_COMMAND if self.part or self.lost else NEVER

    def has_command(self):
        return len(self.octets) >= 4

    def take(self, now):
        command, self.octets = self.octets[:4], self.octets[4:]
        self.tell_room(now)
        return command

    def give_up_part(self, now):
        if self.part:
            del self.octets[-self.part:]
            self.tell_room(now)
            self.host.report_error(self.first, PART, now)
        self.part, self.lost, self.deadline = 0, 0, NEVER

    def tell_room(self, now):
        self.host.stream.write(ROOM, FIFO_OCTETS - len(self.octets), now)


class Host:
    def __init__(self, stream, settings):
        self.stream, self.settings = stream, settings
        self.counters = {}
        self.power(False, 0)

    # ---- supply ----

    def power(self, is_on, now):
        self.is_on = is_on
        self.driver_off_at = NEVER  # without a supply it is off
        self.fifo = Fifo(self)
        self.known, self.written = {}, {}  # last response of each node; what was written to it and when
        self.request, self.verification, self.attempt = None, None, 0
        self.is_awaiting, self.was_wrong, self.was_refresh = False, False, False
        self.asked = None  # whose response may still come late
        self.frame, self.frame_start, self.is_spoilt = [], 0, False
        self.busy_until = self.own_start = self.own_end = self.rest_until = now
        self.blocked_since = NEVER
        if is_on:
            self.begin(now)

    def begin(self, now):
        rate = BIT_RATES[self.stream.read(DIP, now) & 7]
        bits = 10 if self.settings["characters"] == 2 else 11
        self.bit, self.half = SECOND // rate + 1, bits * SECOND // (2 * rate) + 1  # half a character
        self.delimiter = 7 * self.half
        self.time_out = self.delimiter + max(3 * MILLISECOND, 3 * (2 * self.half + self.bit))
        self.rest_until = now + self.delimiter
        for item, value in self.counters.items():
            if value:
                self.stream.write(item, 0, now)
        self.counters = {}
        self.fifo.tell_room(now)
        self.stream.write(OVERFLOW, 0, now)

    # ---- reports ----

    def report_error(self, node, kind, now):
        self.stream.write(ERROR, node | kind << 8, now)

    def report_response(self, node, is_old, now):
        if node not in self.known:
            return
        data0, data1 = self.known[node]
        self.stream.write(RESPONSE, node | data0 << 8 | data1 << 16 | is_old << 24, now)

    def count(self, counter, now):
        item = counter + (self.request.id if self.request else self.asked)
        self.counters[item] = self.counters.get(item, 0) + 1
        self.stream.write(item, self.counters[item], now)

    # ---- what is received ----

    def receive(self, port, start, busy_until, data, flags, now):  # a character that is over
        if not self.is_on:
            return
        if port == PC:
            self.fifo.put(data & 0xFF, now)
            self.go_on(now)
            return
        if self.own_start <= start < self.own_end:  # its echo, or who talks into it
            if busy_until > self.own_end + SLACK:
                self.busy_until = busy_until
            return
        gap = start - self.busy_until
        if self.frame and gap >= self.delimiter - SLACK:
            self.end_frame(now)
        if not self.frame:
            self.frame_start = start
        if flags or self.frame and gap > 3 * self.half + SLACK:
            self.is_spoilt = True
        self.frame = self.frame[:3] + [data & 0xFF]
        self.busy_until = busy_until

    def end_frame(self, now):
        frame, start, is_spoilt = self.frame, self.frame_start, self.is_spoilt
        self.frame, self.is_spoilt = [], False
        is_right = not is_spoilt and len(frame) == 3 and frame[0] ^ frame[1] == frame[2]
        if self.is_awaiting and start < self.own_end + self.time_out:
            if self.was_wrong:
                return
            is_right = is_right and start >= self.own_end + 3 * self.half - SLACK
            if is_right and self.request.command == WRITE:
                is_right = frame[:2] == [self.request.data0, self.request.data1]
            if is_right:
                self.take_response(frame[0], frame[1], now)
            else:
                self.was_wrong = True
        elif not is_spoilt and (self.is_awaiting or self.asked):
            self.count(LATE, now)

    def take_response(self, data0, data1, now):
        request, self.request, self.is_awaiting, self.asked = self.request, None, False, None
        if request.command == WRITE:
            self.end_write(request)
            return
        if not request.is_verifying:
            self.known[request.id] = data0, data1
            self.report_response(request.id, False, now)
        elif (data0, data1) != (request.data0, request.data1):
            self.report_error(request.id, READ_BACK, now)

    def end_write(self, request):
        if request.is_of_pc and self.settings["verifies_writes"]:
            self.verification = Request(request.id, READ, request.data0, request.data1, True, True)

    def fail(self, now):
        """Of an attempt; the third one is the last."""
        self.is_awaiting, self.asked = False, None if self.was_wrong else self.request.id
        self.count(WRONG if self.was_wrong else SILENT, now)
        if self.attempt < ATTEMPTS:
            return
        self.rest_until = self.own_end + self.time_out + self.time_out // 20
        self.give_up(WRONG_RESPONSE if self.was_wrong else NO_RESPONSE, now)

    def give_up(self, kind, now):
        request, self.request, self.is_awaiting = self.request, None, False
        if kind == LINE_BUSY and request.command == WRITE:  # is remembered, and due again
            self.written[request.id] = request.data0, request.data1, now
        if kind == LINE_BUSY and not request.is_of_pc:  # a refresh: without an error
            return
        if request.command == WRITE:
            self.report_error(request.id, kind if kind == LINE_BUSY else NOT_ACKNOWLEDGED, now)
        else:
            self.report_error(request.id, kind, now)
            if not request.is_verifying:
                self.report_response(request.id, True, now)

    # ---- time ----

    def silence_known(self):  # a character that began within the delimiter is over by then
        return self.busy_until + self.delimiter + 2 * self.half + self.bit

    def response_known(self):
        """When it is sure that none has begun in time."""
        return self.own_end + self.time_out + 2 * self.half + self.bit

    def free_at(self):
        """When the line can be driven."""
        return max(self.rest_until + 2 * self.half + self.bit, self.silence_known())

    def refresh_due(self):
        """The next node that has to be written again, and when."""
        ages = [(time + REFRESH, node) for node, (_, _, time) in self.written.items()]
        return min(ages, default=(NEVER, None))

    def next_time(self):
        if not self.is_on:
            return NEVER
        times = [self.driver_off_at, self.fifo.deadline, self.silence_known() if self.frame else NEVER]
        if self.is_awaiting:
            times.append(self.response_known() + (self.time_out if self.is_being_answered() else 0))
        elif self.blocked_since != NEVER:
            times += NEVER if self.frame else self.free_at(), self.blocked_since + self.time_out
        else:
            times.append(max(self.work_since(), self.rest_until if self.frame else self.free_at()))
        return min(times)

    def work_since(self):
        return 0 if self.request or self.verification or self.fifo.has_command() else self.refresh_due()[0]

    def is_being_answered(self):
        return self.frame and self.frame_start < self.own_end + self.time_out

    def on_time(self, now):
        if not self.is_on:
            return
        if now >= self.driver_off_at:
            self.release_driver(now)
        if self.frame and now >= self.silence_known():
            self.end_frame(now)
        if now >= self.fifo.deadline:
            self.fifo.give_up_part(now)
        if self.is_awaiting and now >= self.response_known():
            if not self.is_being_answered():
                self.fail(now)
            elif now >= self.response_known() + self.time_out:
                self.give_up(LINE_BUSY, now)
        self.go_on(now)

    def release_driver(self, now):
        if self.driver_off_at != NEVER:
            self.stream.send(DRIVER, "BBq", LINE, 0, now)
        self.driver_off_at = NEVER

    # ---- what is done next ----

    def go_on(self, now):
        if self.is_awaiting or now < self.rest_until:
            return
        while now >= self.work_since():
            if self.frame or now < self.free_at():
                self.wait_for_silence(now)
                return
            self.blocked_since = NEVER
            self.request = self.request or self.next_request(now)
            if self.request:
                self.send(now)
                return

    def wait_for_silence(self, now):
        if self.blocked_since == NEVER:
            self.blocked_since = now
        elif now >= self.blocked_since + self.time_out:
            self.blocked_since = NEVER
            self.request = self.request or self.next_request(now)
            if self.request:
                self.give_up(LINE_BUSY, now)

    def next_request(self, now):
        """None for a command that is refused."""
        self.attempt = 0
        if self.verification:
            request, self.verification = self.verification, None
            return request
        due, node = self.refresh_due()
        if now >= due and not (self.was_refresh and self.fifo.has_command()):
            self.was_refresh = True
            return Request(node, WRITE, *self.written[node][:2], False)
        self.was_refresh = False
        request = Request(*self.fifo.take(now))
        if not 1 <= request.id <= 99:
            self.report_error(request.id, NOBODY, now)
        elif request.command not in (WRITE, READ):
            self.report_error(request.id, UNDEFINED, now)
        else:
            return request
        return None

    def send(self, now):
        request, self.attempt = self.request, self.attempt + 1
        if self.attempt > 1:
            self.count(REPEATED, now)
        octets = [*request[:4], request.id ^ request.command ^ request.data0 ^ request.data1]
        ninth = 0x100 if self.settings["characters"] == 0 else 0
        self.own_start = now + self.bit
        self.own_end = self.busy_until = self.own_start + 10 * self.half
        self.stream.send(DRIVER, "BBq", LINE, 1, now)
        self.stream.send(CHARACTERS, "BqH5H", LINE, self.own_start, 5, *(ninth | octet for octet in octets))
        # Said when it comes, as firmware does whose transmitter tells its end.
        self.driver_off_at = self.own_end + self.bit
        self.asked, self.was_wrong = None, False
        if request.command == WRITE:
            self.written[request.id] = request.data0, request.data1, self.own_start
        self.is_awaiting = request.command == READ or bool(self.settings["answers_writes"])
        if not self.is_awaiting:
            self.request, self.rest_until = None, self.own_end + self.delimiter + MILLISECOND
            self.end_write(request)


if __name__ == "__main__":
    serve(Stream(sys.stdin.buffer, sys.stdout.buffer), "host", Host)

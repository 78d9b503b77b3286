# SPDX-License-Identifier: Apache-2.0
"""Which of two channels of a token bus a MAC is given, and which has a fault.

Nothing here knows levels or messages: symbols come in, with the instants at which they begin and end, and out come
the faults and `Selection.is_indicated`. protocols/token_bus/channel_manager.md has the rules."""
import zlib

from contract import NEVER

LONG_AGO = -NEVER
ZERO, ONE, BAD_SIGNAL, NON_DATA, SILENCE, ANSWER = 0, 1, 2, 4, 6, 8  # ANSWER: any unit of the management mode
NO_START_DELIMITER, BAD, FRAME_ERRORS, CLEAN_AGAIN = range(4)  # kinds of a report
NEITHER, CLEAN, SPOILED = range(3)  # verdicts on a frame or a transmission
DELIMITER_SYMBOLS = 8
START_DELIMITER = bytes([NON_DATA, NON_DATA, ZERO, NON_DATA, NON_DATA, ZERO, ZERO, ZERO])
END_DELIMITER = bytes([NON_DATA, NON_DATA, ONE, NON_DATA, NON_DATA, ONE])  # and I, E


class Rules:
    """The settings, in picoseconds and counts."""
    def __init__(self, settings):
        self.symbol = 2 * 10**12 // settings["phy_bit_rate"]
        self.skew = settings["skew_symbols"] * self.symbol
        self.slot = 8 * settings["slot_time_octets"] * self.symbol
        self.most_octets = settings["most_octets"]
        self.least_octets = 1 + 2 * settings["address_length"] + 4
        self.longest = (8 * self.most_octets + DELIMITER_SYMBOLS) * self.symbol
        self.errors_in_a_row = settings["errors_in_a_row"]
        self.clean_in_a_row = settings["clean_in_a_row"]


class Transmission:
    """From a start delimiter to an end delimiter with I = 0, or to silence, on one channel."""
    def __init__(self, channel, begin):
        self.channel, self.begin, self.end = channel, begin, None
        self.is_selected = False
        self.partner = None  # the same on the other channel
        self.frames = set()  # verdicts on them

    def verdict(self):
        if SPOILED in self.frames:
            return SPOILED
        return CLEAN if self.frames == {CLEAN} else NEITHER


class Channel:
    """What one channel shows: delimiters, bad_signal, frames, transmissions. It tells its selection of each."""
    def __init__(self, port, rules, selection):
        self.port, self.rules, self.selection, self.other = port, rules, selection, None
        self.recent = bytearray()  # the last symbols, as many as a delimiter has
        self.begins = []  # and when each began
        self.last_transmission = None
        self.transmission, self.frame = None, None  # that are under way; a frame is its symbols
        self.last_start = self.last_bad = LONG_AGO  # ends of the last start delimiter and bad_signal
        self.unmatched = []  # (end, transmission) of start delimiters that the other channel may still have
        self.start_due = NEVER  # when a start delimiter is missing
        self.bad_due, self.bad_since = NEVER, 0  # when a bad_signal is no collision, and the start delimiter before it
        self.is_faulty, self.errors, self.clean = False, 0, 0

    def take(self, symbol, begin, end):
        """A symbol that is over."""
        if symbol in (SILENCE, ANSWER):
            self.fall_silent(begin)
            return
        self.recent.append(symbol)
        self.begins.append(begin)
        del self.recent[:-DELIMITER_SYMBOLS], self.begins[:-DELIMITER_SYMBOLS]
        if self.frame is not None:
            self.frame.append(symbol)
        if symbol == BAD_SIGNAL:
            self.last_bad = end
            self.selection.on_bad_signal(self, end)
        elif self.recent == START_DELIMITER:
            self.start_frame(end)
        elif self.transmission and self.recent.startswith(END_DELIMITER) and max(self.recent[6:]) <= ONE:
            self.end_frame(end)
        elif self.frame is not None and len(self.frame) > 8 * self.rules.most_octets + DELIMITER_SYMBOLS:
            self.transmission.frames.add(NEITHER)  # too long
            self.frame = None

    def fall_silent(self, since):
        self.recent.clear()
        self.begins.clear()
        if self.frame is not None:
            self.transmission.frames.add(SPOILED)
        self.end_transmission(since)

    def start_frame(self, end):
        if self.frame is not None:  # the one before has no end delimiter
            self.transmission.frames.add(SPOILED)
        self.frame = bytearray()
        is_first = self.transmission is None
        if is_first:
            self.transmission = self.last_transmission = Transmission(self, self.begins[0])
        self.selection.on_start_delimiter(self, is_first, end)

    def end_frame(self, end):
        is_followed, is_marked = self.recent[6:]  # I, E
        if self.frame is not None:
            symbols, self.frame = self.frame[:-DELIMITER_SYMBOLS], None
            self.transmission.frames.add(NEITHER if is_marked else self.verdict_on(symbols))
        if not is_followed:
            self.end_transmission(end)

    def end_transmission(self, end):
        ended, self.transmission, self.frame = self.transmission, None, None
        if ended:
            ended.end = end
            self.selection.on_end(ended)

    def verdict_on(self, symbols):
        """What is between two delimiters; octets go with the lowest bit first."""
        if len(symbols) % 8 or max(symbols, default=ZERO) > ONE:
            return SPOILED
        octets = int("0" + "".join(map(str, reversed(symbols))), 2).to_bytes(len(symbols) // 8, "little")
        if len(octets) > self.rules.most_octets:
            return NEITHER
        if len(octets) < 4 or zlib.crc32(octets[:-4]) != int.from_bytes(octets[-4:], "little"):
            return SPOILED
        return CLEAN if len(octets) >= self.rules.least_octets else NEITHER

    def cannot_complete(self, now):
        return self.last_bad > self.last_start or now - self.last_start > self.rules.longest

    def has_frame_under_way(self, now):
        return self.frame is not None and not self.cannot_complete(now) and (
            max(self.frame[:-DELIMITER_SYMBOLS], default=ZERO) <= ONE)


class Selection:
    """The channel that is indicated, at each instant, and the faults of both."""
    def __init__(self, settings, ports, report):
        self.rules, self.report = Rules(settings), report
        self.channels = [Channel(port, self.rules, self) for port in ports]
        first, second = self.channels
        first.other, second.other = second, first
        self.preferred = first
        self.current = None  # the transmission that is indicated
        self.waiting, self.decided_at = None, NEVER  # one of the other channel, while the preferred one may have it, too
        self.sources = [(LONG_AGO, first)]  # who is indicated from when on

    # ---- what the channels show ----

    def on_start_delimiter(self, channel, is_first, end):
        other = channel.other
        original = self.original_of(channel, end)
        channel.start_due, channel.last_start = NEVER, end
        if original:
            channel.transmission.partner, original.partner = original, channel.transmission
        if is_first:
            self.choose(channel, original is not None and original.is_selected, end)
        if original:
            return
        if channel.transmission in (self.current, self.waiting):
            channel.unmatched.append((end, channel.transmission))
        if other.start_due == NEVER and not other.has_frame_under_way(end):
            other.start_due = end + self.rules.slot

    def choose(self, channel, is_repeated, end):
        other = channel.other
        if self.waiting and self.waiting.channel is other:
            if channel is self.preferred:
                self.select(channel.transmission)
        elif is_repeated or self.current and not other.cannot_complete(end):
            self.follow(channel.transmission.begin)
        elif channel is self.preferred:
            self.select(channel.transmission)
        else:
            self.waiting, self.decided_at = channel.transmission, end + self.rules.skew

    def original_of(self, channel, end):
        """The transmission of the other channel that has had this start delimiter."""
        other, rules = channel.other, self.rules
        other.unmatched = [one for one in other.unmatched if end - one[0] <= rules.slot]
        if end - other.last_start <= rules.skew:
            other.unmatched, channel.unmatched = [], []
            return other.last_transmission
        return other.unmatched.pop(0)[1] if other.unmatched else None

    def on_bad_signal(self, channel, end):
        other = channel.other
        if channel.bad_due != NEVER or end - other.last_start > self.rules.slot or other.last_bad > other.last_start:
            return
        channel.bad_due, channel.bad_since = end + self.rules.skew, other.last_start

    def on_end(self, ended):
        channel = ended.channel
        if self.current is ended:
            self.current = None
        self.follow(ended.end)
        if channel.is_faulty:
            self.count_clean(channel, ended.verdict())
        if ended.partner and ended.partner.end is not None:
            self.compare(ended, ended.partner)
            self.compare(ended.partner, ended)

    # ---- who is indicated ----

    def select(self, transmission):
        """It is indicated from its first symbol on; what was to be indicated since then is not."""
        self.waiting, self.decided_at = None, NEVER
        self.preferred = transmission.channel
        self.sources = [one for one in self.sources if one[0] < transmission.begin]
        self.sources.append((transmission.begin, transmission.channel))
        self.current, transmission.is_selected = transmission, True
        if transmission.end is not None:  # it was over before this was known
            self.current = None
            self.follow(transmission.end)

    def follow(self, since):
        """Outside of transmissions that is the preferred channel, but for the rest of one that was not selected."""
        if self.current:
            return
        source = None if self.preferred.transmission else self.preferred
        if source is not self.sources[-1][1]:
            self.sources.append((max(since, self.sources[-1][0]), source))

    def is_indicated(self, channel, begin, end):
        """Whether a symbol of a channel is, for its whole duration."""
        source = None
        for since, one in self.sources:
            if since <= begin:
                source = one
            elif since < end and one is not source:
                return False
        return source is channel

    def forget_before(self, instant):
        while len(self.sources) > 1 and self.sources[1][0] <= instant:
            del self.sources[0]

    # ---- faults ----

    def compare(self, here, there):
        channel, verdict = here.channel, here.verdict()
        if verdict == CLEAN:
            channel.errors = 0
        elif verdict == SPOILED and there.verdict() == CLEAN:
            channel.errors += 1
            if channel.errors >= self.rules.errors_in_a_row:
                self.find_fault(channel, FRAME_ERRORS, max(here.end, there.end))

    def find_fault(self, channel, kind, now):
        channel.clean = channel.errors = 0
        if self.preferred is channel:
            self.preferred = channel.other
            self.follow(now)
        if not channel.is_faulty:
            channel.is_faulty = True
            self.report(kind, channel.port)

    def count_clean(self, channel, verdict):
        if verdict == NEITHER:
            return
        channel.clean = channel.clean + 1 if verdict == CLEAN else 0
        if channel.clean >= self.rules.clean_in_a_row:
            channel.is_faulty = False
            self.report(CLEAN_AGAIN, channel.port)

    # ---- time ----

    def next_time(self):
        first, second = self.channels
        return min(self.decided_at, first.start_due, second.start_due, first.bad_due, second.bad_due)

    def on_time(self, now):
        """What is due by now; all symbols that are over by now have been taken."""
        if self.decided_at <= now:
            self.select(self.waiting)
        for channel in self.channels:
            if channel.bad_due <= now:
                channel.bad_due = NEVER
                if channel.other.last_bad <= channel.bad_since:
                    self.find_fault(channel, BAD, now)
            if channel.start_due <= now:
                channel.start_due = NEVER
                self.find_fault(channel, NO_START_DELIMITER, now)

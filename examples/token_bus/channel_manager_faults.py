# SPDX-License-Identifier: Apache-2.0
"""Faults of a channel manager, to see that the bench finds them: channel_manager.py --fault NAME."""
from channel_manager import CHANNEL_B, ChannelManager
from channel_selection import CLEAN, NEVER, Selection


class RequestsOfAAlone(ChannelManager):
    def transmit(self, port, units, delay):
        if port != CHANNEL_B:
            super().transmit(port, units, delay)


class FirstArrivalWins(ChannelManager):
    class make_selection(Selection):
        def choose(self, channel, is_repeated, end):
            super().choose(channel, is_repeated, end)
            if self.waiting:
                self.select(self.waiting)


class PrefersAForEver(ChannelManager):
    class make_selection(Selection):
        def select(self, transmission):
            preferred = self.preferred
            super().select(transmission)
            self.preferred = preferred


class LateCopiesAreNew(ChannelManager):
    class make_selection(Selection):
        def choose(self, channel, is_repeated, end):
            super().choose(channel, False, end)


class MissesNothing(ChannelManager):
    class make_selection(Selection):
        def on_start_delimiter(self, channel, is_first, end):
            super().on_start_delimiter(channel, is_first, end)
            channel.other.start_due = NEVER


class CleanAfterOne(ChannelManager):
    class make_selection(Selection):
        def count_clean(self, channel, verdict):
            if verdict == CLEAN:
                channel.clean = self.rules.clean_in_a_row - 1
            super().count_clean(channel, verdict)


class ReportsAgain(ChannelManager):
    class make_selection(Selection):
        def find_fault(self, channel, kind, now):
            channel.is_faulty = False
            super().find_fault(channel, kind, now)


# name: (class, what it does, which case of token_bus/channel_manager finds it)
FAULTS = {
    "requests_of_a_alone": (RequestsOfAAlone, "passes requests on to channel A alone",
                            "requests/go_out_on_both_channels"),
    "first_arrival_wins": (FirstArrivalWins, "does not wait for the preferred channel",
                           "selection/the_preferred_channel_within_the_skew"),
    "prefers_a_for_ever": (PrefersAForEver, "prefers A whatever was selected last",
                           "selection/what_comes_too_late_is_left"),
    "late_copies_are_new": (LateCopiesAreNew, "selects what comes later on the other channel once more",
                            "selection/what_comes_too_late_is_left"),
    "misses_nothing": (MissesNothing, "never misses a start delimiter", "faults/a_missing_start_delimiter_is_reported"),
    "clean_after_one": (CleanAfterOne, "calls a channel clean after one clean transmission",
                        "faults/a_repaired_channel_is_reported"),
    "reports_again": (ReportsAgain, "reports each fault of a channel that has one",
                      "faults/a_missing_start_delimiter_is_reported"),
}

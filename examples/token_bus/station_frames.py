# SPDX-License-Identifier: Apache-2.0
"""Frames of the token bus, their check, and their levels on a 10 Mbit/s line.

protocols/token_bus/README.md has the line code and the table of frames."""
import zlib
from itertools import groupby

CLAIM_TOKEN, SOLICIT_SUCCESSOR_1, SOLICIT_SUCCESSOR_2, WHO_FOLLOWS = 0x00, 0x80, 0x40, 0xC0
RESOLVE_CONTENTION, TOKEN, SET_SUCCESSOR = 0x20, 0x10, 0x30
REQUEST, REQUEST_WITH_RESPONSE, RESPONSE = 0b000, 0b001, 0b010  # what a data frame is, first bit of the line highest
NON_SILENCE, FRAGMENT, FCS_ERROR, E_BIT_ERROR, TOO_LONG = range(16, 21)  # items of the counters
FCS_OCTETS = 4

# Half bits: a 1 of the line rises in its middle, a 0 falls, idle is high. A symbol of the MAC is two bits of the line.
ONE, ZERO, NON_DATA = "0110", "1001", "0101" "1010"
START_DELIMITER = NON_DATA + ZERO + NON_DATA + 3 * ZERO
END_DELIMITER = NON_DATA + ONE + NON_DATA + ONE  # and I, E
HALVES_OF_OCTET = ["".join(ONE if octet >> bit & 1 else ZERO for bit in range(8)) for octet in range(256)]
OCTET_OF_HALVES = {halves: octet for octet, halves in enumerate(HALVES_OF_OCTET)}
OCTET = len(START_DELIMITER)  # half bits of an octet


def reversed3(value):
    """Three bits, the first of the line highest, as they are stored, and back."""
    return (value & 1) << 2 | value & 2 | value >> 2


class Frame:
    """What is between two delimiters, without its check."""

    def __init__(self, control, destination, source, data=b""):
        self.control, self.destination, self.source, self.data = control, destination, source, data

    @classmethod
    def of_data(cls, action, priority, destination, source, data):
        """A data frame: REQUEST, REQUEST_WITH_RESPONSE or RESPONSE."""
        return cls(0b10 | reversed3(action) << 2 | reversed3(priority) << 5, destination, source, data)

    @classmethod
    def parsed(cls, octets, address_length):
        """The frame of octets without their check."""
        address = lambda n: int.from_bytes(octets[1 + n * address_length:1 + (n + 1) * address_length], "little")
        return cls(octets[0], address(0), address(1), octets[1 + 2 * address_length:])

    def octets(self, address_length):
        """All octets but the check."""
        addresses = (address.to_bytes(address_length, "little") for address in (self.destination, self.source))
        return bytes([self.control]) + b"".join(addresses) + self.data

    def is_data(self):
        return self.control & 0b11 == 0b10

    def action(self):
        return reversed3(self.control >> 2 & 7)

    def priority(self):
        return reversed3(self.control >> 5)

    def control_kind(self, address_length):
        """Its code as a control frame; None for data, an unknown code, or a data unit of a wrong length."""
        if self.control == CLAIM_TOKEN:
            return self.control
        sizes = dict.fromkeys((SOLICIT_SUCCESSOR_1, SOLICIT_SUCCESSOR_2, RESOLVE_CONTENTION, TOKEN), 0)
        sizes |= dict.fromkeys((WHO_FOLLOWS, SET_SUCCESSOR), address_length)
        return self.control if sizes.get(self.control) == len(self.data) else None

    def named(self):
        """The address in the data of who_follows and set_successor."""
        return int.from_bytes(self.data, "little")


def is_group(address):
    return bool(address & 1)


def fcs_of(octets):
    """CRC-32/ISO-HDLC, the lowest octet first."""
    return zlib.crc32(octets).to_bytes(FCS_OCTETS, "little")


def half_bits_of(octets, preamble_octets):
    """The levels of a frame: preamble, delimiters and check included."""
    content = "".join(HALVES_OF_OCTET[octet] for octet in octets + fcs_of(octets))
    return 8 * preamble_octets * ONE + START_DELIMITER + content + END_DELIMITER + 2 * ZERO


def packed(half_bits):
    """Levels as a message carries them, the first in bit 0 of the first octet."""
    return int(half_bits[::-1], 2).to_bytes((len(half_bits) + 7) // 8, "little")


def unpacked(levels, count, rate, half_bit_rate):
    """Half bits of levels that came with any rate: each edge is taken to the nearest border of half bits."""
    text = f"{int.from_bytes(levels, 'little'):0{count}b}"[::-1][:count]
    if rate == half_bit_rate:
        return text
    runs = ((level, len(list(run))) for level, run in groupby(text))
    return "".join(level * ((2 * length * half_bit_rate + rate) // (2 * rate)) for level, length in runs)


class Reception:
    """What is in one transmission: frames and faults in their order, and whether it said that no frame follows."""

    def __init__(self, half_bits, address_length, most_octets):
        self.address_length, self.most_octets = address_length, most_octets
        self.parts = []  # a Frame, or the item of the counter of a fault
        self.says_nothing_follows = False
        at = half_bits.find(START_DELIMITER)
        if at < 0:
            self.parts.append(NON_SILENCE)
        while at >= 0:
            at = half_bits.find(START_DELIMITER, self._read(half_bits, at + OCTET))

    def _read(self, half_bits, at):
        """One frame that begins behind a start delimiter; where it is over."""
        octets = bytearray()
        while (octet := OCTET_OF_HALVES.get(half_bits[at:at + OCTET])) is not None:
            octets.append(octet)
            at += OCTET
        flags = [half_bits[at + n:at + n + 4] for n in (OCTET - 8, OCTET - 4)]  # I, E
        is_ended = half_bits.startswith(END_DELIMITER, at) and all(flag in (ONE, ZERO) for flag in flags)
        if is_ended:
            self.says_nothing_follows = flags[0] == ZERO
            at += OCTET
        self.parts.append(self._judged(bytes(octets), is_ended, flags[1] == ONE))
        return at

    def _judged(self, octets, is_ended, has_error):
        if not is_ended or not octets:
            return FRAGMENT
        if len(octets) > self.most_octets:
            return TOO_LONG
        if has_error:
            return E_BIT_ERROR
        content, check = octets[:-FCS_OCTETS], octets[-FCS_OCTETS:]
        if fcs_of(content) != check:
            return FCS_ERROR
        if len(content) < 1 + 2 * self.address_length:
            return FRAGMENT
        return Frame.parsed(content, self.address_length)

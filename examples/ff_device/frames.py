# SPDX-License-Identifier: Apache-2.0
"""Frames of the data link: their check, and their half bits; protocols/fieldbus_dll/README.md has both."""
from itertools import groupby

# Half bits. A 1 falls in its middle; symbols without an edge there are no data, and delimit frames.
PREAMBLE = "1001100110011001"
START_DELIMITER = "1011001001001101"
END_DELIMITER = "1011001100100110"
BIT_OF = {"10": "1", "01": "0"}
HALVES_OF = [f"{octet:08b}".replace("1", "x").replace("0", "01").replace("x", "10") for octet in range(256)]


def shifted(register):
    for _ in range(8):
        register = register << 1 ^ (0x1DCF if register & 0x8000 else 0)
    return register & 0xFFFF


CHECK_TABLE = [shifted(high << 8) for high in range(256)]


def check_of(octets):
    """CRC-16/PROFIBUS."""
    register = 0xFFFF
    for octet in octets:
        register = register << 8 & 0xFFFF ^ CHECK_TABLE[register >> 8 ^ octet]
    return (register ^ 0xFFFF).to_bytes(2, "big")


def half_bits_of_frame(octets, preamble_octets):
    content = "".join(HALVES_OF[octet] for octet in octets + check_of(octets))
    return PREAMBLE * preamble_octets + START_DELIMITER + content + END_DELIMITER


def half_bits_in(rate, count, packed, bit_rate):
    levels = f"{int.from_bytes(packed, 'little'):0{count}b}"[::-1][:count]
    if rate == 2 * bit_rate:
        return levels
    # Each edge is a border of half bits: the clock is recovered from one to the next.
    runs = ((level, len(list(run))) for level, run in groupby(levels))
    return "".join(level * ((4 * length * bit_rate + rate) // (2 * rate)) for level, length in runs)


def frames_in(half_bits):
    """Octets of all frames that end as they should and whose check fits, without it."""
    at = half_bits.find(START_DELIMITER)
    while at >= 0:
        at += len(START_DELIMITER)
        bits = []
        while not half_bits.startswith(END_DELIMITER, at):
            bit = BIT_OF.get(half_bits[at:at + 2])
            if bit is None or half_bits.startswith(START_DELIMITER, at):
                break
            bits.append(bit)
            at += 2
        else:
            octets = int("0" + "".join(bits), 2).to_bytes(len(bits) // 8 + 1, "big")[1:]
            if len(bits) % 8 == 0 and len(octets) > 2 and check_of(octets[:-2]) == octets[-2:]:
                yield octets[:-2]
        at = half_bits.find(START_DELIMITER, at)

"""The 31 bytes of a ping (see the table in the documentation of `shoal_bus::ping`), rounded outwards."""

import math
import struct
from typing import NamedTuple

from interval import Interval

BYTES = 31


class Ping(NamedTuple):
    sender: int
    sequence: int
    emission_s: Interval
    position_m: list
    velocity_m_s: list


def encode(ping: Ping) -> bytes:
    """The frame whose intervals hold those of `ping`: lower bounds are rounded down, widths up."""
    # Scaling by a power of two is exact.
    earliest = math.floor(math.ldexp(ping.emission_s.lower, 20))
    width = math.ceil(math.ldexp(ping.emission_s.upper, 20)) - earliest
    exponent = next(e for e in range(32) if -(-width >> e) <= 255)
    head = struct.pack("<BHB", 2 << 5 | exponent, ping.sender, ping.sequence % 256)
    time = earliest.to_bytes(6, "little", signed=True) + bytes([-(-width >> exponent)])
    return head + time + block(ping.position_m, 3) + block(ping.velocity_m_s, 1)


def block(sides, size: int) -> bytes:
    """Three intervals in the finest units in which they fit: an exponent, lower bounds of `size` bytes, widths of one."""
    limit = 1 << 8 * size - 1
    for exponent in range(-60, 61):
        lower = [math.floor(math.ldexp(side.lower, -exponent)) for side in sides]
        width = [math.ceil(math.ldexp(side.upper, -exponent)) - least for side, least in zip(sides, lower)]
        if all(-limit <= least < limit for least in lower) and max(width) <= 255:
            lowers = b"".join(least.to_bytes(size, "little", signed=True) for least in lower)
            return struct.pack("b", exponent) + lowers + bytes(width)
    raise ValueError("too large for a frame")


def decode(frame: bytes):
    """What a frame says; `None` for one that has no intervals."""
    if len(frame) != BYTES or frame[0] >> 5 != 2:
        return None
    _, sender, sequence = struct.unpack("<BHB", frame[:4])
    earliest = int.from_bytes(frame[4:10], "little", signed=True)
    latest = earliest + (frame[10] << (frame[0] & 31))
    emission_s = Interval(math.ldexp(earliest, -20), math.ldexp(latest, -20))
    return Ping(sender, sequence, emission_s, unblock(frame[11:24], 3), unblock(frame[24:31], 1))


def unblock(block: bytes, size: int):
    exponent = max(-60, min(60, struct.unpack("b", block[:1])[0]))
    sides = []
    for axis in range(3):
        lower = int.from_bytes(block[1 + axis * size : 1 + (axis + 1) * size], "little", signed=True)
        upper = lower + block[1 + 3 * size + axis]
        sides.append(Interval(math.ldexp(lower, exponent), math.ldexp(upper, exponent)))
    return sides

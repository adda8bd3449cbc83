"""One end of a bad link: a network interface (TUN) whose packets are delayed, and some of them lost.

    link.py INTERFACE OWN_SOCKET OTHER_SOCKET DELAY_S LOSS SEED

Packets that the kernel sends go to the other end's socket after DELAY_S, but for a fraction LOSS of them; what comes from there goes to the
kernel. Ends with its standard input.
"""

import collections
import fcntl
import os
import random
import select
import socket
import struct
import sys
import time

TUNSETIFF = 0x400454CA
IFF_TUN, IFF_NO_PI = 0x0001, 0x1000
PACKET = 65_536


def main():
    name, here, there, delay_s, loss, seed = sys.argv[1:]
    delay_s, loss, draw = float(delay_s), float(loss), random.Random(seed)
    tun = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TUN | IFF_NO_PI))
    box = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    box.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4 << 20)
    box.bind(here)
    print("ready", flush=True)
    waiting = collections.deque()
    while True:
        patience_s = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        ready, _, _ = select.select([tun, box, sys.stdin], [], [], patience_s)
        if sys.stdin in ready:
            return
        if tun in ready:
            packet = attempt(lambda: os.read(tun, PACKET))
            if packet and draw.random() >= loss:
                waiting.append((time.monotonic() + delay_s, packet))
        if box in ready:
            packet = box.recv(PACKET)
            attempt(lambda: os.write(tun, packet))
        while waiting and waiting[0][0] <= time.monotonic():
            packet = waiting.popleft()[1]
            attempt(lambda: box.sendto(packet, there))


def attempt(action):
    """A packet that cannot go where it should is lost: the interface is down, or nobody is at the other end."""
    try:
        return action()
    except OSError:
        return None


main()

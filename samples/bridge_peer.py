#!/usr/bin/env python3
"""A device for `palpate run SCENE --hand bridge:udp:PORT`: a simulated arm in a simulated hand, over UDP.

    python3 samples/bridge_peer.py PORT [SECONDS] &
    build/bin/palpate run samples/scenes/palm_wart.json --hand bridge:udp:PORT --seconds 8

The report is that of device/README.md, "The bridge"; replace arm() by a device of your own.
"""
import binascii
import math
import socket
import struct
import sys
import time

PERIOD = 1e-3                       # [s]
MASS, DAMPING = 0.3, 2.0            # [kg], [N s/m] of the arm
GRIP, HAND = 300.0, 3.0             # [N/m], [N s/m] of the hand
WATCHDOG_LIMIT = 0.1                # [s] no host may ask for more
RESTART = 0.1                       # [s] without a command, after which the host may count from any number

ANSWER = "<4BHHI3i3hh4hIH3h4HBB"    # 62 bytes, then the checksum
COMMAND = "<4BHH3hBB46x"            # likewise


def with_checksum(body):
    return body + struct.pack("<H", binascii.crc_hqx(body, 0xFFFF))


def hand(t):
    """Height of the hand's own place [m]: above the object for 3 s, then up and down."""
    return 0.0 if t < 3 else -0.006 * (1 - math.cos(math.pi * (t - 3)))


def arm(y, v, force, t):
    """Moves the arm on by a period; its place and speed [m], [m/s]."""
    for _ in range(4):
        h = PERIOD / 4
        v += (force + GRIP * (hand(t) - y) - (HAND + DAMPING) * v) / MASS * h
        y += v * h
    return y, v


def main(port, seconds):
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    line.setblocking(False)
    start = time.monotonic()
    y = v = force = most = asked = 0.0
    rendered = heard = sequence = stopped = enabled = 0
    patience, next_tick, pushed = 0.0, start, start
    while (now := time.monotonic()) < start + seconds:
        try:
            while True:             # the newest command counts
                report = line.recv(65)
                if len(report) != 64 or report != with_checksum(report[:62]):
                    continue
                kind, p, b, version, number, flags, _, fy, _, ms, _ = struct.unpack(COMMAND, report[:62])
                if (kind, p, b, version >> 4) != (2, 0x50, 0x42, 1):
                    continue
                ahead = (number - rendered) & 0xFFFF
                if not 0 < ahead < 0x8000 and now - heard <= RESTART:  # (int16)(number - rendered) > 0
                    continue        # an old one, which came late
                rendered, heard, patience = number, now, min(ms * 1e-3, WATCHDOG_LIMIT)
                enabled = flags & 1
                stopped = stopped and enabled       # until a command without "enable"
                asked = fy * 1e-3 if enabled else 0.0
                force = 0.0 if stopped else asked
        except (BlockingIOError, ConnectionRefusedError):
            pass                    # nothing more, or nobody listens yet
        if enabled and now - heard > patience:      # the watchdog
            force, stopped = 0.0, 1
        y, v = arm(y, v, force, now - start)
        most = max(most, abs(force))
        sequence = sequence + 1 & 0xFFFF
        pushed = now if enabled or now - pushed > 1.5 else pushed
        button = 1 if now - pushed > 1.0 else 0     # a second without "enable": a hand that clears the host's fault
        flags = 2 | 4 | (1 if force else 0) | (8 if stopped else 0)   # homed, in the box, motors on, stopped
        line.sendto(with_checksum(struct.pack(
            ANSWER, 1, 0x50, 0x42, 0x11, sequence, flags, button, 0, round(y * 1e6), 0, 0, round(v * 1e3), 0, 0, 0, 0, 0, 0,
            int(now * 1e6) & 0xFFFFFFFF, rendered, 0, round(force * 1e3), 0, 500, 6000, 800, 3000, 1, 0)),
            ("127.0.0.1", port))
        next_tick += PERIOD
        time.sleep(max(0.0, next_tick - time.monotonic()))
    print(f"rendered at most {most:.2f} N; the last command asked for {abs(asked):.2f} N")


if __name__ == "__main__":
    if len(sys.argv) < 2 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    main(int(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 60.0)

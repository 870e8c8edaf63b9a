"""Plays the host to samples/bridge_peer.py, over UDP, and holds it to the rules of device/README.md. Argument: the checkout."""

import contextlib
import io
import socket
import struct
import sys
import threading
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv[1]) / "samples"))

import bridge_peer as peer  # noqa: E402

WATCHDOG = 25  # [ms] that the host asks for


class Peer(unittest.TestCase):
    def setUp(self):
        self.line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.line.bind(("127.0.0.1", 0))
        self.line.settimeout(5)
        run = threading.Thread(target=self.run_peer, args=(self.line.getsockname()[1],))
        run.start()
        self.addCleanup(self.line.close)
        self.addCleanup(run.join)

    def run_peer(self, port):
        with contextlib.redirect_stdout(io.StringIO()):
            peer.main(port, 3)

    def hear(self):
        """Returns the number of the command that the peer renders, its force [N] and whether it has stopped by itself."""
        report, self.there = self.line.recvfrom(65)
        fields = struct.unpack(peer.ANSWER, report[:62])
        flags, rendered, force = fields[5], fields[19], fields[21]
        return rendered, force * 1e-3, bool(flags & 8)

    def say(self, number, enable, force=0.0):
        body = struct.pack(peer.COMMAND, 2, 0x50, 0x42, 0x11, number, 1 if enable else 0, 0, round(1e3 * force), 0, WATCHDOG, 0)
        self.line.sendto(peer.with_checksum(body), self.there)

    def until(self, wanted):
        """Hears until it is so, for 2 s at most; the last that was heard."""
        end = time.monotonic() + 2
        while not wanted(*(heard := self.hear())):
            self.assertLess(time.monotonic(), end, heard)
        return heard

    def test_an_old_command_is_not_taken_and_a_host_may_start_anew(self):
        self.hear()
        self.say(0xFFFF, True, 1.0)
        self.until(lambda rendered, force, stopped: rendered == 0xFFFF)
        for number in range(100):  # counted on from 0
            self.say(number, True, 1.0)
            self.say((number - 5) & 0xFFFF, True, 2.0)  # late
            rendered, force, _ = self.hear()
            self.assertLess(force, 1.5, rendered)
        self.assertTrue(self.until(lambda rendered, force, stopped: stopped)[2], "the host has fallen silent")
        time.sleep(peer.RESTART)
        self.say(7, False)
        self.until(lambda rendered, force, stopped: rendered == 7 and not stopped)

    def test_the_watchdog_acts_where_no_force_is_asked_for(self):
        self.hear()
        self.say(1, True, 0.0)
        self.until(lambda rendered, force, stopped: rendered == 1)
        self.until(lambda rendered, force, stopped: stopped)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

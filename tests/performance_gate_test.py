#!/usr/bin/env python3
"""Tests performance_gate.py with programs that print made-up ratios: a loss of 14 % passes, one of 16 % does not."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
GATE = Path(__file__).resolve().parent / "performance_gate.py"


def row(ratio, case="table", nodes=65, peer="CHOLMOD", took=1.0):
    """A row of a report; took: Palpate's time [ms]."""
    return {"case": case, "map": "wart", "nodes": nodes, "accuracy": "1e-4", "peer": peer, "ratio": ratio, "peer_ms": ratio * took, "palpate_ms": took}


class Gate(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def program(self, name, rows, status=0):
        path = Path(self.folder.name) / name
        path.write_text(f"#!/bin/sh\ncat <<'JSON'\n{json.dumps({'rows': rows})}\nJSON\nexit {status}\n")
        path.chmod(0o755)
        return path

    def judged(self, old, new):
        """Returns the exit status and what was printed."""
        programs = [old if isinstance(old, Path) else self.program("old", old), new if isinstance(new, Path) else self.program("new", new)]
        done = subprocess.run([sys.executable, GATE, *programs, "1"], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def test_a_program_beside_itself_passes(self):
        status, said = self.judged([row(10), row(0.5, "update")], [row(10), row(0.5, "update")])
        self.assertEqual(status, 0, said)
        self.assertIn("table", said)
        self.assertIn("update", said)

    def test_what_is_lost_is_a_share_of_what_was(self):
        self.assertEqual(self.judged([row(10)], [row(8.6)])[0], 0)
        status, said = self.judged([row(10)], [row(8.4)])
        self.assertEqual(status, 1)
        self.assertIn("FAILED", said)

    def test_one_case_that_is_slower_is_enough(self):
        self.assertEqual(self.judged([row(10), row(10, "update")], [row(20), row(8, "update")])[0], 1)

    def test_within_a_case_the_geometric_mean_counts(self):
        self.assertEqual(self.judged([row(10), row(10, nodes=129)], [row(8), row(12.5, nodes=129)])[0], 0)
        self.assertEqual(self.judged([row(10), row(10, nodes=129)], [row(5), row(13, nodes=129)])[0], 1)

    def test_what_the_new_program_alone_has_does_not_count_and_what_it_lacks_does(self):
        self.assertEqual(self.judged([row(10)], [row(10), row(1, "new")])[0], 0)
        status, said = self.judged([row(10), row(100, "gone")], [row(10)])
        self.assertEqual(status, 1)
        self.assertIn("gone", said)
        self.assertNotEqual(self.judged([row(10, "gone")], [row(10, "new")])[0], 0)

    def test_a_published_time_is_of_another_machine_and_the_runs_peers_take_its_place(self):
        before = [row(10), row(160, "update", peer="paper (published)")]
        busy = [row(10, took=3), row(160 / 3, "update", peer="paper (published)", took=3)]  # all takes thrice the time
        self.assertEqual(self.judged(before, busy)[0], 0)
        slow = [row(10), row(80, "update", peer="paper (published)", took=2)]
        self.assertEqual(self.judged(before, slow)[0], 1)

    def test_a_program_that_fails_is_no_pass(self):
        self.assertNotEqual(self.judged([row(10)], self.program("broken", [row(10)], 2))[0], 0)


if __name__ == "__main__":
    unittest.main()

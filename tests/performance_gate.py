#!/usr/bin/env python3
"""Fails if Palpate has become slower beside its peers than the last release was.

usage: python3 tests/performance_gate.py OLD-PALPATE NEW-PALPATE [ROUNDS]

Both programs run  palpate bench --quick  in turns (3 rounds), so that a machine that gets slower slows both. What counts is
the ratio of a peer's time to Palpate's, the median of the rounds; of each case the geometric mean over its rows may fall by
15 % at most. Single rows vary by more than that on a busy machine, their means do not. Where the peer's time is a
published one, of another machine, the mean time of the run's own peers takes its place.
"""

import json
import math
import statistics
import subprocess
import sys

CASES = "new_map,new_load,update,table"
MOST_LOSS = 0.15


def is_published(row):
    return row["peer"].endswith("(published)")


def ratios(program):
    """Returns the ratio of each row by what it measures."""
    done = subprocess.run([program, "bench", "--quick", "--json", "--solver", "host", "--cases", CASES], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{program} bench: {done.stderr.strip()}")
    rows = [row for row in json.loads(done.stdout)["rows"] if row["ratio"]]
    own = [math.log(row["peer_ms"]) for row in rows if not is_published(row)]
    yardstick = math.exp(statistics.mean(own)) if own else 1.0  # [ms]
    return {
        tuple(row[k] for k in ("case", "map", "nodes", "accuracy", "peer")): yardstick / row["palpate_ms"] if is_published(row) else row["ratio"]
        for row in rows
    }


def lost(old, new):
    """Returns the rows that every run of the old program has and none of the new one: it does not solve them any more."""
    return sorted(set.intersection(*map(set, old)) - set.union(*map(set, new)), key=str)


def compared(old, new):
    """Returns the change of each case's mean ratio, from lists of ratios() of both programs."""
    cases = {}
    for key in set.intersection(*map(set, old + new)):
        before, after = (statistics.median(run[key] for run in runs) for runs in (old, new))
        cases.setdefault(key[0], []).append(math.log(after / before))
    return {case: math.exp(statistics.mean(logs)) - 1 for case, logs in sorted(cases.items())}


def main():
    if not 3 <= len(sys.argv) <= 4:
        raise SystemExit(__doc__)
    old, new = [], []
    for _ in range(int(sys.argv[3]) if len(sys.argv) == 4 else 3):
        old.append(ratios(sys.argv[1]))
        new.append(ratios(sys.argv[2]))
    changes = compared(old, new)
    if not changes:
        raise SystemExit("the two programs have no row in common: is palpate_peers beside both?")
    gone = lost(old, new)
    for row in gone:
        print(f"{', '.join(map(str, row))}: FAILED, the new program has no such row, or calls it otherwise")
    for case, change in changes.items():
        print(f"{case:10} {100 * change:+6.1f} %" + ("  FAILED, beyond 15 %" if change < -MOST_LOSS else ""))
    sys.exit(bool(gone) or any(change < -MOST_LOSS for change in changes.values()))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Do the tests bite? Changes one thing of a source at a time and looks whether its tests notice.

usage: python3 tests/mutate.py [--minutes N] [--file TEXT]... [--part I/N] [--survivors | --report]

  --minutes N    stop after this time (10); what was judged is kept in BUILD/mutants/results.tsv and not judged again
  --file TEXT    only sources whose path contains TEXT; tests/mutation/targets.txt lists all
  --part I/N     every N-th source from the I-th on, such as 1/2 and 2/2 in two terminals, for two cores
  --survivors    judge those anew that survived, after the tests have been improved
  --report       judge nothing, print the table only

It needs a build with tests by ninja, which  cmake -S . -B build -G Ninja -DPALPATE_TESTS=ON  and
cmake --build build  make; PALPATE_BUILD=FOLDER names another one. Sources take turns, so that any time gives a fair
sample. Survivors that are known to be harmless stand in tests/mutation/explained.txt with their reason.
"""

import argparse
import os
import random
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
from mutation.bench import Bench, Program
from mutation.operators import applied, mutants_of

ROOT = Path(__file__).resolve().parent.parent
COUNTED = ("killed", "timeout", "survived")


def targets(words):
    for line in (ROOT / "tests/mutation/targets.txt").read_text().splitlines():
        source, *rest = line.split() if line.strip() and not line.startswith("#") else [None]
        if source and (not words or any(word in source for word in words)):
            own = rest[0] == "OWN"
            yield source, [Program(word, own) for word in rest[own:]]


def keyed(text, source):
    """Returns the mutants of a source's text by a key that survives edits elsewhere in the file."""
    seen, out = {}, {}
    lines = text.split("\n")
    for mutant in mutants_of(text):
        line = lines[mutant.line]
        mutated = applied(line, mutant._replace(line=0)).strip()
        count = seen[line.strip(), mutated] = seen.get((line.strip(), mutated), 0) + 1
        out[source, mutant.operator, line.strip(), mutated, str(count)] = mutant
    return out


def read(path):
    if not path.exists():
        return {}
    rows = [line.split("\t") for line in path.read_text().splitlines()]
    return {tuple(row[:5]): (row[5], row[6]) for row in rows if len(row) == 7}


def explained():
    """Returns (file, line as mutated, or "delete: " and the line) of the survivors whose reason is known."""
    path = ROOT / "tests/mutation/explained.txt"
    blocks = path.read_text().split("\n\n") if path.exists() else []
    out = set()
    for block in blocks:
        source = None
        for line in block.splitlines():
            if line.startswith("    ") and source:
                out.add((source, line.strip()))
            elif not line.startswith("#") and line.strip():
                source = line.split(":")[0]
    return out


def shown(line, mutated):
    return "delete: " + line if mutated == ";" else mutated


def turns(results, wanted, again):
    """Yields (source, programs, key, line, text) that are to be judged, one of each source in turn; edits meanwhile do not count."""
    queues = []
    for source, programs in wanted:
        text = (ROOT / source).read_text()
        known = keyed(text, source)
        keys = [k for k in known if (results.get(k, ("",))[0] == "survived" if again else k not in results)]
        random.Random(source).shuffle(keys)
        queues.append([(source, programs, k, known[k].line + 1, text, known[k]) for k in keys])
    while any(queues):
        for queue in queues:
            if queue:
                *about, text, mutant = queue.pop(0)
                yield *about, applied(text, mutant)


def killers(results, source):
    """Lists the tests that killed mutants of a source: the next one of it most likely dies by them too."""
    return sorted({reason for key, (verdict, reason) in results.items() if key[0] == source and verdict == "killed" and "." in reason})


def report(results, wanted):
    """Prints the table, of what is a mutant of the present code."""
    known, harmless, rows = {key for source, _ in wanted for key in keyed((ROOT / source).read_text(), source)}, explained(), {}
    for key, (verdict, _) in results.items():
        source, _, line, mutated, _ = key
        if key not in known or verdict not in COUNTED:
            continue
        judged = "explained" if verdict == "survived" and (source, shown(line, mutated)) in harmless else verdict
        for name in (source, str(Path(source).parent) + "/", "all"):
            rows.setdefault(name, {}).setdefault(judged, 0)
            rows[name][judged] += 1
    print(f"{'':46} mutants killed explained survived   score")
    for name in sorted(rows, key=lambda n: (n == "all", str(Path(n).parent) if not n.endswith("/") else n[:-1], not n.endswith("/"), n)):
        row = rows[name]
        dead, told = row.get("killed", 0) + row.get("timeout", 0), row.get("explained", 0)
        total = sum(row.values())
        print(f"{name:46} {total:7} {dead:6} {told:9} {total - dead - told:8} {100 * (dead + told) / total:6.1f} %")
    for key, (verdict, _) in sorted(results.items()):
        source, operator, line, mutated, count = key
        if key in known and verdict == "survived" and (source, shown(line, mutated)) not in harmless:
            print(f"survived: {source}, {operator}, occurrence {count}\n    {line}\n    {mutated}")
    possible = {(source, shown(line, mutated)) for source, _, line, mutated, _ in known}
    for source, line in sorted(harmless - possible):
        print(f"tests/mutation/explained.txt: this is no mutant of {source} any more\n    {line}")


def main():
    options = argparse.ArgumentParser(add_help=False)
    options.add_argument("--minutes", type=float, default=10)
    options.add_argument("--file", action="append", default=[])
    options.add_argument("--part", default="1/1", type=lambda word: tuple(map(int, word.split("/"))))
    options.add_argument("--survivors", action="store_true")
    options.add_argument("--report", action="store_true")
    options.add_argument("--help", "-h", action="store_true")
    chosen = options.parse_args()
    if chosen.help:
        print(__doc__)
        return
    build = Path(os.environ.get("PALPATE_BUILD", ROOT / "build")).resolve()
    kept = build / "mutants/results.tsv"
    results, wanted = read(kept), list(targets(chosen.file))
    if not chosen.report:
        if not (build / "build.ninja").exists():
            raise SystemExit(f"{build} holds no build.ninja: build Palpate with its tests by ninja first, see --help")
        part, parts = chosen.part
        bench, end = Bench(ROOT, build, part), time.monotonic() + 60 * chosen.minutes
        for source, programs, key, line, text in turns(results, wanted[part - 1 :: parts], chosen.survivors):
            if time.monotonic() > end:
                break
            results[key] = bench.judge(source, text, programs, killers(results, source))
            with kept.open("a") as out:
                out.write("\t".join((*key, *results[key])) + "\n")
            print(f"{results[key][0]:9} {source}:{line} {key[3]}", flush=True)
    report(results, wanted)


if __name__ == "__main__":
    main()

"""The felt map of felt_map_benchmark.cpp from Python: clock's and processors' time, the latter on all cores.

    PYTHONPATH=engine/capi/python PALPATE_LIBRARY=build/lib/libpalpate.so.0 python3 tests/benchmarks/felt_map.py
"""

import resource
import time

import palpate


def now():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return time.perf_counter(), used.ru_utime + used.ru_stime


made = palpate.Object.scene({"cloud": "sample:skin", "points": 40000, "solver": "host"})
before = now()
felt = made.felt_map(spacing=2e-3)
clock, processors = (after - at for after, at in zip(now(), before))
print(f"felt map of {len(felt)} points, 2 mm, from Python: {clock:.2f} s, of the processors {processors:.2f} s")

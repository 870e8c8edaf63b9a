#!/bin/sh
# Runs sessions in virtual time for hours, over all scenes and hands, with faults of device, solver, clock, memory and
# disk at random instants, and checks every tick.
set -eu
usage() {
    cat <<'TEXT'
usage: sh tests/soak.sh [--hours N | --minutes N] [--seed N] [--jobs N]

  --hours N, --minutes N  how long (10 minutes); what was run is kept, so that the next run goes on where this one ended,
                          or with the batch that found something
  --seed N                of everything that is random (1)
  --jobs N                processes side by side (2), each with batches of its own

It needs a build with tests, which sh tests/run.sh makes; PALPATE_BUILD=FOLDER names another one. A finding names the batch
that repeats it. Exits with 1 if there was one.
TEXT
}
cd "$(dirname "$0")/.."
minutes=10 seed=1 jobs=2
whole() { # whole FLAG TEXT
    case $2 in '' | *[!0-9]* | 0*) echo "$1: expected a whole number from 1, found \"$2\""; exit 2 ;; esac
}
while [ $# -gt 0 ]; do
    case $1 in
    --hours) whole "$1" "${2:-}"; minutes=$(($2 * 60)); shift ;;
    --minutes) whole "$1" "${2:-}"; minutes=$2; shift ;;
    --seed) whole "$1" "${2:-}"; seed=$2; shift ;;
    --jobs) whole "$1" "${2:-}"; jobs=$2; shift ;;
    --help | -h) usage; exit 0 ;;
    *) echo "unknown option $1"; usage; exit 2 ;;
    esac
    shift
done
build=${PALPATE_BUILD:-build}
[ -x "$build/bin/palp_soak" ] || { echo "$build/bin/palp_soak is missing: build Palpate with its tests first, by sh tests/run.sh"; exit 2; }

mkdir -p "$build/soak"
pids= part=0
trap 'kill $pids 2>/dev/null; exit 130' INT
trap 'kill $pids 2>/dev/null; exit 143' TERM
while [ $part -lt "$jobs" ]; do
    "$build/bin/palp_soak" --seed "$seed" --seconds $((minutes * 60)) --part "$part/$jobs" \
        --state "$build/soak/seed_${seed}_part_${part}_of_$jobs" --scenes samples/scenes &
    pids="$pids $!"
    part=$((part + 1))
done
failed=0
for pid in $pids; do wait "$pid" || failed=1; done
exit $failed

#!/bin/sh
# Every reader of what comes from outside over its seeds, whole and damaged, each byte watched by valgrind: memory that nobody
# has written, which AddressSanitizer does not see. Exits with 77 where valgrind is missing.
set -eu
cd "$(dirname "$0")/.."
build=${PALPATE_BUILD:-build}
replay=$build/bin/palp_fuzz_replay
[ -x "$replay" ] || { echo "$replay is missing: build Palpate with its tests first, by sh tests/run.sh"; exit 2; }
command -v valgrind >/dev/null 2>&1 || { echo 'valgrind is missing; it is a package of that name'; exit 77; }
seeds=$(mktemp -d)
trap 'rm -rf "$seeds"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
sh tests/fuzz/make_seeds.sh "$seeds"
sh tests/fuzz/written_seeds.sh "$build/bin/palpate" "$seeds"
valgrind --quiet --error-exitcode=1 --exit-on-first-error=yes --num-callers=30 "$replay" --few "$seeds" tests/fuzz/found

#!/bin/sh
# Replays the seeds of every fuzzer and the inputs that fuzzing once found faults with (found/FORMAT). Arguments: the
# program palp_fuzz_replay and a folder for the seeds.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
sh "$here/make_seeds.sh" "$2"
cd "$2/.."
exec "$1" "$2" "$here/found"

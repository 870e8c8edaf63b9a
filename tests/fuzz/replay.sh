#!/bin/sh
# Replays the seeds of every fuzzer and the inputs that fuzzing once found faults with (found/FORMAT), then compares the time
# for long inputs with that for short ones. Arguments: the programs palp_fuzz_replay and palpate, and a folder for the seeds.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
sh "$here/make_seeds.sh" "$3"
sh "$here/written_seeds.sh" "$2" "$3"
cd "$3/.."
"$1" "$3" "$here/found"
if ! command -v python3 >/dev/null 2>&1; then echo 'skipped: times of long inputs, there is no python3'; exit; fi
python3 "$here/make_long.py" "$3/../short" 1000
python3 "$here/make_long.py" "$3/../long" 16000
exec "$1" --linear "$3/../short" "$3/../long"

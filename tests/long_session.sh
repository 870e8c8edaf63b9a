#!/bin/sh
# A session in real time with an emulated Falcon, for as long as asked: its memory, threads and handles stay, its clock keeps
# with the machine's, and its recording is whole.
set -u
usage() {
    cat <<'TEXT'
usage: sh tests/long_session.sh [--hours N | --minutes N | --seconds N] [PALPATE]

  --hours N, --minutes N, --seconds N  how long (10 minutes)
  PALPATE                              the program (build/bin/palpate)

An hour takes some 2.5 GB, 0.8 of a recording and 1.7 of its table, in a temporary folder that is removed.
TEXT
}
seconds=600 palpate=
whole() { # whole FLAG TEXT
    case $2 in '' | *[!0-9]* | 0*) echo "$1: expected a whole number from 1, found \"$2\""; exit 2 ;; esac
}
while [ $# -gt 0 ]; do
    case $1 in
    --hours) whole "$1" "${2:-}"; seconds=$(($2 * 3600)); shift ;;
    --minutes) whole "$1" "${2:-}"; seconds=$(($2 * 60)); shift ;;
    --seconds) whole "$1" "${2:-}"; seconds=$2; shift ;;
    --help | -h) usage; exit 0 ;;
    -*) echo "unknown option $1"; usage; exit 2 ;;
    *) palpate=$1 ;;
    esac
    shift
done
top=$(cd "$(dirname "$0")/.." && pwd)
palpate=${palpate:-$top/build/bin/palpate}
. "$top/tests/support/sessions.sh"
work=$(mktemp -d)
session=
trap '[ -z "$session" ] || { kill "$session" && wait "$session"; } 2>/dev/null; rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
failed=0
complain() { failed=1; echo "FAILED: $*"; }

look() { # memory [kB], threads, handles
    echo "$(awk '/^VmRSS/ { m = $2 } /^Threads/ { t = $2 } END { print m, t }' "/proc/$session/status" 2>/dev/null)" "$(ls "/proc/$session/fd" 2>/dev/null | wc -l)"
}
step=$((seconds / 60))
[ $step -ge 1 ] || step=1
attempt=1
while :; do
    "$palpate" run "$top/samples/scenes/palm_wart.json" --solver host --hand falcon-emulator --seconds "$seconds" --record "$work/session" \
        >"$work/out.txt" 2>"$work/err.txt" </dev/null &
    session=$!
    n=0
    until [ -s "$work/session/ticks.npy" ] || [ $n -gt 300 ]; do n=$((n + 1)); sleep 0.1; done
    sleep 2 # what is made once is made
    while kill -0 $session 2>/dev/null; do
        look | awk 'NF == 3 && $3 > 0' >>"$work/looks"
        sleep $step
    done
    wait $session && break
    status=$?
    if [ $attempt -eq 3 ] || ! was_held_up "$work/err.txt"; then complain "exit $status: $(cat "$work/err.txt")"; break; fi
    attempt=$((attempt + 1))
    rm -rf "$work/session" "$work/looks"
done
session=
# The last looks may have met its end.
awk '{ m[NR] = $1; t[NR] = $2; h[NR] = $3 } END {
    last = NR - 2
    if (last < 3) { print "FAILED: " NR " looks at the session only"; exit 1 }
    for (n = 2; n <= last; ++n) if (t[n] != t[1] || h[n] != h[1]) { print "FAILED: look " n ": " t[n] " threads and " h[n] " handles, " t[1] " and " h[1] " at first"; bad = 1 }
    grown = m[last] - m[1]
    print NR " looks: " t[1] " threads, " h[1] " handles, " m[1] " kB of memory at first and " m[last] " in the end"
    if (grown > 1024) { print "FAILED: its memory grew by " grown " kB"; bad = 1 } # 0.17 MB in 145 minutes were seen
    exit bad
}' "$work/looks" || failed=1

# Of each tick the bytes are there; the last one is when the clock on the wall says that the recording was finished.
"$palpate" export "$work/session" --csv "$work/ticks.csv" >/dev/null 2>"$work/err.txt" || complain "the recording: $(cat "$work/err.txt")"
ticks=$(sed -n 's/.*"samples": *\([0-9]*\).*/\1/p' "$work/session/session.json")
began=$(sed -n 's/.*"realtime_ns": *\([0-9]*\).*/\1/p' "$work/session/session.json")
finished=$(stat -c %.3Y "$work/session/session.json")
awk -F, -v ticks="$ticks" -v seconds="$seconds" -v wall="$(awk -v b="$began" -v f="$finished" 'BEGIN { printf "%.3f", f - b / 1e9 }')" 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n == "force_x") x = n; next }
    { if (NR > 2 && $1 <= last) bad = "times do not rise"
      last = $1
      for (n = x; n < x + 3; ++n) { if ($n !~ /^[-+0-9.e]+$/ || $n > 6 || $n < -6) bad = "a bad force"; else if ($n != 0) felt = 1 } }
    END {
        if (NR - 1 != ticks) bad = NR - 1 " rows of " ticks " ticks"
        if (!felt) bad = "nothing was felt"
        if (last < seconds - 0.1 || last > seconds + 0.1) bad = "the last tick is at " last " s of " seconds
        if (wall - last < -0.1 || wall - last > 2) bad = "by the wall it took " wall " s"
        print NR - 1 " ticks, the last at " last " s, the recording finished at " wall " s by the clock on the wall"
        if (bad) { print "FAILED: " bad; exit 1 }
    }' "$work/ticks.csv" || failed=1
[ $failed -eq 0 ] && echo 'passed'
exit $failed

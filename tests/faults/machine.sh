#!/bin/sh
# Faults of the machine beneath a whole session: clocks that jump, no threads and processes left, a single core, huge pages;
# and the ports that a session opens, which are none unless they are asked for. Arguments: the program, the library of
# jumping_clock.cpp, the tests of the C interface, and the build's sanitizers, which bring clocks and threads of their own: those parts are omitted then.
set -u
palpate=$1 jump=$(realpath "$2") host=$(realpath "$3") sanitizers=${4:-}
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/checks.sh"
. "$root/tests/support/sessions.sh"
chmod 777 "$work"
cp "$jump" "$work/jumping_clock.so" # LD_PRELOAD parts its paths at spaces
jump=$work/jumping_clock.so
skip() { echo "skipped: $*"; }
sheet='sample:sheet --points 2000 --cells 16 --solver host'

# session NAME LIMITS... -- ARGUMENTS...: runs one under LIMITS, which are words before a command
session() {
    name=$1 limits=
    shift
    while [ "$1" != -- ]; do limits="$limits $1"; shift; done
    shift
    for attempt in 1 2 3; do
        rm -rf recorded
        # shellcheck disable=SC2086
        $limits "$palpate" "$@" >out.txt 2>err.txt </dev/null
        status=$?
        case $name in *jump* | suspended*) break ;; esac # where the governor has to stop it
        [ $status -eq 1 ] && [ $attempt -lt 3 ] && was_held_up err.txt || break
    done
    [ $status -lt 126 ] || complain "$name: ended by a signal, status $status: $(tail -n 2 err.txt)"
}
succeeds() { [ $status -eq 0 ] && pass || complain "$name: exit $status: $(cat err.txt)"; }

# table of what was recorded: time, the three parts of the force, milliseconds since the tick before
steps() {
    "$palpate" export recorded --csv recorded.csv >/dev/null 2>&1
    awk -F, 'NR > 1 { print $1, $11, $12, $13, (NR > 2 ? ($1 - last) * 1000 : 1); last = $1 }' recorded.csv
}

if [ -n "$sanitizers" ]; then
    echo 'left out: jumping clocks and limits of threads, which sanitizers take no part in'
else
    # The clock on the wall is set: nothing happens. Half a second is the most that a busy machine may take a tick.
    for by in -86400 31536000; do
        # shellcheck disable=SC2086
        session "the wall's clock jumps by $by s" env LD_PRELOAD="$jump" JUMPING_CLOCK=wall JUMPING_CLOCK_AFTER=1 JUMPING_CLOCK_BY=$by -- \
            run $sheet --seconds 2 --record recorded
        succeeds
        steps | awk -v by=$by '$5 <= 0 || $5 > 500 { bad = 1 } { ++ticks } END { exit bad || ticks < 500 }' && pass || complain "$name: ticks are missing, or their times jump"
    done
    # The machine was suspended, which the session's own clock does not count: the governor is told. Nothing was wrong before.
    # shellcheck disable=SC2086
    session 'suspended for 20 s' env LD_PRELOAD="$jump" JUMPING_CLOCK=sleep JUMPING_CLOCK_AFTER=2 JUMPING_CLOCK_BY=20 -- \
        run $sheet --hand falcon-emulator --seconds 4 --record recorded
    { [ $status -eq 1 ] && grep -q 'the governor stopped the force' err.txt && pass; } || complain "$name: exit $status: $(cat out.txt err.txt)"
    steps | awk '$1 > 0.5 && $1 < 1.8 && ($2 != 0 || $3 != 0 || $4 != 0) { pressed = 1 } $1 > 2.6 && ($2 != 0 || $3 != 0 || $4 != 0) { bad = 1 } END { exit bad || !pressed || $1 < 3 }' &&
        pass || complain "$name: a force is left half a second later, or there was none before"
    # The same of a host with a loop of its own.
    env LD_PRELOAD="$jump" JUMPING_CLOCK=sleep JUMPING_CLOCK_AFTER=4 JUMPING_CLOCK_BY=20 \
        "$host" --gtest_also_run_disabled_tests --gtest_filter='*AHostWhoseMachineSleeps*' >out.txt 2>&1 && grep -q 'PASSED.* 1 test' out.txt && pass ||
        complain "a host whose machine slept: $(tail -n 20 out.txt)"
    # All clocks run on: from the jump on there is no force, and a sentence says why.
    # shellcheck disable=SC2086
    session 'all clocks jump by 20 s' env LD_PRELOAD="$jump" JUMPING_CLOCK=all JUMPING_CLOCK_AFTER=2 JUMPING_CLOCK_BY=20 -- \
        run $sheet --hand falcon-emulator --seconds 24 --record recorded
    { [ $status -eq 1 ] && grep -q 'the governor stopped the force' err.txt && pass; } || complain "$name: exit $status: $(cat out.txt err.txt)"
    steps | awk '$5 > 19000 { jumped = $1 } !jumped && ($2 != 0 || $3 != 0 || $4 != 0) { pressed = 1 } jumped && $1 > jumped + 0.02 && ($2 != 0 || $3 != 0 || $4 != 0) { bad = 1 } END { exit bad || !jumped || !pressed }' &&
        pass || complain "$name: a force is left 20 ms later, there was none before, or there was no jump"

    # No threads and processes are left. Drivers of Vulkan are omitted: Mesa's waits for ever for threads that it cannot start.
    if [ "$(id -u)" -eq 0 ] && command -v setpriv >/dev/null && command -v prlimit >/dev/null && su nobody -s /bin/sh -c "test -x '$palpate'" 2>/dev/null; then
        for most in 0 1 2 3; do
            for command in 'touch' 'run --seconds 0.2' 'run --hand falcon-emulator --seconds 0.2' 'run --clock virtual --seconds 0.2 --record recorded' 'doctor'; do
                what=$sheet
                [ "$command" != doctor ] || what=
                # shellcheck disable=SC2086
                session "at most $most threads, $command" prlimit --nproc=$most:$most setpriv --reuid 65534 --regid 65534 --clear-groups -- $command $what
                if [ "$command" != doctor ] && [ $status -ne 0 ] && ! has_sentence; then
                    complain "$name: exit $status without a sentence: $(cat err.txt)"
                else
                    pass
                fi
            done
        done
    else
        skip 'limits of threads are not for root, who sets them here'
    fi
fi

# One core: all threads of a session share it.
if command -v taskset >/dev/null; then
    # shellcheck disable=SC2086
    session 'one core' taskset -c 0 -- run $sheet --hand falcon-emulator --seconds 1 --record recorded
    succeeds
    steps | awk '{ ++ticks } END { exit ticks < 500 }' && pass || complain 'one core: half of the ticks are missing'
else
    skip 'one core, there is no taskset'
fi

# Huge pages: as the system gives them by madvise(), and always. Each tick is the same to the bit.
for pages in 0 1 2; do
    # shellcheck disable=SC2086
    session "huge pages, $pages" env GLIBC_TUNABLES=glibc.malloc.hugetlb=$pages -- run $sheet --clock virtual --seconds 0.5 --record recorded
    succeeds
    steps >"pages$pages.txt"
    cmp -s pages0.txt "pages$pages.txt" && [ -s pages0.txt ] && pass || complain "huge pages, $pages: other ticks"
done

# ports PROCESS: the ports at which it listens, as PROTOCOL ADDRESS:PORT in the kernel's hexadecimal words
ports() {
    inodes=$(find "/proc/$1/fd" -lname 'socket:*' -printf '%l\n' 2>/dev/null | tr -cd '0-9\n')
    for protocol in tcp tcp6 udp udp6; do
        for inode in $inodes; do
            awk -v p=$protocol -v inode="$inode" '$10 == inode && (p ~ /udp/ || $4 == "0A") { print p, $2 }' "/proc/net/$protocol" 2>/dev/null
        done
    done
}
seconds=3
opens() { # NAME EXPECTED ARGUMENTS...: what a session of so many seconds listens at
    name=$1 expected=$2
    shift 2
    open_once "$@" && return
    was_held_up err.txt && open_once "$@" || complain "$name: it is no session: $(cat err.txt)"
}
open_once() {
    rm -rf recorded
    # shellcheck disable=SC2086
    "$palpate" run $sheet --seconds $seconds --record recorded "$@" >out.txt 2>err.txt </dev/null &
    process=$!
    n=0
    until [ -s recorded/ticks.npy ] || [ $n -gt 200 ]; do n=$((n + 1)); sleep 0.1; done
    found=$(ports $process)
    [ "$found" = "$expected" ] && pass || complain "$name: it listens at '$found' in place of '$expected'"
    wait $process && [ -s recorded/ticks.npy ]
}
opens 'a session' ''
opens 'a session with an emulated device' '' --hand falcon-emulator
grep -q came_from_m recorded/session.json && complain 'a scripted hand is said to come from elsewhere than it does' || pass
opens 'a session that is told of markers' 'udp 0100007F:5EED' --markers udp:24301
if command -v python3 >/dev/null; then # a device that is a script, which presses after three seconds
    python3 "$root/samples/bridge_peer.py" 24302 20 >peer.txt & # longer than a busy machine takes to start
    peer=$! seconds=5
    opens 'a session whose device comes by UDP' 'udp 0100007F:5EEE' --hand bridge:udp:24302
    grep -q came_from_m recorded/session.json && pass || complain "where a person's hand comes from is not recorded"
    wait $peer
    was_pushed_and_let_go peer.txt && pass || complain "the device that is a script felt nothing, or feels it still: $(cat peer.txt)"
else
    skip 'a session whose device comes by UDP, there is no python3'
fi

conclude

#!/bin/sh
# Memory that ends at the n-th request of a whole program, n spread over its life: once, or from then on for large ones.
# Arguments: the program and the library of failing_malloc.cpp. PALPATE_INSTANTS says how many of each command (12).
#
# Expected each time: the program's own exit, with a sentence if it is not 0, and no signal; of a session all that was recorded
# until then.
set -u
palpate=$1 failing=$(realpath "$2") instants=${PALPATE_INSTANTS:-12}
unset PALPATE_INSTANTS # it is no key of a scene
. "$(dirname "$0")/checks.sh"
sheet='sample:sheet --points 2000 --cells 16 --solver host'
commands() {
    cat <<LIST
touch touch $sheet --json
run run $sheet --clock virtual --seconds 0.4 --record recorded
run_real run $sheet --hand falcon-emulator --seconds 0.3 --record recorded
convert convert sample:skin --points 2000 recorded.ply
LIST
}

judge() { # NAME STATUS
    if [ "$2" -gt 2 ]; then complain "$1: ended by a signal, status $2: $(tail -n 2 err.txt)"; return; fi
    if [ "$2" -ne 0 ] && ! has_sentence; then complain "$1: exit $2 without a sentence: $(cat err.txt)"; return; fi
    if find . -name '*.part' | grep -q .; then complain "$1: a part of a file is left"; return; fi
    if [ "$(wc -c 2>/dev/null <recorded/ticks.npy || echo 0)" -gt 2000 ]; then
        forces_are_good recorded some || { complain "$1: the recording, or a force in it, is bad"; return; }
    fi
    pass
}

attempt() { # NAME WAY N ARGUMENTS...
    name=$1 fails=FAILING_MALLOC_$2=$3
    shift 3
    rm -rf recorded recorded.ply
    env LD_PRELOAD="$failing" "$fails" timeout -s KILL 60 "$palpate" "$@" >out.txt 2>err.txt </dev/null
    judge "$name, $fails" $?
}

commands | {
    # Before main, and while the command line is made: requests of objects that are made at all times, and promise not to throw.
    n=1
    # shellcheck disable=SC2086
    while [ $n -le 40 ]; do attempt touch AT $n touch $sheet; n=$((n + 1)); done
    while read -r name arguments; do
        rm -rf recorded recorded.ply
        # shellcheck disable=SC2086
        env LD_PRELOAD="$failing" FAILING_MALLOC_COUNT=count "$palpate" $arguments >out.txt 2>err.txt </dev/null || complain "$name fails without a fault: $(cat err.txt)"
        calls=$(cat count) n=0
        [ "$calls" -gt 1000 ] || complain "$name asks for memory $calls times only: are its requests counted?"
        while [ $n -lt "$instants" ]; do
            # shellcheck disable=SC2086
            for way in AT FROM; do attempt "$name" $way $(((2 * n + 1) * calls / (2 * instants) + 1)) $arguments; done
            n=$((n + 1))
        done
    done
    conclude
}

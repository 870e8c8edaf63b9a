#!/bin/sh
# Memory that ends at the n-th request of a whole program, n spread over its life: once, or from then on for large ones.
# Arguments: the program and the library of failing_malloc.cpp. PALPATE_INSTANTS says how many of each command (12).
#
# Expected each time: the program's own exit, with a sentence if it is not 0, and no signal; of a session all that was recorded
# until then.
set -u
palpate=$1 failing=$2 instants=${PALPATE_INSTANTS:-12}
unset PALPATE_INSTANTS # it is no key of a scene
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0 failed=0
pass() { passed=$((passed + 1)); }
complain() { failed=$((failed + 1)); echo "FAILED: $*"; }
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
    if [ "$2" -ne 0 ] && { grep -q 'internal error' err.txt || ! grep -q '^palpate: .*[a-z]' err.txt; }; then complain "$1: exit $2 without a sentence: $(cat err.txt)"; return; fi
    if find . -name '*.part' | grep -q .; then complain "$1: a part of a file is left"; return; fi
    if [ "$(wc -c 2>/dev/null <recorded/ticks.npy || echo 0)" -gt 2000 ]; then
        "$palpate" export recorded --csv ticks.csv >/dev/null 2>&1 || { complain "$1: the recording cannot be read"; return; }
        awk -F, 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n == "force_x") x = n; next }
            { for (n = x; n < x + 3; ++n) if ($n !~ /^[-+0-9.e]+$/ || $n > 6 || $n < -6) bad = 1 }
            END { exit bad || !x }' ticks.csv || { complain "$1: a bad force"; return; }
    fi
    pass
}

commands | {
    while read -r name arguments; do
        rm -rf recorded recorded.ply
        # shellcheck disable=SC2086
        env LD_PRELOAD="$failing" FAILING_MALLOC_COUNT=count "$palpate" $arguments >out.txt 2>err.txt </dev/null || complain "$name fails without a fault: $(cat err.txt)"
        calls=$(cat count) n=0
        [ "$calls" -gt 1000 ] || complain "$name asks for memory $calls times only: are its requests counted?"
        while [ $n -lt "$instants" ]; do
            for way in AT FROM; do
                rm -rf recorded recorded.ply
                # shellcheck disable=SC2086
                env LD_PRELOAD="$failing" FAILING_MALLOC_$way=$(((2 * n + 1) * calls / (2 * instants) + 1)) timeout -s KILL 60 "$palpate" $arguments >out.txt 2>err.txt </dev/null
                judge "$name, FAILING_MALLOC_$way=$(((2 * n + 1) * calls / (2 * instants) + 1))" $?
            done
            n=$((n + 1))
        done
    done
    echo "$passed checks passed, $failed failed"
    [ $failed -eq 0 ]
}

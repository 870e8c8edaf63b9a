#!/bin/sh
# Faults of the machine, command by command: a disk that is full after some bytes, a folder that cannot be written, few
# file handles, each single call that changes a file, and standard streams that are closed. Arguments: the program, the build's
# sanitizers, the scene of a hunt, and the library of failing_files.cpp. PALPATE_INSTANTS says how many calls of each command fail
# in each way (3); 0 means each.
#
# Expected each time: exit 0 with everything there, or exit 2 with a sentence (1 of calibrate, which prints what it could not store); an
# older file as it was; no part of a file. Sanitizers need handles of their own, so that part is omitted with them.
set -u
palpate=$1 sanitizers=${2:-} hunt=$(realpath "$3") failing_files=$(realpath "$4") instants=${PALPATE_INSTANTS:-3}
unset PALPATE_INSTANTS # it is no key of a scene
. "$(dirname "$0")/checks.sh"
trap 'umount "$work/small" "$work/locked" 2>/dev/null; rm -rf "$work"' EXIT
sheet='sample:sheet --points 2000 --cells 16 --solver host'

# shellcheck disable=SC2086
{
    "$palpate" convert sample:skin --points 2000 skin.ply >/dev/null 2>&1 || complain 'no cloud'
    "$palpate" run $sheet --clock virtual --seconds 0.3 --record session >/dev/null 2>&1 || complain 'no session'
}
cat >plate.json <<'JSON'
{"size": [0.04, 0.04], "cells": [16, 16], "rigidity": {"law": "constant", "value": 2e-3}, "poisson": 0.3, "load": {"law": "uniform", "pressure": 100}}
JSON
cat >sheet.json <<'JSON'
{"cloud": "sample:sheet", "points": 1000, "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 16, "footprint_radius": "4.4 mm"}
JSON
cat >plan.json <<'JSON'
{"title": "t", "seconds": 1.5, "hand": "press", "conditions": [{"name": "SOFT", "scene": "sheet.json"}],
 "tasks": [{"name": "real", "kind": "rating", "statement": "It felt real.", "least": "no", "most": "yes"}]}
JSON
awk -v OFS=, 'BEGIN { print "probe,depth [mm],force,x,y,z"
    for (p = 0; p < 9; ++p) for (n = 0; n < 10; ++n) print p, n / 4, 300 * (exp(0.2 * n) - 1) / 800, p % 3 / 50, int(p / 3) / 50, 0 }' >probes.csv
i=0
while [ $i -lt 20 ]; do printf '\n2\n'; i=$((i + 1)); done >keys # begins each trial of a study and answers it

# Each command that writes, as  NAME OUTPUT ARGUMENTS; OUTPUT is a file or a folder at WHERE.
commands() {
    cat <<LIST
convert_ply a.ply convert skin.ply WHERE/a.ply
convert_pcd a.pcd convert skin.ply WHERE/a.pcd
convert_csv a.csv convert skin.ply WHERE/a.csv
paint b.ply paint skin.ply --stroke at=0,0,0mm;radius=5mm;value=2MPa --out WHERE/b.ply
touch touched touch $sheet --out WHERE/touched
render c.png render sample:skin --points 2000 --cells 32 --size 120x90 --out WHERE/c.png
export d.csv export session --csv WHERE/d.csv
info j.png info sample:skin --points 2000 --picture WHERE/j.png
run recorded run $sheet --clock virtual --seconds 0.5 --record WHERE/recorded
run_real recorded run $sheet --hand falcon-emulator --seconds 0.3 --record WHERE/recorded
solve e.npy solve plate.json --solver host --out WHERE/e.npy
fit f.csv fit probes.csv --out WHERE/f.csv
fit_page g.html fit probes.csv --page WHERE/g.html
perceive h.svg perceive $sheet --reach 10mm --places 3 --out WHERE/h.svg
hunt i.svg hunt $hunt --hand press --clock virtual --seconds 0.3 --solver host --cells 32 --out WHERE/i.svg
study study study plan.json --participant P1 --clock virtual --out WHERE/study
paper report paper --quick --only f,g --solver host --out WHERE/report
bench bench bench --quick --solver host --cases dispatches --out WHERE/bench
calibrate palpate calibrate --emulator
LIST
}

# is_whole NAME PLACE: what a command wrote is what it writes without a fault (in whole/NAME), as far as that is the same each time.
is_whole() {
    [ -e "whole/$1" ] || return 0
    case $1 in
    bench) find "$2" -type f -size 0 | grep -q . && return 1 || return 0 ;; # times
    calibrate) [ -s "$2/falcon-EMULATED.json" ] ;; # it has a date
    run) # to the bit up to the force; other columns are times of the machine
        "$palpate" export "$2" --csv is.csv >/dev/null 2>&1 && "$palpate" export "whole/$1" --csv was.csv >/dev/null 2>&1 || return 1
        cut -d, -f1-13 is.csv >is && cut -d, -f1-13 was.csv >was && cmp -s is was
        ;;
    run_real) "$palpate" export "$2" --csv is.csv >/dev/null 2>&1 && [ "$(wc -l <is.csv)" -gt 50 ] ;; # a busy machine leaves out ticks
    study) [ "$(wc -l <"$2/P1/trials.csv")" -eq "$(wc -l <"whole/$1/P1/trials.csv")" ] && cmp -s "$2/P1/study.json" "whole/$1/P1/study.json" ;;
    touch | paper) for file in "whole/$1"/*; do # one has times
        case $file in */touch.json | */timings.json) [ -s "$2/$(basename "$file")" ] ;; *) cmp -s "$file" "$2/$(basename "$file")" ;; esac || return 1
    done ;;
    *) cmp -s "$2" "whole/$1" ;;
    esac
}

# judge NAME OUTPUT WHERE CODE: what is left after a command.
judge() {
    if [ "$4" -eq 127 ] && grep -q 'loading shared libraries' err.txt; then pass; return; fi # it did not start
    if [ "$4" -ge 126 ]; then complain "$1 ended by a signal, status $4: $(head -n 2 err.txt)"; return; fi
    if [ "$4" -ne 0 ] && ! has_sentence; then complain "$1: exit $4 without a sentence: $(cat err.txt)"; return; fi
    if find "$3" -name '*.part' | grep -q .; then complain "$1: a part of a file is left"; return; fi
    if [ "$4" -ne 0 ] && [ -f "$3/$2" ] && [ "$(cat "$3/$2")" != 'what was there before' ]; then complain "$1: exit $4, and the older file is lost"; return; fi
    if [ "$4" -eq 0 ] && [ ! -e "$3/$2" ]; then complain "$1: exit 0, and nothing is there"; return; fi
    case $1 in calibrate*) # its numbers are said all the same
        if [ "$4" -eq 1 ] && ! grep -q 'would be used by' out.txt; then complain "$1: exit 1 without what it measured: $(cat out.txt err.txt)"; return; fi ;;
    esac
    if [ "$4" -eq 0 ] && [ -e "$3/$2" ] && ! is_whole "${1%% *}" "$3/$2"; then complain "$1: exit 0, and what is there is not whole"; return; fi
    if [ "$4" -eq 0 ] && [ -f "$3/$2" ] && [ "$(head -c 30 "$3/$2" | tr -d '\000')" = 'what was there before' ]; then complain "$1: exit 0, and what was there before is there still"; return; fi
    pass
}

# attempt NAME OUTPUT WHERE LIMIT ARGUMENTS...: runs a command under a limit, such as 'ulimit -f 8'.
attempt() {
    name=$1 output=$2 where=$3 limit=$4
    shift 4
    case $output in *.*) (echo 'what was there before' >"$where/$output") 2>/dev/null ;; esac
    (eval "$limit" && XDG_CONFIG_HOME=$where exec "$palpate" "$@") >out.txt 2>err.txt
    status=$?
    judge "$name ($limit)" "$output" "$where" $status
}

# every LIMIT WHERE: all commands under it.
every() {
    rm -f counts
    commands | while read -r name output arguments; do
        arguments=$(printf '%s' "$arguments" | sed "s|WHERE|$2|g; s|;| |g")
        [ "$name" != paint ] || arguments=$(printf '%s' "$arguments" | sed 's|--stroke \(.*\) --out|--stroke "\1" --out|')
        eval "attempt $name $output $2 '$1' $arguments" <keys
        [ -f "$2/$output" ] && rm -f "$2/$output"
        [ -d "$2/$output" ] && rm -rf "${2:?}/$output"
        echo "$passed $failed" >counts
    done
    read -r passed failed <counts || complain 'no command was tried'
}

mkdir limited whole
every_good() { # what each command writes without a fault
    rm -f counts
    commands | while read -r name output arguments; do
        arguments=$(printf '%s' "$arguments" | sed "s|WHERE|limited|g; s|;| |g")
        [ "$name" != paint ] || arguments=$(printf '%s' "$arguments" | sed 's|--stroke \(.*\) --out|--stroke "\1" --out|')
        eval "attempt $name $output limited : $arguments" <keys
        [ "$status" -eq 0 ] || complain "$name fails without a fault: $(cat err.txt)"
        [ ! -e "limited/$output" ] || mv "limited/$output" "whole/$name"
        echo "$passed $failed" >counts
    done
    read -r passed failed <counts || complain 'no command was tried'
}
every_good
for blocks in 1 64; do every "ulimit -f $blocks" limited; done # of 512 bytes; with 0 nothing could be said into a file
[ -n "$sanitizers" ] || for handles in 4 8; do every "ulimit -n $handles" limited; done

# every_call FOLDER: each call that changes a file fails, alone or with all that follow; or each that reads one below FOLDER. The
# loader's variable is set for the program only.
every_call() {
    reads=$1
    # shellcheck disable=SC2034 # by eval
    preload="export LD_PRELOAD='$failing_files'${reads:+ FAILING_FILES_READ='$reads'}"
    rm -f counts
    commands | while read -r name output arguments; do
        arguments=$(printf '%s' "$arguments" | sed "s|WHERE|limited|g; s|;| |g")
        [ "$name" != paint ] || arguments=$(printf '%s' "$arguments" | sed 's|--stroke \(.*\) --out|--stroke "\1" --out|')
        again() { rm -rf "limited/${output:?}"; eval "attempt $name $output limited \"$1; \$preload\" $arguments" <keys; }
        rm -f calls
        again "export FAILING_FILES_COUNT=$work/calls"
        calls=$(cat calls 2>/dev/null || echo 0) most=$instants n=0
        [ "$calls" -gt 0 ] || [ -n "$reads" ] || complain "$name changes no file: are its calls counted?"
        [ "$most" -gt 0 ] && [ "$most" -lt "$calls" ] || most=$calls
        while [ $n -lt "$most" ]; do
            for as in AT ONCE; do again "export FAILING_FILES_$as=$((n * calls / most + 1))"; done
            n=$((n + 1))
        done
        rm -rf "limited/${output:?}"
        echo "$passed $failed" >counts
    done
    read -r passed failed <counts || complain 'no command was tried'
}
if [ -z "$sanitizers" ]; then
    every_call ''
    every_call "$work"
    # A participant goes on while any read fails: the rows that are saved stay, also where the program says that all is well.
    sed 's/"repetitions": 1,//; s/"tasks"/"repetitions": 2, "tasks"/' plan.json >plan2.json
    printf '\n2\n' | "$palpate" study plan2.json --participant P1 --clock virtual --out begun >/dev/null 2>&1
    [ "$(wc -l <begun/P1/trials.csv)" -eq 2 ] || complain 'no study was begun'
    n=1
    while [ $n -le 30 ]; do
        rm -rf goes_on && cp -r begun goes_on
        (export LD_PRELOAD="$failing_files" FAILING_FILES_READ="$work" FAILING_FILES_ONCE=$n
            exec "$palpate" study plan2.json --participant P1 --clock virtual --out goes_on) >out.txt 2>err.txt </dev/null
        head -n 2 goes_on/P1/trials.csv | cmp -s - begun/P1/trials.csv && pass || complain "a study that goes on, read $n fails: its row is lost"
        n=$((n + 1))
    done
fi

mkdir small locked
if mount -t tmpfs -o size=64k none small 2>/dev/null; then
    every : small
    umount small
else
    echo 'skipped: a small disk can be mounted by root only'
fi
if mount -t tmpfs -o ro none locked 2>/dev/null; then
    every : locked
    umount locked
else
    chmod 555 locked
    if [ -w locked ]; then echo 'skipped: a folder that root cannot write has to be mounted'; else every : locked; fi
fi

# Streams that the caller has closed: no sentence is written into a file, which would have a stream's number.
for closed in '<&-' '>&-' '2>&-' '<&- >&- 2>&-'; do
    rm -rf closed
    eval "\"\$palpate\" run $sheet --clock virtual --seconds 0.3 --record closed >out.txt 2>err.txt $closed"
    [ $? -le 2 ] || complain "run $closed: ended by a signal"
    "$palpate" export closed --csv closed.csv >out.txt 2>err.txt && [ "$(wc -l <closed.csv)" -eq 301 ] &&
        pass || complain "run $closed: the recording is damaged: $(cat err.txt)"
done

# A reader of its warnings that has gone ends no session.
rm -rf closed
# shellcheck disable=SC2086
"$palpate" run $sheet --clock virtual --seconds 0.3 --record closed 2>&1 >/dev/null | true
"$palpate" export closed --csv closed.csv >out.txt 2>err.txt && [ "$(wc -l <closed.csv)" -eq 301 ] &&
    pass || complain "run into a closed pipe: the recording is not whole: $(cat err.txt)"

conclude

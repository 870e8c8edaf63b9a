#!/bin/sh
# Kills programs that write, by kill -9 at random instants: what was said to be saved is there. Argument: the program.
# PALPATE_INSTANTS says how often (3); 500 take an hour.
set -u
palpate=$1 instants=${PALPATE_INSTANTS:-3}
. "$(dirname "$0")/checks.sh"
wait_at_random() { # NUMBER MOST: up to MOST seconds, the same for the same number
    sleep "$(awk -v n="$1" -v most="$2" 'BEGIN { srand(n + 1); rand(); printf "%.3f", rand() * most }')"
}

# A recording in real time: what it lacks is the time from its last tick to the kill.
n=0
: >lost
while [ $n -lt "$instants" ]; do
    rm -rf killed
    "$palpate" run sample:sheet --points 2000 --cells 16 --solver host --seconds 60 --record killed </dev/null >/dev/null 2>&1 &
    child=$!
    until [ "$(wc -c 2>/dev/null <killed/ticks.npy || echo 0)" -gt 2000 ] || ! kill -0 $child 2>/dev/null; do sleep 0.02; done
    wait_at_random $n 1
    at=$(date +%s%N)
    kill -9 $child
    wait $child 2>/dev/null
    if ! "$palpate" export killed --csv killed.csv >out.txt 2>err.txt; then
        complain "a recording that was killed, $n: $(cat err.txt)"
    elif [ "$(wc -l <killed.csv)" -lt 2 ]; then
        complain "a recording that was killed, $n: no tick is left"
    elif ! awk -F, 'NR == 2 { last = $1 - 0.001 } NR > 1 { if ($1 <= last) exit 1; last = $1 }' killed.csv; then
        complain "a recording that was killed, $n: its times do not rise"
    else
        began=$(sed -n 's/.*"realtime_ns": *\([0-9]*\).*/\1/p' killed/session.json)
        tail -n 1 killed.csv | awk -F, -v began="$began" -v at="$at" '{ print (at - began) / 1e6 - 1000 * $1 }' >>lost
        pass
    fi
    n=$((n + 1))
done
# A kill costs 10 ms at most, and more where this machine had no processor for the program or for this script.
median=$(sort -n lost | awk '{ v[NR] = $1 } END { print NR ? v[int((NR + 1) / 2)] : "none" }')
echo "a kill costs $median ms at the median, $(sort -n lost | tail -n 1) at most"
awk -v median="$median" 'BEGIN { exit !(median != "none" && median <= 10 && median > -50) }' && pass || complain "a kill costs $median ms of a recording at the median"

# A study: rows in the order of the plan, each once, and never fewer than before.
cat >sheet.json <<'JSON'
{"cloud": "sample:sheet", "points": 1000, "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 16, "footprint_radius": "4.4 mm"}
JSON
cat >plan.json <<'JSON'
{"title": "t", "seconds": 1.5, "hand": "press", "conditions": [
 {"name": "SOFT", "scene": "sheet.json", "values": {"stiffness": {"law": "constant", "value": 3e5}}},
 {"name": "STIFF", "scene": "sheet.json", "values": {"stiffness": {"law": "constant", "value": 4e5}}}],
 "tasks": [{"name": "real", "kind": "rating", "statement": "It felt real.", "least": "no", "most": "yes"},
  {"name": "stiffer", "kind": "two-alternative", "question": "Which felt stiffer?", "pairs": [["SOFT", "STIFF"]], "right": "second"}]}
JSON
i=0
while [ $i -lt 60 ]; do printf '\n2\n'; i=$((i + 1)); done >keys # begins each trial and answers it
printf 'P01,1,1\nP01,2,1\nP01,3,2\n' >expected
table=study/P01/trials.csv n=0 hit=0 # kills that met a study at work
rows() { if [ -f $table ]; then tail -n +2 $table | cut -d, -f1-3; fi; }
whole_rows() { if [ -f $table ]; then head -n "$(wc -l <$table)" $table | tail -n +2 | cut -d, -f1-3; fi; } # the last may be cut
while [ $n -lt "$instants" ]; do
    before=$(whole_rows | wc -l)
    [ "$before" -lt 3 ] || { rm -rf study; before=0; }
    "$palpate" study plan.json --participant P01 --out study --clock virtual <keys >/dev/null 2>&1 &
    child=$!
    wait_at_random $((n + 1000)) 0.4
    kill -9 $child 2>/dev/null
    wait $child 2>/dev/null
    [ $? -ne 137 ] || hit=$((hit + 1))
    whole_rows >whole
    if [ "$(wc -l <whole)" -lt "$before" ] || ! head -n "$(wc -l <whole)" expected | cmp -s - whole; then
        complain "a study that was killed, $n: $(cat $table)"
    else
        pass
    fi
    n=$((n + 1))
done
if "$palpate" study plan.json --participant P01 --out study --clock virtual <keys >out.txt 2>err.txt && rows | cmp -s - expected; then pass; else complain "the study did not end: $(cat err.txt $table)"; fi

echo "$hit of $n kills met a study at work; the others came after its end"
[ $hit -gt 0 ] && pass || complain "no study was killed before it ended by itself"

conclude

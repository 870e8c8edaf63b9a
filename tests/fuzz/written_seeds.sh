#!/bin/sh
# Adds to the seeds of make_seeds.sh what Palpate writes, clouds, a grid, a recording and a study, and what is shipped to be
# read. Arguments: the program palpate and the folder of the seeds.
set -eu
palpate=$(realpath "$1") samples=$(cd "$(dirname "$0")/../../samples" && pwd)
seeds=$(cd "$2" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
cd "$work"
export XDG_CONFIG_HOME="$work" PALPATE_SOLVER=host
run() { "$palpate" "$@" >out.txt 2>err.txt </dev/null || { cat err.txt; exit 1; }; }

for kind in ply:binary ply:binary-big-endian ply:ascii pcd:binary pcd:ascii csv: xyz:; do
    format=${kind%:*} encoding=${kind#*:}
    run convert sample:ear-lobe --points 20 "cloud.$format" ${encoding:+--encoding "$encoding"}
    case $format in csv | xyz) folder=text ;; *) folder=$format ;; esac
    cp "cloud.$format" "$seeds/$folder/written-${encoding:-text}-$format"
done

cat >plate.json <<'JSON'
{"size": [0.04, 0.04], "cells": [4, 4], "rigidity": {"law": "constant", "value": 2e-3}, "poisson": 0.3, "load": {"law": "uniform", "pressure": 100}}
JSON
run solve plate.json --out grid.npy
cp grid.npy "$seeds/npy/written"

# A prefix says which of its files it is, as in make_seeds.sh. Four ticks: a fuzzer's inputs are short.
cat >scene.json <<'JSON'
{"cloud": "sample:sheet", "points": 2000, "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 16, "footprint_radius": "4.4 mm"}
JSON
run run scene.json --clock virtual --seconds 0.004 --record session
{ printf t; cat session/ticks.npy; } >"$seeds/recording/written-ticks"
{ printf s; cat session/session.json; } >"$seeds/recording/written-session"
run export session --csv session.csv
cp session.csv "$seeds/hand/written" # its first columns are a hand's

cat >plan.json <<'JSON'
{"title": "t", "seconds": 1.5, "hand": "press", "conditions": [{"name": "one", "scene": "scene.json"}],
 "tasks": [{"name": "real", "kind": "rating", "statement": "It felt real.", "least": "no", "most": "yes"}]}
JSON
printf '\n4\n' >answers
"$palpate" study plan.json --participant P01 --out study --clock virtual <answers >out.txt 2>err.txt || { cat err.txt; exit 1; }
cp study/P01/trials.csv "$seeds/trials/written"
cp "$(find study -name study.json | head -n 1)" "$seeds/study/written"

for scene in "$samples"/scenes/*.json; do
    case $scene in *.schema.json | *_hunt.json) ;; *) cp "$scene" "$seeds/scene/shipped-$(basename "$scene" .json)" ;; esac
done
cp "$samples/scenes/nodule_hunt_hand.csv" "$seeds/hand/shipped"
for plan in "$samples"/studies/*.json; do cp "$plan" "$seeds/plan/shipped-$(basename "$plan" .json)"; done

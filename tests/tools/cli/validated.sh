#!/bin/sh
# Whole solves of plates of 24 to 512 cells, a shell, a session and fused passes under Vulkan's validation layer: with
# synchronization checks, and with shaders that check each access. Any message fails. Arguments: palpate, a folder that may be emptied, and the samples.
set -u
here=$(cd "$(dirname "$0")" && pwd)
palpate=$1 work=$2 samples=$3
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1
failed=0 silent=0
fail() { echo "FAILED: $*"; failed=1; }
. "$here/../../support/validation_layer.sh"

cat >plate.json <<'TEXT'
{"size": [1, 1.5], "cells": [128, 192], "poisson": 0.3,
 "edges": {"x0": "clamped", "x1": "free", "z0": "supported", "z1": "clamped"},
 "rigidity": {"law": "disc", "from": 1, "to": 1000, "centre": [0.5, 0.7], "radius": 0.2},
 "load": {"law": "point", "force": 1, "at": [0.5, 0.75]}}
TEXT

quiet() { # quiet DESCRIPTION ARGUMENTS...: it succeeds on Vulkan, and the layer has nothing to say
    what=$1
    shift
    layer "$checks"
    "$palpate" "$@" --solver lavapipe >out.txt 2>err.txt || { fail "$what: exit $?"; cat err.txt; return; }
    grep -q llvmpipe out.txt err.txt || { fail "$what: not by Vulkan"; cat out.txt; }
    layer_is_silent "$what, $checks"
    silent=$((silent + 1))
}

layer_arrives "$palpate"
for checks in $checks_synchronization $checks_accesses; do
    for cells in 24 64 128 256 512; do
        quiet "a touch of $cells cells" touch sample:sheet --points 5000 --cells $cells
    done
    quiet 'a plate of jumps' solve plate.json
    quiet 'a shell' touch sample:skin --points 5000 --theory shell --cells 32
    quiet 'a session' run "$samples/scenes/skin_wart.json" --points 5000 --clock virtual --seconds 0.2
    quiet 'fused passes' bench --schedule fused --cases dispatches --nodes 65
done
[ $failed -eq 0 ] && echo "the validation layer has no word about $silent commands"
exit $failed

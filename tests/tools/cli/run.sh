#!/bin/sh
# The command line as a user meets it: good runs, bad input (exit code 2, one sentence, no half-written file).
# Arguments: the program, the manifest of a Vulkan driver that fails (tests/compute/broken_driver.cpp), and the sanitizer of
# the build, if any.
set -u
palpate=$1 broken=$2 sanitizer=${3-}
place=$(mktemp -d "${TMPDIR:-/tmp}/palpate program XXXXXX") || exit 1
trap 'chmod -R u+w "$place"; rm -rf "$place"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
cd "$place" || exit 1
XDG_CONFIG_HOME=$place/config # no calibration of the user's
export XDG_CONFIG_HOME
unset PALPATE_SOLVER # of the shaders' tests; here every command chooses for itself

failed=0 passed=0
complain() { echo "FAILED: $*"; failed=$((failed + 1)); }

good() { # good DESCRIPTION ARGUMENTS...: exit code 0
    what=$1; shift
    if "$palpate" "$@" >out.txt 2>err.txt; then passed=$((passed + 1)); else complain "$what: exit $? $(cat err.txt)"; fi
}
holds() { grep -qF -- "$1" out.txt && passed=$((passed + 1)) || complain "output lacks '$1': $(head -c 600 out.txt)"; }
bad() { # bad DESCRIPTION WORD ARGUMENTS...: exit code 2, one line on stderr that holds WORD, nothing on stdout
    what=$1 word=$2; shift 2
    "$palpate" "$@" >out.txt 2>err.txt
    code=$?
    [ $code -eq 2 ] || { complain "$what: exit $code, expected 2: $(cat err.txt)"; return; }
    grep -qF -- "$word" err.txt || { complain "$what: '$word' is not in: $(cat err.txt)"; return; }
    [ "$(wc -l <err.txt)" -eq 1 ] || { complain "$what: more than one line: $(cat err.txt)"; return; }
    [ ! -s out.txt ] || { complain "$what: printed something to standard output"; return; }
    passed=$((passed + 1))
}

# --- good runs
good 'version' --version
holds 'palpate 0.'
good 'version for reports' --version --json
for name in version commit compiler libraries window panels falcon sanitizers recording library; do holds "\"$name\":"; done
bad 'JSON of nothing' '--version' --json
good 'manual' --man
mv out.txt manual.txt
good 'completion' --completion
mv out.txt completion.txt
"$palpate" --help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p' >commands.txt
[ "$(grep -c . commands.txt)" -ge 19 ] || complain "the help lists too few commands: $(cat commands.txt)"
while read -r command; do # each option of a command's help stands in both
    grep -q "^\.SS palpate $command\$" manual.txt || complain "the manual has no command $command"
    options=$("$palpate" "$command" --help | sed -n 's/^  \(-.,\)*\(--[a-z][a-z-]*\).*/\2/p')
    [ "$(echo "$options" | wc -l)" -ge 2 ] || complain "the help of $command lists too few options: $options"
    for option in $options; do
        grep -q "^    $command) .*[ ']$option[ ']" completion.txt || complain "no completion of $command $option"
    done
    passed=$((passed + 1))
done <commands.txt
good 'help' --help
holds 'Examples:'
while read -r command; do
    good "help of $command" "$command" --help; holds 'Examples:'
    mv out.txt help.txt
    good "help in other words, $command" help "$command"
    cmp -s out.txt help.txt && passed=$((passed + 1)) || complain "'help $command' is not '$command --help'"
done <commands.txt
good 'help of bench' bench --help
holds 'palpate bench --out bench'
grep -qF 'palpate touch' out.txt && complain 'the help of bench has the examples of touch' || passed=$((passed + 1))
good 'materials' materials
holds 'ecoflex-0030 ' && holds 'CC BY 4.0' && holds '810 1/m'
good 'materials for scripts' materials --json
holds '"modulus": 97260.0'

# --- measurements
awk -v OFS=, 'BEGIN { print "probe,depth [mm],force,x,y,z"
    for (p = 0; p < 9; ++p) for (n = 0; n < 10; ++n) print p, n / 4, 300 * (exp(0.2 * n) - 1) / 800, p % 3 / 50, int(p / 3) / 50, 0 }' >probes.csv
good 'presses' fit probes.csv --page probes.html --out felt.csv
holds '"stiffening": 800, "relaxation": "none"' && holds 'K' && holds 'cubic'
holds 'written     felt.csv' && holds 'written     probes.html'
grep -q '<svg' probes.html && passed=$((passed + 1)) || complain 'the page of presses has no plot'
good 'presses for scripts' fit probes.csv --json
holds '"interval_from": "covariance"' && holds '"other_residuals"' && holds '"written": null'
bad 'places of presses' '--places has no effect on presses' fit probes.csv --places 20
good 'the map of presses' info felt.csv
holds '300 N/m' && holds 'felt stiffness [N/m]'
good 'a map' fit felt.csv --footprint-radius 8mm --thickness 4mm --foundation 1MPa/m --window 12cm --solver host --page map.html --out fitted.ply
holds 'left over'
good 'the object of a map' info fitted.ply --json
grep -aq '^property double stiffening' fitted.ply && passed=$((passed + 1)) || complain "fit lost how the places stiffen: $(head -c 600 fitted.ply)"
grep -v '^#' felt.csv >bare_felt.csv
PALPATE_THICKNES=1 "$palpate" fit bare_felt.csv --footprint-radius 8mm --thickness 4mm --foundation 1MPa/m --window 12cm --solver host --json >out.txt 2>err.txt
holds 'PALPATE_THICKNES is not used' && holds 'assumed metres'
good 'what is left' info fitted.ply
holds 'residual'
bad 'a map is no object' 'palpate fit makes an object of it' touch felt.csv
bad 'a map without a tip' 'give --footprint-radius' fit felt.csv
bad 'a tip larger than the map' 'is the unit right' fit felt.csv --footprint-radius 60mm --window 20cm
bad 'an object is no map' 'found a stiffness in Pa' fit fitted.ply --footprint-radius 8mm
bad 'presses have no tip' 'take no keys of scenes' fit probes.csv --footprint-radius 8mm
bad 'a page of another kind' 'ends in .html' fit probes.csv --page probes.svg
cp probes.csv kept.csv
bad 'a map over its presses' '--out: ./probes.csv is read as well, and would be overwritten' fit probes.csv --out ./probes.csv
ln probes.csv linked.html
bad 'a page over its presses' '--page: linked.html is read as well' fit probes.csv --page linked.html
cmp -s probes.csv kept.csv && rm linked.html && passed=$((passed + 1)) || complain 'fit wrote over its presses'
sed 1q probes.csv >one.csv && sed -n 2,11p probes.csv >>one.csv
PALPATE_THICKNES=1 "$palpate" fit one.csv >out.txt 2>err.txt && grep -q '^palpate: warning: .*PALPATE_THICKNES is not used' err.txt && passed=$((passed + 1)) ||
    complain "fit does not name a variable that nothing reads: $(cat err.txt)"
holds ': 1 press, 95'
sed 's/^probe/press/' probes.csv >unnamed.csv
bad 'places of presses without names' 'name several probes by a column "probe"' fit unnamed.csv
sed 's/,\([0-9.]*\),\([0-9.]*,[0-9.]*,0\)$/,-\1,\2/' probes.csv >pulls.csv
bad 'presses that pull' 'turn the sign' fit pulls.csv
sed 's/ \[mm\]//' probes.csv >metres.csv
bad 'presses in metres' 'call the column "depth [mm]"' fit metres.csv
good 'list of samples' info --samples
for sample in ellipsoid sheet pad hemisphere saddle skin palm ear-lobe; do holds "sample:$sample"; done
good 'a sample as a file' convert sample:skin skin.ply --points 5000
good 'info' info skin.ply --json
holds '"points": 5000'
holds '"for_touch": ['
holds '"border_points"'
good 'ascii, millimetres, a named property' convert skin.ply skin.csv
bad 'an encoding of a text file' '--encoding has no effect on text files, found encoded.csv' convert skin.ply encoded.csv --encoding ascii
good 'touch a sample' touch sample:ellipsoid --points 8000 --cells 32 --out 'a folder' --json
holds '"felt_stiffness"'
for file in deformed.ply touch.json rigidity.npy deflection.npy rigidity.svg deflection.svg profile.svg surface.svg close_up.svg; do
    [ -s "a folder/$file" ] && passed=$((passed + 1)) || complain "touch --out did not write $file"
done
good 'the deformed cloud is a cloud' info 'a folder/deformed.ply'
holds 'deflection'
good 'touch a file' touch skin.ply --place 0,0,0.0015 --window 40mm --cells 32
holds 'felt stiffness'
dome='touch sample:ellipsoid --points 5000 --cells 32 --thickness 1mm --theory shell --large on --json'
# shellcheck disable=SC2086
{
    good 'a dome that is pressed softly' $dome --force 20mN
    ! grep -qE '"(depth|felt_stiffness)": null' out.txt && passed=$((passed + 1)) || complain 'a dome that is pressed softly has no depth'
    good 'a dome that gives way' $dome --force 2N
    [ "$(grep -cE '"(depth|felt_stiffness)": null' out.txt)" -eq 2 ] && passed=$((passed + 1)) || complain 'a dome that gives way is felt'
}
good 'a place off the surface' touch skin.ply --place 0,0,7mm --window 40mm --cells 32
holds 'off the surface: the nearest place on it is touched'
good 'touch as the paper' touch skin.ply --place 0,0,0.0015 --preset paper --window 40mm --cells 32 --json
holds '"differences_from_paper": []'
# agree KEY FILE FILE SHARE: the number of that key differs by no more than a share, here the tolerance that solves have;
# devices smooth each in its own way, so only the tests of the solver, which choose the way, compare bits
agree() {
    value=$(sed -n "s/.*\"$1\": \([-+.0-9e]*\).*/\1/p" "$2") other=$(sed -n "s/.*\"$1\": \([-+.0-9e]*\).*/\1/p" "$3")
    awk -v a="$value" -v b="$other" -v share="$4" 'BEGIN { d = a - b; if (d < 0) d = -d; m = a < 0 ? -a : a; exit !(m > 0 && d <= share * m) }' &&
        passed=$((passed + 1)) || complain "$1: $2 has $value, $3 $other"
}
cat >plate.json <<'JSON'
{"size":[1,1.5], "cells":[16,24], "poisson":0.3, "edges":{"x0":"clamped","x1":"free","z0":"supported","z1":"clamped"}, "foundation":0,
 "rigidity":{"law":"constant","value":1}, "load":{"law":"point","force":1,"at":[0.5,0.75]}, "probes":[[0.25,0.25]]}
JSON
good 'solve' solve plate.json --json
for key in '"probes"' '"deflection"' '"max_deflection"' '"report"' '"solver"' '"iterations"' '"error_estimate"' '"work_units"' '"milliseconds"' '"square_cells": true' '"poisson": 0.3' '"x1": "free"' '"foundation": 0' \
    '"rigidity_min": 1' '"rigidity_max": 1' '"total_force": 1' '"max_deflection_at"' '"note": null' '"warnings": []'; do holds "$key"; done
tr -d ' \n' <out.txt >flat.txt
grep -qF '"size":[1.0,1.5],"cells":[16,24],"spacing":[0.0625,0.0625]' flat.txt && passed=$((passed + 1)) || complain "the plate of solve --json: $(cat flat.txt)"
sed 's/\[16,24\]/[16,16]/; s/\[0.5,0.75\]/[0,0.75]/' plate.json >odd.json
good 'cells that are not square, and a load on a clamped edge' solve odd.json --json
holds '"square_cells": false'
holds 'bends nothing'
grep -qF 'palpate: warning: odd.json: load: ' err.txt && passed=$((passed + 1)) || complain "no warning: $(cat err.txt)"
good 'solve, finer' solve plate.json --cells 32 --out w.npy
[ -s w.npy ] || complain 'solve --out wrote nothing'

good 'solve by the reference' solve plate.json --solver Reference --json
holds '"solver": "reference"'
good 'solve on the host' solve plate.json --solver Host --json --out host.npy
holds '"solver": "host"'
cp out.txt host.json
good 'solve on lavapipe' solve plate.json --solver lavapipe --json
agree max_deflection host.json out.txt 1e-4
without() { env VK_DRIVER_FILES="$place/none.json" VK_ICD_FILENAMES="$place/none.json" "$@" >out.txt 2>err.txt; } # any Vulkan driver
failing() { where=$1; shift; env PALPATE_BROKEN="$where" VK_DRIVER_FILES="$broken" VK_ICD_FILENAMES="$broken" "$@" >out.txt 2>err.txt; }
without "$palpate" solve plate.json --solver host && [ ! -s err.txt ] && passed=$((passed + 1)) || complain "the host needs a driver: $(cat out.txt err.txt)"
good 'solve where there is only software' solve plate.json --json --out auto.npy
holds '"solver": "host"'
holds '"note": null'
[ ! -s err.txt ] && cmp -s auto.npy host.npy && passed=$((passed + 1)) || complain "auto is not the host: $(cat err.txt)"
without "$palpate" touch sample:skin --points 3000 --cells 32 --solver host --out undrawn && grep -q 'warning .*a picture could not be drawn' out.txt &&
    grep -q 'a picture could not be drawn and says so in its place: ' undrawn/touch.json && grep -q 'could not be drawn' undrawn/surface.svg && passed=$((passed + 1)) ||
    complain "pictures that are none are not warned of: $(cat out.txt err.txt)"
PALPATE_HOST_ISA=sse9
export PALPATE_HOST_ISA
for command in 'solve plate.json' devices; do
    # shellcheck disable=SC2086  # a command and its arguments
    bad 'an instruction set that is none' 'PALPATE_HOST_ISA: expected portable, avx2 or avx512, found "sse9"' $command
done
PALPATE_HOST_ISA=portable
good 'another instruction set' solve plate.json --out portable.npy
cmp -s portable.npy host.npy && passed=$((passed + 1)) || complain 'instruction sets differ'
good 'its name' devices --json
holds '"instruction_set": "portable"'
unset PALPATE_HOST_ISA
good 'solve tightly' solve plate.json --solver Lavapipe --tolerance 1e-7 --json
holds '"work_units"'
good 'touch by the reference' touch sample:skin --points 5000 --cells 32 --solver reference
holds '(reference)'
if [ -z "$sanitizer" ]; then # the same solves many times over, minutes of them; palp_bench_test makes some
    good 'batches of loads' bench --solver lavapipe --schedule pass-by-pass --nodes 33 --cases batch --json
    for key in '"case": "batch"' '"loads": 49' '"palpate_parts_ms"' '"iterations"' '"work_units"' '"moved_gb_per_s"' '"copy_gb_per_s"' '"dispatches_per_cycle": 12'; do holds "$key"; done
    good 'the paper'\''s iteration' bench --solver lavapipe --nodes 33 --cases jacobi
    holds 'Jacobi 0.6, same error'
    good 'peers' bench --solver lavapipe --nodes 33,65 --maps linear,disc_0.1 --cases new_map,contrast,memory --out peers --json
    for key in '"case": "new_map"' '"case": "contrast"' '"case": "memory"' '"peer": "CHOLMOD"' '"peer": "Eigen SimplicialLDLT"' '"accuracy": "discretisation"' '"accuracy": "1e-6"' \
        '"peer_ms"' '"palpate_ms"' '"ratio"' '"error"' '"peer_error"' '"work_units"' '"iterations"' 'OPENBLAS_NUM_THREADS=1'; do holds "$key"; done
    for file in plate.json plate.txt new_map.svg; do
        [ -s "peers/$file" ] && passed=$((passed + 1)) || complain "bench --out did not write $file"
    done
    [ ! -e peers/new_load.svg ] && passed=$((passed + 1)) || complain 'bench --out wrote a picture of nothing'
fi

bad 'nothing to measure' 'begin at 65 nodes' bench --solver host --nodes 33 --cases new_map
bad 'quick and large' 'with --quick at most 257' bench --quick --nodes 513
"$palpate" solve plate.json --solver 77 >out.txt 2>err.txt
[ $? -eq 2 ] && grep -qF 'there is no GPU 77' err.txt && passed=$((passed + 1)) || complain "no such index: $(cat err.txt)"
mkdir alone && cp "$palpate" alone/palpate
alone/palpate bench --solver lavapipe --nodes 33 --cases memory >out.txt 2>err.txt || complain "bench without peers: exit $? $(cat err.txt)"
holds 'install libsuitesparse-dev'

good 'counts of dispatches' bench --solver lavapipe --nodes 65 --cases dispatches --json
for key in '"case": "dispatches"' '"schedule": "fused"' '"nested_iteration": 4' '"step": 4' '"after_steps": 0' '"step": 30'; do holds "$key"; done

good 'list of devices' devices
holds 'host  '
holds 'usable   yes; sessions with auto take it'
holds 'arm  a simulated arm'
holds 'looked for with '
holds 'hidapi'
holds 'libusb'
# Where there is a window depends on the environment, and so does what needs one.
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" devices --haptic >out.txt 2>err.txt || complain "devices --haptic: exit $?"
holds 'usable   no: there is no display'
holds 'help     run it on a desktop'
grep -q Vulkan out.txt && complain "a hand computes nothing: $(cat out.txt)" || passed=$((passed + 1))
DISPLAY=:0 "$palpate" devices --haptic --json >out.txt 2>err.txt || complain "devices --haptic --json: exit $?"
for key in '"name": "mouse"' '"name": "arm"' '"model"' '"path": null' '"usable": true' '"why": null' '"help": null'; do holds "$key"; done
[ "$(head -c 1 out.txt)" = '[' ] && passed=$((passed + 1)) || complain "devices --haptic --json is no list: $(cat out.txt)"
bad 'two sorts alone at once' 'excludes' devices --gpus --haptic
bad 'two other sorts alone at once' 'excludes' devices --processors --haptic
good 'list of processors' devices --processors
holds 'for a new map and 9 loads on 64 x 64 cells'
holds 'host  '
holds 'usable   yes; sessions with auto take it'
grep -q 'a simulated arm' out.txt && complain "an arm solves nothing: $(cat out.txt)" || passed=$((passed + 1))

# doctor [VARIABLE=VALUE...] -- WORDS of one line of its output, runs of blanks as one
doctor() {
    variables=
    while [ "$1" != -- ]; do variables="$variables $1"; shift; done
    shift
    # shellcheck disable=SC2086  # a list of words on purpose
    env -u DISPLAY -u WAYLAND_DISPLAY -u FALCON_FIRMWARE $variables "$palpate" doctor --quick >out.txt 2>err.txt && [ ! -s err.txt ] || complain "doctor: exit $? $(cat err.txt)"
    tr -s ' ' <out.txt | grep -qF -- "$*" && passed=$((passed + 1)) || complain "doctor$variables lacks '$*': $(cat out.txt)"
}
for part in vulkan host display 'real time' usb guardian 'udev rule' falcon 'falcon firmware' haply 'haply service' forcedimension 'forcedimension sdk' openhaptics 'openhaptics sdk' bridge spacemouse; do doctor -- " $part "; done
doctor -- 'Embree '
doctor -- 'missing display neither DISPLAY nor WAYLAND_DISPLAY'
doctor DISPLAY=:0 -- 'ok display X11'
doctor DISPLAY=:0 WAYLAND_DISPLAY=wayland-0 -- 'ok display Wayland'
doctor -- 'warning falcon firmware FALCON_FIRMWARE is not set'
doctor FALCON_FIRMWARE=nothing.bin -- 'missing falcon firmware FALCON_FIRMWARE names a file that cannot be read'
doctor FALCON_FIRMWARE=plate.json -- 'which is no image'
head -c 8000 skin.ply >image.bin
doctor FALCON_FIRMWARE=image.bin -- 'ok falcon firmware 8000 byte'
grep -qF 'image.bin' out.txt && complain 'a report names a file of the user' || passed=$((passed + 1))
doctor PALPATE_HOST_ISA=portable -- 'code for portable'
doctor PALPATE_HOST_ISA=sse9 -- '-> unset PALPATE_HOST_ISA'
doctor VK_DRIVER_FILES=none.json VK_ICD_FILENAMES=none.json -- 'warning vulkan no processor'
doctor -- 'warning vulkan only in software: '
doctor -- 'ok guardian it starts'
good 'doctor, with the clock of the servo' doctor
holds "a servo's tick of 1 ms is late by"
holds 'up to 50'
good 'doctor, for scripts' doctor --json
for key in '"part": "servo"' '"late_up_to_s": [' '"busy": {' '"counts": [' '"p99.9_s"'; do holds "$key"; done
for key in '"palpate": "0.' '"compiler"' '"libraries"' '"system"' '"part": "real time"' '"verdict": "' '"found"' '"help"' '"name": "arm"'; do holds "$key"; done
good 'list of GPUs' devices --gpus
holds 'usable   yes'
grep -q host out.txt && complain "the host is no GPU: $(cat out.txt)" || passed=$((passed + 1))
good 'list of devices, for scripts' devices --json
for key in '"index": 0' '"index": null' '"name": "host"' '"kind": "software"' '"kind": "host"' '"driver"' '"api"' '"memory"' '"float64"' '"usable": true' '"refusals": []' '"processor": "' \
    '"instruction_set": "' '"trial_ms": null' '"auto": false'; do holds "$key"; done
tr -d ' \n' <out.txt | grep -q '^{"haptic":\[.*\],"processors":\[.*"auto":true}\]}$' && passed=$((passed + 1)) || complain "auto is not the host, the last of: $(cat out.txt)"
without "$palpate" devices --gpus --json
code=$?
[ $code -eq 4 ] && grep -qF 'mesa-vulkan-drivers' err.txt && [ "$(cat out.txt)" = '[]' ] && passed=$((passed + 1)) ||
    complain "a machine without a GPU: exit $code, expected 4: $(cat out.txt err.txt)"
without "$palpate" devices && grep -qF 'sessions with auto take it' out.txt && [ ! -s err.txt ] && passed=$((passed + 1)) ||
    complain "a machine without a GPU has its host: $(cat out.txt err.txt)"
without "$palpate" solve plate.json --json && grep -qF '"solver": "host"' out.txt && grep -qF '"note": null' out.txt && [ ! -s err.txt ] && passed=$((passed + 1)) ||
    complain "solving without a GPU, on the host: $(cat out.txt err.txt)"
without "$palpate" solve plate.json --solver lavapipe
code=$?
[ $code -eq 4 ] && [ ! -s out.txt ] && passed=$((passed + 1)) ||
    complain "a GPU that is asked for and is not there: exit $code, expected 4: $(cat out.txt err.txt)"
for where in start list open; do
    for command in 'solve plate.json' 'touch sample:sheet --points 5000 --cells 16' 'bench --nodes 33 --cases memory'; do
        # shellcheck disable=SC2086  # a command and its arguments
        failing $where "$palpate" $command --json && grep -qE '"(solver|name)": "host"' out.txt && [ "$(wc -l <err.txt)" -eq 1 ] &&
            grep -qF 'palpate: auto takes host: ' err.txt && passed=$((passed + 1)) || complain "$command, Vulkan broken at $where: $(cat out.txt err.txt)"
        case $command in bench*) continue ;; esac
        grep -qE '"note": "(Vulkan|the GPU) ' out.txt && passed=$((passed + 1)) || complain "$command does not report it: $(cat out.txt)"
    done
    failing $where "$palpate" devices && grep -qF 'host  ' out.txt && passed=$((passed + 1)) || complain "devices, Vulkan broken at $where: $(cat out.txt err.txt)"
    failing $where "$palpate" solve plate.json --solver lavapipe
    code=$?
    [ $code -eq 4 ] && [ ! -s out.txt ] && passed=$((passed + 1)) || complain "asked for, Vulkan broken at $where: exit $code: $(cat err.txt)"
done

# --- another solver takes over: each command says so, once
told() { # told DESCRIPTION WORDS: of the last command
    [ "$(grep -c 'took over' err.txt)" -eq 1 ] && grep -qF "$2" err.txt && grep -qF "\"takeover\": \"$2" out.txt && passed=$((passed + 1)) ||
        complain "$1 does not say once that $2: $(cat err.txt) $(grep '"takeover"' out.txt)"
}
cat >hard.json <<'JSON'
{"cloud": "sample:ellipsoid", "points": 6000, "thickness": "1 mm", "foundation": "1.74 MPa/m", "window": "60 mm", "cells": 24, "footprint_radius": "4 mm", "theory": "shell",
 "place": [0, 0, 0.03], "deformation_rate": 10, "solver": "host",
 "stiffness": {"law": "disc", "from": 1e12, "to": 1e3, "centre": [0, 0, 0.03], "radius": 0.014}}
JSON
good 'touch of a hard shell' touch hard.json --json
grep -qF 'the reference solver took over' err.txt && passed=$((passed + 1)) || complain "a hard shell is none any more, and the next tests test nothing: $(cat err.txt)"
good 'picture of a hard shell' render hard.json --out hard.png --size 64x64 --json
told render 'the reference solver took over: '
good 'film of a hard shell' render hard.json --out hard.png --size 64x64 --frames 1 --seconds 0.1 --json
told 'render --frames' 'the reference solver took over: '
good 'perceive a hard shell' perceive hard.json --places 3 --reach 3mm --json
told perceive 'the reference solver took over: '
good 'run on a hard shell' run hard.json --hand press --clock virtual --seconds 1 --record hard --json
told run 'the reference solver took over: '
good 'replay on a hard shell' replay hard --json
told replay 'the reference solver took over: '
awk -v OFS=, 'BEGIN { print "x,y,z,felt_stiffness"; for (n = 0; n < 3000; ++n) {
    z = 1 - (2 * n + 1) / 3000; r = sqrt(1 - z * z); x = r * cos(2.4 * n); y = r * sin(2.4 * n)
    print 0.03 * x, 0.03 * y, 0.03 * z, (z > 0.9 ? 10 : 1e7) } }' >hard.csv
good 'fit of a hard shell' fit hard.csv --footprint-radius 4mm --thickness 1mm --foundation 1.74MPa/m --window 60mm --cells 24 --theory shell --places 30 --solver host --json
told fit 'the reference solver took over: '
for command in 'perceive sample:sheet --points 5000 --cells 16 --places 3 --reach 3mm' 'paper --only g --quick --out paper'; do
    # shellcheck disable=SC2086  # a command and its arguments
    failing open "$palpate" $command --solver auto --json && grep -qF '"takeover": "the host took over: ' out.txt && ! grep -q 'took over' err.txt &&
        [ "$(grep -c 'auto takes host: ' err.txt)" -eq 1 ] && passed=$((passed + 1)) ||
        complain "$command, Vulkan broken: told when it is opened, and not again: $(cat err.txt) $(grep '"takeover"' out.txt)"
done

# --- a hand feels a scene
cat >scene.json <<'JSON'
{"cloud": "sample:sheet", "points": 4000, "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 32, "footprint_radius": "4.4 mm",
 "stiffness": {"law": "gaussian", "from": 0.3e6, "to": 3e6, "centre": [0, 0, 0], "sigma": 3e-3}}
JSON
good 'run' run scene.json --clock virtual --seconds 0.5 --record session --json
for key in '"ticks": 500' '"fault": "none"' '"ticks_coming_on"' '"max_whole_force_N": null' '"samples": 500' '"p99.9_s"'; do holds "$key"; done
good 'a session that ends before its force is whole' run scene.json --clock virtual --hand press --seconds 1
holds 'all of it was never felt: take more --seconds'
good 'a longer one' run scene.json --clock virtual --hand press --seconds 4
holds 'all of it was at most'
good 'replay' replay session --compare
holds 'equal to the bit'
good 'a table of a session' export session --csv session.csv
holds '500 ticks in session.csv'
[ "$(wc -l <session.csv)" -eq 501 ] && head -1 session.csv | grep -q '^time,hip_x,' && passed=$((passed + 1)) || complain "the table: $(head -c 300 session.csv)"
good 'a table is a hand' run scene.json --hand session.csv --clock virtual --seconds 0.1
bad 'a table over a recording' 'ends in .csv' export session --csv session/ticks.npy
bad 'a table of nothing' 'session.json' export nowhere --csv nowhere.csv
[ ! -e nowhere.csv ] && passed=$((passed + 1)) || complain 'a table of nothing was written'
bad 'markers that nothing takes' 'add --record' run scene.json --markers udp:9871
bad 'a stream to nowhere' 'udp:HOST:PORT, lsl or lsl:NAME' run scene.json --stream nowhere
env LD_LIBRARY_PATH="$place" "$palpate" run scene.json --stream lsl --record unmade >out.txt 2>err.txt
[ $? -eq 2 ] && grep -q 'needs no library' err.txt && [ ! -e unmade ] && passed=$((passed + 1)) || complain "a library that is not there: $(cat err.txt)"
good 'a stream' run scene.json --clock virtual --seconds 0.2 --stream udp:127.0.0.1:9 --stream udp:127.0.0.1:9 --json
holds '"to": "udp:127.0.0.1:9"'
good 'a session of one tick' run scene.json --clock virtual --seconds 0.001
holds '1 tick, 0 in contact'
good 'replay on lavapipe' replay session --compare --solver lavapipe
good 'the configuration' run scene.json --print-config --max-force '4 N' --flat
grep -qE '^max_force +4 +N +flag --max-force$' out.txt && grep -qE '^theory +plate +- +flag --theory$' out.txt &&
    passed=$((passed + 1)) || complain "the configuration: $(cat out.txt)"
good 'the same for scripts' run scene.json --print-config --json
bad 'a hand of the configuration' '--hand has no effect with --print-config' run scene.json --print-config --hand press
bad 'a session is not overwritten' session run scene.json --clock virtual --seconds 0.1 --record session
printf '{"cloud": "sample:sheet", "thicknes": 0.004}' >wrong.json
"$palpate" run scene.json --solver gpu9000 --record unmade >out.txt 2>err.txt
[ $? -eq 2 ] && [ ! -e unmade ] && passed=$((passed + 1)) || complain "a missing device left a session behind: $(cat err.txt)"
bad 'an unknown key of a scene' 'did you mean' run wrong.json
printf '{"cloud": "sample:sheet", "thickness": -0.004}' >wrong.json
bad 'a negative thickness' thickness run wrong.json
printf '0,0,0,0\n0.1,nan,0,0\n' >hand.csv
bad 'a hand that is not a number' hand.csv run scene.json --hand hand.csv
printf 't;x;y;z\n0;0;0;0,01\n1;0;0;0,002\n' >decimal.csv
bad 'decimal commas' 'expected 4 columns, found 5' run scene.json --hand decimal.csv
bad 'a grip in a wrong unit' '"150 N/mm"' run scene.json --arm '150 N/mm'
bad 'a speed in a unit of length' 'unknown unit "mm" in "5 mm"; known units: m/s' run scene.json --speed '5 mm'
bad 'a time in another unit' 'unknown unit "min" in "2min"; known units: s, ms' run scene.json --seconds 2min
good 'a time in milliseconds' run scene.json --clock virtual --seconds 100ms --json
holds '"ticks": 100'
bad 'a speed of a file' "--speed belongs to the hands press, circle, scan, found --hand session.csv" run scene.json --hand session.csv --speed 10mm/s
bad 'a reach of a press' '--reach belongs to the hands circle and scan' run scene.json --hand press --reach 5mm --clock virtual
bad 'a recording on standard output' '--record: expected a folder, found "-", which stands for standard output' run scene.json --hand press --record - --clock virtual
bad 'a speed of the mouse' '--speed belongs to the hands press, circle, scan, found --hand mouse' view sample:sheet --speed 10mm/s
bad 'a grip on the mouse' '--arm: no scripted hand grips the mouse' view sample:sheet --arm 150N/m
mkdir -p recorded
bad 'a scene option of a recorded session' '--window has no effect on a recorded session, recorded,' view recorded --window 30mm
bad 'an arm of the mouse' '--forcedimension-init is an option of --hand forcedimension, found --hand mouse' view sample:sheet --forcedimension-init
bad 'a reach of a device' '--reach belongs to the hands circle and scan, found' run scene.json --hand spacemouse --reach 1mm
ln -sf skin.ply linked.png
bad 'a picture over the cloud' 'linked.png is read as well' render skin.ply --out linked.png
echo '{"cloud": "skin.ply"}' >linked.json
bad 'a picture over the cloud of a scene' 'linked.png is read as well' info linked.json --picture linked.png
ln -sf skin.ply linked.svg
bad 'a plot over the cloud' 'linked.svg is read as well' perceive skin.ply --out linked.svg
bad 'a depth of a device' '--press-depth belongs to' run scene.json --hand falcon --press-depth 1mm
printf 'time [ms], x [mm], y [mm], z [mm]\n0, 0, 0, 10\n100, 0, 0, 9\n' >units.csv
good 'a hand in milliseconds' run scene.json --hand units.csv --clock virtual --json
holds '"ticks": 100'
bad 'a speed that no hand has' 'up to 100 m/s' run scene.json --speed 1e300
bad 'a time without end' 'up to 86400 s' run scene.json --seconds 1e9
bad 'threads without a clock' 'virtual clock has no threads' run scene.json --threads paper --clock virtual
for counts in 1 1999 50000; do
    bad 'counts of no motor' 'expected 2000 to 10000' run scene.json --hand falcon-emulator --falcon-counts $counts
    bad 'counts of no motor' 'expected 2000 to 10000' calibrate --emulator --falcon-counts $counts
done
bad 'a firmware that is not needed' 'with --falcon-cold only' run scene.json --hand falcon-emulator --falcon-firmware scene.json
bad 'counts that are no number' 'nan' run scene.json --hand falcon-emulator --falcon-counts nan
bad 'counts without a Falcon' 'of --hand falcon' run scene.json --falcon-counts 4300
bad 'a slip' 'did you mean falcon?' run scene.json --hand falcom
bad 'no hand at all' '--hand foo: there is no such hand or file; hands: press, circle, scan' run scene.json --hand foo
grep -q ' mouse' err.txt && complain "run offers a hand that needs a window: $(cat err.txt)" || passed=$((passed + 1))
bad 'a mouse without a window' 'needs a window' run scene.json --hand mouse
bad 'a table that is too large' '0, 1, 3, 5 or 7' run scene.json --table-size 9
good 'units of keys' run scene.json --print-config --stiffness-cap '800 N/m' --deformation-rate 30Hz --from 1e300,0,1e300
for hand in arm falcon-emulator haply-emulator; do
    good "a hand that forces move: $hand" run scene.json --hand $hand --clock virtual --seconds 0.5 --record "held-$hand" --json
    good "it replays: $hand" replay "held-$hand" --compare
    holds 'equal to the bit'
done
good 'a small workspace and a large object' run scene.json --hand haply-emulator --workspace-scale 3 --clutch-button 2 --clock virtual --seconds 0.5 --record scaled --json
holds '1 mm of the device is 3.00 mm of the scene; forces are not scaled'
holds 'button 2 is the clutch'
holds 'torques and the force of a grip stay zero'
good 'it replays: scaled' replay scaled --compare
holds 'equal to the bit'
bad 'a scale of nothing' '0.1 to 10' run scene.json --hand haply-emulator --workspace-scale 0
bad 'a button that no device has' '0 to 16' run scene.json --hand haply-emulator --clutch-button 17
printf 'time,x,y,z,orientation_x,orientation_y,orientation_z,orientation_w\n0,0,0,0.01,0.26,0,0,0.966\n1,0,0,0.01,0.26,0,0,0.966\n' >tilted.csv
good 'a hand that is tilted' run scene.json --hand tilted.csv --clock virtual --record tilted
good 'its table' export tilted --csv tilted-out.csv
tail -n 1 tilted-out.csv | grep -q ',0.259' && passed=$((passed + 1)) || complain "the tilt is not in the table: $(tail -n 1 tilted-out.csv)"
sed 's/0.966/9/' tilted.csv >untilted.csv
bad 'a tilt that is none' 'length 1' run scene.json --hand untilted.csv
bad 'a device that is not there' 'is haply-inverse-service running?' run scene.json --hand haply:127.0.0.1:1
bad 'a line that is none' 'expected udp:PORT or udp:HOST:PORT' run scene.json --hand bridge:udp:x
bad 'a bridge that says nothing' 'sends no report of a bridge' run scene.json --hand bridge:udp:47321
good 'threads of the paper' run scene.json --threads paper --seconds 0.3
good 'a fast hand' run scene.json --speed 2 --clock virtual --seconds 1 --json
holds 'no force came on'
holds '"ticks_without_force"'
# contact is never silent: 12 mm between points, and a window that holds one of them
awk 'BEGIN { print "x,y,z"; for (i = -15; i < 15; ++i) for (j = -15; j < 15; ++j) print 12 * i + 6 "," 12 * j + 6 ",0" }' >coarse.csv
coarse='coarse.csv --length-unit mm --window 20 --footprint-radius 4 --thickness 4 --place 6,6,0 --from 0,0,1 --hand press --clock virtual --seconds 2 --cells 32'
# shellcheck disable=SC2086  # a list of words
{
    good 'a touch without a patch' run $coarse --speed 10mm/s
    holds 'ticks that pressed, the last because: '
    holds '1 points of the touched surface'
    [ "$(grep -c 'the hand touches and feels nothing' err.txt)" -eq 1 ] && passed=$((passed + 1)) || complain "a touch without a patch is not said once: $(cat err.txt)"
    good 'a touch without a patch that ends before its law does' run $coarse --speed 50mm/s --press-depth 0.4mm
    holds 'homogeneous law of each place'
    holds '1 points of the touched surface'
    good 'a touch without a patch, for scripts' run $coarse --speed 10mm/s --json
    holds '"patches": 0'
    grep -q '"why_without_force": ".*at (.*1 points of the touched surface' out.txt && passed=$((passed + 1)) || complain "no reason in the summary: $(cat out.txt)"
    good 'which info foretells' info coarse.csv --length-unit mm
    holds 'spacing     12'
    holds 'covers only'
}
sed 's/"samples": [0-9]*/"samples": 7/' held-arm/session.json >cut.json && mv cut.json held-arm/session.json
bad 'a damaged recording' 'the recording is damaged' replay held-arm --compare
"$palpate" run scene.json --clock virtual --seconds 3000 --record stopped >out.txt 2>err.txt &
session=$!
n=0
until [ -n "$(find stopped -name ticks.npy -size +4k 2>/dev/null)" ] || [ $n -gt 1200 ]; do sleep 0.1; n=$((n + 1)); done
kill -TERM $session
kill -TERM $session # as timeout(1), which signals its child and its group
wait $session && grep -q '"finished": true' stopped/session.json && passed=$((passed + 1)) || complain "a session that is stopped: exit $? $(cat err.txt)"
# Whoever removes, moves or cuts a recording while it is made is told that it is lost.
for harm in 'rm -r stopped' 'mv stopped away' 'truncate -s 4000 stopped/ticks.npy'; do
    rm -rf stopped away
    "$palpate" run scene.json --clock virtual --seconds 3000 --record stopped >out.txt 2>err.txt &
    session=$!
    n=0
    until [ -n "$(find stopped -name ticks.npy -size +4k 2>/dev/null)" ] || [ $n -gt 1200 ]; do sleep 0.1; n=$((n + 1)); done
    $harm
    kill -TERM $session
    wait $session
    [ $? -eq 1 ] && grep -q 'palpate: .*stopped.*: another program has .*cut' err.txt && passed=$((passed + 1)) ||
        complain "a recording after $harm: $(cat out.txt err.txt)"
done
[ "$(wc -c <stopped/ticks.npy)" -le 4000 ] && grep -q '"samples": 0' stopped/session.json && passed=$((passed + 1)) || complain 'what was cut has grown again, or is counted'
bad 'the cloud twice' '--cloud: the cloud is already named, sample:palm' touch sample:palm --cloud sample:skin
long=$(printf '%300s' | tr ' ' a)
bad 'a hand whose name no file can have' 'File name too long' run scene.json --hand "$long" --clock virtual
bad 'a scene whose name no file can have' 'File name too long' run "$long" --clock virtual
mkdir gone && { (cd gone && rmdir ../gone && "$palpate" run "$place/scene.json" --clock virtual --seconds 0.1 --record "$place/elsewhere" >../out.txt 2>"$place/err.txt")
    [ $? -eq 2 ] && grep -q '^palpate: the current folder: ' err.txt && passed=$((passed + 1)) || complain "a folder that is gone: $(cat err.txt)"; }
bad 'an unknown clock' 'expected real or virtual' run scene.json --clock wall
at=$(($(wc -c <session/ticks.npy) - 124)) # within the last tick's force z
byte=$(od -An -tu1 -j$at -N1 session/ticks.npy)
# shellcheck disable=SC2059  # an octal number behind a backslash
printf "\\$(printf %o $((byte ^ 1)))" | dd of=session/ticks.npy bs=1 seek=$at conv=notrunc 2>/dev/null
"$palpate" replay session --compare >out.txt 2>err.txt
[ $? -eq 1 ] && grep -qF 'tick 499' out.txt && passed=$((passed + 1)) || complain "one changed bit is not found: $(cat out.txt err.txt)"
[ ! -w /dev/full ] || { "$palpate" replay session --compare >/dev/full 2>err.txt; [ $? -eq 2 ] && grep -q 'standard output cannot be written' err.txt; } &&
    passed=$((passed + 1)) || complain "a difference that nobody can read: $(cat err.txt)"
cp -r session lacking && sed -i 's/"stopped": null/"stopped": "the disk was full"/' lacking/session.json
good 'a table of a recording that stopped' export lacking --csv lacking.csv
grep -q 'lacking is not complete: the disk was full' err.txt && passed=$((passed + 1)) || complain "a table of a part: $(cat err.txt)"
sed -i 's/"stopped": "the disk was full"/"stopped": null/; s/"markers_lost": 0/"markers_lost": 3/' lacking/session.json
good 'replay of a recording without some markers' replay lacking
grep -q 'lacking is not complete: it lacks 3 markers' err.txt && passed=$((passed + 1)) || complain "a replay of a part: $(cat err.txt)"
sed -i 's/"markers_lost": 3/"markers_lost": 0/; s/"markers": 0/"markers": 2/' lacking/session.json && rm lacking/markers.jsonl
last=$(($(wc -c <lacking/ticks.npy) - 224)) # the row of tick 499
printf '\377\377\377\377\377\377\377\377' | dd of=lacking/ticks.npy bs=1 seek=$((last + 8)) conv=notrunc 2>/dev/null
head -c 448 /dev/zero >>lacking/ticks.npy
good 'a table of a damaged recording' export lacking --csv lacking.csv
for sentence in 'lacking/markers.jsonl: expected the 2 markers that session.json counts, found no such file' \
    'lacking/ticks.npy: expected the end after the 500 ticks that the header counts, found 2 ticks more' \
    'lacking/ticks.npy: tick 499: expected a number as hip_x, found NaN'; do
    grep -qF "palpate: warning: $sentence" err.txt || grep -qF "lacking is not complete: $sentence" err.txt &&
        passed=$((passed + 1)) || complain "a table of a damaged recording does not say '$sentence': $(cat err.txt)"
done
good 'a damaged recording for scripts' export lacking --csv lacking.csv --json
holds '"incomplete": "lacking/markers.jsonl'
holds 'tick 499: expected a number as hip_x'
truncate -s $((last + 100)) lacking/ticks.npy
bad 'a recording that was cut short' 'bytes, 499 whole ticks; it may have been cut short while it was copied: copy it again' export lacking --csv lacking.csv

# --- a Falcon weighs a mass: an emulated one, of 4200 counts per N m and an arm of 210 g
# near KEY EXPECTED SHARE, of tests/device/falcon_calibration_test.cpp
near() {
    value=$(sed -n "s/^  \"$1\": \([-+.0-9e]*\).*/\1/p" out.txt)
    awk -v a="$value" -v b="$2" -v share="$3" 'BEGIN { d = a - b; if (d < 0) d = -d; exit !(a > 0 && d <= share * b) }' &&
        passed=$((passed + 1)) || complain "calibrate: $1 is $value, expected $2"
}
bad 'a mass that no motor holds' '--mass: expected 50 g to 250 g, found "300 g": the motors could not hold it' calibrate --emulator --mass '300 g'
bad 'a mass that is too small' '--mass: expected 50 g to 250 g, found "49 g"' calibrate --emulator --mass '49 g'
bad 'a mass that is none' 'unknown unit "N" in "200 N"; known units: kg, g' calibrate --emulator --mass '200 N'
bad 'a mass in another unit' 'unknown unit "mg" in "200mg"' calibrate --emulator --mass 200mg
bad 'a firmware of what is emulated' '--falcon-firmware has no effect with --emulator' calibrate --emulator --falcon-firmware scene.json
good 'calibrate, from counts that are twice too few' calibrate --emulator --falcon-counts 2100 --json
holds '"counts_per_torque_before": 2100.0'
holds '"why_no_hold": null'
near counts_per_torque 4200 0.005
near arm_kg 0.21 0.01
near hold_s 0.02 0.1 # the emulator's 20 ms; an exchange is 1 ms
for step in 'emulated' 'lift the grip' 'find the command that carries the arm' 'hang 200 g on the grip' 'hands off'; do
    grep -qF "$step" err.txt && passed=$((passed + 1)) || complain "calibrate does not say '$step': $(cat err.txt)"
done
stored=$XDG_CONFIG_HOME/palpate/falcon-EMULATED.json
holds "\"file\": \"$stored\""
# What is stored is shown, used, and where the next calibration begins.
good 'devices, calibrated' devices --haptic
grep -qE 'force    (419.|420.|421.) counts per N m, an arm of 2[01]. g, a hold of (19|20|21) ms' out.txt && passed=$((passed + 1)) || complain "devices does not show the calibration: $(cat out.txt)"
good 'run, calibrated' run scene.json --hand falcon-emulator --clock virtual --seconds 0.1
grep -qF 'runs as its calibration found it' err.txt && passed=$((passed + 1)) || complain "run does not say that the emulator is calibrated: $(cat err.txt)"
sed 's/"counts_per_torque": [0-9.]*/"counts_per_torque": 5000/' "$stored" >file.json && mv file.json "$stored"
good 'calibrate anew, the heaviest mass' calibrate --emulator --mass 0.25
grep -qF 'hang 250 g on the grip' err.txt && passed=$((passed + 1)) || complain "the mass that is hung: $(cat err.txt)"
grep -qE 'counts per N m   (419.|420.|421.)   \(5000 before: the forces were 1\.19 times' out.txt && passed=$((passed + 1)) || complain "a second calibration: $(cat out.txt)"
holds 'this Falcon is emulated, and no other has its numbers'
holds "used by          --hand falcon-emulator, as every command uses a real Falcon's: $stored"
grep -qF 'use it' out.txt && complain "asks to use an emulated arm's numbers: $(cat out.txt)" || passed=$((passed + 1))
# A damaged file is shown and refused; the next calibration mends it.
echo '{' >"$stored"
bad 'a damaged calibration' "the Falcon's calibration is damaged" run scene.json --hand falcon-emulator --clock virtual
good 'devices, damaged' devices --haptic
holds 'its file is damaged'
good 'calibrate in place of a damaged file' calibrate --emulator --json
holds '"counts_per_torque_before": null'
grep -qF 'the weighing begins with 4200 counts per N m' err.txt && passed=$((passed + 1)) || complain "calibrate does not say why it begins with 4200: $(cat err.txt)"
good 'run, mended' run scene.json --hand falcon-emulator --clock virtual --seconds 0.1
# So is one that cannot be read; what is found then is printed, but not stored.
mv "$XDG_CONFIG_HOME/palpate" away && ln -s palpate "$XDG_CONFIG_HOME/palpate"
bad 'an unreadable calibration' "the Falcon's calibration cannot be read" run scene.json --hand falcon-emulator --clock virtual
good 'devices, unreadable' devices --haptic
holds "force    the Falcon's calibration cannot be read"
"$palpate" calibrate --emulator >out.txt 2>err.txt
status=$?
[ $status -eq 1 ] && grep -q "^palpate: $XDG_CONFIG_HOME/palpate.*; the calibration was measured, and is not stored" err.txt && passed=$((passed + 1)) || complain "calibrate, unreadable, ends with $status: $(cat err.txt)"
grep -qE 'would be used by palpate run SCENE --hand falcon-emulator --falcon-counts (419|420|421).$' out.txt && passed=$((passed + 1)) || complain "what could not be stored: $(cat out.txt)"
"$palpate" calibrate --emulator --json >out.txt 2>err.txt
[ $? -eq 1 ] && grep -q '"file": null' out.txt && near counts_per_torque 4200 0.005 || complain "calibrate --json, unreadable: $(cat out.txt err.txt)"
rm -r "$XDG_CONFIG_HOME"

# --- the same numbers every time
for run in one two; do "$palpate" touch sample:palm --points 4000 --cells 32 --out $run --json >touch.json; done
"$palpate" touch sample:palm --points 4000 --cells 32 --solver lavapipe --out three --json >lavapipe.json
grep -qF '"name": "llvmpipe' lavapipe.json && passed=$((passed + 1)) || complain "that was not lavapipe: $(cat lavapipe.json)"
agree compliance touch.json lavapipe.json 1e-4
cmp -s one/rigidity.npy three/rigidity.npy && passed=$((passed + 1)) || complain 'the host and lavapipe sample differently'
for file in deformed.ply rigidity.npy deflection.npy rigidity.svg surface.svg; do
    cmp -s one/$file two/$file && passed=$((passed + 1)) || complain "$file differs between two equal runs"
done

# --- bad usage
bad 'unknown option' 'unknown option --frobnicate; see palpate touch --help' touch sample:skin --frobnicate
bad 'a slip in an option' 'palpate touch: unknown option --materal; did you mean --material?' touch sample:skin --materal skin
bad 'a long word' "unknown unit \"$(printf '%60s' | tr ' ' m)...\"" touch sample:skin --window "4$(printf '%300s' | tr ' ' m)"
"$palpate" info "$(printf '%5000s' | tr ' ' a)" 2>err.txt
[ "$(wc -c <err.txt)" -lt 300 ] && passed=$((passed + 1)) || complain 'a name of 5000 letters is repeated'
bad 'samples and keys' '--keys has no effect with --samples' info --samples --keys
bad 'samples of a file' 'SCENE has no effect with --samples' info skin.ply --samples
bad 'places of no picture' '--picture-places belongs to --picture' perceive sample:skin --picture-places 20
bad 'two pictures in one file' '--out and --picture: expected two files' perceive sample:skin --out p.svg --picture ./p.svg
bad 'a hand without frames' '--hand belongs to --frames' render sample:skin --hand press --out no.png
bad 'a word too many' 'found "0.5N" where no further word is expected' touch sample:skin 0.5N
bad 'a slip in a command' 'did you mean touch?' tuch sample:skin
bad 'unknown sample' 'palm' touch sample:elbow
bad 'a slip in a sample' 'did you mean "skin"?' touch sample:skni
bad 'a side that is named twice' '--edges: expected each side once, found "x0=free" and "x0=clamped"; omit one' touch sample:skin --edges x0=free,x0=clamped
bad 'held by a word' '--held: expected' touch sample:skin --held foo
bad 'unknown unit' 'parsec' info skin.ply --length-unit parsec
bad 'unknown preset' 'paper' touch sample:skin --preset rabbit
bad 'unknown map' 'gall-peters' touch sample:skin --map mercator
bad 'odd cells' 'even' touch sample:skin --cells 33
bad 'force that is no number' '--force' touch sample:skin --force nan
bad 'negative window' '--window' touch sample:skin --window -40mm
bad 'all edges free, nothing below' 'rigid' touch sample:sheet --points 5000 --cells 16 --edges free
bad 'footprint wider than the window' 'footprint' touch sample:sheet --points 5000 --cells 16 --footprint-radius 50mm
bad 'contact far from the cloud' 'contact' touch sample:skin --points 5000 --place 1m,0,0
good 'a file without a place is touched where it comes nearest to the viewer' touch skin.ply --window 40mm --cells 32 --json
tr -d ' \n' <out.txt >flat.txt
grep -q '"point":\[-*0.00[0-9]*,-*0.00[0-9]*,0.001[0-9]*\]' flat.txt && passed=$((passed + 1)) || complain "not the top of the wart: $(grep -A4 '"point"' out.txt)"
good 'a window that is left to a plate without a foundation' touch sample:sheet --points 5000 --cells 16 --foundation 0 --window auto
holds 'window chosen      auto: 60.0 mm, the width without auto, because nothing ends the dents of a plate without a foundation'
good 'a session says so too' run sample:sheet --points 5000 --cells 16 --foundation 0 --window auto --clock virtual --seconds 0.1 --json
holds 'the patch window is auto: 60.0 mm'
bad 'tolerance that 32 bits cannot give' '--tolerance' solve plate.json --tolerance 1e-12
bad 'tolerance that is no number' '--tolerance' touch sample:skin --tolerance nan
bad 'peers on an even grid' 'multiple of 4' bench --nodes 64
bad 'peers on a giant' '--nodes' bench --nodes 2049
bad 'peers in an unknown case' 'new_map' bench --cases speed
bad 'peers on an unknown map' 'disc_100' bench --maps cubic
bad 'too few runs for quartiles' '--runs' bench --runs 5
bad 'the reference as its own peer' 'reference' bench --solver reference
bad 'peers with an empty solver' '--solver' bench --solver ''
bad 'devices take no argument' 'voodoo' devices voodoo
bad 'nor does the doctor' 'voodoo' doctor voodoo
for command in 'solve plate.json' 'touch sample:skin'; do
    # shellcheck disable=SC2086  # a command and its arguments
    "$palpate" $command --solver gpu9000 >out.txt 2>err.txt
    code=$?
    [ $code -eq 2 ] && grep -qF "'gpu9000'; expected auto, host, lavapipe, an index or part of a name" err.txt && grep -qF usable err.txt && grep -qF '; host is' err.txt && grep -qF '; reference is' err.txt && [ ! -s out.txt ] && passed=$((passed + 1)) ||
        complain "unknown device: exit $code, expected 2 and the list of devices: $(cat err.txt)"
done
for tolerance in 0 1e-12 nan 1; do
    bad "a tolerance of $tolerance" '--tolerance: expected a number from 1e-7 to 0.1' solve plate.json --tolerance $tolerance
    grep -q "found $tolerance$" err.txt && passed=$((passed + 1)) || complain "the tolerance's bounds: $(cat err.txt)"
done
for schedule in nosuch 0; do
    bad 'unknown schedule' "--schedule: expected automatic, pass-by-pass or fused, found \"$schedule\"" bench --schedule $schedule
done

# --- bad files
bad 'missing file' 'No such file' info nowhere.ply
mkdir folder.ply
bad 'a folder' 'folder' info folder.ply
cp plate.json plate.step
bad 'unknown extension' '.ply' info plate.step
bad 'a plate is no scene' 'unknown key "load"' info plate.json
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\nabc' >huge.ply
bad 'a header that lies' 'huge.ply' info huge.ply
head -c 900 skin.ply >short.ply
bad 'a short file' 'short.ply' info short.ply
printf 'x,y,z\n0,0,0\n1,nan,0\n' >nan.csv
bad 'NaN' 'nan.csv' info nan.csv
printf 'x,y,z,stiffness\n0,0,0,1\n1,0,0,0\n0,1,0,2\n' >zero.csv
bad 'zero stiffness' 'zero.csv' info zero.csv
printf 'x,y,z\n1,2,3\n1,2,3\n1,2,3\n' >same.csv
bad 'all points equal' 'same.csv' info same.csv
: >empty.ply
bad 'empty file' 'empty.ply' info empty.ply
bad 'missing property' 'quality' info skin.ply --stiffness-property quality
printf '{"size":[1,1],' >broken.json
bad 'broken JSON' 'broken.json' solve broken.json
sed 's/"value":1/"value":-1/' plate.json >negative.json
bad 'negative rigidity' 'negative.json' solve negative.json
sed 's/\[\[0.25,0.25\]\]/[[5,5]]/' plate.json >outside.json
bad 'probe off the plate' 'probes' solve outside.json

# --- unwritable targets, and nothing half-written
bad 'target in a folder that is not there' 'cannot be written' convert skin.ply nowhere/skin.ply
bad 'unknown target format' '.ply' convert skin.ply skin.stl
printf 'precious' >kept.ply
bad 'bad input keeps the old target' 'short.ply' convert short.ply kept.ply
[ "$(cat kept.ply)" = precious ] && passed=$((passed + 1)) || complain 'an old file was lost'
(
    ulimit -f 100 && "$palpate" solve plate.json --cells 128 --solver reference --out big.npy >out.txt 2>err.txt
    code=$?
    [ $code -eq 2 ] && grep -qF 'big.npy: cannot be written: File too large' err.txt
) && [ ! -e big.npy ] && passed=$((passed + 1)) || complain "a limit on the size of files: $(cat err.txt)"
(ulimit -f 150 && "$palpate" run sample:sheet --points 2000 --cells 16 --solver host --foundation 1MPa/m --hand press --clock virtual --seconds 2 --record stops --json >out.txt 2>err.txt)
grep -q '"stopped": ".*File too large' out.txt && passed=$((passed + 1)) || complain "the JSON of a session does not say why its recording stopped: $(grep -A8 recorded out.txt) $(cat err.txt)"
# Without memory: the sentence, and no exit handler, where a driver may wait for its own lock. No sanitizer runs so.
(
    ulimit -v 400000 && LD_DEBUG=files "$palpate" solve plate.json --cells 512 --solver reference >out.txt 2>err.txt
    code=$?
    grep -qF Sanitizer err.txt && exit 0
    [ $code -eq 2 ] && grep -qF 'out of memory' err.txt && ! grep -qF 'calling fini' err.txt
) && passed=$((passed + 1)) || complain "no memory: $(grep -F -e palpate: -e 'calling fini' err.txt)"
mkdir full && : >full/out
mkdir own && cp skin.ply own/deformed.ply && cp skin.ply own/kept.ply
bad 'a touch over its cloud' '--out: own/deformed.ply is read as well' touch own/deformed.ply --out own
(cd own && echo '{"cloud": "deformed.ply"}' >scene.json && ! "$palpate" touch scene.json --out . >/dev/null 2>&1 && cmp -s deformed.ply kept.ply && [ ! -e touch.json ]) &&
    passed=$((passed + 1)) || complain 'a touch wrote over the cloud of its scene'
cp 'a folder/rigidity.npy' own
bad 'a touch over its law' '--out: own/rigidity.npy is read as well' touch own/kept.ply --stiffness 'grid:file=own/rigidity.npy,spacing=1' --out own
bad 'a folder that is a stream' 'which stands for standard output' touch sample:skin --json --out -
bad 'a folder that is a file' 'full/out' touch sample:skin --points 5000 --cells 48 --out full/out
# --- options that cannot apply
for option in '--stiffness-property quality' '--stiffness-range 1kPa,2kPa' --log-range '--uniform 3kPa' '--stiffness-unit N_m' '--columns x,y,z' --drop-invalid; do
    # shellcheck disable=SC2086  # an option and its value
    bad "a sample with $option" "${option%% *}: expected a file" info sample:skin $option
done
bad 'an unknown unit on a sample' 'parsec' info sample:skin --length-unit parsec
for option in --points --seed; do bad "a file with $option" "$option: expected a sample" info skin.ply $option 100; done
bad 'points below zero' 'found "-3"' info sample:skin --points -3
bad 'no points' '--points: expected a whole number from 16 to 10000000, found "0"' info sample:skin --points 0
bad 'no cells' 'found "0"' touch sample:skin --cells 0
bad 'a scale without a range' '--stiffness-range' info skin.ply --log-range
bad 'uniform where there is a stiffness' '--uniform: expected a file without' info skin.ply --uniform 300kPa
bad 'uniform beside a law' '--uniform: --stiffness replaces' info skin.ply --uniform 300kPa --stiffness constant:value=1
bad 'a folder without a name' '--out: expected a value' touch sample:skin --out ''
bad 'a law with a unit' 'SI units' info skin.ply --stiffness constant:value=300kPa
bad 'the comment says otherwise' 'stiffness_unit Pa' info skin.ply --stiffness-unit N_m
bad 'an unknown command' 'frob' frob
bad 'help on an unknown command' 'frob' help frob
bad 'an answer that is no array' '.npy' solve plate.json --out plate.json
cp plate.json plate.npy
bad 'an answer over its problem' 'is read as well' solve plate.npy --out ./plate.npy
cp 'a folder/rigidity.npy' D.npy && cp w.npy p.npy
sed 's/16,24/32,32/; s/"law":"constant","value":1/"law":"grid","file":"D.npy"/' plate.json >grid.json
bad 'an answer over its rigidity' '--out: ./D.npy is read as well' solve grid.json --out ./D.npy
sed 's/16,24/32,48/; s/"law":"point","force":1,"at":\[0.5,0.75\]/"law":"grid","file":"p.npy"/' plate.json >load.json
bad 'an answer over its load' '--out: p.npy is read as well' solve load.json --out p.npy
cmp -s D.npy 'a folder/rigidity.npy' && cmp -s p.npy w.npy && passed=$((passed + 1)) || complain 'solve wrote over what it read'
sed 's/"constant","value"/"odd","value"/' plate.json >odd.json
bad 'an unknown rigidity law' 'checker, grid' solve odd.json

# --- values beyond all sense
bad 'a window beyond the world' '--window: expected object, auto, or a length from 1e-6 to 100 m' touch sample:sheet --window 1e300m --footprint-radius 1e299m
for option in --thickness --footprint-radius --window; do bad "nothing of $option" "$option" touch sample:sheet $option 1e-12m; done
bad 'a force that pulls' '--force: expected a force from 0 to 1e6 N' touch sample:sheet --force=-1N
bad 'a force beyond the world' '--force' touch sample:sheet --force 1e308 --thickness 0.001mm
bad 'a foundation beyond the world' '--foundation' touch sample:sheet --foundation 1e300
bad 'a place beyond the world' '--place' touch sample:sheet --place 1e300,0,0
bad 'a stiffness beyond the world' 'that 32 bits cannot hold' touch sample:sheet --points 5000 --cells 16 --stiffness constant:value=1e307 --thickness 1e-6m

# --- what is assumed is said
printf 'x,y,z\n' >bare.csv
awk 'BEGIN { for (i = -20; i <= 20; ++i) for (j = -20; j <= 20; ++j) print i "," j "," 0.01 * (i * i + j * j) }' >>bare.csv
good 'a bare file' convert bare.csv bare.ply
holds 'assumed metres'
holds '300 kPa assumed'
good 'a bare file, touched in millimetres' touch bare.csv --length-unit mm --place 0,0,0 --window 20 --thickness 3 --footprint-radius 2mm --cells 32
holds '300 kPa assumed'
holds 'mm, from the setting'
holds 'thickness 3.00 mm'
bad 'a place beside the cloud' 'nearest point' touch bare.csv --length-unit mm --place 0,0,50 --window 20 --footprint-radius 2
bad 'no place near the cloud' '--length-unit' touch bare.csv --place 5,5,1000 --window 20 --footprint-radius 2 --thickness 0.5 --cells 16
good 'a law beside the cloud' info bare.csv --length-unit mm --stiffness disc:from=1,to=2,centre=5\;5\;5,radius=1
holds 'same stiffness'
printf '0 0 0 1\n1 0 0 1\n0 1 0 1\n' >three.xyz
good 'three points' info three.xyz
holds 'spacing     unknown'
printf 'x [mm],y [mm],z [mm]\n0,0,0\n1,0,0\n0,1,0\n' >units.csv
bad 'a header with units' '--columns' info units.csv
good 'such a header with names' info units.csv --columns x,y,z
name=$(printf 'caf\351.csv')
cp bare.csv "$name"
good 'a name that is not UTF-8' info "$name" --json
good 'nor in convert' convert bare.csv "$name" --json
good 'nor in touch' touch "$name" --length-unit mm --place 0,0,0 --window 20 --footprint-radius 2 --cells 16 --json --out "folder $name"

# --- standard output that cannot be written
full() { # full DESCRIPTION ARGUMENTS...: exit 2 and a sentence, on a full device and on a closed output
    what=$1; shift
    [ -c /dev/full ] || return
    for where in full closed; do
        if [ $where = full ]; then "$palpate" "$@" >/dev/full 2>err.txt; else "$palpate" "$@" >&- 2>err.txt; fi
        code=$?
        if [ $code -eq 2 ] && grep -q 'standard output cannot be written' err.txt; then passed=$((passed + 1)); else complain "$what ($where): exit $code: $(cat err.txt)"; fi
    done
}
full 'help' --help
full 'version' --version
full 'help of a command' touch --help
full 'solve' solve plate.json
full 'solve for scripts' solve plate.json --json
full 'touch' touch sample:sheet --points 5000 --cells 16
full 'info' info skin.ply
full 'samples' info --samples
full 'convert' convert skin.ply other.ply

# --- pictures without a display
small='--points 4000 --cells 32 --size 240x180'
png() { # png FILE WIDTH HEIGHT: it is a PNG of that size
    [ "$(od -An -tx1 -N8 "$1" | tr -d ' \n')" = 89504e470d0a1a0a ] && [ "$(od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }')" = "$2 $3" ] &&
        passed=$((passed + 1)) || complain "$1 is no PNG of $2 x $3"
}
cat >soft.json <<'JSON'
{"cloud": "sample:skin", "points": 4000, "cells": 32}
JSON
# shellcheck disable=SC2086  # options
{
    good 'a picture of a sample' render sample:skin $small --out skin.png
    holds 'skin.png'
    png skin.png 240 180
    good 'the same once more' render sample:skin $small --out again.png
    cmp -s skin.png again.png && passed=$((passed + 1)) || complain 'the same picture has other bytes'
    good 'a picture of a scene' render soft.json --size 200x150 --force '0.5 N' --colour stiffness --colour-map cividis --dark --exaggerate 3 --view whole --out soft.png --json
    for key in '"force": 0.5' '"max_deflection"' '"drawn_on"' '"points": 4000' '"warnings": ['; do holds "$key"; done
    good 'a picture of a file' render skin.ply --place 0,0,0.0015 --window 40mm --cells 32 --size 64x48 --out file.png
    png file.png 64 48
    good 'a picture of a bare file' render bare.csv --place 0,0,0 --window 20m --cells 32 --size 64x48 --footprint-radius 2m --thickness 0.5 --out bare.png
    grep -q 'assumed metres' err.txt && grep -q '300 kPa assumed' err.txt && passed=$((passed + 1)) || complain "render does not say what it assumed: $(cat err.txt)"
    good 'a picture without anything added' render soft.json --size 64x48 --out plain.png
    for option in --ghost --sphere --projected '--finer 1' '--color stiffness' '--color-map cividis'; do
        good "a picture with $option" render soft.json --size 64x48 $option --out other.png
        cmp -s plain.png other.png && complain "the picture with $option is the one without" || passed=$((passed + 1))
    done
    bad 'a factor beyond memory' '--finer' render soft.json --finer 5 --out no.png
    good 'pictures along a hand' render soft.json --size 64x48 --frames 3 --hand press --seconds 0.3 --out film.png --json
    good 'pictures along a hand by its options' render soft.json --size 64x48 --frames 1 --hand press --speed 20mm/s --press-depth 0.5mm --seconds 0.3 --out slow.png
    bad 'no speed at all' '--speed' render soft.json --frames 1 --speed 0 --out no.png
    for n in 1 2 3; do png film_000$n.png 64 48; done
    [ ! -e film.png ] && passed=$((passed + 1)) || complain 'render --frames wrote a picture without a number'
    env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" render sample:sheet $small --out dark.png >out.txt 2>err.txt && passed=$((passed + 1)) || complain "render needs a display: $(cat err.txt)"
    bad 'a size without a height' '--size: expected WIDTHxHEIGHT' render sample:skin --out no.png --size 320
    bad 'a size that is none' '--size' render sample:skin --out no.png --size 0x100
    bad 'a size beyond devices' '--size' render sample:skin --out no.png --size 5000x100
    bad 'a size with more behind' '--size' render sample:skin --out no.png --size 320x240px
    bad 'another kind of file' '.png' render sample:skin --out no.jpg
    bad 'an unknown colour' 'deflection, stiffness or plain' render sample:skin --out no.png --colour red
    bad 'curvature of a plate' '--theory shell' render sample:skin --out no.png --curvature
    good 'curvature of a shell' render sample:ellipsoid --points 4000 --theory shell --curvature --size 64x48 --out crosses.png
    bad 'an unknown map' 'viridis, cividis or grey' render sample:skin --out no.png --colour-map jet
    bad 'an unknown view' 'patch or whole' render sample:skin $small --out no.png --view side
    bad 'a negative exaggeration' '--exaggerate' render sample:skin --out no.png --exaggerate -1
    bad 'an unknown sample' 'known' render sample:nose --out no.png
    bad 'a scene that is not there' 'nowhere.json' render nowhere.json --out no.png
    bad 'a cloud that is not there' 'nowhere.ply' render nowhere.ply --out no.png
    good 'a cloud without a place' render skin.ply --window 40mm --cells 32 --size 64x48 --out placeless.png
    png placeless.png 64 48
    bad 'a place off the cloud' 'the place (1, 1, 1) m is ' render sample:skin $small --place 1,1,1 --out no.png
    bad 'a force of the hand' '--force' render soft.json --frames 2 --force 1N --out no.png
    bad 'no frames' '--frames' render soft.json --frames 0 --out no.png
    bad 'a folder that is not there' 'nowhere/no.png' render sample:skin $small --out nowhere/no.png
    [ ! -e no.png ] && passed=$((passed + 1)) || complain 'a refused picture was written'
    without "$palpate" render sample:skin $small --out no.png
    code=$?
    [ $code -eq 4 ] && grep -qF 'no Vulkan processor can draw' err.txt && grep -qF 'mesa-vulkan-drivers' err.txt && [ ! -s out.txt ] && [ ! -e no.png ] && passed=$((passed + 1)) ||
        complain "render without Vulkan: exit $code, expected 4: $(cat err.txt)"
    "$palpate" render sample:skin $small --draw-on host --out no.png >out.txt 2>err.txt
    code=$?
    [ $code -eq 4 ] && grep -qF 'cannot draw' err.txt && passed=$((passed + 1)) || complain "render on the host: exit $code: $(cat err.txt)"
}

# --- faces, and stiffness that is painted
cat >mesh.ply <<'PLY'
ply
format ascii 1.0
comment VCGLIB generated
comment length_unit mm
element vertex 9
property float x
property float y
property float z
property uchar red
property float quality
element face 5
property list uchar int vertex_indices
end_header
0 0 0 255 1000
1 0 0 255 1000
2 0 0.10 255 1000
0 1 0 128 1000.0
1 1 0 128 1000.0
2 1 0 128 1000.0
0 2 0 0 1000
1 2 0 0 1000
2 2 0 0 1000
4 0 1 4 3
4 1 2 5 4
3 3 4 7
3 4 4 5
2 0 1
PLY
good 'a mesh' info mesh.ply
holds '5 triangles of 5 faces, 2 left out: fewer than three corners, or one twice'
good 'a mesh, for scripts' info mesh.ply --json
holds '"faces": 5'
holds '"degenerate_faces": 2'
good 'a mesh as another' convert mesh.ply mesh2.ply
holds '5 triangles'
good 'which has its faces' info mesh2.ply
holds '5 triangles of 5 faces'
holds 'sides       known for 78 % of the points: 78 % by faces'
good 'a mesh as text' convert mesh.ply mesh.csv --json
holds 'only .ply files hold faces'
cat >surface.vtk <<'VTK'
# vtk DataFile Version 3.0
two triangles, whose corners are their own
ASCII
DATASET POLYDATA
POINTS 6 float
0 0 0 20 0 0 0 20 0 20 0 0 20 20 0 0 20 0
POLYGONS 2 8
3 0 1 2 3 3 4 5
POINT_DATA 6
SCALARS E float
LOOKUP_TABLE default
1e5 4e5 1e5 1e5 1e5 1e5
NORMALS up float
0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1
VTK
good 'a file of VTK' info surface.vtk --length-unit mm
holds 'VTK, ascii, 4 points'
holds 'size        20.0 mm x 20.0 mm x 0 m'
holds '2 exact duplicates merged'
holds '100 kPa to 200 kPa'
holds '2 triangles of 2 faces'
holds 'warning     2 points lie exactly where an earlier one lies'
good 'a file of VTK as another' convert surface.vtk surface.ply --length-unit mm
good 'which keeps faces and normals' info surface.ply
holds '2 triangles of 2 faces'
holds 'normals     in the file'
{
    printf 'ply\nformat ascii 1.0\nelement vertex 49\n'
    printf 'property float %s\n' x y z nx ny nz
    printf 'property uchar red\nproperty float stiffness\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n'
    awk 'BEGIN { for (i = 0; i < 7; ++i) for (j = 0; j < 7; ++j) print i, j, 0, 0, 0, 1, 7, 1000 }'
    echo 3 0 1 7
} >coloured.ply
good 'a cloud with colours' convert coloured.ply colourless.csv --length-unit mm
holds 'warning     1 triangle was not written'
holds 'warning     not written: red; nothing was read from it'
good 'painting it into another format' paint coloured.ply --length-unit mm --stroke 'at=0,0,0 radius=5mm value=2kPa' --out painted.csv
holds 'warning     1 triangle was not written'
holds 'warning     not written: red; nothing was read from it'
good 'which keeps normals' info painted.csv
holds 'normals     in the file'
bad 'a format that is only read' 'surface2.vtk: expected a name that ends with' convert surface.ply surface2.vtk
good 'a mesh of far vertices' info mesh.ply --scatter on
holds 'a fingertip of 4.00 mm touches 5 triangles through about'
good 'a mesh of far vertices, for scripts' info mesh.ply --json --scatter 0.2mm
holds '"distance": 0.0002'
good 'a mesh as points' convert mesh.ply points.ply --uniform 1kPa --scatter 0.1mm --json
holds '"faces": 0'
bad 'points on what has no faces' '--scatter: expected a cloud with faces' info skin.ply --scatter on
bad 'a distance that is none' '--scatter: expected auto, on, off, or a distance' info mesh.ply --scatter far
printf 'v 0 0 0\nv 50 0 0\nv 50 50 0\nv 0 50 0\nf 1 2 3 4\n' >side.obj
good 'a side of four corners' info side.obj --length-unit mm
holds '4 vertices, 25.0 mm apart'
good 'is touched in its middle' touch side.obj --length-unit mm --place 25,25,0 --from 0,0,1 --window 30 --cells 32 --json
good 'and keeps its corners' convert side.obj side.ply --length-unit mm
holds 'side.ply: 4 points, 2 triangles'
sed 's/^3 3 4 7/3 3 4 9/' mesh.ply >hole.ply
bad 'a face of a point that is not there' 'hole.ply: line 25: face 2: expected the number of a point from 0 to below 9, found 9' info hole.ply

good 'paint one point of a mesh' paint mesh.ply --stiffness-property quality --length-unit mm --stroke 'at=1,1,0 radius=0.5mm value=2kPa' --out painted.ply
holds '9 points, 1 with another stiffness'
holds 'property quality, all else as in mesh.ply'
holds '--stiffness-property quality'
sed 's/^1 1 0 128 1000.0/1 1 0 128 2000/' mesh.ply | cmp -s - painted.ply && passed=$((passed + 1)) || complain "painting changed more than a number: $(diff mesh.ply painted.ply)"
good 'paint where there is no stiffness' paint mesh.ply --stroke 'at=1mm,1mm,0 radius=0.5mm value=2kPa' --out appended.ply --json --uniform 1kPa
for key in '"appended": true' '"property": "stiffness"' '"changed_points": 1' '"original_kept": true' '"stiffness_max": 2000'; do holds "$key"; done
grep -q '^1 1 0 128 1000.0 2000$' appended.ply && grep -q '^comment stiffness_unit Pa$' appended.ply && passed=$((passed + 1)) || complain "nothing appended: $(cat appended.ply)"
good 'paint a sample' paint sample:skin --points 5000 --stroke 'at=0,0,1.5mm radius=6mm value=2MPa strength=0.5' --stroke 'at=0,0,1.5mm;5mm,0,1.5mm radius=4mm smooth' --out wart.ply --json
for key in '"dabs": 1' '"smooth": true' '"strength": 0.5' '"original_kept": false' '"written": "wart.ply"'; do holds "$key"; done
good 'the painted cloud is felt' touch wart.ply --place 0,0,1.5mm --window 40mm --cells 32
good 'paint the cloud of a scene' paint soft.json --stroke 'at=0,0,1.5mm radius=6mm value=2MPa' --out soft.csv
holds '4000 points, '
good 'paint over a law of a scene' paint scene.json --stroke 'at=0,0,0 radius=6mm smooth' --out law.ply
holds 'take the key "stiffness" out'
good 'paint how a place stiffens' paint soft.json --stroke 'at=0,0,1.5mm radius=6mm stiffening=800' --out stiffens.csv
holds ' with another stiffening'
good 'and read it' info stiffens.csv
holds 'stiffening  0 1/m to 7' # the middle lies between points
good 'and feel it' touch stiffens.csv --place 0,0,1.5mm --window 40mm --cells 32 --force 1 --json
holds '"stiffening": '
bad 'a stiffening below zero' 'stiffening from 0 to' paint soft.json --stroke 'at=0,0,1.5mm radius=6mm stiffening=-1' --out no.csv
good 'paint what is held' paint sample:skin --points 5000 --stroke 'at=-30mm,0,1.5mm radius=15mm held=1' --out rooted.ply --json
holds '"held": 1'
holds '"changed_points": 0'
good 'and feel it' touch rooted.ply --held own --window object --cells 32 --place 0,0,1.5mm --json
grep -q '"nodes_held": 0' out.txt && complain "nothing is held: $(grep nodes_held out.txt)" || passed=$((passed + 1))
bad 'more than held' 'from 0, free, to 1' paint soft.json --stroke 'at=0,0,1.5mm radius=6mm held=2' --out no.csv
good 'painting beside everything' paint sample:skin --points 5000 --stroke 'at=0,0,1.5mm radius=6mm value=1MPa' --stiffness constant:value=1e6 --out same.ply
holds 'no stroke changed anything'
mesh='paint mesh.ply --uniform 1kPa --out no.ply --stroke'
# shellcheck disable=SC2086  # a command and its options
{
    bad 'a stroke without a place' '--stroke 1: expected at=' $mesh 'radius=1mm value=1kPa'
    bad 'a stroke without a radius' '--stroke 1: expected radius=' $mesh 'at=1,1,0 value=1kPa'
    bad 'a stroke towards nothing' 'one of value=, stiffening=, held= and smooth' $mesh 'at=1,1,0 radius=1mm'
    bad 'a stroke towards both' 'found 2 of them' $mesh 'at=1,1,0 radius=1mm smooth value=1kPa'
    bad 'a slip in a stroke' 'did you mean radius?' $mesh 'at=1,1,0 radios=1mm smooth'
    bad 'a word twice' 'radius is given twice' $mesh 'at=1,1,0 radius=1mm radius=2mm smooth'
    bad 'the second stroke' '--stroke 2: ' $mesh 'at=1,1,0 radius=1mm smooth' --stroke 'at=1,1,0 radius=-1mm smooth'
    bad 'a radius that is none' 'finite number' $mesh 'at=1,1,0 radius=nan smooth'
    bad 'a place of two numbers' 'three numbers x,y,z' $mesh 'at=1,1 radius=1mm smooth'
    bad 'a path that ends in nothing' 'x,y,z' $mesh 'at=1,1,0; radius=1mm smooth'
    bad 'a force as a stiffness' 'unknown unit "N"' $mesh 'at=1,1,0 radius=1mm value=1N'
    bad 'no stiffness' 'above zero' $mesh 'at=1,1,0 radius=1mm value=0'
    bad 'too strong' 'up to 1' $mesh 'at=1,1,0 radius=1mm smooth strength=2'
    bad 'beside the cloud' 'from its nearest point' $mesh 'at=1,1,1m radius=1mm smooth'
    bad 'no stroke' '--stroke' paint mesh.ply --out no.ply
    cp mesh.ply itself.ply
    bad 'the cloud itself' '--out: ./itself.ply is read as well, and would be overwritten' paint itself.ply --uniform 1kPa --stroke 'at=1mm,1mm,0 radius=1mm value=2kPa' --out ./itself.ply
    bad 'the cloud itself, converted' 'TARGET: itself.ply is read as well, and would be overwritten' convert itself.ply itself.ply --length-unit mm
    cmp -s mesh.ply itself.ply && passed=$((passed + 1)) || complain 'a cloud was written over'
    bad 'another kind of file' '.ply' paint mesh.ply --stroke 'at=1,1,0 radius=1mm smooth' --out no.stl
    bad 'an option of files for a scene of a sample' '--stiffness-range: expected a file' paint scene.json --stiffness-range 1kPa,2kPa --out no.ply --stroke 'at=0,0,0 radius=6mm smooth'
    bad 'a folder that is not there' 'nowhere/no.ply' paint mesh.ply --uniform 1kPa --stroke 'at=1mm,1mm,0 radius=1mm smooth' --out nowhere/no.ply
}
[ ! -e no.ply ] && passed=$((passed + 1)) || complain 'a refused painting was written'
sed 's/^1 2 0 0 1000/nan 2 0 0 1000/' mesh.ply >lost.ply
bad 'a file that lost points' '1 points were dropped' paint lost.ply --drop-invalid --stroke 'at=1mm,1mm,0 radius=1mm value=1kPa' --out no.ply

# --- one scene for every command: a scan in millimetres whose stiffness was painted as "quality"
awk 'BEGIN {
    print "ply\nformat ascii 1.0\ncomment VCGLIB generated\nelement vertex 3721\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\nend_header"
    for (x = -30; x <= 30; ++x) for (y = -30; y <= 30; ++y) print x, y, 30 - (x * x + y * y) / 200, exp(-((x - 5) ^ 2 + y * y) / 32)
}' >scan.ply
words='scan.ply --length-unit mm --stiffness-property quality --stiffness-range 20kPa,2MPa --log-range'
touched='--window 40 --cells 32 --thickness 4 --footprint-radius 4'
cat >scan.json <<'JSON'
{"cloud": "scan.ply", "length_unit": "mm", "stiffness_property": "quality", "stiffness_range": [2e4, 2e6], "log_range": true,
 "window": "40 mm", "cells": 32, "thickness": 0.004, "footprint_radius": 4e-3}
JSON
# shellcheck disable=SC2086  # lists of words on purpose
{
    good 'info of the scan' info $words
    holds '20.0 kPa to 2.00 MPa'
    holds 'mm, from the setting'
    good 'info of its scene' info scan.json
    holds '20.0 kPa to 2.00 MPa'
    holds 'of the points are at a border or beside a hole'
    holds 'the outward side is the one from which the hand comes'
    good 'a picture of its quality' info $words --picture quality.png --json
    holds '"picture": "quality.png"'
    png quality.png 1800 700
    good 'the same as SVG' info $words --picture quality.svg
    bad 'a picture of another kind' '.png or .svg' info $words --picture quality.jpg
    good 'touch the scan' touch $words $touched --json
    cp out.txt touched.txt
    good 'touch its scene' touch scan.json --json
    agree felt_stiffness touched.txt out.txt 1e-12
    good 'touch its stiff spot' touch $words $touched --place 5,0,30 --json
    cp out.txt stiff.txt
    good 'the same place in metres' touch $words $touched --place 5mm,0,0.03m --json
    agree felt_stiffness stiff.txt out.txt 1e-12
    good 'run the scan' run $words $touched --clock virtual --seconds 0.3 --record scanned --json
    holds '"fault": "none"'
    good 'replay it' replay scanned --compare
    holds 'equal to the bit'
    good 'draw the scan' render $words $touched --size 64x48 --colour stiffness --out scan.png
    png scan.png 64 48
    good 'perceive the scan' perceive $words $touched --places 5 --reach 8 --json
    good 'paint the scan' paint $words --stroke 'at=0,0,30 radius=5 value=1MPa' --out painted-scan.ply
    good 'paint its scene' paint scan.json --stroke 'at=0,0,30 radius=5 value=1MPa' --out painted-scene.ply
    cmp -s painted-scan.ply painted-scene.ply && passed=$((passed + 1)) || complain 'a scan and its scene are painted differently'
    good 'convert the scan' convert $words scan-in-metres.ply
    good 'which is the same cloud' touch scan-in-metres.ply --window 40mm --cells 32 --thickness 4mm --footprint-radius 4mm --json
    agree felt_stiffness touched.txt out.txt 1e-9
    good 'where its values come from' run $words --print-config --preset paper
    holds 'flag --preset: preset paper'
    for command in info touch run; do
        bad "$command, a property that is not there" 'qualty' $command scan.ply --length-unit mm --stiffness-property qualty
        bad "$command, a unit that is none" '--length-unit: expected m, mm, cm, um, km, in or ft, found "parsec"' $command scan.ply --length-unit parsec
        bad "$command, a range that is none" '--stiffness-range: expected two stiffnesses above zero, FROM,TO' $command scan.ply --length-unit mm --stiffness-property quality --stiffness-range 20kPa
    done
    sed '40s/ [^ ]*$/ nan/' scan.ply >holed.ply
    for command in info touch run; do bad "$command, NaN" 'holed.ply' $command holed.ply --length-unit mm --stiffness-property quality --stiffness-range 20kPa,2MPa; done
    good 'without that point' touch holed.ply --drop-invalid --length-unit mm --stiffness-property quality --stiffness-range 20kPa,2MPa $touched
    sed 's/^comment VCGLIB generated/comment length_unit mm/' scan.ply >stated.ply
    bad 'a place that would be metres' '--place: 5,0,30 has no unit and would mean metres, but the file'\''s lengths are in mm' touch stated.ply --place 5,0,30
    good 'a place with units' touch stated.ply --place 5mm,0,30mm --window 40mm --cells 32
    good 'in hundredths of that unit' touch stated.ply --length-unit mm --place 5,0,30 --window 40 --cells 32
    good 'the host by the environment' touch scan.json --json
    PALPATE_SOLVER=reference "$palpate" touch scan.json >out.txt 2>err.txt
    holds '(reference)'
    printf '{"cloud": "sample:sheet", "hunt": {"nodules": [{"at": [0, 0, 0], "radius": "6 mm", "modulus": "3 MPa"}]}}' >hidden.json
    good 'what touch does with a hunt' touch hidden.json --json
    holds 'has hidden 1 nodule in this stiffness; palpate hunt and palpate view score'
    unused() { # unused COMMAND...: it tells of variables that nothing reads, one of each kind, and of no others
        env PALPATE_CELS=8 PALPATE_HAND_OVER=hold PALPATE_ODD=1 PALPATE_EMPTY= PALPATE_CELLS=32 \
            PALPATE_HOST_ISA=portable PALPATE_HAPLY=localhost:10001 PALPATE_BUILD=build PALPATE_LIBRARY=none "$palpate" "$@" >out.txt 2>err.txt ||
            complain "unused variables, $1: exit $? $(cat err.txt)"
        cat err.txt >>out.txt
        holds "environment's PALPATE_CELS is not used; did you mean PALPATE_CELLS?"
        holds "environment's PALPATE_HAND_OVER is not used; the key is compliance_law now: PALPATE_COMPLIANCE_LAW"
        holds "environment's PALPATE_ODD is not used; palpate info --keys lists the keys"
        grep -qE 'PALPATE_(CELLS|EMPTY|HOST_ISA|HAPLY|BUILD|LIBRARY) is not used' out.txt && complain "$1 tells of variables that are used: $(cat out.txt)"
    }
    unused info scan.json
    unused convert scan.json unused.ply
    unused paint scan.json --stroke 'at=0,0,30 radius=5 value=1MPa' --out unused.ply
    unused touch scan.json
    unused render scan.json --size 64x48 --out unused.png
    unused perceive scan.json --places 5 --reach 8mm
    unused run scan.json --clock virtual --seconds 0.05
    unused run scan.json --print-config
    unused hunt hidden.json --clock virtual --seconds 0.05
    good 'keys of scenes' info --keys
    holds '| `compliance_law` |'
    good 'their schema' info --schema
    holds '"hunt_seed"'
}

# --- what would be noticed
good 'perceive' perceive soft.json --places 5 --reach 8mm --out path.svg --picture object.svg --picture-places 20
holds 'a prediction, not a study'
for file in path.svg object.svg; do [ -s $file ] && passed=$((passed + 1)) || complain "perceive did not write $file"; done
"$palpate" touch sample:ellipsoid --theory shell --window auto --cells 16 --json 2>/dev/null | awk '/"window": [0-9]/ { print $2 + 0 }' >window.txt
good 'perceive a third of a window that is chosen' perceive sample:ellipsoid --theory shell --window auto --cells 16 --places 3 --json
awk -v window="$(cat window.txt)" '/"reach":/ { found = 3 * $2 > 0.999 * window && 3 * $2 < 1.001 * window } END { exit !found }' out.txt && passed=$((passed + 1)) ||
    complain "a window of $(cat window.txt) m, and $(grep '"reach"' out.txt)"
# A stiffening that is in the cloud's file is felt in a replay as in the session.
good 'paint a stiffening' paint sample:sheet --points 2000 --stiffness constant:value=1e5 --stroke 'at=0,0,0 radius=3cm stiffening=800' --out stiffens.ply
good 'record on it' run stiffens.ply --foundation 1.74MPa/m --window 50mm --cells 16 --hand press --clock virtual --seconds 2 --solver host --record stiffens
good 'replay of what stiffens' replay stiffens --compare
good 'perceive as JSON' perceive soft.json --places 5 --reach 8mm --along 0,1,0 --json
for key in '"prediction": true' '"weber_fraction": 0.07' '"floor_is_low": true' '"right_answers"' '"steps_in_passing"' '"felt_stiffness"' '"direction"' '"warnings": ['; do holds "$key"; done
bad 'a path that leaves the surface' 'along the surface' perceive soft.json --along 0,0,1
bad 'a path without a direction' 'expected a vector' perceive soft.json --along 0,0,0
bad 'a reach of nothing' '--reach' perceive soft.json --reach 0
bad 'a reach of infinity' '--reach' perceive soft.json --reach inf
bad 'a reach beyond a metre' '--reach: expected a length above 0 and up to 1 m' perceive soft.json --reach 2m
bad 'the same for a hand' '--reach: expected a length above 0 and up to 1 m' run soft.json --reach 2m
bad 'a picture of another kind' '.svg' perceive soft.json --out path.png
bad 'an object of another kind' '.svg' perceive soft.json --picture object.png
bad 'a scene that is not there' 'nowhere.json' perceive nowhere.json

# --- the paper, computed again: all of it at once, and again what has clocks in it
if [ "$sanitizer" != thread ]; then # minutes, and the parts below start the same threads
    good 'the paper' paper --quick --solver host --out paper
    for part in a b c d e f g h i; do holds "$part  "; done
    for file in index.html numbers.json timings.json; do [ -s paper/$file ] && passed=$((passed + 1)) || complain "paper did not write $file"; done
    for word in 'does not hold' 'A quick run' '<svg' 'commit'; do grep -qF "$word" paper/index.html && passed=$((passed + 1)) || complain "the page lacks '$word'"; done
fi
good 'parts of the paper' paper --quick --solver host --only a,c,d --out one
good 'the same parts again' paper --quick --solver host --only a,c,d --out two --json
holds '"timings"'
cmp -s one/numbers.json two/numbers.json && passed=$((passed + 1)) || complain 'the same numbers have other bytes'
cmp -s one/timings.json two/timings.json && complain 'two clocks agree to the last digit' || passed=$((passed + 1))
bad 'a part that is not there' '--only' paper --out no --only a,z
bad 'parts without a comma' '--only' paper --out no --only ab
bad 'a bunny without its part' '--bunny' paper --out no --only a --bunny skin.ply
bad 'a bunny that is not there' 'nowhere.ply' paper --out no --bunny nowhere.ply
bad 'an empty folder name' '--out' paper --out ''
[ ! -e no ] && passed=$((passed + 1)) || complain 'a refused report left a folder'
: >taken
bad 'a folder that is a file' 'taken' paper --quick --solver host --only g --out taken

# --- a folder without touch.json holds no whole set
mkdir -p broken/profile.svg && : >broken/touch.json
bad 'a set that cannot be finished' 'profile.svg' touch sample:sheet --points 5000 --cells 48 --out broken
[ ! -e broken/touch.json ] && passed=$((passed + 1)) || complain 'an unfinished folder kept its touch.json'
left=$(find . -name '*.part')
[ -z "$left" ] && passed=$((passed + 1)) || complain "left behind: $left"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

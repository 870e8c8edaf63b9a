#!/bin/sh
# Runs the commands of a page in order, as a reader would: every line of each ```sh block and every inline command that
# begins with "palpate ". A ```json block becomes the .json file that the command before it names.
# Arguments: the checkout, palpate, a folder that may be emptied, pages of the checkout. A new command on a page is run as
# it is, and must exit 0.
set -u
. "$1/tests/support/sessions.sh"
checkout=$1 palpate=$2
scratch=$3"/reader's folder" # a path with a space and an apostrophe
rm -rf "$scratch"
mkdir -p "$scratch/build" && cd "$scratch" || exit 1
scratch=$PWD
shift 3

# The commands find the samples, the programs, and the scan that the pages name. Outputs stay here.
ln -s "$checkout/samples" samples
ln -s "$(dirname "$palpate")" build/bin
make_scan() { # prints a sheet in millimetres at z = 30, a point per millimetre, "quality" 0 at its sides to 1 in the middle
    awk 'BEGIN {
        print "ply\nformat ascii 1.0\nelement vertex 5041\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\nend_header"
        for (x = -35; x <= 35; ++x) for (y = -35; y <= 35; ++y) print x, y, 30, 1 - (x < 0 ? -x : x) / 35
    }'
}
make_scan >scan.ply

make_probes() { # prints nine presses of liver on a grid of 10 mm, 10 rows each; every fifth newton is off by a hundredth
    awk -v OFS=, 'BEGIN {
        print "probe,x [mm],y [mm],z [mm],depth [mm],force"
        for (p = 0; p < 9; ++p) for (n = 0; n < 10; ++n) {
            d = n * 0.25
            print p, 10 * (p % 3), 10 * int(p / 3), 0, d, (200 + 20 * p) * (exp(0.81 * d) - 1) / 810 * (n % 5 ? 1 : 1.01)
        }
    }'
}
make_probes >probes.csv

make_map() { # prints a sheet of 80 mm, a point every 4 mm, felt from 300 to 600 N/m along x
    awk -v OFS=, 'BEGIN {
        print "x,y,z,felt_stiffness"
        for (x = -40; x <= 40; x += 4) for (y = -40; y <= 40; y += 4) print x / 1000, y / 1000, 0, 300 * exp((x + 40) / 80 * log(2))
    }'
}
make_map >map.csv

make_part() { # prints a cube of 40 mm as STL: two triangles a side, given by axis and place
    awk 'BEGIN {
        print "solid part"
        for (axis = 0; axis < 3; ++axis) for (side = 0; side < 2; ++side) for (half = 0; half < 2; ++half) {
            print "facet normal 0 0 0\nouter loop"
            for (k = 0; k < 3; ++k) {
                n = half + k # corners 0 1 2 and 1 2 3 of the square
                p[axis] = 40 * side; p[(axis + 1) % 3] = 40 * (n % 2); p[(axis + 2) % 3] = 40 * int(n / 2)
                print "vertex", p[0], p[1], p[2]
            }
            print "endloop\nendfacet"
        }
        print "endsolid part"
    }'
}
make_part >part.stl

make_volume() { # prints 4 x 4 x 2 values of 10 kPa as an array of NumPy
    printf '\223NUMPY\001\000\166\000%-117s\n' "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 4, 2), }"
    for value in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32; do
        printf '\000\000\000\000\000\210\303\100'
    done
}
make_volume >e.npy

# Sets the exit code and a required message for a command; the patterns name the commands that do not end with 0 here,
# with the reason. Where a Falcon is plugged in, its commands are skipped: no test may move a device.
expected() {
    case $1 in
    *'--hand falcon '* | *'--hand falcon') code=2 says='no Novint Falcon is plugged in' ;; # a machine without one
    *'palpate view'*) code=2 says='palpate render makes pictures without a display' ;;     # DISPLAY is unset
    *) code=0 says= ;;
    esac
}

# prints events: "run" or "unknown", a tab, and the command or the mistake; writes the JSON files
events() {
    awk -v tick='`' '
    function emit(kind, text) { print kind "\t" text }
    function inline(line,    parts, n, k) {
        n = split(line, parts, tick)
        for (k = 2; k < n; k += 2) if (parts[k] ~ /^palpate /) { command("build/bin/" parts[k]) }
    }
    function command(text,    words, n, k) {
        emit("run", text)
        n = split(text, words, " ")
        for (k = 1; k <= n; ++k) if (words[k] ~ /\.json$/ && words[k] !~ /\//) json = words[k]
        if (json != "") last = json
        json = ""
    }
    substr($0, 1, 3) == tick tick tick {
        if (block != "") { block = ""; next }
        block = substr($0, 4)
        if (block == "json" && last == "") { emit("unknown", "line " NR ": a JSON block without a command before it that names a .json file"); block = "none" }
        else if (block == "json") printf "" >last
        else if (block == "cpp") block = "none" # install/run.sh builds and runs it
        else if (block != "sh") { emit("unknown", "line " NR ": a block of kind \"" block "\": the test has no rule for it"); block = "none" }
        next
    }
    block == "sh" {
        if (sub(/\\$/, "")) { held = held $0; next }
        text = held $0; held = ""
        if (text !~ /^ *(#|$)/) command(text)
        next
    }
    block == "json" { print >last; next }
    block == "" { inline($0) }
    END { if (block != "") emit("unknown", "a block that does not end") }' "$1"
}

# A window stays open until it is closed: the function waits for it, asks the program to end, and expects 0.
open_window() { # command
    # --foreground: otherwise timeout passes a signal on twice, to its child and to its group, and the second one ends a
    # program at once.
    DISPLAY=:$display timeout --foreground 300 sh -c "exec ${1%%#*}" </dev/null >out 2>err &
    program=$!
    n=0
    while [ -z "$(DISPLAY=:$display xdotool search --onlyvisible --name Palpate 2>/dev/null)" ]; do
        n=$((n + 1))
        if [ $n -gt 400 ] || ! kill -0 $program 2>/dev/null; then break; fi
        sleep 0.1
    done
    sleep 1
    kill -TERM $program 2>/dev/null # timeout passes the signal on and ends with the program's own code
    wait $program
    found=$?
    [ $n -le 400 ] || { echo "FAILED: no window in 40 s: $1"; failed=1; }
    [ $found -eq 0 ] || { echo "FAILED ($found, in a window): $1"; cat err; failed=1; }
}

run() { # runs one command and compares its exit code and message with the expected ones
    case $1 in
    'sh tests/run.sh'* | 'sh samples/demo.sh'* | 'sh engine/package/make.sh'*)
        # The first would run this test again, and the others build for minutes: they run with --dry-run instead.
        script=${1%%#*}
        (cd "$checkout" && sh -c "${script%%.sh*}.sh --dry-run${script#*.sh}") </dev/null >out 2>err
        found=$? code=0 says=would
        ;;
    *)
        expected "${1%%  #*}"
        if [ "$code" -ne 0 ] && [ -n "$falcon" ]; then case $1 in *falcon*) echo "skipped: a Falcon is plugged in: $1"; return ;; esac; fi
        for attempt in 1 2 3; do
            timeout 600 sh -c "$1" </dev/null >out 2>err
            found=$?
            [ $found -eq 1 ] && [ "$code" -eq 0 ] && [ $attempt -lt 3 ] && was_held_up err || break
            record=$(echo "$1" | sed -n 's/.*--record \([^ ]*\).*/\1/p')
            [ -z "$record" ] || rm -rf "$record"
        done
        ;;
    esac
    ran=$((ran + 1))
    if [ "$found" -ne "$code" ]; then
        echo "FAILED: $1"
        echo "  exit code $found, expected $code"
        cat out err | tail -5
        failed=1
    elif [ -n "$says" ] && ! grep -q "$says" out err; then
        # A build without GLFW has no windows, and prints that.
        if ! grep -q 'made without GLFW' err; then echo "FAILED: $1"; echo "  it does not say \"$says\":"; cat out err; failed=1; fi
    fi
    case $1 in *'palpate view'*) [ -z "$display" ] || grep -q 'made without GLFW' err || open_window "$1" ;; esac
}

check() { # page
    events "$1" >events.txt
    while IFS='	' read -r kind text <&4; do
        case $kind in
        run) run "$text" ;;
        *) echo "FAILED: $1: $text"; failed=1 ;;
        esac
    done 4<events.txt
}

unset DISPLAY WAYLAND_DISPLAY FALCON_FIRMWARE
XDG_CONFIG_HOME=$scratch/config
export XDG_CONFIG_HOME
falcon=$(build/bin/palpate devices | grep '^falcon  ')
display= server=
if command -v Xvfb >/dev/null 2>&1 && command -v xdotool >/dev/null 2>&1; then
    mkfifo number
    Xvfb -displayfd 3 -noreset -screen 0 1400x900x24 3>number 2>xvfb.log & # -noreset: see tools/gui/desktop.sh
    server=$!
    trap 'kill $server 2>/dev/null' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM
    read -r display <number
else
    echo 'skipped: windows are not opened, there is no Xvfb or no xdotool'
fi

failed=0
for page in "$@"; do
    ran=0
    check "$checkout/$page"
    [ $ran -gt 0 ] || { echo "FAILED: no command was found in $page"; failed=1; }
    echo "$page: $ran commands"
done

# The test is tested with a page of mistakes, each of which it must name.
cat >mistakes.md <<'PAGE'
`palpate info --samplez` and `palpate info absent.ply`
```sh
build/bin/palpate touch sample:skn
```
```python
print()
```
```json
{}
```
PAGE
before=$failed failed=0 ran=0
check mistakes.md >mistakes.txt
found=$(grep -c '^FAILED' mistakes.txt)
failed=$before
[ "$found" -eq 5 ] || { echo "FAILED: of five mistakes in a page $found were found:"; cat mistakes.txt; failed=1; }

[ $failed -eq 0 ] && echo 'every command of these pages works as described'
exit $failed

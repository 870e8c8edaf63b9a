#!/bin/sh
# The real window on a display without a screen, with keys and a pointer that xdotool moves, all under Vulkan's
# validation layer with synchronization checks: any message fails. Where Vulkan computes the plates too, these are under it as
# well, a second time with shaders that check each access. Arguments: palpate, a folder that may be emptied, and
# palp_desktop_client, which closes the window as a window manager does and lets files fall on it as a file manager does.
set -u
here=$(cd "$(dirname "$0")" && pwd)
palpate=$1 work=$2 client=$3
for tool in Xvfb xdotool "$client"; do
    command -v "$tool" >/dev/null 2>&1 || { echo "$tool is missing"; exit 77; }
done
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view 2>&1 </dev/null | grep -q 'made without GLFW' && { echo 'palpate opens no windows in this build'; exit 77; }
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1
XDG_CONFIG_HOME=$work/config
export XDG_CONFIG_HOME

# A display of our own, of a number that is free.
mkfifo number
# -noreset: otherwise the server starts anew whenever its last client leaves, and refuses whom it meets meanwhile.
Xvfb -displayfd 3 -noreset -screen 0 1400x900x24 3>number 2>xvfb.log &
server=$!
read -r display <number
DISPLAY=:$display
export DISPLAY
window= program=
finish() {
    [ -n "$program" ] && kill -9 "$program" 2>/dev/null
    kill "$server" 2>/dev/null
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

long=120 # [s] for what takes a second: an instrumented program beside others has needed more than 20
failed=0 solver=host # a patch takes lavapipe as long as some pictures
validate=--validate  # the pictures' device
fail() { echo "FAILED: $*"; failed=1; }
. "$here/../../support/validation_layer.sh"
# waits until something holds: description, seconds, command
until_() {
    what=$1 patience=$2
    shift 2
    n=0
    while ! "$@" >/dev/null 2>&1; do
        n=$((n + 1))
        [ $n -gt $((patience * 10)) ] && { fail "$what: not within $patience s"; return 1; }
        kill -0 "$program" 2>/dev/null || { fail "$what: the program has ended"; cat out err; return 1; }
        sleep 0.1
    done
}
# waits until the program has ended, in good order: description
ended() {
    n=0
    while kill -0 "$program" 2>/dev/null && [ $n -lt $((long * 10)) ]; do n=$((n + 1)); sleep 0.1; done
    kill -0 "$program" 2>/dev/null && { fail "$1 does not end it within $long s"; kill -9 "$program"; return; }
    wait "$program"
    status=$?
    program=
    [ $status -eq 0 ] || fail "$1: exit status $status"
}
# starts it with these arguments more, and waits for the window
start() {
    : >err
    # shellcheck disable=SC2086  # a word or none
    "$palpate" view "$@" --size 640x480 $validate --json --solver "$solver" >out 2>>err &
    program=$!
    until_ 'a window' $long shows || exit 1
    window=$(xdotool search --onlyvisible --name Palpate | head -1)
    until_ 'its object' $long titled ' - Palpate' || exit 1 # keys and files before that find nothing to act on
}
titled() { xdotool getwindowname "$window" | grep -qF -- "$1"; }
shows() { [ -n "$(xdotool search --onlyvisible --name Palpate)" ]; }

start sample:skin --points 4000
sleep 2 # first pictures compile the shaders
xdotool windowfocus --sync "$window" # what is held down goes to the window that has the focus

# orbit, pan, zoom
xdotool mousemove --window "$window" 500 300 mousedown 1 mousemove --window "$window" 540 320 sleep 0.3 mouseup 1
xdotool mousemove --window "$window" 500 300 mousedown 3 mousemove --window "$window" 510 300 sleep 0.3 mouseup 3
xdotool click 4 click 5
# every look
for key in v c l o s g j x t 1 3 7 f r F1 F1; do xdotool key --window "$window" $key sleep 0.1; done
# touch, recorded
xdotool key --window "$window" F5
until_ 'a recording' $long test -s session-0001/ticks.npy
xdotool mousemove --window "$window" 420 260 keydown space sleep 1 mousemove --window "$window" 440 260 sleep 1 \
    click 5 sleep 0.5 keyup space
xdotool key --window "$window" F7 sleep 0.2 key --window "$window" F5 sleep 0.5
# a recording that begins while the hand presses begins outside of the object, and letting go leaves no force
xdotool keydown space sleep 0.7 key F5 sleep 1.5 keyup space sleep 0.7 key F5 sleep 0.5
# paint, take back, paint, save
xdotool key --window "$window" b sleep 0.2 mousemove --window "$window" 420 260 mousedown 1 sleep 0.2 \
    mousemove --window "$window" 440 270 sleep 0.3 mouseup 1 sleep 0.2 key --window "$window" ctrl+z sleep 0.2 \
    key --window "$window" ctrl+y sleep 0.2 key --window "$window" ctrl+s
until_ 'a painted cloud' $long test -s skin-painted-0001.ply
# pictures, without panels and with them
xdotool key --window "$window" p
until_ 'a picture' $long test -s palpate-0001.png
xdotool key --window "$window" shift+p
until_ 'a picture of the window' $long test -s palpate-0002.png
# replay what was recorded, resize, close
xdotool key --window "$window" F6 sleep 2
xdotool windowsize "$window" 800 600 sleep 1 key --window "$window" shift+p
until_ 'a picture after the replay' $long test -s palpate-0003.png
[ "$(od -An -tu1 -j16 -N8 palpate-0003.png | tr -s ' ')" = ' 0 0 3 32 0 0 2 88' ] || fail 'after resizing a picture has not 800 x 600 px'
xdotool key --window "$window" Escape sleep 0.2
kill -0 "$program" 2>/dev/null || fail 'Escape must not quit'
"$client" "$window" close || fail 'the window cannot be asked to close'
ended 'closing the window'
[ -s err ] && { fail 'it complained:'; cat err; }
grep -q '"frames": [1-9]' out || fail 'no picture was shown'

"$palpate" info skin-painted-0001.ply >info || fail 'the painted cloud cannot be read'
grep -q stiffness info || fail 'the painted cloud has no stiffness'
"$palpate" replay session-0001 >/dev/null 2>replay # real time: refused, but read
grep -q 'real time' replay || { fail 'the recording cannot be read'; cat replay; }
grep -q '"text":"F7"' session-0001/markers.jsonl || fail 'the key F7 left no marker'
for number in 1 2; do
    "$palpate" export session-000$number --csv session-000$number.csv >/dev/null || fail "no table of recording $number"
done
last=$(tail -1 session-0002.csv | cut -d, -f11-13) # its force [N]
[ "$last" = 0,0,0 ] || fail "a force was left after letting go: $last"
# did the hand feel anything?
awk -F, 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n ~ /^force.*z/ || $n == "force_z") column = n } NR > 1 && column && ($column > 0.05 || $column < -0.05) { felt = 1 } END { exit !felt }' session-0001.csv ||
    { fail 'no force was felt while touching'; head -2 session-0001.csv; }

# Files that fall on the window: what is shown then, a recording tells.
says() { grep -q -- "$1" err; }
recorded_as() { # description, name of the cloud
    number=$((number + 1))
    session=session-000$number
    xdotool key --window "$window" F5
    until_ "$1: a recording" $long test -s $session/ticks.npy
    grep -q -- "$2" $session/session.json || { fail "$1: not what is shown"; grep -o '"cloud"[^,]*' $session/session.json; }
    xdotool key --window "$window" F5 sleep 0.3
}
fall() { "$client" "$window" drop "$@" || fail "cannot let $* fall"; }
number=2
mkdir "files of 50%"
awful="files of 50%/Ann's pad #1 ä.ply"
"$palpate" convert sample:sheet --points 1500 "$awful" >/dev/null
"$palpate" convert sample:palm --points 1500 plain.ply >/dev/null
echo '{"cloud": "sample:ear-lobe", "points": 1500, "cells": 32}' >lobe.json
echo 'this is no cloud' >text.ply
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 123456789012\nproperty float x\nproperty float y\nproperty float z\nend_header\n' >hostile.ply
mkdir empty
start sample:skin --points 1500
sleep 1
fall "$awful"
until_ 'an awful path' $long titled "Ann's pad #1"
recorded_as 'a path with blanks, an apostrophe, a percent sign and an umlaut' "Ann's pad #1"
fall lobe.json
until_ 'a scene' $long titled lobe.json
recorded_as 'a scene' sample:ear-lobe
fall plain.ply
until_ 'a cloud' $long titled plain.ply
recorded_as 'a cloud' plain.ply
[ -s err ] && { fail 'good files were complained of:'; cat err; }
for bad in text.ply hostile.ply empty; do
    fall $bad
    until_ "a sentence on $bad" $long says "palpate: $bad\|palpate: .*/$bad"
    [ "$(wc -l <err)" -eq 1 ] || { fail "$bad: not one sentence"; cat err; }
    : >err
done
recorded_as 'the object stays after bad files' plain.ply
fall session-0001
until_ 'a session' $long titled session-0001
# a hand that moved for some seconds: nothing can be recorded while it is replayed
xdotool key --window "$window" F5 sleep 0.3
[ -e session-000$((number + 1)) ] && fail 'a session is not replayed: it is being recorded'
[ -s err ] && { fail 'a session was complained of:'; cat err; }
kill -TERM "$program"
ended 'being told to end'

# A window without panels: Tab, which shows and hides them, changes nothing.
start sample:skin --points 1500 --no-panels --color plain --color-map cividis
sleep 2
for picture in palpate-0004.png palpate-0005.png; do
    xdotool key --window "$window" Tab sleep 1 key --window "$window" shift+p
    until_ 'a picture without panels' $long test -s $picture
done
cmp -s palpate-0004.png palpate-0005.png || fail 'there are panels, although none were asked for'
[ -s err ] && { fail 'a window without panels complained:'; cat err; }
kill -TERM "$program"
ended 'being told to end without panels'

# Plates and pictures on one Vulkan driver, with a hand that feels them. The environment brings the layer, to both.
layer_arrives "$palpate"
validate= solver=lavapipe
for checks in $checks_synchronization $checks_accesses; do
    layer $checks
    start sample:skin --points 1500 --cells 24
    sleep 2
    number=$((number + 1))
    xdotool windowfocus --sync "$window" key --window "$window" F5
    until_ 'a recording of plates by Vulkan' $long test -s session-000$number/ticks.npy
    xdotool mousemove --window "$window" 420 260 keydown space sleep 8 mousemove --window "$window" 430 260 sleep 2 keyup space sleep 0.5
    xdotool key --window "$window" F5 sleep 0.5
    "$client" "$window" close || fail 'the window of plates by Vulkan cannot be asked to close'
    ended 'closing the window of plates by Vulkan'
    [ -s err ] && { fail 'plates by Vulkan were complained of:'; cat err; }
    layer_is_silent "$checks"
    "$palpate" export session-000$number --csv vulkan.csv >/dev/null || fail 'the recording of plates by Vulkan cannot be read'
    awk -F, 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n == "compliance") column = n } NR > 1 && column && $column > 0 { felt = 1 } END { exit !felt }' vulkan.csv ||
        { fail "no plate by Vulkan was felt, $checks"; head -2 vulkan.csv; }
done
unset VK_LAYER_SETTINGS_PATH VK_INSTANCE_LAYERS

# Without a display there is a sentence, and another way.
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view sample:skin >out 2>err
[ $? -eq 2 ] || fail 'no display must be exit code 2'
grep -q 'palpate render' err || { fail 'no display: no advice'; cat err; }

[ $failed -eq 0 ] && echo 'the window opens, turns, touches, records, paints, saves, resizes and closes'
exit $failed

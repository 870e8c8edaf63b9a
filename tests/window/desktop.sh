#!/bin/sh
# The real window on a display without a screen, with keys and a pointer that xdotool moves, all under Vulkan's
# validation layer with synchronization checks: any message fails. Arguments: palpate, and a folder that may be emptied.
set -u
palpate=$1 work=$2
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null 2>&1 || { echo "$tool is missing"; exit 77; }
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

failed=0
fail() { echo "FAILED: $*"; failed=1; }
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
shows() { [ -n "$(xdotool search --onlyvisible --name Palpate)" ]; }

"$palpate" view sample:skin --points 4000 --size 640x480 --validate --json --device host >out 2>err &
program=$!
until_ 'a window' 60 shows || exit 1
window=$(xdotool search --onlyvisible --name Palpate | head -1)
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
until_ 'a recording' 20 test -s session-0001/samples.csv
xdotool mousemove --window "$window" 420 260 keydown space sleep 1 mousemove --window "$window" 440 260 sleep 1 \
    click 5 sleep 0.5 keyup space
xdotool key --window "$window" F5 sleep 0.5
# a recording that begins while the hand presses begins outside of the object, and letting go leaves no force
xdotool keydown space sleep 0.7 key F5 sleep 1.5 keyup space sleep 0.7 key F5 sleep 0.5
# paint, take back, paint, save
xdotool key --window "$window" b sleep 0.2 mousemove --window "$window" 420 260 mousedown 1 sleep 0.2 \
    mousemove --window "$window" 440 270 sleep 0.3 mouseup 1 sleep 0.2 key --window "$window" ctrl+z sleep 0.2 \
    key --window "$window" ctrl+y sleep 0.2 key --window "$window" ctrl+s
until_ 'a painted cloud' 20 test -s skin-painted-0001.ply
# pictures, without panels and with them
xdotool key --window "$window" p
until_ 'a picture' 40 test -s palpate-0001.png
xdotool key --window "$window" shift+p
until_ 'a picture of the window' 40 test -s palpate-0002.png
# replay what was recorded, resize, close
xdotool key --window "$window" F6 sleep 2
xdotool windowsize "$window" 800 600 sleep 1 key --window "$window" shift+p
until_ 'a picture after the replay' 40 test -s palpate-0003.png
[ "$(od -An -tu1 -j16 -N8 palpate-0003.png | tr -s ' ')" = ' 0 0 3 32 0 0 2 88' ] || fail 'after resizing a picture has not 800 x 600 px'
xdotool key --window "$window" Escape sleep 0.2
kill -0 "$program" 2>/dev/null || fail 'Escape must not quit'
kill -TERM "$program" # without a window manager nothing can ask the window itself
n=0
while kill -0 "$program" 2>/dev/null && [ $n -lt 200 ]; do n=$((n + 1)); sleep 0.1; done
wait "$program"
status=$?
program=
[ $status -eq 0 ] || fail "exit status $status"
[ -s err ] && { fail 'it complained:'; cat err; }
grep -q '"frames": [1-9]' out || fail 'no picture was shown'

"$palpate" info skin-painted-0001.ply >info || fail 'the painted cloud cannot be read'
grep -q stiffness info || fail 'the painted cloud has no stiffness'
"$palpate" replay session-0001 >/dev/null 2>replay # real time: refused, but read
grep -q 'real time' replay || { fail 'the recording cannot be read'; cat replay; }
last=$(tail -1 session-0002/samples.csv | cut -d, -f11-13) # its force [N]
[ "$last" = 0,0,0 ] || fail "a force was left after letting go: $last"
# did the hand feel anything?
awk -F, 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n ~ /^force.*z/ || $n == "force_z") column = n } NR > 1 && column && ($column > 0.05 || $column < -0.05) { felt = 1 } END { exit !felt }' session-0001/samples.csv ||
    { fail 'no force was felt while touching'; head -2 session-0001/samples.csv; }

# Without a display there is a sentence, and another way.
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view sample:skin >out 2>err
[ $? -eq 2 ] || fail 'no display must be exit code 2'
grep -q 'palpate render' err || { fail 'no display: no advice'; cat err; }

[ $failed -eq 0 ] && echo 'the window opens, turns, touches, records, paints, saves, resizes and closes'
exit $failed

#!/bin/sh
# The X server is killed at random instants of a window's life: while it opens, while its object is read, while a hand
# touches and is recorded. Arguments: palpate, and a folder that may be emptied.
#
# Expected each time: an exit of the program's own, one sentence, and a recording, where one was begun, that is whole.
# PALPATE_INSTANTS says how many instants (3) beside two that are always the same, when the window opens and while a hand is
# recorded; PALPATE_LATEST by when [s].
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/tests/support/sessions.sh"
latest=${PALPATE_LATEST:-5} # [s] after the start: by then the hand has touched for two seconds
unset PALPATE_LATEST
palpate=$1 work=$2 instants=${PALPATE_INSTANTS:-3}
unset PALPATE_INSTANTS # it is no key of a scene
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null 2>&1 || { echo "$tool is missing"; exit 77; }
done
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view 2>&1 </dev/null | grep -q 'made without GLFW' && { echo 'palpate opens no windows in this build'; exit 77; }
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1
XDG_CONFIG_HOME=$work/config
export XDG_CONFIG_HOME
failed=0 server= program=
fail() { echo "FAILED: killed at $after [s]: $*"; failed=$((failed + 1)); }
finish() {
    for process in $program $server; do kill -9 "$process" 2>/dev/null; done
    [ -z "$server" ] || rm -f "/tmp/.X$display-lock" "/tmp/.X11-unix/X$display" # which a killed server leaves
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

attempt() {
    rm -rf session-* number
    mkfifo number
    Xvfb -displayfd 3 -noreset -screen 0 800x600x24 3>number 2>xvfb.log &
    server=$!
    read -r display <number
    DISPLAY=:$display "$palpate" view sample:skin --points 1500 --size 640x480 --solver host >out 2>err &
    program=$!
    # The hand, which fails where the display has gone. The window has the object's name once keys find it.
    (
        window= n=0
        while [ -z "$window" ] && [ $n -lt 1200 ]; do
            sleep 0.1
            n=$((n + 1))
            window=$(DISPLAY=:$display timeout 2 xdotool search --onlyvisible --name " - Palpate" 2>/dev/null | head -n 1)
        done
        [ -n "$window" ] && DISPLAY=:$display timeout 10 xdotool windowfocus --sync "$window" key --window "$window" F5 \
            mousemove --window "$window" 200 130 keydown space sleep 3
    ) >/dev/null 2>&1 &
    hand=$!
    if [ "$after" = opened ]; then
        n=0
        while [ -z "$(DISPLAY=:$display xdotool search --name Palpate 2>/dev/null)" ] && [ $n -lt 1200 ]; do n=$((n + 1)); sleep 0.02; done
    elif [ "$after" = recorded ]; then # at whatever time a hand is recorded
        n=0
        while [ ! -s session-0001/ticks.npy ] && [ $n -lt 1200 ]; do n=$((n + 1)); sleep 0.1; done
        [ -s session-0001/ticks.npy ] || fail 'no session was recorded'
        sleep 1
    else
        sleep "$after"
    fi
    kill -9 "$server"
    n=0
    while kill -0 "$program" 2>/dev/null && [ $n -lt 600 ]; do n=$((n + 1)); sleep 0.1; done
    kill -0 "$program" 2>/dev/null && { fail 'the program outlives its display by a minute'; kill -9 "$program"; }
    wait "$program"
    status=$?
    program=
    kill $hand 2>/dev/null
    wait "$server" 2>/dev/null
    rm -f "/tmp/.X$display-lock" "/tmp/.X11-unix/X$display"
    server=
    [ $status -eq 2 ] || fail "exit status $status"
    { [ "$(wc -l <err)" -eq 1 ] && grep -q '^palpate: .*display' err; } || { fail 'not one sentence of the display:'; cat err; }
    [ -e session-0001 ] || return
    recorded=$((recorded + 1))
    grep -q '"finished": true' session-0001/session.json || fail 'the recording has no end'
    "$palpate" export session-0001 --csv last.csv >/dev/null 2>err || { fail 'the recording cannot be read'; cat err; }
}

# device: a hand over UDP presses while the display goes; the last that it is told is no force.
device() {
    rm -f number
    mkfifo number
    Xvfb -displayfd 3 -noreset -screen 0 800x600x24 3>number 2>xvfb.log &
    server=$!
    read -r display <number
    python3 "$root/samples/bridge_peer.py" 24304 "$1" >peer.txt &
    peer=$!
    DISPLAY=:$display "$palpate" view sample:sheet --points 1500 --size 400x320 --solver host --hand bridge:udp:24304 >out 2>err &
    program=$!
    sleep "$2"
    kill -9 "$server"
    wait "$server" 2>/dev/null
    rm -f "/tmp/.X$display-lock" "/tmp/.X11-unix/X$display"
    server=
    wait $program
    status=$?
    program=
    wait $peer
    [ $status -eq 2 ] && grep -q '^palpate: .*display' err || fail "a device in the hand: exit status $status: $(cat err)"
    was_pushed_and_let_go peer.txt || fail "a device in the hand: $(cat peer.txt)"
}

recorded=0
for after in $(awk -v n="$instants" -v latest=$latest 'BEGIN { srand(); for (k = 0; k < n; ++k) print (k + rand()) / n * latest }') opened recorded; do attempt; done
after=pushed
if command -v python3 >/dev/null; then
    device 20 6
else
    echo 'skipped: a device while its display goes, there is no python3'
fi
echo "$((instants + 2)) times the display went, $recorded times while a session was recorded; $failed times something was wrong"
[ $failed -eq 0 ]

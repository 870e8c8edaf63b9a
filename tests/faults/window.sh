#!/bin/sh
# The disk of a window fails: somebody records a touch, paints, saves that and takes a picture, and one of the calls that change
# files fails, or all from that one on. Arguments: palpate, the library of failing_files.cpp, and palp_desktop_client, which
# closes the window as a window manager does. PALPATE_INSTANTS says how many calls fail in each way (2); 0 means each.
#
# Expected each time: an exit of the program's own; what is there is whole, or a sentence says that it is not; and paint is saved
# somewhere, or the program ends with 1 and says that it is lost.
set -u
palpate=$1 failing_files=$(realpath "$2") client=$(realpath "$3") instants=${PALPATE_INSTANTS:-2}
unset PALPATE_INSTANTS # it is no key of a scene
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null 2>&1 || { echo "$tool is missing"; exit 77; }
done
env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view 2>&1 </dev/null | grep -q 'made without GLFW' && { echo 'palpate opens no windows in this build'; exit 77; }
. "$(dirname "$0")/checks.sh"
mkfifo number
Xvfb -displayfd 3 -noreset -screen 0 800x600x24 3>number 2>xvfb.log &
server=$! program=
trap 'for process in $program $server; do kill -9 "$process" 2>/dev/null; done; rm -rf "$work"' EXIT
read -r display <number
DISPLAY=:$display
export DISPLAY

# until_ WHAT COMMAND...: waits until it holds, for two minutes, or until the program has ended.
until_() {
    what=$1 looks=0
    shift
    while ! "$@" >/dev/null 2>&1; do
        kill -0 "$program" 2>/dev/null || return 1
        looks=$((looks + 1))
        [ $looks -le 1200 ] || { complain "$fault: no $what within two minutes"; return 1; }
        sleep 0.1
    done
}
titled() { window=$(xdotool search --onlyvisible --name ' - Palpate' | head -n 1) && [ -n "$window" ]; }
gone() { ! kill -0 "$program" 2>/dev/null; }

# attempt VARIABLE=VALUE: a window whose files fail so, left in place/ and err.txt.
attempt() {
    fault=$1
    rm -rf place home draft calls
    mkdir place home draft
    (cd place && exec env "$fault" LD_PRELOAD="$failing_files" HOME="$work/home" XDG_CONFIG_HOME="$work/home" TMPDIR="$work/draft" \
        "$palpate" view sample:skin --points 1500 --size 640x480 --solver host) >out.txt 2>err.txt &
    program=$!
    if until_ 'window' titled; then
        xdotool windowfocus --sync "$window" key --window "$window" F5 mousemove --window "$window" 420 260 keydown space sleep 0.6 \
            keyup space sleep 0.3 key --window "$window" F5 sleep 0.2 key --window "$window" b sleep 0.2 mousedown 1 sleep 0.2 \
            mousemove --window "$window" 440 270 sleep 0.2 mouseup 1 sleep 0.2 key --window "$window" ctrl+s sleep 0.2 \
            key --window "$window" p sleep 0.3 >/dev/null 2>&1
        "$client" "$window" close >/dev/null 2>&1
        looks=0
        while ! gone && [ $looks -lt 20 ]; do looks=$((looks + 1)); sleep 0.1; done
        gone || "$client" "$window" close >/dev/null 2>&1 # the first request says that paint is not saved
    fi
    until_ 'end' gone
    gone || kill -9 "$program"
    wait "$program"
    status=$?
    program=
    judge
}

judge() {
    [ $status -le 2 ] || { complain "$fault: ended by a signal, status $status: $(head -n 2 err.txt)"; return; }
    [ $status -eq 0 ] || has_sentence || { complain "$fault: exit $status without a sentence: $(cat err.txt)"; return; }
    ! grep -q 'internal error' err.txt || { complain "$fault: $(cat err.txt)"; return; }
    ! find place home draft -name '*.part' | grep -q . || { complain "$fault: a part of a file is left"; return; }
    painted=0
    for file in place/*.ply home/*.ply draft/*.ply; do
        [ -e "$file" ] || continue
        "$palpate" info "$file" 2>&1 | grep -q 1500 && painted=$((painted + 1)) || { complain "$fault: $file is not whole"; return; }
    done
    if [ $painted -eq 0 ] && ! { [ $status -eq 1 ] && grep -q 'paint' err.txt; }; then
        complain "$fault: exit $status, and the paint is lost without a word: $(cat err.txt)"
        return
    fi
    for file in place/*.png; do
        [ ! -e "$file" ] || [ "$(tail -c 8 "$file" | head -c 4)" = IEND ] || { complain "$fault: the picture is not whole"; return; }
    done
    if grep -q '"finished": true' place/session-0001/session.json 2>/dev/null; then
        forces_are_good place/session-0001 some || { complain "$fault: the recording is not what it says"; return; }
    elif ! grep -q 'record\|session-0001' err.txt; then
        complain "$fault: the recording has no end, and nothing says so: $(cat err.txt)"
        return
    fi
    [ -e place/palpate-0001.png ] || grep -q 'picture\|png' err.txt || { complain "$fault: there is no picture, and nothing says so: $(cat err.txt)"; return; }
    pass
}

attempt "FAILING_FILES_COUNT=$work/calls"
[ -e place/session-0001 ] && [ -e place/skin-painted-0001.ply ] && [ -e place/palpate-0001.png ] || complain "without a fault: $(ls place) $(cat err.txt)"
calls=$(cat calls 2>/dev/null || echo 0) most=$instants n=0
[ "$calls" -gt 0 ] || complain 'a window changes no file: are its calls counted?'
[ "$most" -gt 0 ] && [ "$most" -lt "$calls" ] || most=$calls
while [ $n -lt "$most" ]; do
    for as in AT ONCE; do attempt "FAILING_FILES_$as=$((n * calls / most + 1))"; done
    n=$((n + 1))
done
conclude

#!/bin/sh
# A Vulkan driver that fails at its n-th call, n spread over the whole life of a program: calls without memory, a processor
# that is lost from then on, one that never finishes, and one that takes the program with it. Arguments: the program, the folder of
# the layer's manifest (tests/compute/failing_layer.cpp), the library of failing_files.cpp, and the build's sanitizers. The environment names lavapipe.
#
# Expected each time: an exit of the program's own, with a sentence if it is not 0; an answer that is the good one, because
# the host took over; of a session every tick, with a force that is finite and at most the limit.
# PALPATE_INSTANTS says how many calls of each command fail in each way (4); 0 means every call, which takes an hour.
# PALPATE_WAYS and PALPATE_COMMANDS choose among "memory lost hang crash" and "touch run render view".
set -u
palpate=$1 layer=$(realpath "$2") failing_files=$(realpath "$3") sanitizers=${4:-} instants=${PALPATE_INSTANTS:-4}
ways=${PALPATE_WAYS:-memory lost hang crash} chosen=${PALPATE_COMMANDS:-}
unset PALPATE_INSTANTS PALPATE_WAYS PALPATE_COMMANDS # they are no keys of a scene
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/checks.sh"
. "$root/tests/support/sessions.sh"
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$work"' EXIT
seconds=1.5 # of a window; a sanitized one takes longer to draw its first panel
twice='1 2'   # the first call of a kind and the next
larger='14 15 16 17 18' # buffers of a window without plates, among them those that panels have in place of smaller ones
[ -z "$sanitizers" ] || seconds=4 twice=1
# shellcheck disable=SC3045
ulimit -c 0 2>/dev/null # what a driver ends need leave no core
export VK_LAYER_PATH="$layer" VK_INSTANCE_LAYERS=VK_LAYER_PALPATE_failing FAILING_LAYER_COUNT="$work/count"

arguments() { # of a command
    case $1 in
    touch) echo 'touch sample:sheet --points 2000 --cells 16 --solver lavapipe --json' ;;
    run) echo 'run sample:sheet --points 2000 --cells 16 --solver lavapipe --clock virtual --seconds 0.4 --json --record recorded' ;;
    view) echo 'view sample:sheet --points 2000 --cells 16 --size 400x320 --solver lavapipe --draw-on lavapipe --hand press --seconds '$seconds ;;
    panels) echo 'view sample:sheet --points 2000 --cells 16 --size 400x320 --solver host --draw-on lavapipe --hand press --seconds '$seconds ;;
    render) echo 'render sample:sheet --points 2000 --cells 16 --size 120x90 --solver host --draw-on lavapipe --out picture.png' ;;
    esac
}
number() { sed -n "s/^ *\"$1\": \([-0-9.e+]*\),*\$/\1/p" "$2" | head -n 1; }
isnear() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a - b <= 0.01 * b && b - a <= 0.01 * b) }'; }

# judge COMMAND WHAT STATUS
judge() {
    if [ "$3" -ge 124 ]; then complain "$2 ended by a signal or not at all, status $3: $(tail -n 3 err.txt)"; return; fi
    if [ "$3" -ne 0 ]; then
        if ! has_sentence; then
            complain "$2: exit $3 without a sentence: $(cat err.txt)"
        elif [ -s picture.png ]; then
            complain "$2: exit $3, and a picture"
        elif [ -s recorded/ticks.npy ] && ! forces_are_good recorded some; then
            complain "$2: exit $3, and a bad tick"
        else
            pass
        fi
        return
    fi
    case $1 in
    touch) isnear "$(number felt_stiffness out.txt)" "$felt" || { complain "$2: another answer: $(number felt_stiffness out.txt)"; return; } ;;
    run) forces_are_good recorded 400 || { complain "$2: a bad tick"; return; } ;;
    render) cmp -s picture.png good.png || { complain "$2: another picture"; return; } ;;
    esac
    pass
}

# judge_crash COMMAND WHAT STATUS: the driver has ended the program, which is to a device what kill -9 is. What was recorded is
# there, and no half of a picture.
judge_crash() {
    if [ "$3" -ne 134 ] && { [ "$1" != view ] || [ "$3" -ne 0 ]; }; then
        complain "$2: exit $3, not 134: $(tail -n 3 err.txt)"
    elif [ -e picture.png ] && ! cmp -s picture.png good.png; then
        complain "$2: there is half a picture"
    elif [ "$(wc -c 2>/dev/null <recorded/ticks.npy || echo 0)" -gt 2000 ] && ! forces_are_good recorded some; then
        complain "$2: a bad tick"
    else
        pass
    fi
}

# attempt COMMAND AS N
attempt() {
    rm -rf recorded picture.png
    # shellcheck disable=SC2046
    FAILING_LAYER_AS=$2 FAILING_LAYER_AT=$3 LD_DEBUG=${debug:-} timeout -s KILL 120 "$palpate" $(arguments "$1") >out.txt 2>err.txt </dev/null
    status=$?
    if [ "$2" = crash ]; then judge_crash "$1" "$1, $2 at call $3" $status; else judge "$1" "$1, $2 at call $3" $status; fi
}

# A window needs a display; its session is in real time, so that a call is another one each time.
commands='touch run render' XDG_CONFIG_HOME=$work/config
export XDG_CONFIG_HOME
if ! command -v Xvfb >/dev/null 2>&1; then
    echo 'skipped: a window whose driver fails, there is no Xvfb'
elif ! env -u DISPLAY -u WAYLAND_DISPLAY "$palpate" view 2>&1 </dev/null | grep -q 'made without GLFW'; then
    mkfifo number
    Xvfb -displayfd 3 -noreset -screen 0 800x600x24 3>number 2>/dev/null &
    server=$!
    read -r display <number
    DISPLAY=:$display commands="$commands view"
    export DISPLAY
else
    echo 'skipped: a window whose driver fails, this build opens none'
fi

# shellcheck disable=SC2046
"$palpate" $(arguments touch) >out.txt 2>err.txt || { cat err.txt; exit 1; }
felt=$(number felt_stiffness out.txt)
for command in ${chosen:-$commands}; do
    # shellcheck disable=SC2046
    "$palpate" $(arguments $command) >out.txt 2>err.txt || { cat err.txt; exit 1; }
    calls=$(cat count)
    [ $command != render ] || mv picture.png good.png
    [ "$calls" -gt 40 ] || complain "$command makes $calls calls only: are they counted?"
    for as in $ways; do
        most=$instants n=0
        [ "$most" -gt 0 ] || most=$calls
        [ $command != view ] || [ "$most" -le 300 ] || most=300 # of the thousands of a window's pictures
        while [ $n -lt "$most" ]; do # in equal shares of the calls, at another place of each for each way
            attempt $command $as "$(awk -v n=$n -v most="$most" -v calls="$calls" -v as=$as 'BEGIN { srand(index("memory lost hang crash", as)); print most == calls ? n + 1 : int((n + rand()) * calls / most) + 1 }')"
            n=$((n + 1))
        done
    done
done

# What happens to each kind of call of a solve once the processor is open: the host takes over, and says so.
export FAILING_LAYER_AS=memory
for call in vkAllocateMemory vkMapMemory vkBindBufferMemory vkResetFences vkQueueSubmit vkWaitForFences; do
    FAILING_LAYER_ONLY=$call attempt touch memory 3
    grep -q 'the host took over' err.txt && pass || complain "touch, $call: the host did not take over: $(cat err.txt)"
done

# A driver that is left at work may crash when the program's own exit handlers end it: they are not run.
debug=files
attempt touch memory 0 # none fails
grep -q 'calling fini: .*embree' err.txt && pass || complain 'touch: no exit handler is told of'
FAILING_LAYER_ONLY=vkWaitForFences attempt touch hang 1
debug=
grep -q 'calling fini: .*embree' err.txt && complain 'touch, a driver that is left at work: exit handlers are run' || pass
grep -q 'the host took over' err.txt && pass || complain "touch, a wait without end: the host did not take over"

# And to what a window makes for its pictures: it went on without images that could not be made, and asked for panels twice.
case $commands in
*view*)
    made() { [ -s count ] && [ "$(cat count)" -ge 1 ]; }
    for call in vkCreateImage vkCreateSampler vkCreateDescriptorSetLayout vkCreateFramebuffer vkCreateBuffer vkCreateSwapchainKHR vkGetSwapchainImagesKHR vkAcquireNextImageKHR vkQueuePresentKHR; do
        for at in $twice; do
            rm -f count
            FAILING_LAYER_ONLY=$call attempt view memory $at
            made || { # on a busy machine the first panel comes later
                usual=$seconds seconds=20
                FAILING_LAYER_ONLY=$call attempt view memory $at
                seconds=$usual
            }
            made && pass || complain "view makes no call $call: does it fail?"
        done
    done
    # Panels whose buffers cannot be made larger: the back end had freed them, and freed them again at the next picture.
    met=
    for at in $larger; do
        FAILING_LAYER_ONLY=vkCreateBuffer MALLOC_PERTURB_=165 attempt panels memory $at
        ! grep -q 'draw a panel' err.txt || met=1
    done
    [ -n "$met" ] && pass || complain 'none of these buffers is a panel'"'"'s'
    for as in lost hang; do
        for call in vkAcquireNextImageKHR vkQueuePresentKHR; do FAILING_LAYER_ONLY=$call attempt view $as 3; done
    done
    ;;
esac

# A driver that crashes beneath a session whose device pushes: the guardian tells the device zero.
if [ -z "$sanitizers" ] && ! command -v python3 >/dev/null; then
    echo 'skipped: a driver that crashes while a device pushes, there is no python3'
elif [ -z "$sanitizers" ]; then
    peer_of() { python3 "$root/samples/bridge_peer.py" 24303 "$1" >peer.txt & }
    device='run sample:sheet --points 2000 --cells 16 --solver lavapipe --hand bridge:udp:24303 --seconds 6'
    peer_of 9
    # shellcheck disable=SC2086
    FAILING_LAYER_AS=crash FAILING_LAYER_AT=0 FAILING_LAYER_ONLY=vkQueueSubmit "$palpate" $device >out.txt 2>err.txt </dev/null # none
    wait $!
    submits=$(cat count)
    was_pushed_and_let_go peer.txt && pass || complain "a device over UDP without a fault: $(cat peer.txt err.txt)"
    for share in 7 8 6 9; do # of a real session's calls; one that crashes before the hand feels anything shows nothing
        peer_of 9
        # shellcheck disable=SC2086
        FAILING_LAYER_AS=crash FAILING_LAYER_AT=$((submits * share / 10)) FAILING_LAYER_ONLY=vkQueueSubmit "$palpate" $device >out.txt 2>err.txt </dev/null
        status=$?
        wait $!
        [ $status -ne 134 ] || grep -q 'rendered at most 0.00' peer.txt || break
    done
    [ $status -eq 134 ] && was_pushed_and_let_go peer.txt && pass || complain "a driver that crashed while a device pushed, exit $status: $(cat peer.txt err.txt)"
fi

# A driver keeps what it has compiled in files of its own. Where these cannot be written nobody feels it.
unset VK_INSTANCE_LAYERS FAILING_LAYER_AS FAILING_LAYER_ONLY
compile() { # as if for the first time
    rm -rf shaders files
    # shellcheck disable=SC2046
    env MESA_SHADER_CACHE_DIR="$work/shaders" LD_PRELOAD="$failing_files" FAILING_FILES_COUNT=files "$@" "$palpate" $(arguments touch) >out.txt 2>err.txt
    status=$?
    judge touch "touch, $*" $status
    [ $status -eq 0 ] || complain "touch, $*: exit $status"
    [ "${1##*=}" -le "$(cat files)" ] || complain "touch, $*: it wrote $(cat files) times only"
}
if [ -z "$sanitizers" ]; then # which want to be loaded first
    compile FAILING_FILES_AT=0
    writes=$(cat files 2>/dev/null || echo 0)
    [ "$writes" -gt 2 ] || complain "the driver wrote its files $writes times only: where are they?"
    for at in 1 2 3 $((writes / 2)); do # another thread writes, perhaps fewer times
        for way in AT ONCE; do compile FAILING_FILES_$way="$at"; done
    done
fi

conclude

#!/bin/sh
# falcon_demo with the emulated Falcon, from its upload to its last packet. Arguments: the program, the checkout.
set -u
demo=$1 checkout=$2
place=$(mktemp -d "${TMPDIR:-/tmp}/palpate demo XXXXXX") || exit 1
trap 'rm -rf "$place"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
cd "$place" || exit 1
unset FALCON_FIRMWARE
XDG_CONFIG_HOME=$place/config # no calibration of the user's
export XDG_CONFIG_HOME

failed=0
complain() { echo "FAILED: $*"; failed=1; }
holds() { grep -qE -- "$1" out.txt || complain "output lacks '$1': $(cat out.txt err.txt)"; }
run() { # run EXPECTED-EXIT-CODE PROGRAM ARGUMENTS...
    expected=$1; shift
    "$@" >out.txt 2>err.txt
    code=$?
    [ $code -eq "$expected" ] || complain "$*: exit $code, expected $expected: $(cat out.txt err.txt)"
}
bad() { # bad WORDS ARGUMENTS...: exit code 2, one line on standard error that holds WORDS, before anything happens
    words=$1; shift
    run 2 "$demo" --scenes "$checkout/samples/scenes" "$@"
    { grep -qF -- "$words" err.txt && [ "$(wc -l <err.txt)" -eq 1 ]; } || complain "$*: '$words' is not the line: $(cat err.txt)"
}

run 0 "$demo" --emulator --seconds 2 --scenes "$checkout/samples/scenes"
holds '^scene   palm_wart'
holds '^device  an emulated Falcon'
holds '^upload  8000 of 8000 bytes, each came back'
holds '^homing  home the emulated Falcon: pull the grip all the way out'
holds '^homing  done'
holds '^felt    [0-9.]+ s, in contact [1-9][0-9]* % of it; force at most [0-9.]+ m?N, depth at most [0-9.]+ [mu]m$'
holds '^wire    [0-9]{4,} packets; the last one asked for no force$'
lights=$(sed -n 's/^light   \([a-z]*\) .*/\1/p' out.txt | tr '\n' ' ')
case $lights in
'red blue green ') ;;
'red blue green '*) grep -q '^plate   it did not answer' out.txt || complain "the light went out without a word: $(cat out.txt)" ;; # a busy machine
*) complain "the light was not red, blue, green: $(cat out.txt)" ;;
esac

rm out.txt # or its "feel" is taken for the next one's
# Ctrl-C: a background job of a script ignores it, SIGTERM goes the same way.
"$demo" --emulator --seconds 600 --scenes "$checkout/samples/scenes" >out.txt 2>err.txt &
pid=$!
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30; do grep -qs '^feel ' out.txt && break; sleep 1; done
kill -TERM $pid
wait $pid
code=$?
[ $code -eq 0 ] || complain "ended by a signal: exit $code: $(cat out.txt err.txt)"
holds '^wire .*no force$'

# An installation that was moved finds its scenes.
mkdir -p moved/bin moved/share/palpate && cp "$demo" moved/bin && cp -R "$checkout/samples/scenes" moved/share/palpate
run 0 moved/bin/falcon_demo --list
for scene in "$checkout"/samples/scenes/[a-z]*[a-z].json; do
    name=$(basename "$scene" .json)
    case $name in *.schema | nodule_hunt) continue ;; esac # a hunt has keys that only a tool reads
    holds "^  $name  *[A-Z].{30,}\.$"
done
grep -qE 'schema|nodule_hunt' out.txt && complain "neither the schema nor a hunt is a scene of the library: $(cat out.txt)"
mkdir alone && cp "$demo" alone
run 2 alone/falcon_demo --list
grep -qF -- '--scenes' err.txt || complain "no scenes: $(cat err.txt)"

bad 'there is no scene "elbow" in' elbow --emulator
bad 'nowhere.json' nowhere.json --emulator
printf '{"cloud": "sample:sheet", "thicknes": 0.004}' >wrong.json
bad 'did you mean' wrong.json --emulator
bad '--seconds' --seconds -1
bad 'frobnicate' --frobnicate
for counts in 1 1999 10001 50000 nan; do bad '--falcon-counts' --emulator --falcon-counts $counts; done
printf 'short' >image.bin
run 2 "$demo" --emulator --falcon-firmware image.bin --scenes "$checkout/samples/scenes"
grep -qF '5 bytes long; expected' err.txt || complain "a firmware that is none: $(cat err.txt)"
grep -q '^upload' out.txt && complain "a firmware that is none was uploaded: $(cat out.txt)"

[ $failed -eq 0 ] && echo 'the demo runs from upload to the last packet'
exit $failed

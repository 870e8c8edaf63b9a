#!/bin/sh
# Hunts and studies as their users meet them: scored, recorded, resumed after a crash, analysed, and refused in one
# sentence. Arguments: the program, and the checkout.
set -u
exec </dev/null # whoever runs this may leave a keyboard open, and a study would wait for it
palpate=$1 samples=$2/samples
place=$(mktemp -d "${TMPDIR:-/tmp}/palpate studies XXXXXX") || exit 1
trap 'rm -rf "$place"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
cd "$place" || exit 1

failed=0 passed=0
complain() { echo "FAILED: $*"; failed=$((failed + 1)); }
pass() { passed=$((passed + 1)); }
good() { # good DESCRIPTION ARGUMENTS...: exit code 0; standard input from the file "input"
    what=$1; shift
    if "$palpate" "$@" >out.txt 2>err.txt <input; then pass; else complain "$what: exit $? $(cat err.txt)"; fi
}
holds() { grep -qF -- "$1" out.txt && pass || complain "output lacks '$1': $(head -c 900 out.txt)"; }
bad() { # bad DESCRIPTION WORD ARGUMENTS...: exit code 2, one line that holds WORD, nothing on standard output
    what=$1 word=$2; shift 2
    "$palpate" "$@" >out.txt 2>err.txt <input
    code=$?
    [ $code -eq 2 ] || { complain "$what: exit $code, expected 2: $(cat err.txt)"; return; }
    grep -qF -- "$word" err.txt || { complain "$what: '$word' is not in: $(cat err.txt)"; return; }
    [ "$(wc -l <err.txt)" -eq 1 ] || { complain "$what: more than one line: $(cat err.txt)"; return; }
    [ ! -s out.txt ] && pass || complain "$what: printed something to standard output"
}
: >input

# --- a hunt
scene=$samples/scenes/nodule_hunt.json hand=$samples/scenes/nodule_hunt_hand.csv
good 'a scripted hand hunts' hunt "$scene" --hand "$hand" --clock virtual --record session --out hunt.svg --json
for word in '"found": 3' '"false_alarms": 1' '"mark_formula"' '"edge_traced": 1.0' '"declared_in_air": 0'; do holds "$word"; done
grep -E '"(found|mark|coverage|impulse_N_s|time_s)"' out.txt >live.txt
grep -q 'Nodules found: 3 of 4' hunt.svg && pass || complain 'the picture does not say what was found'
good 'the recording scores the same' hunt --score session --json
grep -E '"(found|mark|coverage|impulse_N_s|time_s)"' out.txt | cmp -s - live.txt && pass || complain 'a recording scores otherwise'
good 'as a table' hunt --score session
holds 'found 3 of 4 nodules, 1 false alarm;'
cp -r session cut && sed -i 's/"lost": 0/"lost": 7/' cut/session.json
good 'one that lacks ticks' hunt --score cut
grep -q 'cut is not complete: it lacks 7 ticks' err.txt && pass || complain "a score of a part: $(cat err.txt)"
good 'in real time' hunt "$scene" --hand "$hand" --seconds 1
holds 'nothing was declared'
good 'hidden anew' hunt "$scene" --hand "$hand" --clock virtual --hunt-seed 7 --json
holds '"found": '
grep -A3 centre_m out.txt >seven.txt
good 'the same again' hunt "$scene" --hand "$hand" --clock virtual --hunt-seed 7 --json
grep -A3 centre_m out.txt | cmp -s - seven.txt && pass || complain 'the same seed hides elsewhere'
good 'another seed' hunt "$scene" --hand "$hand" --clock virtual --hunt-seed 8 --json
grep -A3 centre_m out.txt | cmp -s - seven.txt && complain 'another seed hides at the same places' || pass
bad 'nothing is hidden' 'nothing is hidden' hunt "$samples/scenes/skin_wart.json" --clock virtual
bad 'a seed of nothing' 'nothing is hidden' hunt "$samples/scenes/skin_wart.json" --hunt-seed 3
bad 'a solver of a score' '--solver has no effect with --score' hunt --score session --solver host
bad 'a seed of a score' '--hunt-seed has no effect with --score' hunt --score session --hunt-seed 3 --json
bad 'both a scene and a recording' '--score' hunt "$scene" --score session
bad 'no recording' 'session.json' hunt --score nowhere
cp "$scene" scene.json
bad 'a picture over the scene' 'ends in .svg' hunt scene.json --hand "$hand" --clock virtual --out scene.json
cmp -s "$scene" scene.json && pass || complain 'a hunt wrote over its scene'
bad 'a picture over a recording' 'ends in .svg' hunt --score session --out session/session.json
bad 'no default scene here' 'name a scene file' hunt
bad 'a file is no recording' 'palpate run --record' hunt --score hunt.svg
bad 'a nodule out of the ground' '"ground"' hunt "$scene" --hunt '{"nodules":[{"at":[0.03,0,0],"radius":0.004,"modulus":1e6}],"ground":0.02}'
bad 'a nodule like the rest' 'key "modulus"' hunt "$scene" --hunt '{"nodules":[{"at":[0,0,0],"radius":0.004,"modulus":3e5}]}'
bad 'a press that is too hard' 'key "press_force"' hunt "$scene" --hunt '{"nodules":[{"at":[0,0,0],"radius":0.004,"modulus":1e6}],"press_force":3,"too_hard":1}'
bad 'a hunt as a flag' 'nodule 1' hunt "$scene" --hunt '{"nodules":[{"at":[0,0,0],"radius":"nan","modulus":1e6}]}'

# --- a study
cat >sheet.json <<'JSON'
{"cloud": "sample:sheet", "points": 4000, "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 16, "footprint_radius": "4.4 mm"}
JSON
cat >plan.json <<'JSON'
{"title": "t", "seconds": 1.6, "hand": "press", "conditions": [
 {"name": "SECRETSOFT", "scene": "sheet.json", "values": {"stiffness": {"law": "constant", "value": 3e5}}},
 {"name": "SECRETSTIFF", "scene": "sheet.json", "values": {"stiffness": {"law": "constant", "value": 4e5}}}],
 "tasks": [{"name": "real", "kind": "rating", "statement": "It felt real.", "least": "no", "most": "yes"},
  {"name": "stiffer", "kind": "two-alternative", "question": "Which felt stiffer?", "pairs": [["SECRETSOFT", "SECRETSTIFF"]], "right": "second"}]}
JSON
good 'the order' study plan.json --participant P01 --order
holds 'SECRETSOFT'
cp out.txt order.txt
good 'the order again' study plan.json --participant P01 --order
cmp -s out.txt order.txt && pass || complain 'the order differs from run to run'
good 'of another' study plan.json --participant P02 --order
cmp -s out.txt order.txt && complain 'two participants have the same order' || pass
sed 's/1\.6/1.4/' plan.json >short.json
table=study/P01/trials.csv
{ printf 'x\n\n'; seq 11 30; } >input # a line that does not begin, one that does, 20 that answer nothing
"$palpate" study plan.json --participant P09 --out strange --clock virtual <input >out.txt 2>err.txt
[ $? -eq 2 ] && grep -q '20 other lines in a row' err.txt && [ "$(grep -vc 'strange/P09/warnings.txt' err.txt)" -eq 1 ] && pass || complain "strange answers: $(cat err.txt)"
holds 'please press Enter alone'
[ "$(wc -l <strange/P09/trials.csv)" -eq 1 ] && pass || complain 'an answer that was none is in the table'
mkfifo quiet # Ctrl-C while the keyboard is waited for
"$palpate" study plan.json --participant P08 --out strange --clock virtual <quiet >out.txt 2>err.txt &
process=$!
exec 3>quiet
tries=0
until grep -q 'Enter begins' out.txt || [ $tries -ge 300 ]; do sleep 0.1; tries=$((tries + 1)); done
sleep 0.3 # it reads by now
kill -INT $process; wait $process && pass || complain "Ctrl-C at a prompt: exit $?"
exec 3>&-
holds 'Paused after 0 of 3'
printf '\n7\nfive\n4\nq\n' >input
good 'a participant pauses' study plan.json --participant P01 --out study --clock virtual
holds 'Trial 1 of 3'
holds 'please answer 1 to 5'
holds 'Paused after 1 of 3'
grep -q SECRET out.txt err.txt && complain "the participant can read a condition's name" || pass
grep -q 'apart' out.txt err.txt && complain "the participant can read what sessions warn of" || pass
grep -q 'should read study/P01/warnings.txt' err.txt && grep -q '^trial 1: the points are .* apart' study/P01/warnings.txt && pass ||
    complain "nobody is told what the sessions warned of: $(cat err.txt study/P01/warnings.txt)"
[ "$(wc -l <$table)" -eq 2 ] && pass || complain "a row is missing: $(cat $table)"
printf 'P01,2,1,real,rating,SECRETS' >>$table # as a crash within a row leaves it
mkdir -p study/P01/trial_002 && echo '{}' >study/P01/trial_002/session.json # and within a session
printf '\n5\n\n\n1\n' >input
good 'and goes on after a crash' study plan.json --participant P01 --out study --clock virtual --json
for word in '"done": 3' '"paused": false' '"trial 2: the points are ' '"trial 3: the points are '; do holds "$word"; done
grep -q '^trial 1: ' study/P01/warnings.txt && grep -q '^trial 3: ' study/P01/warnings.txt && pass || complain "the warnings: $(cat study/P01/warnings.txt)"
cut -d, -f1-3 $table >columns.txt
printf 'participant,trial,block\nP01,1,1\nP01,2,1\nP01,3,2\n' | cmp -s - columns.txt && pass || complain "trials lost or repeated: $(cat $table)"
grep -q 'P01/trial_002_again2' $table && pass || complain 'the session that was cut was written over'
good 'nothing is left' study plan.json --participant P01 --out study --clock virtual
holds '3 of 3 trials'
[ "$(wc -l <$table)" -eq 4 ] && pass || complain 'a finished study got another row'
good 'its sessions are sessions' replay study/P01/trial_001 --compare
# Killed at once: between two trials, while the keyboard is waited for.
mkfifo keys
"$palpate" study plan.json --participant P02 --out study --clock virtual <keys >first.txt 2>first_errors.txt &
process=$!
exec 3>keys
printf '\n2\n' >&3
tries=0
until [ -f study/P02/trials.csv ] && [ "$(wc -l <study/P02/trials.csv)" -eq 2 ] || [ $tries -ge 300 ]; do sleep 0.1; tries=$((tries + 1)); done
bad 'two at one participant' "study/P02: another process runs this participant's trials" study plan.json --participant P02 --out study --clock virtual
kill -9 $process; exec 3>&-; wait $process 2>/dev/null
printf '\n3\n\n\n2\n' >input
good 'the killed one goes on' study plan.json --participant P02 --out study --clock virtual --json
cut -d, -f1-3 study/P02/trials.csv >columns.txt
printf 'participant,trial,block\nP02,1,1\nP02,2,1\nP02,3,2\n' | cmp -s - columns.txt && pass || complain "trials lost or repeated after a kill: $(cat study/P02/trials.csv)"
: >input
good 'analysed' study --analyse study --plot shares.svg --json
for word in '"participants": 2' '"trials": 6' '"left_out": 0' '"unfinished": []' '"weber": 0.22' '"wilson_95"' '"noticeable_steps"' '"mean_bootstrap_95"'; do holds "$word"; done
good 'in words' study --analyse study
holds 'predicted, not measured'
holds 'means by a bootstrap'
grep -q 'has not finished' out.txt && complain 'who has finished is said not to have' || pass
cp -r study part && sed -i '3,$d' part/P02/trials.csv
good 'one has not finished' study --analyse part
holds 'P02 has not finished: 1 of 3 trials'
good 'the same as JSON' study --analyse part --json
for word in '"answered": 1' '"planned": 3'; do holds "$word"; done
bad 'a folder twice' 'study/P01: expected each folder once' study --analyse study study/P01
grep -q 'share of trials' shares.svg && pass || complain 'the plot has no axis'
sed 's/4e5/5e5/' plan.json >changed.json
bad 'the plan has changed' 'has changed since' study changed.json --participant P01 --out study --clock virtual
bad 'the hand presses otherwise' 'the motion of the hand' study plan.json --participant P01 --out study --clock virtual --press-depth 3mm
bad 'a new participant with another plan' 'choose another --out' study changed.json --participant P06 --out study --clock virtual
[ ! -e study/P06 ] && pass || complain 'a refused participant has a folder'
cp -r study answers && sed -i 's/^P02,/P07,/' answers/P02/trials.csv
bad 'two participants of one name' '"P01" again, who is also in study/P01' study --analyse study answers/P01
bad 'a table of another participant' 'expected the participant of study.json, "P02", found "P07"' study --analyse answers
sed -i '3s/,2,1,/,7,1,/' answers/P01/trials.csv
bad 'a table without a trial' 'P01/trials.csv: line 3: column trial: expected 2, found 7' study --analyse answers
sed -i 's/4 mm/5 mm/' sheet.json
bad 'a scene of it has changed' 'has changed since' study plan.json --participant P01 --out study --clock virtual
sed -i 's/5 mm/4 mm/' sheet.json
sed -i '2s/P01/P03/' $table
bad 'a changed table' 'was the table changed' study plan.json --participant P01 --out study --clock virtual
bad 'no participant' '--participant' study plan.json --out study
bad 'no number' 'end in a number' study plan.json --participant Jo --out study
bad 'a way out of the folder' '--participant' study plan.json --participant ../P1 --out study
bad 'no folder' '--out' study plan.json --participant P01
bad 'the plan says how long' 'the plan says how long' study plan.json --participant P01 --out study --seconds 3
bad 'no plan' 'PLAN' study --participant P01
bad 'no such plan' 'none.json' study none.json --participant P01 --out study
bad 'nothing to analyse' 'trials.csv' study --analyse .
bad 'a plot over a table' 'ends in .svg' study --analyse study --plot $table
head -1 $table | grep -q '^participant' && pass || complain 'a plot wrote over a table'
bad 'another clock' 'the --clock that' study plan.json --participant P02 --out study
bad 'another hand' 'the --hand that' study plan.json --participant P02 --out study --clock virtual --hand scan
bad 'no such hand' '--hand pres:' study plan.json --participant P04 --out study --hand pres
bad 'no hand in the file' 'sheet.json' study plan.json --participant P04 --out study --hand sheet.json
printf '0,0,0,0.02\n2,0,0,0.02\n' >air.csv # above the sheet
printf '\n3\nq\n' >input
good 'a hand in the air' study plan.json --participant P05 --out air --clock virtual --hand air.csv
grep -q 'trial 1: nothing was felt' err.txt && pass || complain "nobody says that nothing was felt: $(cat err.txt)"
: >input
bad 'nothing that was felt' 'expected trials that were felt, found none; 1 trial left out, because nothing was felt' study --analyse air
bad 'a folder of an order' '--out has no effect with --order' study plan.json --participant P01 --order --out study
bad 'a clock of an analysis' '--clock has no effect with --analyse' study --analyse study --clock virtual
bad 'a long name' 'at most 64 characters, found 101' study plan.json --participant "$(printf '%100s' | tr ' ' P)1" --out study
mkdir plans # one touch of a pair is in the air, and so is one of the ratings
good 'a sheet' convert sample:sheet plans/here.csv --points 4000
awk -F, -v OFS=, '$3 + 0 == $3 { $3 -= 0.05 } { print }' plans/here.csv >plans/below.csv
for at in here below; do sed "s/sample:sheet\", \"points\": 4000/$at.csv\"/" sheet.json >plans/$at.json; done
printf '0,0,0,0.01\n1,0,0,-0.001\n2,0,0,-0.001\n' >plans/down.csv
cat >plans/pair.json <<'JSON'
{"title": "t", "seconds": 2, "hand": "down.csv", "conditions": [{"name": "HERE", "scene": "here.json"}, {"name": "BELOW", "scene": "below.json"}],
 "tasks": [{"name": "p", "kind": "two-alternative", "question": "Which?", "pairs": [["HERE", "BELOW"]]}, {"name": "r", "kind": "rating", "statement": "It felt real."}]}
JSON
printf '\n\n1\n\n4\n\n4\n' >input
good 'a pair of which one is not felt' study plans/pair.json --participant P01 --out pairs --clock virtual --json
tr -d ' \n' <out.txt | grep -q '"unfelt":\[1,[23]\]' && pass || complain "JSON does not say which trials were not felt: $(cat out.txt)"
grep -q 'trial 1: nothing was felt in one of its touches' err.txt && pass || complain "nobody says that one was not felt: $(cat err.txt)"
: >input
[ "$(sed -n 's/.*,//; 2p' pairs/P01/trials.csv)" = 0 ] && pass || complain "the table: $(cat pairs/P01/trials.csv)"
good 'what was not felt is left out' study --analyse pairs --json
for word in '"trials": 1' '"left_out": 2'; do holds "$word"; done
mv out.txt analysed.txt
good 'in the other spelling' study --analyze pairs --json
cmp -s out.txt analysed.txt && pass || complain "--analyze is not --analyse: $(cat out.txt)"
good 'which is said' study --analyse pairs
holds '2 trials left out'
grep -q bootstrap out.txt && complain 'an interval that there is not' || pass
(cd plans && "$palpate" study pair.json --participant P01 --out ../pairs --clock virtual >../out.txt 2>../err.txt) && pass || complain "from another folder: $(cat err.txt)"
holds '3 of 3 trials'
cp -r pairs older && sed -i '/"hand_path"/d' older/P01/study.json
sed -i 's/-0.001/-0.002/' plans/down.csv
bad 'the path of its hand has changed' 'has changed since' study plans/pair.json --participant P01 --out pairs --clock virtual
good 'which a study of an earlier version does not know' study plans/pair.json --participant P01 --out older --clock virtual
bad 'a run and an analysis' '--analyse' study plan.json --analyse study
bad 'a folder and an analysis' '--analyse' study --analyse study --out other
bad 'too short to feel' 'a force needs to come on' study short.json --participant P01 --out study
bad 'a plot of nothing' '--plot' study plan.json --participant P01 --plot x.svg
[ ! -e study/P04 ] && [ ! -e study/Jo ] && [ ! -e P1 ] && pass || complain 'a refused study left a folder'

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

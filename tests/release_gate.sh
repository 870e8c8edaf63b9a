# Sourced by run.sh: the steps that a release has to pass, each with its result in one table. A step that fails does not stop
# the others; one that this machine cannot run is skipped with a reason, and a release has none of those.

# other_compiler: the first compiler that is another one than the default.
other_compiler() {
    case $(c++ --version 2>/dev/null) in *clang*) candidates='g++' ;; *) candidates='clang++ clang++-20 clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14' ;; esac
    for candidate in $candidates; do
        if command -v "$candidate" >/dev/null 2>&1; then echo "$candidate"; return; fi
    done
}

# Which steps each commit has passed, a line each. A checkout that was changed has no commit, nor has a gate whose tests are
# chosen by options.
passed_file=$top/release_gate.txt commit=
commit_here() { [ -n "$(git status --porcelain --untracked-files=normal 2>&1)" ] || git rev-parse HEAD; }

table= gate_failed=0 skipped=
# step NAME REASON COMMAND...: runs the command unless there is a reason to skip it, or --resume and it has passed.
step() {
    name=$1 reason=$2
    shift 2
    if [ -n "$resume" ] && [ -n "$commit" ] && before=$(grep "^$commit $name:" "$passed_file" 2>/dev/null); then
        [ -z "$dry_run" ] || say "would skip $name, which has passed"
        table="$table$(printf '%-14s %5s    %s' "$name" - "passed before, in ${before##*: }")
"
        return
    fi
    if [ -n "$dry_run" ]; then
        say "would run $name: ${reason:+skipped, $reason: }$*"
        return
    fi
    result=passed note='' began=$(date +%s)
    if [ -n "$reason" ]; then
        result="skipped: $reason"
    else
        say "== $name"
        mkdir -p "$top"
        log=$top/release_gate_step.log
        rm -f "$log.status"
        { ("$@"); echo $? >"$log.status"; } 2>&1 | tee "$log"
        status=$(cat "$log.status" 2>/dev/null)
        case $status in '' | *[!0-9]*) status=1 ;; esac # it was killed, or the disk is full
        # Tests that do not apply to this machine are counted; scripts that it cannot run, whole or in part, make a gap.
        left_out=$(grep -c '(Skipped)$' "$log") gaps=$(grep -cE '^skipped: |^[[:space:]]*[0-9]+ - [a-z_]+ \(Skipped\)$' "$log")
        if [ "$status" -eq 77 ]; then
            result='skipped: see its output above'
        elif [ "$status" -ne 0 ]; then
            result="FAILED, status $status" gate_failed=1
        elif [ "$gaps" -gt 0 ]; then
            result="skipped in part: $gaps, see its output above"
        elif [ "$left_out" -gt 0 ]; then
            note=", $left_out of its tests do not apply here"
        fi
    fi
    took=$(($(date +%s) - began))
    case $result in skipped*) skipped="$skipped, $name" ;; esac
    table="$table$(printf '%-14s %5d s  %s' "$name" $took "$result$note")
"
    [ "$result" != passed ] || [ -z "$commit" ] || [ "$(commit_here)" != "$commit" ] ||
        printf '%s %s: %d s\n' "$commit" "$name" $took >>"$passed_file"
}

gate_flavour() { # NAME FOLDER CTEST-OPTIONS...
    flavour=$1 folder=$2
    shift 2
    build_flavour "$flavour" "$folder" && gate_tests "$folder" "$@"
}

# gate_tests FOLDER CTEST-OPTIONS...: runs tests, and says what passed without a part of itself.
gate_tests() {
    test_flavour "$@"
    status=$?
    grep -h '^skipped: ' "$1/Testing/Temporary/LastTest.log"
    return $status
}

# gate_plain CTEST-OPTIONS...: and says which tests need what this machine lacks.
gate_plain() {
    gate_flavour plain "$top" "$@"
    status=$?
    ctest --test-dir "$top" -N >"$top/all_tests.txt" 2>&1
    for test in bridge_peer desktop display_faults driver_faults hardening mutation_operators performance_gate \
        reference window_faults; do
        grep -q ": $test\$" "$top/all_tests.txt" || echo "skipped: there is no test $test; cmake said what it misses"
    done
    return $status
}

gate_packages() {
    PALPATE_BUILD=$top/package sh engine/package/make.sh && sh tests/install/packages.sh "$top/package"
}

# release_gate CTEST-OPTIONS...: all steps; the options go to the tests of the three builds.
release_gate() {
    other=$(other_compiler)
    [ -n "$driver" ] || driver=$(ls /usr/lib/chromium/vk_swiftshader_icd.json 2>/dev/null) # Debian's chromium-common
    [ $# -gt 0 ] || commit=$(commit_here)
    if [ -n "$resume" ]; then
        [ -n "$commit" ] || say '--resume: the checkout is changed or no clone, or tests are chosen by options: everything is run'
        build_flavour plain "$top" || return 1 # what the steps after plain look at
    elif [ -z "$dry_run" ]; then
        rm -f "$passed_file" # what failed now may have passed before
    fi
    slow='shader-validation|shader-gpu-assisted'
    step plain '' gate_plain -LE "$slow" -E '^(fuzz|install|soak)$' "$@"
    step validation '' gate_tests "$top" -L "$slow" "$@"
    step 'fuzz replay' '' gate_tests "$top" -R '^fuzz$'
    step fuzzers '' sh tests/fuzz.sh --minutes 1
    step valgrind '' sh tests/valgrind.sh
    step soak '' "$top/bin/palp_soak" --seed "$(date +%Y%m%d)" --seconds 60 --scenes samples/scenes
    step install '' gate_tests "$top" -R '^install$'
    step package '' gate_packages
    step asan '' gate_flavour asan "$top/asan" -LE "$again" "$@"
    step tsan '' gate_flavour tsan "$top/tsan" -LE "$again" -E "$without_tsan" "$@"
    step 'compiler' "$([ -n "$other" ] || echo 'there is no second compiler here')" gate_flavour other "$top/other" -LE shader "$@"
    commit= # a driver and a release that are named may be others than before
    step 'second driver' "$([ -n "$driver" ] || echo 'no --driver, and no package chromium-common, which has SwiftShader')" run_on_driver "$top"
    step performance "$([ -n "$release" ] || echo 'no --release')" python3 tests/performance_gate.py "$release" "$top/bin/palpate"
    [ -z "$dry_run" ] || return 0
    say "== result"
    printf '%s' "$table"
    [ $gate_failed -eq 0 ] || return 1
    [ -z "$skipped" ] || { say "This is not the whole gate. Skipped: ${skipped#, }."; return 77; }
}

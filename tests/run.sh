#!/bin/sh
# Installs missing packages (asks first unless root), builds Release, runs every test.
set -u
cd "$(dirname "$0")/.." || exit 1
. engine/prepare.sh

usage() {
    cat <<'TEXT'
usage: sh tests/run.sh [--asan | --tsan] [--yes] [--no-install] [--dry-run] [-- CTEST-OPTIONS]
       sh tests/run.sh --driver ICD.json
       sh tests/run.sh --all [--driver ICD.json] [--release PROGRAM] [--resume]

  (nothing)      every test but the slow GPU-assisted validation of shaders, Release build in build/
  --asan         the same tests under AddressSanitizer and UndefinedBehaviorSanitizer, in build/asan; those that run the
                 same code again are left out: the pages' commands, validation of shaders
  --tsan         the same under ThreadSanitizer, in build/tsan, without the long ones that start no thread
  --all          what a release has to pass: those three builds, validation of the shaders, fuzzing and its replay, valgrind,
                 a minute of the soak, the other compiler, installation and packages, a second driver and the performance;
                 ends with a table. Exits with 77 if a step was skipped
  --resume       with --all: what this same commit has passed in a gate that was stopped or failed is not run again, but
                 for the second driver and the performance
  --driver FILE  builds, and runs the tests of shaders and pictures on the first processor of another Vulkan driver: FILE
                 is its manifest, as /usr/share/vulkan/icd.d has them. Golden pictures are skipped there. The gate takes
                 the package chromium-common's where none is named
  --release FILE with --all: palpate of the last release; this one may be slower beside its peers by 15 % at most
  --yes          install missing packages without asking (password-less sudo)
  --no-install   install nothing; exit 3 naming what is missing
  --dry-run      print the steps without running them

  sh tests/run.sh -- -R plate        only the tests whose name contains "plate". With options of ctest the GPU-assisted
                                     ones run too; -LE shader-gpu-assisted leaves them out
  PALPATE_BUILD=/tmp/b sh tests/run.sh   builds elsewhere, for a checkout that cannot be written
TEXT
}

flavours= all= driver= release= resume=
while [ $# -gt 0 ]; do
    case $1 in
    --asan) flavours="$flavours asan" ;;
    --tsan) flavours="$flavours tsan" ;;
    --all) all=1 ;;
    --resume) resume=1 ;;
    --driver)
        [ $# -gt 1 ] || { say "--driver: expected the manifest of a Vulkan driver, a .json file"; exit 2; }
        driver=$2
        shift
        ;;
    --release)
        [ $# -gt 1 ] && [ -x "$2" ] || { say "--release: expected the program palpate of the last release"; exit 2; }
        release=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
        shift
        ;;
    --help | -h) usage; exit 0 ;;
    --) shift; break ;;
    --yes | --no-install | --dry-run) prepare_options "$1" ;;
    *) say "unknown option $1"; usage; exit 2 ;;
    esac
    shift
done

[ -z "$resume" ] || [ -n "$all" ] || { say "--resume: expected with --all"; exit 2; }
if [ -n "$driver" ]; then
    [ -r "$driver" ] || { say "--driver: $driver cannot be read; drivers have their manifests in /usr/share/vulkan/icd.d"; exit 2; }
    driver=$(cd "$(dirname "$driver")" && pwd)/$(basename "$driver") # as the loader wants it
fi

# run_on_driver FOLDER: the programs of shader tests on the driver's first processor.
run_on_driver() (
    export VK_DRIVER_FILES="$driver" VK_ICD_FILENAMES="$driver" PALPATE_SOLVER=0
    "$1/bin/palpate" devices --processors || exit 1
    passed=0 skipped=0 failures=0 log=$1/driver_test.log
    # A process for each test, as ctest has it: a driver of hardware that had been loaded and unloaded dozens of times in one
    # listed no processor any more, and all later tests failed.
    for program in "$1"/bin/palp_*_shader_test; do
        say "== $(basename "$program")"
        tests=$("$program" --gtest_list_tests) || failures=$((failures + 1))
        for test in $(printf '%s\n' "$tests" | awk '/^[^ ]/ { suite = $1 } /^ / { print suite $1 }'); do
            if ! "$program" --gtest_brief=1 --gtest_filter="$test" >"$log" 2>&1; then
                cat "$log"
                failures=$((failures + 1))
            elif grep -q 'SKIPPED' "$log"; then
                skipped=$((skipped + 1))
            else
                passed=$((passed + 1))
                grep ' ulp of' "$log" # how far the driver rounds otherwise
            fi
        done
    done
    say "$passed tests passed, $skipped skipped, $failures failed"
    [ $failures -eq 0 ] && [ $passed -gt 0 ]
)

again='shader-validation|shader-gpu-assisted|pages' # labels that sanitized builds leave out
# What ThreadSanitizer leaves out, an hour of it. Most of these tests start no thread of ours: sums of numerics, kernels on
# the host, sessions in virtual time. Those of whole bodies start only threads that other tests of the pipeline start too.
without_tsan='^(contact|chart|fit|perception|plot)\.|^host-|^plate\.(LargeLaw|MultigridShell|PressDeep|ReferenceShell|ShearWork|CellsThatAreNotSquare|RigidityThatJumps|Smooth/|All/ConstantRigidity)'
without_tsan="$without_tsan"'|^pipeline\.(Calculix|ComplianceTracker|TouchedSurface|TableSolve|WholeObject|ShellPatch\.FeelsHardly)|^device\.FalconCalibration'
without_tsan="$without_tsan"'|^session\.(Reversals|ClosedStrokes|FalconLag|Taps|Weight|Strokes|Tissue)\.|^session\.On/TenMinutes'
without_tsan="$without_tsan"'|^session\.(SceneMesh\.BadMeshes|VirtualSession\.AHomogeneous|On/ScaledSessions\.APressedWall)|^cloud\.(SurfaceSurvey\.FindsTheNoiseOf|MeshPoints\.EveryPlace)|^(fuzz|prepare)$'
# The emulated Haply's threads and the generated hands' are those of another test of the same suite.
without_tsan="$without_tsan"'|^session\.(Below\.ANodule|LargeDeflection\.AClosedStroke|GeneratedHand\.IsRepeated|On/LineSessions\.AnArm.*haply)|^pipeline\.(DenseCloud|LargeTouch)\.'

# build_flavour plain|asan|tsan|other FOLDER
build_flavour() {
    sanitizers= compiler=
    case $1 in
    asan) sanitizers=address,undefined ;;
    tsan) sanitizers=thread ;;
    other) compiler=-DCMAKE_CXX_COMPILER=$other ;;
    esac
    say "== $1: building in $2"
    # The demo's build has cached PALPATE_TESTS=OFF.
    # shellcheck disable=SC2086
    prepare_build "$2" -DPALPATE_TESTS=ON -DPALPATE_WERROR=ON -DPALPATE_SANITIZE=$sanitizers "-DPALPATE_SHADER_CACHE=$top/shader_cache" -DPALPATE_BENCHMARKS=$([ "$1" = plain ] && echo ON || echo OFF) $compiler
}

# test_flavour FOLDER CTEST-OPTIONS...
test_flavour() {
    folder=$1
    shift
    ctest --test-dir "$folder" --output-on-failure --no-tests=error --parallel "$(jobs)" "$@"
}

# shellcheck disable=SC2086
prepare_packages $packages_build $packages_tests ${all:+$packages_package $packages_gate}
top=${PALPATE_BUILD:-build}
if [ -n "$all" ]; then
    . tests/release_gate.sh
    release_gate "$@"
    exit
fi
failed=0
for flavour in ${flavours:-plain}; do
    case $flavour in
    plain) folder=$top ;;
    *) folder=$top/$flavour ;;
    esac
    build_flavour "$flavour" "$folder"
    if [ -n "$dry_run" ]; then say "would run the tests in $folder"; continue; fi
    if [ -n "$driver" ]; then run_on_driver "$folder" || failed=1; continue; fi
    say "== $flavour: testing"
    # Instrumented shaders are 20 times slower: they run with --all, or if ctest options are given.
    excluded='shader-gpu-assisted'
    [ "$flavour" = plain ] || excluded=$again
    left_out=
    [ "$flavour" != tsan ] || left_out="-E $without_tsan"
    # shellcheck disable=SC2086
    if [ $# -gt 0 ]; then test_flavour "$folder" "$@"; else test_flavour "$folder" -LE "$excluded" $left_out; fi || failed=1
done
exit $failed

#!/bin/sh
# Installs missing packages (asks first unless root), builds Release, runs every test.
set -u
cd "$(dirname "$0")/.." || exit 1
. engine/prepare.sh

usage() {
    cat <<'TEXT'
usage: sh tests/run.sh [--asan | --tsan | --all] [--yes] [--no-install] [--dry-run] [-- CTEST-OPTIONS]

  (nothing)      every test, Release build in build/
  --asan         the same tests under AddressSanitizer and UndefinedBehaviorSanitizer, in build/asan
  --tsan         the same tests under ThreadSanitizer, in build/tsan
  --all          all three builds in turn, and GPU-assisted validation of the shaders
  --yes          install missing packages without asking (password-less sudo)
  --no-install   install nothing; exit 3 naming what is missing
  --dry-run      print the steps without running them

  sh tests/run.sh -- -R plate        only the tests whose name contains "plate"
  PALPATE_BUILD=/tmp/b sh tests/run.sh   builds elsewhere, for a checkout that cannot be written
TEXT
}

flavours= all=
while [ $# -gt 0 ]; do
    case $1 in
    --asan) flavours="$flavours asan" ;;
    --tsan) flavours="$flavours tsan" ;;
    --all) flavours='plain asan tsan' all=1 ;;
    --help | -h) usage; exit 0 ;;
    --) shift; break ;;
    --yes | --no-install | --dry-run) prepare_options "$1" ;;
    *) say "unknown option $1"; usage; exit 2 ;;
    esac
    shift
done

# shellcheck disable=SC2086
prepare_packages $packages_build $packages_tests
top=${PALPATE_BUILD:-build}
failed=0
for flavour in ${flavours:-plain}; do
    case $flavour in
    plain) folder=$top sanitizers= ;;
    asan) folder=$top/asan sanitizers=address,undefined ;;
    tsan) folder=$top/tsan sanitizers=thread ;;
    esac
    say "== $flavour: building in $folder"
    # The demo's build has cached PALPATE_TESTS=OFF.
    prepare_build "$folder" -DPALPATE_TESTS=ON -DPALPATE_WERROR=ON -DPALPATE_SANITIZE=$sanitizers -DPALPATE_BENCHMARKS=$([ $flavour = plain ] && echo ON || echo OFF)
    if [ -n "$dry_run" ]; then say "would run the tests in $folder"; continue; fi
    say "== $flavour: testing"
    # Instrumented shaders are 20 times slower: they run with --all, or if ctest options are given.
    excluded=
    [ $# -gt 0 ] || { [ -n "$all" ] && [ $flavour = plain ]; } || excluded='-LE shader-gpu-assisted'
    # shellcheck disable=SC2086
    ctest --test-dir "$folder" --output-on-failure --no-tests=error --parallel "$(jobs)" $excluded "$@" || failed=1
done
exit $failed

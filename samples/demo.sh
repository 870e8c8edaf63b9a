#!/bin/sh
# Installs what is missing (asks first unless root), builds, touches a wart, and computes the paper again, with a page of
# pictures.
set -u
cd "$(dirname "$0")/.." || exit 1
. engine/prepare.sh

usage() {
    cat <<'TEXT'
usage: sh samples/demo.sh [--yes] [--no-install] [--dry-run]

  --yes          install missing packages without asking (password-less sudo)
  --no-install   install nothing; exit 3 naming what is missing
  --dry-run      say what would be done
TEXT
}

for option; do
    case $option in
    --help | -h) usage; exit 0 ;;
    --yes | --no-install | --dry-run) prepare_options "$option" ;;
    *) say "unknown option $option"; usage; exit 2 ;;
    esac
done

# shellcheck disable=SC2086
prepare_packages $packages_build
build=${PALPATE_BUILD:-build}
# A build that the tests made keeps its options: changing them would compile everything again.
if [ -f "$build/CMakeCache.txt" ]; then prepare_build "$build"; else prepare_build "$build" -DPALPATE_TESTS=OFF -DPALPATE_BENCHMARKS=OFF; fi
out=$build/demo
if [ -n "$dry_run" ]; then say "would write $out/index.html"; exit 0; fi

say '== a wart under the skin'
"$build/bin/palpate" touch sample:skin --out "$out/skin" || exit 1
say
say '== the paper, computed again: one to two minutes on two cores'
"$build/bin/palpate" paper --out "$out" || exit 1
say
say "claims, pictures and tables: $out/index.html; the wart: $out/skin"
say "next: $build/bin/palpate touch sample:palm --at 14mm,5mm,0 --out touch"
say "      your own cloud: $build/bin/palpate info FILE --unit mm"

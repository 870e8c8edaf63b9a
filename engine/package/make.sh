#!/bin/sh
# Installs what is missing (asks first unless root), builds the four Debian packages, and names them.
set -u
cd "$(dirname "$0")/../.." || exit 1
. engine/prepare.sh

usage() {
    cat <<'TEXT'
usage: sh engine/package/make.sh [--yes] [--no-install] [--dry-run]

  --yes          install missing packages without asking (password-less sudo)
  --no-install   install nothing; exit 3 naming what is missing
  --dry-run      print the steps without running them

PALPATE_BUILD=FOLDER builds there; else in build-package
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
prepare_packages $packages_build $packages_package
build=${PALPATE_BUILD:-build-package}
prepare_build "$build" -DCMAKE_INSTALL_PREFIX=/usr -DPALPATE_TESTS=OFF -DPALPATE_BENCHMARKS=OFF -DPALPATE_BENCH_PEERS=OFF
if [ -n "$dry_run" ]; then say "would write $build/*.deb"; exit 0; fi
(cd "$build" && cpack) >"$build/package.log" 2>&1 || { cat "$build/package.log"; exit 1; }
ls "$build"/*.deb

#!/bin/sh
# Checks that every dependency has a row in third_party_notes.md. Argument: the checkout.
set -u
cd "$1" || exit 1
. engine/prepare.sh

bad=0
row() { # expects a table row that contains the word in backticks
    grep '^|' third_party_notes.md | grep -qF "\`$1\`" || { echo "third_party_notes.md has no row with \`$1\` ($2)"; bad=1; }
}
for name in $(cat CMakeLists.txt engine/CMakeLists.txt engine/*/CMakeLists.txt tests/CMakeLists.txt tests/*/CMakeLists.txt samples/CMakeLists.txt |
    sed -n 's/#.*//; s/.*find_package(\([A-Za-z0-9_]*\).*/\1/p' | sort -u); do
    [ "$name" = Threads ] || row "$name" 'find_package'
done
for package in $packages_build $packages_tests $packages_package $packages_gate; do row "$package" 'package list in engine/prepare.sh'; done

[ $bad -eq 0 ] && echo 'every dependency has a row'
exit $bad

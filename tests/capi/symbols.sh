#!/bin/sh
# Compares what libpalpate.so exports with the list. Arguments: the library, symbols.txt.
set -u
nm -D --defined-only "$1" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | sort >"${TMPDIR:-/tmp}/palpate symbols $$"
trap 'rm -f "${TMPDIR:-/tmp}/palpate symbols $$"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
diff "$2" "${TMPDIR:-/tmp}/palpate symbols $$" || { echo 'the left is symbols.txt, the right is exported'; exit 1; }

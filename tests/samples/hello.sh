#!/bin/sh
# Runs a small program of samples/: it must succeed, and its first number lie within bounds.
# Arguments: the program, the least and the largest number.
set -eu
said=$("$1")
echo "$said"
echo "$said" | awk -v least="$2" -v most="$3" '
    { for (i = 1; i <= NF && !found; ++i) if ($i ~ /^[0-9.]+(e[-+]?[0-9]+)?$/) { found = 1; number = $i + 0 } }
    END { exit !(found && number >= least + 0 && number <= most + 0) }'

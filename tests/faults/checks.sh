# What the scripts of this folder share; each reads it first, with $palpate set. It goes to a new folder, $work, that is removed
# in the end, counts checks, and judges what a program leaves there in err.txt and in recordings.
palpate=$(realpath "$palpate") || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
cd "$work" || exit 1
passed=0 failed=0
pass() { passed=$((passed + 1)); }
complain() { failed=$((failed + 1)); echo "FAILED: $*"; }
conclude() {
    echo "$passed checks passed, $failed failed"
    [ $failed -eq 0 ]
}

# has_sentence: the program says why it ended; a warning does only if it says what ended the session or its force.
has_sentence() {
    ! grep -q 'internal error' err.txt || return 1
    grep -v '^palpate: warning' err.txt | grep -q '^palpate: .*[a-z]' || grep -qE 'ended the session|stopped the force' err.txt
}

# forces_are_good RECORDING TICKS: each of so many ticks, or of one and more where that is "some", is there; its force is finite
# and at most the 6 N of a session; its time is later than the last, by a millisecond in virtual time.
forces_are_good() {
    "$palpate" export "$1" --csv forces.csv >/dev/null 2>&1 || return 1
    grep -q '"clock": *"virtual"' "$1/session.json" && virtual=1 || virtual=0
    awk -F, -v all="$2" -v virtual=$virtual 'NR == 1 { for (n = 1; n <= NF; ++n) if ($n == "force_x") x = n; next }
        { for (n = x; n < x + 3; ++n) if ($n !~ /^[-+0-9.e]+$/ || $n > 6 || $n < -6) bad = 1
          if (ticks > 0 && $1 <= last) bad = 1
          if (virtual && ($1 - ticks * 1e-3 > 1e-6 || ticks * 1e-3 - $1 > 1e-6)) bad = 1
          last = $1
          ++ticks }
        END { exit bad || !x || ticks < 1 || (all != "some" && ticks != all) }' forces.csv
}

#!/bin/sh
# Tests the commands that install packages, on machines that lack them, root, sudo or a terminal. Substitutes first in
# PATH imitate them. Argument: the checkout.
set -u
cd "$1" || exit 1
place=$(mktemp -d "${TMPDIR:-/tmp}/palpate prepare XXXXXX") || exit 1
trap 'rm -rf "$place"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
passed=0 failed=0

stand_in() { printf '#!/bin/sh\n%s\n' "$2" >"$place/bin/$1"; chmod +x "$place/bin/$1"; }
machine() { # makes new substitutes; every call of apt-get or sudo writes a line to calls
    rm -rf "$place/bin" "$place/calls"
    mkdir "$place/bin"
    : >"$place/calls"
    stand_in dpkg-query 'case $* in *libembree-dev*) exit 1 ;; *) printf "install ok installed" ;; esac'
    stand_in apt-get "echo \"apt-get \$*\" >>'$place/calls'; exit 1"
    stand_in sudo "echo \"sudo \$*\" >>'$place/calls'; exit 1"
    stand_in id "echo $1"
}
check() { # check DESCRIPTION EXIT-CODE WORD COMMAND...
    what=$1 code=$2 word=$3
    shift 3
    PATH="$place/bin:$PATH" "$@" </dev/null >"$place/out" 2>&1
    found=$?
    if [ $found -ne "$code" ]; then echo "FAILED: $what: exit $found, expected $code: $(cat "$place/out")"; failed=$((failed + 1)); return; fi
    if ! grep -qF -- "$word" "$place/out"; then echo "FAILED: $what: no '$word' in: $(cat "$place/out")"; failed=$((failed + 1)); return; fi
    passed=$((passed + 1))
}
calls() { # calls DESCRIPTION PATTERN: expects the pattern in the calls; with an empty pattern, no calls
    if [ -z "$2" ] && [ -s "$place/calls" ] || { [ -n "$2" ] && ! grep -q -- "$2" "$place/calls"; }; then
        echo "FAILED: $1: $(cat "$place/calls")"; failed=$((failed + 1))
    else
        passed=$((passed + 1))
    fi
}

for script in tests/run.sh samples/demo.sh engine/package/make.sh; do
    machine 0
    check "$script --help" 0 'usage:' sh $script --help
    check "$script with an unknown option" 2 'unknown option' sh $script --fast
    check "$script --dry-run names the line" 0 'apt-get install -y --no-install-recommends libembree-dev' sh $script --dry-run
    check "$script --no-install" 3 'libembree-dev' sh $script --no-install
    calls "$script installed although it was told not to" ''

    check "$script as root, when nothing can be installed" 3 'libembree-dev' sh $script
    calls "$script as root does not ask" 'install -y --no-install-recommends libembree-dev'

    machine 1000
    check "$script without root and terminal" 3 'sudo apt-get install' sh $script
    calls "$script asked for a password that nobody can type" ''
    check "$script --yes without password-less sudo" 3 'libembree-dev' sh $script --yes
    calls "$script --yes tries sudo without a password" 'sudo -n true'

    machine 1000
    stand_in dpkg-query 'printf "install ok installed"'
    check "$script with nothing missing" 0 'would' sh $script --dry-run
    calls "$script needs neither root nor network when nothing is missing" ''
done

# Both commands share a build folder: after the demo, which builds no tests, tests/run.sh still builds them.
machine 0
stand_in dpkg-query 'printf "install ok installed"'
stand_in cmake "echo \"cmake \$*\" >>'$place/calls'; : >'$place/build/CMakeCache.txt'"
stand_in ctest "echo \"ctest \$*\" >>'$place/calls'"
mkdir -p "$place/build/bin"
cp "$place/bin/ctest" "$place/build/bin/palpate"
check 'the demo in a fresh clone' 0 'index.html' env PALPATE_BUILD="$place/build" sh samples/demo.sh
calls 'the demo in a fresh clone builds no tests' '-DPALPATE_TESTS=OFF'
: >"$place/calls"
check 'the demo once more' 0 'index.html' env PALPATE_BUILD="$place/build" sh samples/demo.sh
if grep -q PALPATE_TESTS "$place/calls"; then echo "FAILED: the demo changed the options of a build"; failed=$((failed + 1)); fi
check 'the tests after the demo' 0 'testing' env PALPATE_BUILD="$place/build" sh tests/run.sh
calls 'the tests after the demo are built' '-DPALPATE_TESTS=ON'

# The gate of a release lists its steps, goes on after one that fails, and says so at its end.
for name in plain validation 'fuzz replay' fuzzers valgrind soak install package asan tsan compiler 'second driver' performance; do
    check "the gate has the step $name" 0 "would run $name:" sh tests/run.sh --all --dry-run
done
check 'the gate without a last release' 0 'skipped, no --release' sh tests/run.sh --all --dry-run
check 'a release that is no program' 2 'expected the program' sh tests/run.sh --all --release "$place/nothing"
stand_in ctest "case \"\$*\" in *asan*) exit 8 ;; esac"
check 'a gate with a failure' 1 'FAILED, status 8' env PALPATE_BUILD="$place/build" sh tests/run.sh --all
check 'a gate goes on after a failure' 1 '== tsan: building' env PALPATE_BUILD="$place/build" sh tests/run.sh --all

# A gate that was stopped or failed goes on where it was, if nothing has changed.
stand_in git "[ \$1 != status ] || cat '$place/changes'; [ \$1 = status ] || cat '$place/commit'"
echo one >"$place/commit"; : >"$place/changes"
gate() { env PALPATE_BUILD="$place/build" sh tests/run.sh --all "$@"; }
not_again() { if grep -q "^== $1\$" "$place/out"; then echo "FAILED: $1 was run again"; failed=$((failed + 1)); else passed=$((passed + 1)); fi; }
check 'a gate that tells what has passed' 1 'FAILED, status 8' gate
check 'what has passed is told' 1 'passed before' gate --resume
not_again validation
check 'what is looked at is built' 1 '== plain: building' gate --resume
check 'what has failed is run again' 1 '== asan: building' gate --resume
check 'the list of steps tells what has passed' 0 'would skip validation' gate --resume --dry-run
check 'the list of steps without the option' 0 'would run validation:' gate --dry-run
check 'chosen tests have passed nothing' 1 '== validation' gate --resume -- -R no
echo 'M file' >"$place/changes"
check 'a change has passed nothing' 1 '== validation' gate --resume
check 'a change is said' 1 'the checkout is changed' gate --resume
: >"$place/changes"; echo two >"$place/commit"
check 'another commit has passed nothing' 1 '== validation' gate --resume
echo one >"$place/commit"
check 'without the option all is run' 1 '== validation' gate
stand_in ctest 'exit 8'
check 'a gate that fails' 1 'FAILED, status 8' gate
check 'what failed last has not passed' 1 '== validation' gate --resume
stand_in ctest "echo two >'$place/commit'"
check 'a gate during which the commit changes' 1 '== validation' gate
echo one >"$place/commit"
check 'it has passed nothing' 1 '== validation' gate --resume
check 'to resume what is no gate' 2 'expected with --all' sh tests/run.sh --resume

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

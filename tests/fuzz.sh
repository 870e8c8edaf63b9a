#!/bin/sh
# Fuzzes every reader of what comes from outside with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer.
set -eu
usage() {
    cat <<'TEXT'
usage: sh tests/fuzz.sh [--minutes N] [FORMAT...]

  --minutes N  for all formats together (2); corpora are kept, so that the next run goes on where this one ended
  FORMAT       only these, such as ply scene; each is tests/fuzz/FORMAT_fuzzer.cpp

It needs clang++ with libFuzzer (packages clang and libclang-rt-14-dev) and a build with tests, which sh tests/run.sh makes;
PALPATE_BUILD=FOLDER names another one. An input that finds a fault is kept; put it into tests/fuzz/found/FORMAT.
Exits with 77 where clang++ with libFuzzer is missing.
TEXT
}
cd "$(dirname "$0")/.."
minutes=2 formats=
while [ $# -gt 0 ]; do
    case $1 in
    --minutes)
        case ${2:-} in '' | *[!0-9]* | 0*) echo "--minutes: expected a whole number of minutes from 1, found \"${2:-}\""; exit 2 ;; esac
        minutes=$2
        shift
        ;;
    --help | -h) usage; exit 0 ;;
    *)
        [ -f "tests/fuzz/${1}_fuzzer.cpp" ] || { echo "unknown option or format $1"; usage; exit 2; }
        formats="$formats $1"
        ;;
    esac
    shift
done
for harness in tests/fuzz/*_fuzzer.cpp; do
    [ -n "${all:-}" ] || all=
    all="$all $(basename "$harness" _fuzzer.cpp)"
done
formats=${formats:-$all}
build=${PALPATE_BUILD:-build}/fuzz
if [ ! -f "$build/archives.cmake" ]; then
    echo "$build holds no archives.cmake: build Palpate with its tests first, by sh tests/run.sh"
    exit 2
fi

clang=
for name in clang++ clang++-20 clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14; do
    command -v "$name" >/dev/null 2>&1 || continue
    echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$build/probe.cpp"
    if "$name" -fsanitize=fuzzer,address,undefined "$build/probe.cpp" -o "$build/probe" 2>"$build/probe.log"; then
        clang=$name
        break
    fi
done
if [ -z "$clang" ]; then
    echo 'there is no clang++ with libFuzzer here; Debian has it in the packages clang and libclang-rt-14-dev'
    exit 77
fi
cmake -S tests/fuzz/instrumented -B "$build" -DCMAKE_CXX_COMPILER="$clang" >"$build/configure.log" 2>&1 || { cat "$build/configure.log"; exit 2; }
echo "building the harnesses with $clang"
cmake --build "$build" --parallel 2 >"$build/build.log" 2>&1 || { cat "$build/build.log"; exit 2; }
sh tests/fuzz/make_seeds.sh "$build/seeds"
sh tests/fuzz/written_seeds.sh "$build/../bin/palpate" "$build/seeds"

count=0
for format in $formats; do count=$((count + 1)); done
seconds=$((minutes * 60 / count))
[ $seconds -gt 0 ] || seconds=1
failed=0 total=0
for format in $formats; do
    mkdir -p "$build/corpus/$format"
    dictionary='' found=''
    if [ -f "tests/fuzz/$format.dict" ]; then dictionary="-dict=tests/fuzz/$format.dict"; fi
    if [ -d "tests/fuzz/found/$format" ]; then found=tests/fuzz/found/$format; fi
    # A file of 8 KiB cannot ask for 64 MiB unless its header is believed. A session's description has 7.
    # shellcheck disable=SC2086
    if "$build/bin/fuzz_$format" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=1024 \
        -malloc_limit_mb=64 -print_final_stats=1 -artifact_prefix="$build/$format-" $dictionary "$build/corpus/$format" \
        "$build/seeds/$format" $found >"$build/$format.log" 2>&1; then
        runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$format.log")
        total=$((total + runs))
        printf '%s\t%s\t%s\n' "$format" "$runs" "$(git rev-parse --short HEAD 2>/dev/null)" >>"$build/executions.tsv"
        printf '%-12s %10s executions, corpus of %s\n' "$format" "$runs" "$(ls "$build/corpus/$format" | wc -l)"
    else
        failed=1
        echo "$format: FAILED, the input is kept as $build/$format-*"
        tail -n 60 "$build/$format.log"
    fi
done
echo "$total executions in all"
if [ -s "$build/executions.tsv" ]; then
    echo "of all runs in this folder ($build/executions.tsv):"
    awk -F'\t' '{ sum[$1] += $2; all += $2 } END { for (format in sum) printf "%-12s %10d\n", format, sum[format]; printf "%-12s %10d\n", "all", all }' "$build/executions.tsv" | sort
fi
exit $failed

#!/bin/sh
# Fuzzes every file reader for a short while. Arguments: the folder fuzz of a build of Palpate, and the seconds for each
# reader (5).
# Exits with 77, which CTest shows as skipped, where clang++ with libFuzzer is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$1
seconds=${2:-5}
mkdir -p "$build"

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
    echo 'skipped: no clang++ with libFuzzer here; Debian has it in the packages clang and libclang-rt-14-dev'
    exit 77
fi

if [ ! -f "$build/archives.cmake" ]; then
    echo "$build holds no archives.cmake: build Palpate with its tests first; its folder has a folder fuzz then"
    exit 1
fi
cmake -S "$here/instrumented" -B "$build" -DCMAKE_CXX_COMPILER="$clang" >"$build/configure.log" 2>&1 || { cat "$build/configure.log"; exit 1; }
cmake --build "$build" --parallel 2 >"$build/build.log" 2>&1 || { cat "$build/build.log"; exit 1; }

sh "$here/make_seeds.sh" "$build/seeds"
failed=0
for harness in "$here"/*_fuzzer.cpp; do
    format=$(basename "$harness" _fuzzer.cpp)
    mkdir -p "$build/corpus/$format"
    dictionary=
    if [ -f "$here/$format.dict" ]; then dictionary="-dict=$here/$format.dict"; fi
    # A file of 4 KiB cannot ask for 64 MiB unless its header is believed. Seconds of 5 and a fixed seed keep it a test.
    # shellcheck disable=SC2086
    if "$build/bin/fuzz_$format" -seed=1 -max_total_time="$seconds" -max_len=4096 -timeout=10 -rss_limit_mb=1024 \
        -malloc_limit_mb=64 -artifact_prefix="$build/$format-" $dictionary "$build/corpus/$format" \
        "$build/seeds/$format" >"$build/$format.log" 2>&1; then
        echo "$format: $(grep '^Done' "$build/$format.log")"
    else
        failed=1
        echo "$format: FAILED, the input is kept as $build/$format-*"
        tail -n 60 "$build/$format.log"
    fi
done
exit $failed

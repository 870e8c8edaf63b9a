#!/bin/sh
# samples/unity, samples/ros2 and samples/sofa on stand-ins of their hosts. Arguments: the checkout, the library, a scratch
# folder. Skipped (77) without python3 or numpy; samples/unity is compiled and run only where mono's compiler is
# (package mono-mcs), and its declarations are compared with palpate.h in any case.
set -eu
checkout=$1 library=$2 scratch=$3
python=${PALPATE_PYTHON:-/usr/bin/python3}
"$python" -c 'import numpy' 2>/dev/null || { echo "skipped: $python has no numpy (package python3-numpy)"; exit 77; }
rm -rf "$scratch" && mkdir -p "$scratch"
export PYTHONDONTWRITEBYTECODE=1 PALPATE_LIBRARY="$library" PYTHONPATH="$checkout/engine/capi/python"
"$python" "$checkout/tests/samples/signatures.py" "$checkout"
"$python" "$checkout/tests/samples/hosts_test.py" "$checkout" "$scratch"
command -v mcs >/dev/null && command -v mono >/dev/null || {
    echo 'skipped: samples/unity is not compiled, there is no mcs (package mono-mcs)'
    exit 0
}
mcs -warnaserror -out:"$scratch/game.exe" "$checkout/samples/unity/Palpate.cs" "$checkout/tests/samples/unity_stub/UnityEngine.cs"
ln -s "$library" "$scratch/libpalpate.so" # as a game has it
LD_LIBRARY_PATH="$scratch" mono "$scratch/game.exe"

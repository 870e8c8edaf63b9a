#!/bin/sh
# The Python package: its doctests and tests, the scripts of samples/python with their pictures, and a wheel that is
# unpacked and imported. Arguments: the checkout, the library, a scratch folder. Skipped (77) without python3 or numpy.
set -eu
checkout=$1 library=$2 scratch=$3
python=${PALPATE_PYTHON:-/usr/bin/python3}
"$python" -c 'import numpy' 2>/dev/null || { echo "skipped: $python has no numpy (package python3-numpy)"; exit 77; }
rm -rf "$scratch" && mkdir -p "$scratch"
export PYTHONDONTWRITEBYTECODE=1 PALPATE_LIBRARY="$library" PYTHONPATH="$checkout/engine/capi/python"
"$python" "$checkout/tests/capi/python_test.py" "$scratch/tests"
for script in felt_map stroke plate; do
    "$python" "$checkout/samples/python/$script.py" "$scratch" >"$scratch/$script.txt" ||
        { cat "$scratch/$script.txt"; exit 1; }
    cat "$scratch/$script.txt"
    "$python" -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' "$scratch/$script.svg"
done
grep -q 'order .* 2\.0[0-2]$' "$scratch/plate.txt" || { echo 'plate.py: expected second order'; exit 1; }
"$python" "$checkout/engine/capi/python/make_wheel.py" "$library" "$scratch"
unset PALPATE_LIBRARY
"$python" -c 'import sys, zipfile; zipfile.ZipFile(sys.argv[1]).extractall(sys.argv[2])' "$scratch"/palpate-*.whl "$scratch/unpacked"
[ -f "$scratch/unpacked/palpate/py.typed" ] || { echo 'the wheel hides its type hints'; exit 1; }
PYTHONPATH="$scratch/unpacked" "$python" -c 'import palpate; print(palpate.__file__, palpate.version())' | grep unpacked

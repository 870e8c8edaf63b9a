#!/bin/sh
# Checks that every shader of the build is valid SPIR-V. Argument: a file that lists them, one per line.
set -u
checked=0 bad=0
while IFS= read -r module; do
    spirv-val --target-env vulkan1.2 "$module" || { echo "invalid: $module"; bad=1; }
    checked=$((checked + 1))
done <"$1"
[ $checked -gt 0 ] || { echo 'no shader was built'; exit 1; }
[ $bad -eq 0 ] && echo "$checked shaders are valid"
exit $bad

#!/bin/sh
# Writes a page with scenes: one picture of a touch in the colours of the stiffness, its dent three times as deep, and in
# one sentence what one feels, which is the first line of the scene's file. Some 20 s for all.
# Arguments: palpate [build/bin/palpate], the folder [gallery], the pictures' size [640x480], scene files [all of scenes/].
set -eu
here=$(cd "$(dirname "$0")" && pwd)
palpate=${1:-$here/../build/bin/palpate} out=${2:-gallery} size=${3:-640x480}
[ $# -lt 3 ] && shift $# || shift 3
[ -x "$palpate" ] || { echo "$palpate: expected the program palpate, found none; sh samples/demo.sh builds it" >&2; exit 1; }
if [ $# -eq 0 ]; then
    for scene in "$here"/scenes/*.json; do case $scene in *.schema.json) ;; *) set -- "$@" "$scene" ;; esac; done
fi
mkdir -p "$out"

escaped() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/"/\&quot;/g'; }

figures=
for scene; do
    name=$(basename "$scene" .json)
    sentence=$(sed -n '1s|^// *||p' "$scene" | escaped)
    [ -n "$sentence" ] || { echo "$scene: expected a first line // with a sentence on what one feels, found none" >&2; exit 1; }
    "$palpate" render "$scene" --size "$size" --colour stiffness --exaggerate 3 --out "$out/$name.png" >"$out/said.txt" 2>&1 ||
        { cat "$out/said.txt" >&2; exit 1; }
    named=$(printf '%s' "$name" | escaped)
    figures="$figures<figure><img src=\"$named.png\" alt=\"$named\"><figcaption><b>$named</b> $sentence</figcaption></figure>
"
done
rm -f "$out/said.txt"
cat >"$out/index.html" <<HTML
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Palpate: the scenes</title>
<style>body{font:16px/1.5 sans-serif;margin:2em auto;max-width:64em;padding:0 1em;color:#1a1a1a}figure{display:inline-block;vertical-align:top;width:calc(50% - 1em);margin:.5em .5em .5em 0}
img{width:100%}figcaption{font-size:.9em}@media(max-width:50em){figure{width:100%}}</style></head><body>
<h1>The scenes</h1>
<p>Colours are the stiffness of the surface, and dents are drawn three times as deep as they are. Touch one: <code>palpate view samples/scenes/NAME.json</code>, hold Space and move.</p>
$figures</body></html>
HTML
echo "$(grep -c '<figure>' "$out/index.html") scenes: $out/index.html"

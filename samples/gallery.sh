#!/bin/sh
# Writes a page with every scene: one picture of a touch, and in one sentence what one feels, which is the first line of
# the scene's file. Arguments: palpate [build/bin/palpate], the folder [gallery], the pictures' size [640x480].
set -eu
here=$(cd "$(dirname "$0")" && pwd)
palpate=${1:-$here/../build/bin/palpate} out=${2:-gallery} size=${3:-640x480}
mkdir -p "$out"

figures=
for scene in "$here"/scenes/*.json; do
    name=$(basename "$scene" .json)
    [ "$name" != scene.schema ] || continue
    sentence=$(sed -n '1s|^// *||p' "$scene" | sed 's/&/\&amp;/g; s/</\&lt;/g')
    [ -n "$sentence" ] || { echo "$scene: expected a first line // with a sentence on what one feels, found none" >&2; exit 1; }
    "$palpate" render "$scene" --size "$size" --out "$out/$name.png" >/dev/null 2>"$out/err.txt" || { cat "$out/err.txt" >&2; exit 1; }
    figures="$figures<figure><img src=\"$name.png\" alt=\"$name\"><figcaption><b>$name</b> $sentence</figcaption></figure>
"
done
rm -f "$out/err.txt"
cat >"$out/index.html" <<HTML
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Palpate: the scenes</title>
<style>body{font:16px/1.5 sans-serif;margin:2em auto;max-width:64em;padding:0 1em;color:#1a1a1a}figure{display:inline-block;vertical-align:top;width:calc(50% - 1em);margin:.5em 0}
img{width:100%}figcaption{font-size:.9em}@media(max-width:50em){figure{width:100%}}</style></head><body>
<h1>The scenes</h1>
<p>Touch one: <code>palpate view samples/scenes/NAME.json</code>, hold Space and move.</p>
$figures</body></html>
HTML
echo "$(grep -c '<figure>' "$out/index.html") scenes: $out/index.html"

#!/bin/sh
# The gallery: two scenes are drawn and stand on the page with their sentences, every scene has one, and mistakes are
# refused. Arguments: palpate, the checkout, a scratch folder.
set -eu
palpate=$1 checkout=$2 scratch=$3
rm -rf "$scratch" && mkdir -p "$scratch/the page" && cd "$scratch"
gallery=$checkout/samples/gallery.sh
fail() { echo "FAILED: $*"; exit 1; }

sh "$gallery" "$palpate" "the page" 160x120 "$checkout/samples/scenes/palm_wart.json" "$checkout/samples/scenes/rubber_sheet.json" |
    grep -q '^2 scenes: the page/index.html$' || fail 'two scenes were not counted'
for name in palm_wart rubber_sheet; do
    grep -qF "<img src=\"$name.png\"" "the page/index.html" || fail "$name is not on the page"
    sentence=$(sed -n '1s|^// ||p' "$checkout/samples/scenes/$name.json")
    grep -qF "</b> $sentence</figcaption>" "the page/index.html" || fail "the page does not say: $sentence"
    od -An -tx1 -N24 "the page/$name.png" | tr -d ' \n' | grep -q '^89504e470d0a1a0a.*000000a000000078$' || fail "$name.png is no picture of 160 x 120"
done
[ "$(ls "the page" | wc -l)" -eq 3 ] || fail "more than a page and its pictures: $(ls "the page")"

# One sentence each, with a full stop, that does not lean on another scene.
for scene in "$checkout"/samples/scenes/*.json; do
    case $scene in *.schema.json) continue ;; esac
    head -1 "$scene" | grep -Eq '^// [A-Z].{20,140}\.$' || fail "$scene: no sentence in its first line"
    if head -1 "$scene" | grep -Eqi 'the same|as above'; then fail "$scene: its sentence leans on another scene"; fi
done

echo '{"cloud": "sample:skin"}' >silent.json
if sh "$gallery" "$palpate" out 160x120 silent.json >said 2>&1; then fail 'a scene without a sentence was drawn'; fi
grep -q 'silent.json: expected a first line' said || fail "$(cat said)"
printf '// What it is.\n{"cloud": "sample:skn"}\n' >wrong.json
if sh "$gallery" "$palpate" out 160x120 wrong.json >said 2>&1; then fail 'a scene that is wrong was drawn'; fi
grep -q 'skn' said || fail "$(cat said)"
echo 'two scenes are on the page'

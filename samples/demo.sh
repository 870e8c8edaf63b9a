#!/bin/sh
# Installs missing packages (asks first unless root), builds, touches objects and draws them, and computes the paper
# again. It makes a page of pictures and one of claims.
set -u
cd "$(dirname "$0")/.." || exit 1
. engine/prepare.sh

usage() {
    cat <<'TEXT'
usage: sh samples/demo.sh [--yes] [--no-install] [--dry-run]

  --yes          install missing packages without asking (password-less sudo)
  --no-install   install nothing; exit 3 naming what is missing
  --dry-run      print the steps without running them
TEXT
}

for option; do
    case $option in
    --help | -h) usage; exit 0 ;;
    --yes | --no-install | --dry-run) prepare_options "$option" ;;
    *) say "unknown option $option"; usage; exit 2 ;;
    esac
done

# shellcheck disable=SC2086
prepare_packages $packages_build
build=${PALPATE_BUILD:-build}
# A build that the tests made keeps its options, because a change would compile everything again.
if [ -f "$build/CMakeCache.txt" ]; then prepare_build "$build"; else prepare_build "$build" -DPALPATE_TESTS=OFF -DPALPATE_BENCHMARKS=OFF; fi
out=$build/demo
if [ -n "$dry_run" ]; then say "would write $out/index.html"; exit 0; fi

say '== a wart under the skin'
"$build/bin/palpate" touch sample:skin --out "$out/skin" || exit 1
say
say '== objects that are touched'
mkdir -p "$out" || exit 1
draw() { # name of the picture, its caption, and the arguments of palpate render
    name=$1 caption=$2
    shift 2
    "$build/bin/palpate" render "$@" --size 1000x700 --out "$out/$name.png" || exit 1
    figures="$figures<figure><img src=\"$name.png\" alt=\"$caption\"><figcaption>$caption</figcaption></figure>
"
}
figures=
draw skin 'Skin with a wart of ten times its stiffness, pressed beside it' sample:skin
draw palm 'A palm with four stiff tendons; colours are the stiffness' sample:palm --colour stiffness
draw lobe 'An ear lobe, clamped around the patch as the paper has it' sample:ear-lobe --dark
touched=$figures figures=
say
say "== what the paper's figures show"
draw contact 'The contact: the proxy stays on the surface, the HIP is in it; the force on the hand is along the normal' sample:ellipsoid --window 16mm --footprint-radius 3mm --colour plain
draw sphere 'The points near the contact projected (blue) to the sphere fitted to them; black: the surface at rest' sample:ellipsoid --sphere --projected --ghost
for law in linear hyperbolic; do
    draw $law-soft "Rigidity $law along the object: 0.25 N at its soft end, displacements four times as large" samples/scenes/ellipsoid_$law.json --place=-30mm,0,30mm --force 0.25N --exaggerate 4 --view whole
    draw $law-stiff "Rigidity $law: the same force at its stiff end" samples/scenes/ellipsoid_$law.json --place=30mm,0,30mm --force 0.25N --exaggerate 4 --view whole
done
say
say '== the paper, computed again: one to two minutes on two cores'
"$build/bin/palpate" paper --out "$out/paper" || exit 1
cat >"$out/index.html" <<HTML || exit 1
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Palpate: what the demo made</title>
<style>body{font:16px/1.5 sans-serif;margin:2em auto;max-width:64em;padding:0 1em;color:#1a1a1a}figure{display:inline-block;width:calc(50% - 1em);margin:.5em 0}
img{width:100%}figcaption{font-size:.9em}@media(max-width:50em){figure{width:100%}}</style></head><body>
<h1>What the demo made</h1>
<p><a href="paper/index.html">The paper's claims, computed again</a>, each beside our figure. The <a href="skin/">wart in numbers and charts</a>. To touch these yourself: <code>$build/bin/palpate view</code>, hold Space and move.</p>
<h2>Objects, touched</h2>
$touched<h2>What the paper's figures show</h2>
<p>Five places in one picture, with a table, are in <a href="paper/index.html">part a</a> of the other page; an ear lobe that may bend at its edges in part b.</p>
$figures</body></html>
HTML
say
say "pictures: $out/index.html; the paper's claims: $out/paper/index.html; the wart: $out/skin"
say "next: $build/bin/palpate view   (a window; hold Space over the object and move)"
say "      $build/bin/palpate touch sample:palm --place 14mm,5mm,0 --out touch"
say "      your own cloud: $build/bin/palpate info FILE --length-unit mm"

#!/bin/sh
# Checks what the Debian packages hold and say. Argument: their folder.
set -eu
hardening=$(cd "$(dirname "$0")/.." && pwd)/hardening.sh
cd "$1"
failed=0 skipped=0
complain() { echo "$*"; failed=1; }
field() { dpkg-deb -f "$package" "$1"; }
needs() { # needs FIELD WORD...: the field of the package names these
    found=$(field "$1")
    shift
    for word; do case $found in *"$word"*) ;; *) complain "$package: no $word in \"$found\"" ;; esac; done
}
holds() { # holds PATTERN...: files of the package, of which nothing lies outside /usr
    dpkg-deb -c "$package" >contents.txt
    for pattern; do grep -q "$pattern\$" contents.txt || complain "$package holds nothing like $pattern: $(tail -5 contents.txt)"; done
    if sed 's/ -> .*//' contents.txt | grep -v ' \./$' | grep -v ' \./usr/'; then complain "$package: files outside /usr"; fi
}
one() { # one NAME: finds the package
    set -- "$1"_*.deb
    [ -f "$1" ] || { complain "no package $1"; exit 1; }
    package=$1
}

one palpate
needs Depends libc6 libembree libvulkan1
needs Recommends mesa-vulkan-drivers
holds bin/palpate lib/udev/rules.d/70-palpate-falcon.rules share/man/man1/palpate.1.gz share/bash-completion/completions/palpate \
    share/applications/palpate.desktop icons/hicolor/scalable/apps/palpate.svg share/palpate/scenes/palm.json share/doc/palpate/copyright share/doc/palpate/changelog.gz
if grep -E 'include/|\.(a|so|py)( |$)' contents.txt; then complain 'the program comes with files for developers'; fi
dpkg-deb -I "$package" postinst | grep -q 'udevadm trigger' || complain "$package does not tell udev"

one libpalpate0
needs Depends libc6 libembree
holds 'libpalpate\.so\.0 -> libpalpate.so\.[0-9.]*' 'libpalpate\.so\.0\.[0-9]*\.[0-9]*'
dpkg-deb -I "$package" shlibs | grep -q '^libpalpate 0 libpalpate0' || complain "$package: programs that use it would not depend on it"

one libpalpate-dev
needs Depends 'libpalpate0 (= ' libembree-dev
holds include/palpate.h pkgconfig/palpate.pc cmake/palpate/palpateConfig.cmake 'libpalpate\.so -> libpalpate.so.0' libpalp_core.a

one python3-palpate
needs Depends libpalpate0 python3-numpy
needs Architecture all
holds python3/dist-packages/palpate/__init__.py python3/dist-packages/palpate/py.typed
# What Python compiles at the first import would stay behind when the package is removed.
dpkg-deb -I "$package" prerm | grep -q py3clean || complain "$package leaves what Python compiled"

rm -rf unpacked
for package in *.deb; do dpkg-deb -x "$package" unpacked; done
programs=$(find unpacked -type f \( -path '*/bin/*' -o -name '*guardian' -o -name '*.so.*' \))
[ "$(echo "$programs" | wc -l)" -ge 3 ] || complain "expected a program, its guardian and a library, found only $programs"
# shellcheck disable=SC2086 # their names have no blanks
sh "$hardening" $programs || { status=$?; if [ $status -eq 77 ]; then skipped=1; else failed=1; fi; }
rm -rf unpacked

versions=$(for package in *.deb; do field Version; done | sort -u)
[ "$(echo "$versions" | wc -l)" -eq 1 ] || complain "versions differ: $versions"
[ $failed -eq 0 ] || exit 1
[ $skipped -eq 0 ] || exit 77

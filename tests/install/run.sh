#!/bin/sh
# Packs the build, unpacks it elsewhere without being root, runs it there, and builds an outside project against it. Where
# there are no Debian packages it is installed and moved. Arguments: build folder, source folder
# of this test, C++ compiler, CMake generator (a machine need not have the default one).
set -eu
build=$1 source=$2 compiler=$3 generator=$4
place=$(mktemp -d "${TMPDIR:-/tmp}/palpate install XXXXXX")
trap 'rm -rf "$place"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

if command -v dpkg-shlibdeps >/dev/null 2>&1; then
    # gzip: it takes a tenth of the time. Ninja: what is built is packed, where Make's files would look at it all again.
    (cd "$build" && cpack -B "$place/packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -D CPACK_CMAKE_GENERATOR=Ninja) >"$place/install.log" 2>&1 ||
        { tail -50 "$place/install.log"; exit 1; }
    sh "$source/packages.sh" "$place/packages"
    for package in "$place"/packages/*.deb; do dpkg-deb -x "$package" "$place/unpacked"; done
    mv "$place/unpacked/usr" "$place/moved"
else
    cmake --install "$build" --prefix "$place/first" >"$place/install.log" || { cat "$place/install.log"; exit 1; }
    mv "$place/first" "$place/moved" # a package must not remember where it was installed
fi

# The lines of C++ on the front page are a program as they stand there.
sed -n '/^```cpp$/,/^```$/p' "$source/../../README.md" | sed '1d;$d' >"$place/readme.cpp"
grep -q 'int main' "$place/readme.cpp" || { echo 'README.md has no lines of C++'; exit 1; }

cmake -G "$generator" -S "$source/outside" -B "$place/outside" -DCMAKE_PREFIX_PATH="$place/moved" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release -DSAMPLES="$source/../../samples" -DREADME="$place/readme.cpp" >"$place/configure.log" 2>&1 || { cat "$place/configure.log"; exit 1; }
cmake --build "$place/outside" >"$place/build.log" 2>&1 || { cat "$place/build.log"; exit 1; }
"$place/outside/hello_touch"
"$place/outside/hello_session"
"$place/moved/bin/palpate" convert sample:ellipsoid "$place/scan.ply" --points 5000 >/dev/null
"$place/outside/readme" "$place/scan.ply" | grep -E '^[0-9]+ N/m$' # a number that is finite
"$place/moved/bin/palpate" --version
"$place/moved/bin/falcon_demo" --list | grep -q palm_wart # it finds the scenes that moved with it

# A stranger's C program finds palpate.h and the library by pkg-config, wherever the tree lies.
PKG_CONFIG_PATH=$(dirname "$(find "$place/moved" -name palpate.pc)")
export PKG_CONFIG_PATH
libraries=$(dirname "$PKG_CONFIG_PATH")
eval "set -- $(pkg-config --cflags --libs palpate)" # it quotes what a shell would divide
# shellcheck disable=SC2086
gcc -std=c11 -pedantic -Wall -Wextra -Werror "$source/../capi/program/capi_program.c" -o "$place/c program" "$@" -lm
LD_LIBRARY_PATH=$libraries "$place/c program"
python=${PALPATE_PYTHON:-/usr/bin/python3}
if "$python" -c 'import numpy' 2>/dev/null; then
    LD_LIBRARY_PATH=$libraries PYTHONPATH=$place/moved/lib/python3/dist-packages "$python" -c 'import palpate; print(palpate.__file__)' | grep -F "$place/moved/"
else
    echo "skipped: the package for Python is not imported, $python has no numpy (package python3-numpy)"
fi

# The manual and the completion are those of the program.
palpate=$place/moved/bin/palpate
gzip -dc "$place/moved/share/man/man1/palpate.1.gz" >"$place/palpate.1"
"$palpate" --man | cmp - "$place/palpate.1"
"$palpate" --completion | cmp - "$place/moved/share/bash-completion/completions/palpate"
completed() { # completed WORDS...: what bash offers for the last of them
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _palpate; echo "${COMPREPLY[*]}"' - "$place/moved/share/bash-completion/completions/palpate" "$@"
}
[ "$(completed palpate tou)" = touch ] || { echo "bash does not complete touch: $(completed palpate tou)"; exit 1; }
[ "$(completed palpate touch --cel)" = --cells ] || { echo "bash does not complete --cells: $(completed palpate touch --cel)"; exit 1; }
[ -z "$(completed palpate touch sca)" ] || { echo 'bash completes something else than files'; exit 1; }
if command -v groff >/dev/null 2>&1; then
    groff -man -Tutf8 -ww -z "$place/palpate.1" 2>"$place/groff.log" && [ ! -s "$place/groff.log" ] || { head -5 "$place/groff.log"; exit 1; }
else
    echo 'skipped: the manual is not set, there is no groff (package groff-base)'
fi

# A desktop opens clouds with the window, and udev finds the rules.
entry=$place/moved/share/applications/palpate.desktop
[ -x "$place/moved/bin/$(sed -n 's/^Exec=\([a-z]*\) view %f$/\1/p' "$entry")" ]
type=$(sed -n 's/^MimeType=\(.*\);$/\1/p' "$entry")
grep -q "type=\"$type\"" "$place/moved/share/mime/packages/palpate.xml"
[ -s "$place/moved/share/icons/hicolor/scalable/apps/$(sed -n 's/^Icon=//p' "$entry").svg" ]
[ -s "$place/moved/lib/udev/rules.d/70-palpate-falcon.rules" ]

# CHOLMOD is in part under the GPL: it must not be in what is passed on, see third_party_notes.md.
[ ! -e "$place/moved/bin/palpate_peers" ] || { echo 'palpate_peers was installed'; exit 1; }
if ldd "$place/moved/bin/palpate" | grep -E 'cholmod|openblas'; then echo 'palpate is linked with it'; exit 1; fi

# Every header that was installed finds what it includes.
(cd "$place/moved/include/palpate" && find engine device -name '*.h' | sed 's/.*/#include "&"/') >"$place/all.cpp"
grep -q multigrid_plate_solver "$place/all.cpp"
if grep -E '/(detail|tools|host)/' "$place/all.cpp"; then echo 'a header that is not for users was installed'; exit 1; fi
"$compiler" -std=c++20 -fsyntax-only -I "$place/moved/include/palpate" "$place/all.cpp"

#!/bin/sh
# The reference is made without a warning, and a mistake in a comment would be one. Arguments: doxygen, the folder of
# the options of both books, a scratch folder.
set -eu
doxygen=$1 options=$2 scratch=$3
rm -rf "$scratch" && mkdir -p "$scratch" && cd "$scratch"

make_reference() { # make_reference BOOK INPUT...: as the target does, and of these files too
    book=$1
    shift
    mkdir -p "$book"
    { cat "$options/Doxyfile.$book"; echo "OUTPUT_DIRECTORY = \"$scratch/$book\""; for file; do echo "INPUT += \"$file\""; done; } >options
    "$doxygen" options >log 2>&1
}

failed=0
for book in reference_c reference_cpp; do
    make_reference $book || { echo "FAILED: $book"; cat log; failed=1; }
done
holds() { grep -q "$2" "$1" || { echo "FAILED: $1 does not say: $2"; failed=1; }; }
holds reference_c/html/palpate_8h.html 'Runs one tick'
holds reference_c/html/index.html 'A session in three calls'
holds reference_cpp/html/deform_8h.html 'Runs section 2 of the paper'
holds reference_cpp/html/index.html 'Where to begin'

# A parameter that is not there, and in the interface for C a field without a sentence.
printf '/** \\file */\n/** Counts. \\param wrong a name */\nint counted(int right);\n' >parameter.h
printf '/** \\file */\n/** A struct. */\nstruct bare {\n    int field;\n};\n' >field.h
for mistake in 'reference_c parameter' 'reference_c field' 'reference_cpp parameter'; do
    set -- $mistake
    if make_reference "$1" "$scratch/$2.h"; then echo "FAILED: the mistake in $2.h went unnoticed in $1"; failed=1; fi
done
exit $failed

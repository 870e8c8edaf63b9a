#!/bin/sh
# Checks that engine/method.md lists every \differs note of the code, and nothing else. Argument: the checkout.
#
# A note belongs to the declaration that follows its comment. A row of the page is [`NAME`](FILE): NAME must stand in the
# first line of that declaration.
set -u
cd "$1" || exit 1
page=${2:-engine/method.md}

# prints "FILE<tab>declaration" for every note
notes() {
    find engine compute_shaders device samples -name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' | sort | while IFS= read -r file; do
        awk -v file="$file" '
        function told() { while (waiting > 0) { print file "\t" line; --waiting } }
        /\\differs/ { waiting += gsub(/\\differs/, "") ; if ($0 !~ /^ *\/\//) print file "\ta note that is no comment of its own"; next }
        waiting && !/^ *\/\// && !/^ *(template|\[\[nodiscard\]\]$)/ { line = $0; told() }
        END { line = "the end of the file"; told() }' "$file"
    done
}
# prints "FILE<tab>NAME" for every row, with files relative to the checkout
rows() {
    grep '^|' "$page" | awk -v tick='`' '{
        while (match($0, "\\[" tick "[A-Za-z]+" tick "\\]\\([^)]*\\)")) {
            entry = substr($0, RSTART, RLENGTH)
            $0 = substr($0, RSTART + RLENGTH)
            name = file = entry
            sub("^\\[" tick, "", name); sub(tick ".*", "", name)
            sub(/^.*\(/, "", file); sub(/\)$/, "", file)
            if (file ~ /^\.\.\//) sub(/^\.\.\//, "", file); else file = "engine/" file
            print file "\t" name
        }
    }'
}

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
notes >"$work/notes"
rows >"$work/rows"
[ -s "$work/notes" ] && [ -s "$work/rows" ] || { echo "no note or no row was found"; exit 1; }

# Every note needs a row of its own, and every row a note.
awk -F '	' -v page="$page" '
function holds(text, name) { return (" " text " ") ~ ("[^A-Za-z0-9_]" name "[^A-Za-z0-9_]") }
NR == FNR { ++rows; file[rows] = $1; name[rows] = $2; next }
{
    for (r = 1; r <= rows; ++r) if (!used[r] && file[r] == $1 && holds($2, name[r])) { used[r] = 1; next }
    print page " has no row of its own for the \\differs note of " $1 " before: " $2
    bad = 1
}
END {
    for (r = 1; r <= rows; ++r) if (!used[r]) { print page " lists " name[r] " of " file[r] ", where no \\differs note stands"; bad = 1 }
    exit bad
}' "$work/rows" "$work/notes" || exit 1

echo "$(wc -l <"$work/notes") notes, each listed in $page"

#!/bin/sh
# Checks that every relative link and picture of the pages points at an existing file, every #part at a heading, and that
# the tests exist that the pages name as `Suite.Case`, or by less where there is a * for any letters or a case of five
# words.
# Arguments: the checkout; pages, or none for all that git or a reader would show.
set -u
cd "$1" || exit 1
shift
[ $# -gt 0 ] || set -- ./*.md engine/*.md engine/*/*.md engine/tools/*/README.md device/*.md tests/*.md samples/*.md samples/*/README.md

# prints "PAGE<tab>TARGET" of each link outside of code blocks
links() {
    awk -v tick='`' '
    FNR == 1 { code = 0 }
    substr($0, 1, 3) == tick tick tick { code = !code }
    code { next }
    {
        while (match($0, /\]\([^) ]+\)/)) {
            print FILENAME "\t" substr($0, RSTART + 2, RLENGTH - 3)
            $0 = substr($0, RSTART + RLENGTH)
        }
    }' "$@"
}
# prints the names that GitHub gives to the headings of a page
headings() {
    awk -v tick='`' '
    substr($0, 1, 3) == tick tick tick { code = !code }
    !code && /^#+ / { sub(/^#+ /, ""); $0 = tolower($0); gsub(/[^a-z0-9 _-]/, ""); gsub(/ /, "-"); print }' "$1"
}

work=$(mktemp) || exit 1
trap 'rm -f "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
for page in "$@"; do [ -f "$page" ] || { echo "$page is not there"; exit 1; }; done
links "$@" >"$work"
[ -s "$work" ] || { echo 'no link was found'; exit 1; }

links=$(wc -l <"$work") bad=0
while IFS='	' read -r page target; do
    case $target in
    http://* | https://* | mailto:*) continue ;; # no test needs the network
    esac
    file=${target%%#*}
    if [ -n "$file" ]; then file=$(dirname "$page")/$file; else file=$page; fi
    [ -e "$file" ] || { echo "$page links to $target, which is not there"; bad=1; continue; }
    case $target in
    *'#'*) headings "$file" | grep -qxF "${target#*#}" || { echo "$page links to $target: $file has no such heading"; bad=1; } ;;
    esac
done <"$work"

grep -rhoE '^TEST(_F|_P)?\([A-Za-z0-9]+, [A-Za-z0-9]+\)' tests --include='*.cpp' | sed 's/^[A-Z_]*(\(.*\), \(.*\))$/\1.\2/' >"$work"
[ -s "$work" ] || { echo 'no test was found'; exit 1; }
for page in "$@"; do
    tr -c 'A-Za-z0-9.`*/' '\n' <"$page" | sed -n "s|^\`\([A-Za-z0-9.*]*\)\(/[A-Za-z0-9]*\)\{0,1\}\`.*|$page	\1|p"
done | sort -u | awk -F '	' '
    function words(word) { return gsub(/[A-Z][a-z0-9]+/, "", word) }
    function exists(word,    k) {
        if (word !~ /\*/) return word in known
        gsub(/\./, "\\.", word); gsub(/\*/, "[A-Za-z0-9.]*", word)
        for (k = 1; k <= tests; ++k) if (name[k] ~ "^([A-Za-z0-9]*\\.)?" word "$") return 1
    }
    NR == FNR { name[++tests] = $1; known[$1]; split($1, part, "."); known[part[1]]; known[part[2]]; next }
    $2 ~ /^[A-Z][A-Za-z0-9]*\.[A-Z*][A-Za-z0-9*]*$/ || ($2 ~ /[A-Z][a-z]/ && $2 ~ /^[A-Za-z0-9]*\*[A-Za-z0-9*]*$/) ||
    ($2 ~ /^[A-Za-z0-9]*$/ && words($2) >= 5) {
        if (!exists($2)) { print $1 " names the test " $2 ", which does not exist"; bad = 1 }
    }
    END { exit bad }' "$work" - || bad=1

[ $bad -eq 0 ] && echo "$links links point at existing files and headings"
exit $bad

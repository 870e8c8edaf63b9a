#!/bin/sh
# Checks that every relative link and picture of the pages points at an existing file, and every #part at a heading.
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
for page in "$@"; do [ -f "$page" ] || { echo "$page is not there"; exit 1; }; done
links "$@" >"$work"
[ -s "$work" ] || { echo 'no link was found'; exit 1; }

bad=0
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

[ $bad -eq 0 ] && echo "$(wc -l <"$work") links point at existing files and headings"
exit $bad

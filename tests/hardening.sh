#!/bin/sh
# What an overflow would meet, in each file that is installed: its place in memory is random, tables of the linker are
# read-only, no stack is executable, the stack is guarded, and the C library is told the sizes of buffers. Arguments: the
# programs and libraries.
set -u
command -v readelf >/dev/null 2>&1 || { echo 'readelf is missing (package binutils)'; exit 77; }
[ $# -gt 0 ] || { echo 'expected files'; exit 2; }
bad=0 fortified=0
complain() { echo "$*"; bad=1; }
for file; do
    readelf -hW "$file" | grep -q 'Type: *DYN' || complain "$file: it is loaded at a fixed address"
    readelf -lW "$file" | grep -q GNU_RELRO || complain "$file: no table is made read-only"
    readelf -dW "$file" | grep -qE 'BIND_NOW|FLAGS_1.*NOW' || complain "$file: functions are looked up while it runs, in a table that can be written"
    readelf -lW "$file" | grep GNU_STACK | grep -q 'RWE' && complain "$file: its stack is executable"
    case $file in
    *.so*) ;;
    *) readelf -dW "$file" | grep -q 'FLAGS_1.*PIE' || complain "$file: it is no program that can lie anywhere" ;;
    esac
    case $file in
    *guardian) ;; # it copies packets of a fixed size, and has no array on a stack that grows
    *)
        readelf -sW "$file" | grep -q '__stack_chk_fail' || complain "$file: no stack is guarded"
        # Clang has sizes of copies checked alone, of which a small program may have none that is not known to fit; and files
        # of packages do not say who compiled them.
        if readelf -sW "$file" | grep -q '__[a-z]*_chk@'; then
            fortified=1
        else
            compiler=$(readelf -p .comment "$file" 2>/dev/null)
            case $compiler in *clang*) ;; *GCC*) complain "$file: no size is checked in the C library (FORTIFY)" ;; esac
        fi
        ;;
    esac
done
[ $fortified -eq 1 ] || complain "$*: no size is checked in the C library (FORTIFY)"
[ $bad -eq 0 ] && echo "$# files are hardened"
exit $bad

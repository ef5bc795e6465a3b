#!/bin/sh
# Merges a kernel's objects into one object that has one global symbol.
# Usage: merge_kernel.sh LD OBJCOPY READELF SYMBOL OUTPUT OBJECT...
#
# A kernel is code that is compiled for newer processors. Its objects contain inline functions
# and templates that the rest of the program, compiled for older processors, contains too. A linker
# keeps only one copy of such a function for the whole program, and older processors must be able to
# run this copy. So all symbols that the objects define become local, except SYMBOL. Undefined
# symbols are resolved by the rest of the program.
#
# Fails if the kernel has code that would run before the program has checked the processor.
set -eu
ld=$1 objcopy=$2 readelf=$3 symbol=$4 output=$5
shift 5
rm -f "$output"
merged=$output.tmp
trap 'rm -f "$merged"' EXIT

fail() {
  echo "merge_kernel.sh: $*" >&2
  exit 1
}

"$ld" -r --force-group-allocation -o "$merged" "$@"
"$objcopy" --keep-global-symbol="$symbol" "$merged"

sections=$("$readelf" --wide --section-headers "$merged")
case $sections in
  *.init_array* | *.fini_array* | *.preinit_array* | *.ctors* | *.dtors*)
    "$readelf" --wide --relocs "$merged" | grep -A 3 -E "'\.rela?\.(init_array|fini_array|preinit_array|ctors|dtors)" >&2 || true
    fail "the kernel has static initialisers: these functions would run on any processor when the program starts" ;;
  *" GROUP "*) fail "the kernel still has section groups; the linker may replace them by groups of other objects" ;;
esac
symbols=$("$readelf" --wide --symbols "$merged")
case $symbols in
  *" IFUNC "*) fail "the kernel has an indirect function, whose resolver runs when the program starts" ;;
esac
# Columns: number, value, size, type, binding, visibility, section, name.
visible=$(echo "$symbols" | awk '$5 ~ /^(GLOBAL|WEAK|UNIQUE)$/ && $7 != "UND" { print $8 }')
[ "$visible" = "$symbol" ] || fail "these symbols are visible, instead of $symbol alone: $visible"
mv "$merged" "$output"

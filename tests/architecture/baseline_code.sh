#!/usr/bin/env bash
# Checks that only the AVX2 kernel contains instructions that x86-64 processors without AVX2 lack. This kernel is the render code,
# compiled for processors with AVX2. Disassembles only the objects of Bandsaw itself, because system libraries check the
# processor at run time. Usage: baseline_code.sh BUILD-FOLDER
set -euo pipefail
cd "$1"
# VEX-coded instructions (AVX, AVX2, FMA, F16C), and those of BMI1, BMI2, LZCNT and MOVBE. tzcnt is allowed: older processors
# execute it as bsf, which gives the same result for operands other than zero, and compilers emit it for all processors.
newer=$'\t''(v[a-z0-9]+|andn|bextr|blsi|blsmsk|blsr|bzhi|mulx|pdep|pext|rorx|sarx|shlx|shrx|lzcnt|movbe)[lqwb]?( |$)'
count() { objdump --disassemble --no-show-raw-insn "$@" | grep --extended-regexp --count "$newer" || true; }

kernel=renderlib/kernel_avx2.o
[ "$(count "$kernel")" -gt 1000 ] || { echo "$kernel has few instructions that the pattern matches, so the pattern is wrong"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
for archive in proto/*.a renderlib/*.a coordinator/*.a worker/*.a; do
  cp "$archive" "$work/archive.a"
  ar d "$work/archive.a" kernel_avx2.o
  found=$(count "$work/archive.a")
  [ "$found" -eq 0 ] || { echo "$archive: $found instructions that processors without AVX2 lack"; status=1; }
done
for object in worker/CMakeFiles/*main*/*.o coordinator/CMakeFiles/bandsaw.dir/cli/*.o renderlib/CMakeFiles/bandsaw-import.dir/import/*.o; do
  found=$(count "$object")
  [ "$found" -eq 0 ] || { echo "$object: $found instructions that processors without AVX2 lack"; status=1; }
done
exit $status
